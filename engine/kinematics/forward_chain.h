// forward() with all that depends on the machine alone found once, of two sets of axis values side by side.
#pragma once

#include <vector>

#include "kinematics/lane_pair.h"
#include "kinematics/machine_model.h"

namespace swarf::kinematics {

class ForwardChain {
 public:
  explicit ForwardChain(const MachineModel& machine);
  /// Sines and cosines are those of lanes.h, so that last bits may differ from forward().
  void at(const AxisValues (&q)[2], ToolPose (&pose_W)[2]) const;

 private:
  std::vector<LinkStep> steps_;
  int rotary_[2] = {0, 0};  ///< axes; the first one again where there are fewer
  Vec3 tip_M_, axis_M_;
  Pose X_MW_;
};

}  // namespace swarf::kinematics
