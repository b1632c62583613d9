// What a [flank] job mills: its passes, and the path along them.
#pragma once

#include "base/diagnostics.h"
#include "sim/job/scene.h"

namespace swarf::sim {

/// Fills Job::flank from the design that has been loaded: each ruled surface in its order, or as the
/// program's G06.5 name them, from the upper pass in depth to the lower. Diagnostics: those of
/// flank::check_task, "flank-needs-ruled", "flank-needs-g065", "no-flank", "flank-above-guide",
/// "limit-unreachable" with the error that no feed goes below (E18), "no-tool-fits". With flank.tool = "best"
/// one tool is left in Scene::tools: of those that nothing refuses the one whose placement errs least.
void load_flank(Job& job, Diagnostics& diagnostics);

/// The rule of the scene: bisected where it gives a limit.
flank::FeedRule flank_rule(const Job& job);

}  // namespace swarf::sim
