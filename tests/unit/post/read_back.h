// A program read back against its CL data: every position within half of the last digit, every feed between
// them within the tolerance.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "base/angles.h"
#include "unit/post/post_support.h"

namespace swarf::post {

/// How far half a digit of every word may put the tip at these axis values, mm: by the machine's forward
/// kinematics alone. rad for the axis: half a digit of each rotary word, and half of one by which an axis
/// beside the pole is laid into it.
struct DigitBound {
  double tip_mm = 0.0, axis_rad = 0.0;
};

inline DigitBound digit_bound(const Posted& posted, const program::NcMove& move, bool tcp) {
  const FollowRules& rules = posted.result.rules;
  DigitBound bound{1e-7, 1e-9};
  if (tcp) bound.tip_mm += std::sqrt(3.0) * rules.linear_half;
  for (size_t i = 0; i < posted.machine.axes.size(); ++i) {
    const bool rotary = posted.machine.axes[i].kind == kinematics::AxisKind::kRotary;
    kinematics::AxisValues low = move.q_to, high = move.q_to;
    const double half = rotary ? rules.rotary_half : rules.linear_half;
    low[static_cast<long>(i)] -= half;
    high[static_cast<long>(i)] += half;
    if (rotary) bound.axis_rad += half;
    if (!tcp)
      bound.tip_mm +=
          0.5 * 1.001 *
          (kinematics::forward(posted.machine, high).tip_W - kinematics::forward(posted.machine, low).tip_W)
              .norm();
  }
  bound.axis_rad += rules.snap_rad;
  return bound;
}

/// Cycles and what leads to them are without TCP in every program.
inline bool reaches(const Posted& posted, const program::NcMove& move, const ToolPose& pose) {
  const DigitBound bound =
      digit_bound(posted, move, posted.result.tcp && move.law != program::BlockLaw::kJoint);
  return (move.to.tip_W - pose.tip_W).norm() <= bound.tip_mm &&
         angle_between(move.to.axis_W, pose.axis_W) <= bound.axis_rad;
}

/// Distance of a point from the line or arc of a CL move, mm.
inline double distance_from(const program::Move& move, const Vec3& tip) {
  const Vec3 way = move.to.tip_W - move.from.tip_W;
  if (!move.arc) {
    const double share = way.squaredNorm() > 0.0
                             ? std::clamp((tip - move.from.tip_W).dot(way) / way.squaredNorm(), 0.0, 1.0)
                             : 0.0;
    return (tip - move.from.tip_W - share * way).norm();
  }
  const Vec3 n = move.arc->normal_W, r = move.from.tip_W - move.arc->centre_W, d = tip - move.arc->centre_W;
  const double radius = (r - r.dot(n) * n).norm(), across = (d - d.dot(n) * n).norm() - radius;
  const double low = std::min(0.0, way.dot(n)), high = std::max(0.0, way.dot(n));
  const double height = d.dot(n) - r.dot(n);
  return std::hypot(across, height - std::clamp(height, low, high));
}

/// The tip at a share of a move as the control drives it.
inline Vec3 tip_at(const Posted& posted, const program::NcMove& move, double share) {
  if (move.arc) {
    const Vec3 n = move.arc->normal_W, r = move.from.tip_W - move.arc->centre_W,
               e = move.to.tip_W - move.arc->centre_W;
    const Vec3 flat = r - r.dot(n) * n, end = e - e.dot(n) * n;
    double sweep = signed_angle(n, flat, end);
    if (sweep <= 1e-12) sweep += kTurn;
    const Vec3 turned = std::cos(sweep * share) * flat + std::sin(sweep * share) * n.cross(flat);
    const double radius = flat.norm() + share * (end.norm() - flat.norm());
    return move.arc->centre_W + turned.normalized() * radius + (r.dot(n) + share * (e - r).dot(n)) * n;
  }
  if (move.law != program::BlockLaw::kJoint)
    return move.from.tip_W + share * (move.to.tip_W - move.from.tip_W);
  return kinematics::forward(posted.machine, move.q_from + share * (move.q_to - move.q_from)).tip_W;
}

/// "" when the program does what the CL data says; else what is wrong first. All tools have one length here.
inline std::string compare(const Posted& posted) {
  const bool tcp = posted.result.tcp;
  std::vector<const program::Move*> from_cl;
  for (const program::Move& move : posted.expected) from_cl.push_back(&move);
  size_t at = 0;
  while (at < posted.moves.size() && !reaches(posted, posted.moves[at], posted.cl.start)) ++at;
  // The start itself may be a place without a move: the control is put there by the first complete position.
  if (at == posted.moves.size()) return "the start is not reached";
  // With TCP an approach comes there twice: by the axes, then by the tip.
  const auto stay = [&](const ToolPose& pose) {
    while (at + 1 < posted.moves.size() && posted.moves[at + 1].rapid &&
           reaches(posted, posted.moves[at + 1], pose))
      ++at;
  };
  stay(posted.cl.start);
  for (size_t i = 0; i < from_cl.size(); ++i) {
    const program::Move& move = *from_cl[i];
    // A whole circle ends where it starts, and is a move all the same.
    const bool circle = move.arc && (move.to.tip_W - move.from.tip_W).norm() < 1e-9;
    size_t to = at + (circle ? 1 : 0);
    while (to < posted.moves.size() && !reaches(posted, posted.moves[to], move.to)) ++to;
    if (to == posted.moves.size())
      return fmt::format(
          "CL line {}: ({:.4f}, {:.4f}, {:.4f}) axis ({:.6f}, {:.6f}, {:.6f}) is not reached after "
          "line {}",
          move.line, move.to.tip_W.x(), move.to.tip_W.y(), move.to.tip_W.z(), move.to.axis_W.x(),
          move.to.axis_W.y(), move.to.axis_W.z(), posted.moves[at].line);
    for (size_t k = at + 1; k <= to && !move.rapid; ++k) {
      for (int part = 0; part <= 8; ++part) {
        const double off = distance_from(move, tip_at(posted, posted.moves[k], part / 8.0));
        const double allowed = tcp && !move.arc ? posted.result.plan.digits_mm : posted.result.rules.tip_mm;
        if (off > allowed + 1e-7)
          return fmt::format("CL line {}, program line {}: {:.3f} um off, allowed {:.3f}", move.line,
                             posted.moves[k].line, um_from_mm(off), um_from_mm(allowed));
      }
    }
    at = to;
    stay(move.to);
  }
  return "";
}

}  // namespace swarf::post
