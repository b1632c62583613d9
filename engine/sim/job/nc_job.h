// The scene's NC program on the scene's machine, with its tools, offsets and start.
#pragma once

#include "sim/job/scene.h"
#include "toolpath/nc_path.h"

namespace swarf::sim {

/// Runs the program as its control would. Throws InputError with everything that is wrong with setup or
/// program; what is only worth a warning goes to `diagnostics`, and so do the errors of NcPathSink::finish.
toolpath::NcPath read_nc_program(const Job& job, Diagnostics& diagnostics);

/// The tools that the program asks for, as far as it can be read without any; problems go to `diagnostics`.
std::vector<program::AskedTool> asked_of_nc(const Job& job, Diagnostics& diagnostics);

}  // namespace swarf::sim
