// Measuring a finished trajectory against the tool path and the machine, without asking the planner.
#pragma once

#include <span>
#include <vector>

#include "motion/block_motion.h"
#include "motion/interpolator.h"

namespace swarf::motion {

/// Everything in MotionStatistics but tick_ns_*. `blocks`: the motions of a path of CL blocks, else empty. A
/// tick that passes from one block into the next counts for the axes, not for the errors along a block.
MotionStatistics measure_motion(const Trajectory& trajectory, const toolpath::ToolPath& path,
                                std::span<const BlockMotion> blocks, const kinematics::MachineModel& machine,
                                const kinematics::InverseKinematics& inverse, const cutter::Cutter& cutter);

/// Travel limits and axis speeds that the trajectory exceeds: the worst sample per element and axis.
std::vector<MotionFinding> find_axis_faults(const Trajectory& trajectory, const toolpath::ToolPath& path,
                                            const kinematics::MachineModel& machine);

/// Excess over an axis' speed limit that counts as rounding of the sampled positions, relative.
inline constexpr double kAxisSpeedTolerance = 1e-6;

}  // namespace swarf::motion
