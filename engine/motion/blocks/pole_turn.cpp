#include "motion/blocks/pole_turn.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/angles.h"
#include "base/tool_axis.h"
#include "kinematics/rotary_pair.h"
#include "motion/speed/jerk_profile.h"

namespace swarf::motion {
namespace {

using kinematics::AxisKind;
using kinematics::AxisValues;
using kinematics::Branch;
using kinematics::InverseOutcome;

/// How far along its great circle the axis is looked at to see which way the block leaves, rad: beyond the
/// rounding of poses, and so near that the outer rotary stands where it starts.
constexpr double kAhead = 1e-6;
/// Rotary axes that are nearer have not turned, rad.
constexpr double kTurned = 1e-9;
/// Nodes of the turn at which the linear axes are looked at.
constexpr int kNodes = 64;
/// Share of the limits that is planned with: between the nodes the linear axes are seen by differences.
constexpr double kUse = 0.95;

}  // namespace

AxisValues leaving_pole(const kinematics::InverseKinematics& inverse, const toolpath::BlockMove& block,
                        const AxisValues& before) {
  const bool by_pose = block.law == toolpath::BlockLaw::kTcp || block.law == toolpath::BlockLaw::kEnds ||
                       block.law == toolpath::BlockLaw::kCurve;
  if (!by_pose || inverse.pole_distance(block.from.axis_W) >= kinematics::kPoleTolerance) return before;
  const double tilt = angle_between(block.from.axis_W, block.to.axis_W);
  if (!(tilt > kAhead)) return before;
  const Branch ahead = inverse.solve_nearest(
      {block.from.tip_W, slerp(block.from.axis_W, block.to.axis_W, kAhead / tilt)}, before);
  if (ahead.outcome == InverseOutcome::kUnreachable) return before;
  // At the pole itself the outer axis stays where the hint has it.
  const Branch start = inverse.solve_nearest(block.from, ahead.q);
  return start.outcome == InverseOutcome::kUnreachable ? before : start.q;
}

bool turns_at_rest(const BlockMotion& before, const BlockMotion& motion) {
  // Where the program commands the axes itself it says how they come there.
  if (before.block.tool != motion.block.tool || motion.block.axes) return false;
  const auto& axes = motion.machine->axes;
  for (size_t i = 0; i < axes.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (axes[i].kind == AxisKind::kRotary && std::abs(motion.q_from[row] - before.q_to[row]) > kTurned)
      return true;
  }
  return false;
}

PoleTurn::PoleTurn(const kinematics::InverseKinematics& inverse, const kinematics::MachineModel& machine,
                   const ToolPose& pose, const AxisValues& from, const AxisValues& to)
    : inverse_(inverse), machine_(machine), pose_(pose), from_(from), to_(to) {
  // Along x in [0, 1], the share of the turn: |q'|, |q''|, |q'''| by differences between nodes.
  constexpr double h = 1.0 / kNodes;
  AxisValues first = AxisValues::Zero(), second = AxisValues::Zero(), third = AxisValues::Zero();
  std::array<AxisValues, kNodes + 1> q;
  for (int i = 0; i <= kNodes; ++i) q.at(static_cast<size_t>(i)) = turned(i * h);
  for (size_t i = 0; i + 1 < q.size(); ++i) first = first.cwiseMax(((q[i + 1] - q[i]) / h).cwiseAbs());
  for (size_t i = 0; i + 2 < q.size(); ++i)
    second = second.cwiseMax(((q[i + 2] - 2.0 * q[i + 1] + q[i]) / (h * h)).cwiseAbs());
  for (size_t i = 0; i + 3 < q.size(); ++i)
    third = third.cwiseMax(((q[i + 3] - 3.0 * (q[i + 2] - q[i + 1]) - q[i]) / (h * h * h)).cwiseAbs());
  // q'(t) = q' v, q''(t) = q'' v^2 + q' a, q'''(t) = q''' v^3 + 3 q'' v a + q' j: equal shares for each term.
  speed_ = acceleration_ = jerk_ = std::numeric_limits<double>::infinity();
  const auto least = [](double& value, double limit, double slope, double power) {
    if (slope > 0.0) value = std::min(value, std::pow(kUse * limit / slope, 1.0 / power));
  };
  for (size_t i = 0; i < machine.axes.size(); ++i) {
    const kinematics::Axis& axis = machine.axes[i];
    const auto row = static_cast<Eigen::Index>(i);
    least(speed_, axis.speed_max, first[row], 1.0);
    least(speed_, axis.acceleration_max / 2.0, second[row], 2.0);
    least(speed_, axis.jerk_max / 3.0, third[row], 3.0);
    least(acceleration_, axis.acceleration_max / 2.0, first[row], 1.0);
    least(jerk_, axis.jerk_max / 3.0, first[row], 1.0);
  }
  for (size_t i = 0; i < machine.axes.size(); ++i)
    least(acceleration_, machine.axes[i].jerk_max / 3.0, 3.0 * speed_ * second[static_cast<Eigen::Index>(i)],
          1.0);
  duration_ = RestToRest(1.0, speed_, acceleration_, jerk_).duration();
}

AxisValues PoleTurn::turned(double share) const {
  AxisValues hint = from_;
  for (size_t i = 0; i < machine_.axes.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (machine_.axes[i].kind == AxisKind::kRotary) hint[row] += share * (to_[row] - from_[row]);
  }
  const Branch branch = inverse_.solve_nearest(pose_, hint);
  return branch.outcome == InverseOutcome::kUnreachable ? hint : branch.q;
}

AxisValues PoleTurn::at(double t_s) const {
  return turned(RestToRest(1.0, speed_, acceleration_, jerk_).position(std::min(t_s, duration_)));
}

}  // namespace swarf::motion
