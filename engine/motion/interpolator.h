// From the tool path to what its cycles are: measured, judged, and shown to whoever asks, in one pass.
#pragma once

#include <functional>
#include <span>

#include "base/progress.h"
#include "motion/cycles/cycles.h"
#include "motion/result.h"

namespace swarf::motion {

/// Receives the cycles in their order, window by window.
using CycleVisitor = std::function<void(std::span<const Cycle>)>;

/// The first pass over the cycles. Deterministic but for tick_ns_*. When the user stops it, the result is
/// that of the cycles so far. Throws InputError as CycleStream does.
MotionResult interpolate(Cycles& cycles, Progress& progress, const CycleVisitor& visit = {});

/// All cycles, for programs that are short.
Trajectory trajectory_of(const Cycles& cycles);

}  // namespace swarf::motion
