// What a [flank] job mills: its passes, and the path along them.
#pragma once

#include "base/diagnostics.h"
#include "sim/job/scene.h"

namespace swarf::sim {

/// Fills Job::flank from the design that has been loaded: each ruled surface in its order, from the upper
/// pass in depth to the lower. Diagnostics: those of flank::check_task, "flank-needs-ruled", "no-flank",
/// "flank-above-guide", "limit-unreachable" with the error that no feed goes below (E18).
void load_flank(Job& job, Diagnostics& diagnostics);

/// How the blocks move.
flank::FlankMotion flank_motion(const Job& job);

/// The rule of the scene: bisected where it gives a limit.
flank::FeedRule flank_rule(const Job& job);
toolpath::ToolPath flank_path(const Job& job, flank::FeedRule rule);

}  // namespace swarf::sim
