// Several clampings of one part: the tables [[setup]] of a scene, each laid over what the scene says for all.
// The material is one: a later set-up begins with what the ones before have left, by their very cuts
// (Job::earlier).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/config.h"
#include "sim/job/scene.h"

namespace swarf::sim {

/// How the table [[setup]] of this index lies over the scene: what belongs to the clamping stays in `setup`.
ConfigOverlay setup_overlay(size_t index);

/// "1_first_side": the folder of its results.
std::string setup_folder(const Scene& scene);

/// What a set-up begins with when `last` has been cut: all cuts so far, in order. `stock_file`: as
/// EarlierSetup's, of `last`.
std::vector<EarlierSetup> setups_up_to(std::shared_ptr<const Job> last, const Pose& X_WL,
                                       const std::string& stock_file = "");

}  // namespace swarf::sim
