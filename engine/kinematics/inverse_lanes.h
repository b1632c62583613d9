// The inverse along a way, of several poses side by side: one kernel for each instruction set.
#pragma once

#include <span>

#include "kinematics/machine_model.h"

namespace swarf::kinematics {

/// Poses that a kernel solves, and where their branches go: as many.
struct PoseRow {
  const InverseKinematics& inverse;
  std::span<const ToolPose> poses_W;
  /// What each pose follows, or what the first of a way follows.
  const AxisValues* before;
  Branch* found;
};

struct InverseLanes {
  int poses = 0;  ///< side by side
  /// Solve the first poses of the row, more than one, and return how many.
  size_t (*apart)(const PoseRow& row);  ///< each after values of its own
  size_t (*along)(const PoseRow& row);  ///< each after the one before it
};

/// Those that this processor runs, fastest first: eight, four and two poses. All give the same bits.
std::span<const InverseLanes> inverse_lane_variants();

/// InverseKinematics::continued() of many poses by one of them.
void continue_apart(const InverseLanes& lanes, const InverseKinematics& inverse,
                    std::span<const ToolPose> poses_W, std::span<const AxisValues> before,
                    std::span<Branch> found);
void continue_along(const InverseLanes& lanes, const InverseKinematics& inverse,
                    std::span<const ToolPose> poses_W, const AxisValues& before, std::span<Branch> found);

}  // namespace swarf::kinematics
