#include "post/follow.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/tool_axis.h"
#include "kinematics/reach.h"
#include "motion/blocks/block_motion.h"
#include "motion/blocks/pole_turn.h"
#include "post/rounding.h"

namespace swarf::post {
namespace {

using kinematics::AxisKind;
using kinematics::AxisValues;
using kinematics::Branch;
using kinematics::InverseOutcome;

/// Shorter shares of a move are the end of all cutting.
constexpr double kShortest = 1e-10;
/// Pieces that a part is cut into at once, and places that one move may have.
constexpr int kPiecesAtOnce = 16;
constexpr size_t kPlacesMost = 50'000;

/// What is cut, and what came of it.
struct Cutting {
  const Follower& follower;
  const motion::BlockMotion& motion;
  std::vector<Waypoint>& places;
  double tip_mm = 0.0;     ///< what is left of the tolerance
  double radius_mm = 0.0;  ///< of an arc; 0: straight
  double angle = 0.0;      ///< of the arc
  double spread_mm = 0.0;  ///< by which its ends differ in radius
  PoleSides& poles;
  FollowFault fault;
};

/// The place that a piece starts from.
struct From {
  double share = 0.0;
  ToolPose pose;
  AxisValues q;
};

double sagitta(const Cutting& cutting, double share) {
  if (cutting.radius_mm == 0.0) return 0.0;
  const double half = std::min(0.5 * cutting.angle * share, kPi);
  return cutting.radius_mm * (1.0 - std::cos(half)) + cutting.spread_mm * share;
}

/// With TCP the rotary axes run evenly and the linear ones follow: from the straight way of their values they
/// stray as far as the tip would without TCP, at most trajectory_error_bound() (the columns of the linear
/// axes are orthonormal). True when they may leave the travel in between.
bool may_leave_travel(const kinematics::MachineModel& machine, const AxisValues& from, const AxisValues& to,
                      double stray_mm) {
  constexpr double kUnseen = 1e-3;  // mm
  for (size_t i = 0; i < machine.axes.size(); ++i) {
    const kinematics::Axis& axis = machine.axes[i];
    const auto row = static_cast<long>(i);
    if (axis.kind != AxisKind::kLinear) continue;
    if (std::max(from[row], to[row]) + stray_mm > axis.max + kUnseen ||
        std::min(from[row], to[row]) - stray_mm < axis.min - kUnseen)
      return true;
  }
  return false;
}

/// Bounds of a piece as shares of what is allowed; its tip deviation, mm.
struct PieceError {
  double share = 0.0, tip_mm = 0.0;
};

PieceError error_of(const Cutting& cutting, const From& from, double share, const ToolPose& to,
                    const AxisValues& q) {
  const Follower& follower = cutting.follower;
  PieceError error;
  const double turn = rotary_way(follower.machine, from.q, q);
  error.tip_mm = sagitta(cutting, share);
  if (turn > kTurned) {
    const kinematics::BlockEnds ends{from.pose, to, from.q, q};
    double bound = kinematics::trajectory_error_bound(follower.machine, ends);
    if (follower.rules.tcp) {
      if (may_leave_travel(follower.machine, from.q, q, bound)) error.share = 4.0;
    } else {
      if (error.tip_mm + bound > cutting.tip_mm)
        bound = std::min(bound, kinematics::segment_deviation(follower.machine, ends).proven);
      error.tip_mm += bound;
    }
    double aside = std::asin(std::min(1.0, turn * turn / 8.0));
    if (aside > follower.rules.axis_rad && turn < kPieceTurn) {
      const double exact = kinematics::trajectory_error(follower.machine, ends).orientation_rad;
      if (exact < aside) aside = exact;
    }
    error.share = std::max(error.share, aside / follower.rules.axis_rad);
    if (greatest_turn(follower.machine, from.q, q) > kPieceTurn) error.share = 1e3;
  }
  if (error.tip_mm > 0.0) error.share = std::max(error.share, error.tip_mm / cutting.tip_mm);
  return error;
}

std::string shown(const kinematics::Axis& axis, double value) {
  return axis.kind == AxisKind::kRotary ? fmt::format("{:.4f} deg", deg_from_rad(value))
                                        : fmt::format("{:.4f} mm", value);
}

FollowFault jump_fault(const Follower& follower, const AxisValues& from, const AxisValues& to) {
  size_t worst = 0;
  double greatest = -1.0;
  for (size_t i = 0; i < follower.machine.axes.size(); ++i) {
    const auto row = static_cast<long>(i);
    const bool rotary = follower.machine.axes[i].kind == AxisKind::kRotary;
    const double way = rotary ? std::abs(to[row] - from[row]) : -1.0;
    if (way > greatest) greatest = way, worst = i;
  }
  const kinematics::Axis& axis = follower.machine.axes[worst];
  const auto row = static_cast<long>(worst);
  return {"axis-jump",
          fmt::format(
              "axis {} would have to jump from {} to {} here: its travel of {} to {} does not let it go on",
              axis.name, shown(axis, from[row]), shown(axis, to[row]), shown(axis, axis.min),
              shown(axis, axis.max)),
          "lift the tool before it with two RAPID moves (the axes unwind there), or clamp the work turned",
          static_cast<int>(worst)};
}

/// Why there is no way on from `from`: the solution that goes on may be out of travel, and another one, which
/// would be a jump, be the one that the inverse gives.
FollowFault no_way_on(const Follower& follower, const ToolPose& pose, const AxisValues& from,
                      const AxisValues& given) {
  const kinematics::InverseSolutions both = follower.inverse.solve(pose, from);
  const Branch* nearest = nullptr;
  for (int i = 0; i < both.count; ++i) {
    const Branch& one = both.branch[i];
    if (nearest == nullptr ||
        rotary_way(follower.machine, from, one.q) < rotary_way(follower.machine, from, nearest->q))
      nearest = &one;
  }
  if (nearest != nullptr && nearest->outcome == InverseOutcome::kOutOfTravel)
    return fault_of(follower, *nearest, pose);
  return jump_fault(follower, from, given);
}

bool cut(Cutting& cutting, From& from, double to);

bool cut_again(Cutting& cutting, From& from, double to, double error_share) {
  const double way = to - from.share;
  const int pieces =
      std::clamp(static_cast<int>(std::ceil(std::sqrt(std::min(error_share, 1e4)))), 2, kPiecesAtOnce);
  const double start = from.share;
  for (int i = 1; i <= pieces; ++i) {
    if (!cut(cutting, from, i == pieces ? to : start + way * i / pieces)) return false;
  }
  return true;
}

/// Adds the place at share `to`, and what has to stand before it.
bool cut(Cutting& cutting, From& from, double to) {
  const Follower& follower = cutting.follower;
  const ToolPose pose = snapped(follower, motion::pose_at(cutting.motion, to));
  const Branch branch = follower.inverse.solve_nearest(pose, from.q);
  const PieceError error = branch.outcome == InverseOutcome::kUnreachable
                               ? PieceError{}
                               : error_of(cutting, from, to - from.share, pose, branch.q);
  if (error.share <= 1.0) {
    cutting.fault = fault_of(follower, branch, pose);
    if (!cutting.fault.code.empty()) return false;
    cutting.places.push_back({pose, branch.q, to, error.tip_mm, false});
    from = {to, pose, branch.q};
    if (cutting.places.size() < kPlacesMost) return true;
  }
  if (to - from.share < kShortest || cutting.places.size() >= kPlacesMost) {
    cutting.fault = fault_of(follower, branch, pose);
    if (cutting.fault.code.empty()) cutting.fault = no_way_on(follower, pose, from.q, branch.q);
    return false;
  }
  return cut_again(cutting, from, to, error.share);
}

/// The rotary axes turn while the tip stands, in pieces in which it does.
bool turn_at_rest(Cutting& cutting, From& from, const AxisValues& to) {
  const Follower& follower = cutting.follower;
  const double turn = rotary_way(follower.machine, from.q, to);
  if (turn <= kTurned) return true;
  // The tip leaves its place by an arm times turn^2 / 8; the arm is that of the digits' bound.
  const AxisValues start = from.q;
  for (int pieces = follower.rules.tcp ? 1 : std::max(1, static_cast<int>(turn / 0.1));; pieces *= 2) {
    std::vector<Waypoint> made;
    AxisValues before = start;
    bool within = true;
    for (int i = 1; i <= pieces && within; ++i) {
      AxisValues hint = start;
      for (size_t k = 0; k < follower.machine.axes.size(); ++k) {
        const auto row = static_cast<long>(k);
        if (follower.machine.axes[k].kind == AxisKind::kRotary)
          hint[row] += (to[row] - start[row]) * i / pieces;
      }
      const Branch branch = follower.inverse.solve_nearest(from.pose, hint);
      cutting.fault = fault_of(follower, branch, from.pose);
      if (!cutting.fault.code.empty()) return false;
      double bound = 0.0;
      if (!follower.rules.tcp)
        bound =
            kinematics::segment_deviation(follower.machine, {from.pose, from.pose, before, branch.q}).proven;
      within = bound <= cutting.tip_mm;
      made.push_back({from.pose, branch.q, from.share, bound, true});
      before = branch.q;
    }
    if (!within && made.size() < kPlacesMost) continue;
    cutting.places.insert(cutting.places.end(), made.begin(), made.end());
    from.q = before;
    return true;
  }
}

/// Share of the move at which the axis passes a pole within the snap; none: nowhere inside.
double share_of_pole(const Follower& follower, const program::Move& move) {
  const Vec3 &a = move.from.axis_W, &b = move.to.axis_W;
  const double angle = angle_between(a, b);
  const Vec3 normal = a.cross(b);
  if (!(angle > 2.0 * follower.rules.snap_rad) || !(normal.norm() > 0.0)) return -1.0;
  const double snap = follower.rules.snap_rad;
  for (const kinematics::Pole& pole : follower.poles.at) {
    const double height = pole.direction_W.dot(normal.normalized());
    if (std::abs(height) > std::sin(snap)) continue;
    const Vec3 in_plane = pole.direction_W - height * normal.normalized();
    const double at = signed_angle(normal.normalized(), a, in_plane);
    if (at > snap && at < angle - snap) return at / angle;
  }
  return -1.0;
}

motion::BlockMotion motion_of(const Follower& follower, const program::Move& move) {
  motion::BlockMotion motion;
  motion.block.from = snapped(follower, move.from);
  motion.block.to = snapped(follower, move.to);
  motion.block.arc = move.arc;
  motion.machine = &follower.machine;
  return motion;
}

void set_arc(Cutting& cutting) {
  const toolpath::BlockMove& block = cutting.motion.block;
  if (!block.arc) return;
  const auto radius = [&](const Vec3& tip) {
    return block.arc->normal_W.cross(tip - block.arc->centre_W).norm();
  };
  cutting.radius_mm = std::max(radius(block.from.tip_W), radius(block.to.tip_W));
  cutting.spread_mm = std::abs(radius(block.from.tip_W) - radius(block.to.tip_W));
  cutting.angle = toolpath::arc_angle(block);
}

/// The other solution beside the pole: the outer axis half a turn away, to the side that its travel has.
AxisValues other_side(const Follower& follower, const ToolPose& pose, const AxisValues& start) {
  const auto outer = static_cast<long>(follower.poles.outer);
  const kinematics::Axis& axis = follower.machine.axes[static_cast<size_t>(outer)];
  AxisValues hint = start;
  hint[outer] += start[outer] + kPi <= axis.max ? kPi : -kPi;
  const Branch branch = follower.inverse.solve_nearest(pose, hint);
  return branch.outcome == InverseOutcome::kUnreachable ? start : branch.q;
}

/// One part of the move, between places where the axis may pass the pole.
bool follow_part(Cutting& cutting, From& from, double to) {
  toolpath::BlockMove part;
  part.from = from.pose;
  part.to = snapped(cutting.follower, motion::pose_at(cutting.motion, to));
  AxisValues start = motion::leaving_pole(cutting.follower.inverse, part, from.q);
  const bool leaves =
      cutting.follower.inverse.pole_distance(from.pose.axis_W) <= kinematics::kPoleTolerance &&
      angle_between(part.from.axis_W, part.to.axis_W) > cutting.follower.rules.snap_rad;
  if (leaves && cutting.poles.next() == PoleSide::kOther)
    start = other_side(cutting.follower, from.pose, start);
  return turn_at_rest(cutting, from, start) && cut(cutting, from, to);
}

}  // namespace

Follower::Follower(const kinematics::MachineModel& with_tool, const FollowRules& given)
    : machine(with_tool), inverse(machine), poles(kinematics::find_poles(machine)), rules(given) {}

ToolPose snapped(const Follower& follower, const ToolPose& pose) {
  const double distance = follower.inverse.pole_distance(pose.axis_W);
  if (distance == 0.0 || !(distance <= follower.rules.snap_rad)) return pose;
  for (const kinematics::Pole& pole : follower.poles.at) {
    if (angle_between(pole.direction_W, pose.axis_W) <= 1.5 * follower.rules.snap_rad)
      return {pose.tip_W, pole.direction_W};
  }
  return pose;
}

double greatest_turn(const kinematics::MachineModel& machine, const AxisValues& from, const AxisValues& to) {
  double greatest = 0.0;
  for (size_t i = 0; i < machine.axes.size(); ++i) {
    const auto row = static_cast<long>(i);
    if (machine.axes[i].kind == AxisKind::kRotary)
      greatest = std::max(greatest, std::abs(to[row] - from[row]));
  }
  return greatest;
}

FollowFault fault_of(const Follower& follower, const Branch& branch, const ToolPose& pose) {
  if (branch.outcome == InverseOutcome::kUnreachable) {
    const kinematics::UnreachableText told = kinematics::unreachable_text(follower.machine, pose);
    return {"unreachable", told.text, told.fix, -1};
  }
  if (branch.outcome != InverseOutcome::kOutOfTravel) return {};
  const auto at = static_cast<size_t>(branch.out_of_travel_axis);
  const kinematics::Axis& axis = follower.machine.axes[at];
  return {
      "travel",
      fmt::format("axis {} would go to {}; its travel is {} to {}", axis.name,
                  shown(axis, branch.q[static_cast<long>(at)]), shown(axis, axis.min), shown(axis, axis.max)),
      "clamp the work elsewhere (--work-origin), or tilt the tool less", branch.out_of_travel_axis};
}

FollowFault follow(const Follower& follower, const program::Move& move, PoleSides& poles, AxisValues& q,
                   std::vector<Waypoint>& places) {
  const motion::BlockMotion motion = motion_of(follower, move);
  const size_t before = places.size();
  std::vector<Waypoint> made;
  Cutting cutting{follower, motion, made, 0.0, 0.0, 0.0, 0.0, poles, {}};
  const Branch end = follower.inverse.solve_nearest(motion.block.to, q);
  if (end.outcome == InverseOutcome::kUnreachable) return fault_of(follower, end, motion.block.to);
  const double digits = rounding_mm(follower, follower.rules.tcp, q, end.q);
  cutting.tip_mm = follower.rules.tip_mm - digits;
  if (cutting.tip_mm < 0.1 * follower.rules.tip_mm) {
    return {"tolerance-below-digits",
            fmt::format("the digits of the axis words alone may put the tip {:.2f} um aside here, the "
                        "tolerance is {:.2f} um",
                        um_from_mm(digits), um_from_mm(follower.rules.tip_mm)),
            "write more digits ([numbers.rotary] decimals of the post), or give --tolerance-um more", -1};
  }
  set_arc(cutting);
  From from{0.0, motion.block.from, q};
  const double pole = share_of_pole(follower, move);
  const bool followed = (pole < 0.0 || follow_part(cutting, from, pole)) && follow_part(cutting, from, 1.0);
  if (!followed) return cutting.fault;
  places.insert(places.begin() + static_cast<long>(before), made.begin(), made.end());
  q = from.q;
  return {};
}

double rotary_way(const kinematics::MachineModel& machine, const AxisValues& from, const AxisValues& to) {
  double way = 0.0;
  for (size_t i = 0; i < machine.axes.size(); ++i) {
    const auto row = static_cast<long>(i);
    if (machine.axes[i].kind == AxisKind::kRotary) way += std::abs(to[row] - from[row]);
  }
  return way;
}

namespace {

double speed_of(const kinematics::Axis& axis, bool rapid) {
  return rapid && axis.rapid_max > 0.0 ? axis.rapid_max : axis.speed_max;
}

}  // namespace

double axis_time(const kinematics::MachineModel& machine, const AxisValues& from, const AxisValues& to,
                 bool rapid) {
  double longest = 0.0;
  for (size_t i = 0; i < machine.axes.size(); ++i) {
    const double speed = speed_of(machine.axes[i], rapid);
    const auto row = static_cast<long>(i);
    if (speed > 0.0) longest = std::max(longest, std::abs(to[row] - from[row]) / speed);
  }
  return longest;
}

}  // namespace swarf::post
