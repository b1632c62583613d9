// Time along the blocks of a CL program: one tool pose per control cycle.
//
// Consecutive blocks of one feed are a run: it starts and stops with bounded jerk and keeps its feed in
// between. Known limit: corners between the blocks of a run are passed at full feed (no look-ahead), and what
// that asks of the axes is measured, not limited. Within a joint block the axes move evenly, so its feed
// holds on average.
#pragma once

#include <span>
#include <vector>

#include "motion/block_motion.h"
#include "motion/interpolator.h"

namespace swarf::motion {

/// Length that the run [first, end) is planned with, mm. Each block counts with the way of its tip or, where
/// an axis would then exceed its speed, with what the feed covers while that axis goes its way at its limit.
double run_length(std::span<const BlockMotion> motions, size_t first, size_t end);

/// First block after `first` that does not belong to its run: a rapid is a run of its own, another tool
/// begins another.
size_t run_end(std::span<const BlockMotion> motions, size_t first);

/// A sample and where it comes from.
struct BlockTick {
  ToolSample sample;  ///< u: share of the block, 0 to 1; element: index into the motions; t_s is left out
  kinematics::AxisValues q = kinematics::AxisValues::Zero();  ///< joint law only
};

/// The ends of the ticks of the run [first, end). Empty when it goes nowhere.
std::vector<BlockTick> sample_run(std::span<const BlockMotion> motions, size_t first, size_t end,
                                  const kinematics::InverseKinematics& inverse, const MotionOptions& options);

}  // namespace swarf::motion
