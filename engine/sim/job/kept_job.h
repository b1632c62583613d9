// The job of a run, from the copies of its inputs that its folder keeps.
#pragma once

#include <string>
#include <vector>

#include "sim/job/scene.h"

namespace swarf::sim {

/// The file that marks a folder as a result of `swarf run`, and says how its inputs were read:
/// `overrides`, of one of several set-ups with those of the ones before it in `earlier_overrides`.
inline constexpr const char* kRunMark = "run.json";

/// `overrides` come on top of those that it was run with. Throws InputError "not-a-run" and as load_job does.
Job load_kept_job(const std::string& folder, const std::vector<std::string>& overrides);

}  // namespace swarf::sim
