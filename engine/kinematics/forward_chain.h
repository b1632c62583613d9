// forward() with all that depends on the machine alone found once, of many sets of axis values: two, four or
// eight side by side, as the processor has it.
#pragma once

#include <span>
#include <vector>

#include "kinematics/machine_model.h"

namespace swarf::kinematics {

class ForwardChain {
 public:
  explicit ForwardChain(const MachineModel& machine);
  /// As many poses as sets of values. Sines and cosines are those of lanes.h, so that last bits may differ
  /// from forward(); none depends on what stands beside it.
  void at(std::span<const AxisValues> q, std::span<ToolPose> poses_W) const;

 private:
  friend struct ForwardLanes;
  std::vector<LinkStep> steps_;
  int rotary_[2] = {0, 0};  ///< axes; the first one again where there are fewer
  Vec3 tip_M_, axis_M_;
  Pose X_MW_;
};

/// ForwardChain::at() by one instruction set.
using ForwardKernel = void (*)(const ForwardChain& chain, std::span<const AxisValues> q,
                               std::span<ToolPose> poses_W);
/// Those that this processor runs, fastest first. All give the same bits.
std::span<const ForwardKernel> forward_kernel_variants();

}  // namespace swarf::kinematics
