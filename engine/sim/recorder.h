// What a run leaves on disk besides pictures: the trajectory as CSV, and reading it back.
#pragma once

#include <string>

#include "motion/tool_sample.h"
#include "sim/simulation.h"

namespace swarf::sim {

/// t_s,block,x_mm,y_mm,z_mm,i,j,k,feed_mm_min,<axis>_mm|_deg...,contact_x_mm,contact_y_mm,contact_z_mm,u,v,element,kind.
/// `block` is the line of the program. Written to a temporary name and renamed.
void write_trajectory(const std::string& path, const motion::Trajectory& trajectory,
                      const toolpath::ToolPath& tool_path, const kinematics::MachineModel& machine);

/// Reads what write_trajectory wrote for the same machine. Throws InputError with file:line.
motion::Trajectory read_trajectory(const std::string& path, const kinematics::MachineModel& machine,
                                   double period_s);

}  // namespace swarf::sim
