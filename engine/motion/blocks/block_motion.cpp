#include "motion/blocks/block_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/angles.h"
#include "base/check.h"
#include "kinematics/joint_path.h"
#include "motion/blocks/pose_law.h"

namespace swarf::motion {
namespace {

using kinematics::Jet;
using kinematics::JointPath;
using toolpath::BlockLaw;
using toolpath::BlockMove;

constexpr int kPiecesMax = 10'000'000;

MotionBounds tcp_bounds(const BlockMove& block) {
  const double theta = angle_between(block.from.axis_W, block.to.axis_W);
  MotionBounds bounds;
  bounds.turn_rate = theta;
  if (block.arc) {
    const ArcShape arc(block);
    bounds.speed = arc.speed();
    bounds.bend = arc.acceleration() + 2.0 * theta * arc.speed();
    return bounds;
  }
  const Vec3 way = block.to.tip_W - block.from.tip_W;
  const Vec3 across = block.from.axis_W.cross(block.to.axis_W);
  bounds.speed = way.norm();
  if (theta > 0.0 && across.norm() > 0.0) bounds.bend = 2.0 * theta * across.normalized().cross(way).norm();
  return bounds;
}

/// a = d/|d| with d linear: its angle turns at sin(theta)/|d|^2, and |d| >= cos(theta/2).
MotionBounds ends_bounds(const BlockMove& block) {
  MotionBounds bounds = tcp_bounds(block);
  const double theta = bounds.turn_rate;
  if (theta == 0.0) return bounds;
  const double half_sine = std::sin(0.5 * theta), least = std::cos(0.5 * theta);
  bounds.turn_rate = 2.0 * std::tan(0.5 * theta);
  bounds.turn_acceleration = 4.0 * std::sin(theta) * half_sine * half_sine / std::pow(least, 4);
  bounds.bend *= bounds.turn_rate / theta;
  return bounds;
}

/// The tip as under tcp, the axis as under joint: values at nodes, plus half a node spacing times what bounds
/// the next derivative; |w'| <= |a x a''| is within the square of the turns.
MotionBounds tcp_axes_bounds(const BlockMotion& motion) {
  const JointPath chain(*motion.machine, motion.q_from, motion.q_to);
  const double turn = chain.turn();
  if (turn == 0.0) return tcp_bounds(motion.block);
  const BlockMove& block = motion.block;
  const Mat3 to_M = motion.machine->X_MW.linear();
  const Vec3 way = block.to.tip_W - block.from.tip_W;
  std::optional<ArcShape> arc;
  if (block.arc) arc.emplace(block);
  const double bending = arc ? arc->acceleration() : 0.0;
  MotionBounds bounds;
  bounds.great_circle = false;
  bounds.speed = arc ? arc->speed() : way.norm();
  const int cells = node_cells(chain);
  const double reach = 0.5 / cells;
  Jet tip, axis;
  for (int i = 0; i <= cells; ++i) {
    chain.derivatives(static_cast<double>(i) / cells, tip, axis);
    const Vec3 w = axis.value.cross(axis.first);
    const double across = arc ? w.norm() * bounds.speed : w.cross(to_M * way).norm();
    bounds.bend = std::max(bounds.bend, 2.0 * across + bending);
    bounds.turn_acceleration = std::max(bounds.turn_acceleration, axis.value.cross(axis.second).norm());
    bounds.turn_rate = std::max(bounds.turn_rate, axis.first.norm());
  }
  bounds.bend += reach * 2.0 * turn * turn * bounds.speed;
  bounds.turn_acceleration += reach * 2.0 * turn * turn * turn;
  bounds.turn_rate += reach * turn * turn;
  return bounds;
}

MotionBounds curve_bounds(const toolpath::CurveSpan& span) {
  const toolpath::PoseCurve::Bounds of_way = span.curve->bounds(span.from, span.to);
  const double length = span.to - span.from;
  MotionBounds bounds;
  bounds.great_circle = false;
  bounds.speed = length * of_way.tip_rate;
  bounds.turn_rate = length * of_way.axis_rate;
  bounds.turn_acceleration = length * length * of_way.axis_bend;
  bounds.bend = 2.0 * bounds.turn_rate * bounds.speed + length * length * of_way.tip_bend;
  return bounds;
}

MotionBounds joint_bounds(const BlockMotion& motion) {
  const JointPath chain(*motion.machine, motion.q_from, motion.q_to);
  MotionBounds bounds;
  bounds.great_circle = false;
  const double turn = chain.turn();
  const int cells = node_cells(chain);
  const double reach = 0.5 / cells;  // from any place to the nearest node
  Jet tip, axis;
  for (int i = 0; i <= cells; ++i) {
    chain.derivatives(static_cast<double>(i) / cells, tip, axis);
    const Vec3 w = axis.value.cross(axis.first);
    bounds.bend = std::max(bounds.bend, (2.0 * w.cross(tip.first) - tip.second).norm());
    bounds.turn_acceleration = std::max(bounds.turn_acceleration, axis.value.cross(axis.second).norm());
    bounds.turn_rate = std::max(bounds.turn_rate, axis.first.norm());
    bounds.speed = std::max(bounds.speed, tip.first.norm());
  }
  if (turn == 0.0) return {0.0, 0.0, 0.0, bounds.speed, true};
  bounds.bend +=
      reach * (2.0 * turn * turn * chain.speed() + 2.0 * turn * chain.acceleration() + chain.jerk());
  bounds.turn_acceleration += reach * 2.0 * turn * turn * turn;
  bounds.turn_rate += reach * turn * turn;
  bounds.speed += reach * chain.acceleration();
  return bounds;
}

}  // namespace

ToolPose pose_at(const BlockMotion& motion, double s) {
  const BlockMove& block = motion.block;
  if (s <= 0.0) return block.from;
  if (s >= 1.0) return block.to;
  return PoseLaw(motion).at(motion, s);
}

MotionBounds motion_bounds(const BlockMotion& motion) {
  switch (motion.block.law) {
    case BlockLaw::kJoint:
      return joint_bounds(motion);
    case BlockLaw::kEnds:
      return ends_bounds(motion.block);
    case BlockLaw::kTcpAxes:
      return tcp_axes_bounds(motion);
    case BlockLaw::kCurve:
      return curve_bounds(*motion.block.curve);
    case BlockLaw::kTcp:
      break;
  }
  return tcp_bounds(motion.block);
}

double split_error(const MotionBounds& bounds, int pieces, double lever_mm) {
  SWARF_CHECK(pieces > 0, "a block has at least one piece");
  const double h = 1.0 / pieces;
  const double turn = h * bounds.turn_rate;
  if (turn > 1.0) return std::numeric_limits<double>::infinity();
  const double lever = lever_mm + h * bounds.speed;
  const double bending = bounds.turn_acceleration + bounds.turn_rate * bounds.turn_rate;
  const double error = h * h / 8.0 * (bounds.bend + (bending > 0.0 ? bending * lever : 0.0));
  if (bounds.great_circle) return error;
  const double sine = h * h * bounds.turn_acceleration / 8.0 / (1.0 - turn * turn / 8.0);
  if (sine >= 1.0) return std::numeric_limits<double>::infinity();
  return error + turn * std::tan(std::asin(sine)) * lever;
}

int pieces_within(const BlockMotion& motion, double lever_mm, double tolerance_mm,
                  const std::function<SourceLocation()>& where) {
  SWARF_CHECK(lever_mm >= 0.0 && tolerance_mm > 0.0, "a lever and a tolerance");
  const MotionBounds bounds = motion_bounds(motion);
  // The error falls with the square of the number or faster: start where that puts it and close in.
  int pieces = 1 + static_cast<int>(std::min<double>(bounds.turn_rate, kPiecesMax));
  for (double error; (error = split_error(bounds, pieces, lever_mm)) > tolerance_mm;) {
    const double growth = std::isfinite(error) ? std::clamp(std::sqrt(error / tolerance_mm), 1.0, 1e4) : 2.0;
    // Slightly less than the square root asks for: the cubic parts fall faster.
    const double next = std::max(pieces + 1.0, std::floor(0.97 * growth * pieces));
    if (next > kPiecesMax) {
      throw InputError("too-many-sweeps", where(),
                       fmt::format("a block of {:.3f} mm needs more than {} sweeps to stay within {:g} um",
                                   bounds.speed, kPiecesMax, tolerance_mm * 1e3),
                       "raise the tolerance of the sweeps, or give the block in shorter pieces");
    }
    pieces = static_cast<int>(next);
  }
  return pieces;
}

std::vector<ToolPose> subdivide(const BlockMotion& motion, double lever_mm, double tolerance_mm,
                                const SourceLocation& where) {
  const int pieces = pieces_within(motion, lever_mm, tolerance_mm, [&] { return where; });
  std::vector<ToolPose> poses;
  poses.reserve(static_cast<size_t>(pieces) + 1);
  for (int i = 0; i <= pieces; ++i) poses.push_back(pose_at(motion, static_cast<double>(i) / pieces));
  return poses;
}

}  // namespace swarf::motion
