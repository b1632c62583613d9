#include <cmath>

#include "kinematics/machine_model.h"
#include "kinematics/rotation.h"

namespace swarf::kinematics {
namespace {

/// How far the link of the axis moves per unit of its value, along or about the direction: +1 or -1.
/// ISO 841: positive values move the tool positively against the work, so table links move the other way.
double link_sense(const Axis& axis) {
  return (axis.side == Side::kTable) == axis.reversed ? 1.0 : -1.0;
}

/// Carries the point and the tool axis along with the link of `axis`, displaced by `amount` in link sense.
void carry(const Axis& axis, double amount, ToolPose& pose) {
  if (axis.kind == AxisKind::kLinear) {
    pose.tip_W += amount * axis.direction_M;
    return;
  }
  const double sine = std::sin(amount), cosine = std::cos(amount);
  pose.tip_W = axis.origin_M + rotate(axis.direction_M, sine, cosine, pose.tip_W - axis.origin_M);
  pose.axis_W = rotate(axis.direction_M, sine, cosine, pose.axis_W);
}

}  // namespace

Pose axis_motion(const Axis& axis, double q) {
  const double amount = link_sense(axis) * q;
  Pose motion = Pose::Identity();
  if (axis.kind == AxisKind::kLinear) {
    motion.translation() = amount * axis.direction_M;
    return motion;
  }
  motion.linear() = Eigen::AngleAxisd(amount, axis.direction_M).toRotationMatrix();
  motion.translation() = axis.origin_M - motion.linear() * axis.origin_M;
  return motion;
}

ToolPose forward(const MachineModel& machine, const AxisValues& q) {
  // Both vectors wander from the tool to the base with the head links, then against the table links to W.
  ToolPose pose{machine.tip_M, machine.tool_axis_M};
  for (auto it = machine.head_chain.rbegin(); it != machine.head_chain.rend(); ++it) {
    const Axis& axis = machine.axes[*it];
    carry(axis, link_sense(axis) * q[*it], pose);
  }
  for (const int i : machine.table_chain) carry(machine.axes[i], -link_sense(machine.axes[i]) * q[i], pose);
  const Mat3 R_WM = machine.X_MW.linear().transpose();
  pose.tip_W = R_WM * (pose.tip_W - machine.X_MW.translation());
  pose.axis_W = R_WM * pose.axis_W;
  return pose;
}

}  // namespace swarf::kinematics
