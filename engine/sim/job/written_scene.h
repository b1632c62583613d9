// A scene.toml for a person to go on from: every value that a job has, each with what it means.
#pragma once

#include <filesystem>
#include <string>

#include "sim/job/scene.h"

namespace swarf::sim {

/// The scene of a job as commented TOML, for a file in `folder`; paths are written as seen from there where
/// they can be. It is the job again: the same path, the same stock, the same voxels. `machine`: what the key
/// says, a name or a path. NC and CL jobs whose tools are those of tool_words.h, or of a tool table.
std::string written_scene(const Job& job, const std::filesystem::path& folder, const std::string& machine);

/// A small program for a first try, LinuxCNC's words: a pocket and a slot by a flat end of 6 mm.
std::string example_program();

}  // namespace swarf::sim
