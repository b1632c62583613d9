// Leaving the pole. There the outer rotary axis turns the tool about itself, so no pose says where it stands;
// a block that tilts away from the pole needs it at one place from its very start. A control turns it there
// while the tip and the axis of the tool stand still: the linear axes follow the table, and the turn takes
// the time that the axes need. Without it the turn would take place within one cycle.
#pragma once

#include "kinematics/machine_model.h"
#include "motion/blocks/block_motion.h"

namespace swarf::motion {

/// Axis values with which the block leaves its start, nearest to `before`; `before` itself unless it starts
/// at the pole and tilts away from it.
kinematics::AxisValues leaving_pole(const kinematics::InverseKinematics& inverse,
                                    const toolpath::BlockMove& block, const kinematics::AxisValues& before);

/// The rotary axes turn at rest before the motion: its start is not where the one before ended.
bool turns_at_rest(const BlockMotion& before, const BlockMotion& motion);

/// All axes from rest to rest at one pose at the pole, within the limits of each.
class PoleTurn {
 public:
  /// References must outlive it.
  PoleTurn(const kinematics::InverseKinematics& inverse, const kinematics::MachineModel& machine,
           const ToolPose& pose, const kinematics::AxisValues& from, const kinematics::AxisValues& to);
  double duration_s() const { return duration_; }
  kinematics::AxisValues at(double t_s) const;

 private:
  kinematics::AxisValues turned(double share) const;

  const kinematics::InverseKinematics& inverse_;
  const kinematics::MachineModel& machine_;
  ToolPose pose_;
  kinematics::AxisValues from_, to_;
  double speed_ = 0.0, acceleration_ = 0.0, jerk_ = 0.0;  ///< of the share of the turn, per s and on
  double duration_ = 0.0;
};

}  // namespace swarf::motion
