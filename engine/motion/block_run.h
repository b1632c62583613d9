// Time along the blocks of a program: one tool pose per control cycle.
//
// Feed blocks that follow each other are a run, whatever their feeds: it ends where a block asks for an exact
// stop, the next one dwells or has another tool, or a rapid comes. A rapid is a run of its own; so are the
// legs of a dog-leg (dog_leg.h) together. A run is one smooth curve of axis values (run_path.h), planned
// ahead from rest to rest under feed, path and axis limits (look_ahead.h). Under the joint law the axes move
// evenly within a block, so its feed holds on average.
#pragma once

#include <span>
#include <vector>

#include "motion/look_ahead.h"
#include "motion/run_path.h"

namespace swarf::motion {

/// First block after `first` that does not belong to its run.
size_t run_end(std::span<const BlockMotion> motions, size_t first);

/// A run with its time law.
struct PlannedRun {
  size_t first = 0;                      ///< index of its first block
  std::span<const BlockMotion> motions;  ///< of the whole path
  RunPath path;
  std::vector<PlacedPhase> phases;  ///< empty when it goes nowhere
  double duration_s = 0.0;
};
PlannedRun plan_run(std::span<const BlockMotion> motions, size_t first, size_t end,
                    const kinematics::InverseKinematics& inverse, const MotionOptions& options);

/// A sample and where it comes from.
struct BlockTick {
  ToolSample sample;  ///< u: share of the block, 0 to 1; element: index into the motions; t_s is left out
  kinematics::AxisValues q = kinematics::AxisValues::Zero();
  bool followed = true;  ///< false: the machine does not follow the block, q has to be found by continuity
};

/// The ticks of a run one by one: cycles of `period_s` from its start at rest; the last one ends on its end.
/// Allocates nothing.
class RunSampler {
 public:
  RunSampler(const PlannedRun& run, double period_s);
  size_t ticks() const { return ticks_; }
  /// False after the last tick.
  bool next(BlockTick& tick);

 private:
  void fill(size_t cell, double offset, BlockTick& tick);

  const PlannedRun& run_;
  double period_;
  size_t ticks_ = 0, tick_ = 0;
  size_t phase_ = 0;
  double time_ = 0.0;  ///< since the start of the phase
  PathPoint before_;
  Vec3 tip_before_ = Vec3::Zero();
};

}  // namespace swarf::motion
