// Copies of what a run was made from, so that its folder can be rendered and exported on its own.
#pragma once

#include <string>
#include <vector>

#include "reports/pending_folder.h"
#include "sim/job/scene.h"

namespace swarf::reports {

/// Copies the files that the job names, and nothing else, into input/: the scene, the program, the machine
/// with its meshes, the tool table, the design. Links are followed: the copies are plain files. The machine's
/// meshes keep their places as seen from machine.toml; those that it names by an absolute path get a place
/// beside it, and the copied machine.toml names that.
///
/// Returns the overrides (key=value) with which input/scene.toml is the job again: `overrides`, then what
/// points to the copies. Throws InputError "cannot-copy" with the file and the reason.
std::vector<std::string> keep_inputs(const PendingFolder& folder, const sim::Job& job,
                                     const std::vector<std::string>& overrides);

/// The programs that the scene's program has called, known when it has been read: beside its copy as they lie
/// seen from it.
void keep_called_programs(const PendingFolder& folder, const sim::Job& job,
                          const std::vector<std::string>& called);

}  // namespace swarf::reports
