// The closed-form inverse held against forward() over the whole travel of a machine.
#pragma once

#include <cstdint>

#include "kinematics/machine_model.h"

namespace swarf::kinematics {

/// What random axis values gave back. Errors are the greatest over all poses and all their branches.
struct RoundTrip {
  int poses = 0;
  int64_t branches = 0;  ///< solutions of all poses together
  int unsolved = 0;      ///< poses without any solution: must be 0, since each came from axis values
  int not_found = 0;     ///< poses away from the pole whose own axis values are not among the branches
  double tip_mm = 0.0;   ///< |forward(inverse(pose)) - pose|
  double axis_rad = 0.0;

  /// Every pose came back, on every branch.
  bool holds() const { return unsolved == 0 && not_found == 0; }
};

/// Axis values uniform over the travel of each axis (rotary: at most a turn to either side of its middle),
/// forward to the pose, and back by every branch. The same seed gives the same poses.
RoundTrip round_trip(const MachineModel& machine, int poses, uint64_t seed);

}  // namespace swarf::kinematics
