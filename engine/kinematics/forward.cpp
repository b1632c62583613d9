#include <cmath>

#include "kinematics/chain.h"
#include "kinematics/machine_model.h"

namespace swarf::kinematics {

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
  const Sines of = sines_of(machine, q);
  Vec3 point = machine.tip_M, tool_axis = machine.tool_axis_M;
  from_tool_to_work(machine, [&](const LinkStep& step) { carry(step, q, of, point, tool_axis); });
  return {machine.X_MW.linear().transpose() * (point - machine.X_MW.translation()),
          machine.X_MW.linear().transpose() * tool_axis};
}

MachineModel with_tool(const MachineModel& machine, double length_mm) {
  MachineModel with = machine;
  if (with.gauge_M) with.tip_M = *with.gauge_M - length_mm * with.tool_axis_M;
  return with;
}

}  // namespace swarf::kinematics
