// What a run leaves on disk besides pictures: the trajectory as CSV, and reading it back.
#pragma once

#include <string>

#include "motion/tool_sample.h"
#include "sim/simulation.h"

namespace swarf::sim {

/// t_s,block,x_mm,y_mm,z_mm,i,j,k,feed_mm_min,<axis>_mm|_deg...,contact_x_mm,contact_y_mm,contact_z_mm,u,v,element,kind,tool.
/// `block` is the line of the program, `tool` the number of the tool in the spindle, or its name. Written to
/// a temporary name and renamed.
void write_trajectory(const std::string& path, const motion::Trajectory& trajectory,
                      const toolpath::ToolPath& tool_path, const Job& job);

/// Reads what write_trajectory wrote for the same machine and tools. Throws InputError with file:line.
motion::Trajectory read_trajectory(const std::string& path, const Job& job);

}  // namespace swarf::sim
