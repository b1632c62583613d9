// How a later set-up holds what the earlier ones have left.
#pragma once

#include "base/diagnostics.h"
#include "sim/run/carried_cuts.h"

namespace swarf::sim {

/// check_clamping() of the stock that the program begins with, by the surface of a level set no finer than a
/// two-hundredth of the stock; half a voxel of it is allowed for. What would be a row of Scene::assumptions
/// is a note "holding". "stock-cut-away": nothing is left. Without earlier set-ups the job has been checked.
void check_starting_clamping(const Job& job, const CarriedCuts& carried, Diagnostics& diagnostics);

}  // namespace swarf::sim
