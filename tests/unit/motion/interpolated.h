// A whole motion with all its cycles, for tests of short programs.
#pragma once

#include <span>

#include "motion/interpolator.h"
#include "toolpath/tool_path.h"

namespace swarf::motion {

struct Interpolated : MotionResult {
  Trajectory trajectory;
};

inline Interpolated interpolate(const toolpath::ToolPath& path,
                                std::span<const kinematics::MachineModel> by_tool,
                                const cutter::Cutter& cutter, const MotionOptions& options,
                                Progress& progress, const LookAheadReach& reach = {}) {
  Cycles cycles(path.elements, by_tool, cutter, options, {reach, 0});
  Interpolated result;
  static_cast<MotionResult&>(result) = interpolate(cycles, progress);
  result.trajectory = trajectory_of(cycles);
  return result;
}
inline Interpolated interpolate(const toolpath::ToolPath& path, const kinematics::MachineModel& machine,
                                const cutter::Cutter& cutter, const MotionOptions& options,
                                Progress& progress, const LookAheadReach& reach = {}) {
  return interpolate(path, std::span(&machine, 1), cutter, options, progress, reach);
}

}  // namespace swarf::motion
