// Invariants of a trajectory, cheap to costly.
#pragma once

#include <string>

#include "kinematics/machine_model.h"
#include "motion/tool_sample.h"

namespace swarf::motion {

/// The reason why the first of these does not hold, with sample and amount; empty when all do:
///   1. as many axis values as samples, a period above zero
///   2. every number is finite
///   3. the tool axes are unit vectors (1e-12)
///   4. sample k stands at k periods (1e-9 of a period per sample)
///   5. forward(axes) gives the pose back (1e-9 mm, 1e-12 rad)
///   6. no axis moves faster than its limit (1e-6 relative)
std::string check_motion(const Trajectory& trajectory, const kinematics::MachineModel& machine);

}  // namespace swarf::motion
