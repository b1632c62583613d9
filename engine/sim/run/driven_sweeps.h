// Sweeps of the control cycles of a job of blocks: its chords, rounded corners and dog-legs, as the axes
// drive them.
#pragma once

#include "sim/run/job_sweeps.h"

namespace swarf::sim {

/// The axes move linearly inside a cycle; where they turn, cycles are divided until the sweeps stay within
/// the tolerance of that motion. Nothing is swept where the tool changes, nor while it stands. Every sweep
/// has a block of its own and one kind of motion: rapids are never joined with feeds, nor cuts of another
/// spindle speed. `join`: neighbouring cycles become one sweep where the tolerance allows it (for the level
/// set).
JobSweeps driven_sweeps(const Job& job, const motion::Cycles& cycles, double tolerance_mm, bool join);

}  // namespace swarf::sim
