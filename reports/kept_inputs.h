// Copies of what a run was made from, so that its folder can be rendered and exported on its own.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reports/pending_folder.h"
#include "sim/job/scene.h"

namespace swarf::reports {

/// The overrides (key=value) with which input/scene.toml is the job again: those of the run, then what points
/// to the copies.
struct KeptInputs {
  std::vector<std::string> own;
  /// Of the set-ups before it; none: the scene has one.
  std::optional<std::vector<std::vector<std::string>>> earlier;
};

/// Copies the files that the job names, and nothing else, into input/: the scene, the program, the machine
/// with its meshes, the tool table, the design. Links are followed: the copies are plain files. The machine's
/// meshes keep their places as seen from machine.toml; those that it names by an absolute path get a place
/// beside it, and the copied machine.toml names that. What belongs to earlier set-ups of the scene lies in
/// input/setup_1/, ...; a run that the stock comes from in input/earlier_run/, with its own inputs.
///
/// Throws InputError "cannot-copy" with the file and the reason.
KeptInputs keep_inputs(const PendingFolder& folder, const sim::Job& job,
                       const std::vector<std::string>& overrides);

/// The programs that the scene's program has called, known when it has been read: beside its copy as they lie
/// seen from it; `called_earlier`: by those of each earlier set-up.
void keep_called_programs(const PendingFolder& folder, const sim::Job& job,
                          const std::vector<std::string>& called,
                          const std::vector<std::vector<std::string>>& called_earlier);

}  // namespace swarf::reports
