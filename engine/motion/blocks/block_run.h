// Time along the blocks of a program: one tool pose per control cycle.
//
// Feed blocks that follow each other are a run, whatever their feeds: it ends where a block asks for an exact
// stop, the next one dwells or has another tool, or a rapid comes. A rapid is a run of its own; so are the
// legs of a dog-leg (dog_leg.h) together. A run is one smooth curve of axis values (run_path.h), planned
// ahead from rest to rest under feed, path and axis limits (look_ahead.h). Under the joint law the axes move
// evenly within a block, so its feed holds on average.
#pragma once

#include <array>
#include <future>
#include <memory>
#include <optional>
#include <vector>

#include "motion/blocks/run_path.h"
#include "motion/speed/look_ahead.h"
#include "motion/tool_sample.h"

namespace swarf::motion {

/// First block after `first` that does not belong to its run.
size_t run_end(const BlockMotions& motions, size_t first);

/// Where a stretch of a run begins: enough to plan it again, and all after it.
struct RunPlace {
  size_t first = 0, end = 0;  ///< blocks of the run, counted from the start of the path
  PathPlace path;
  PlanStart plan;
  /// The rest of the stretch before, where no plan starts here (CellPlan); mostly none.
  std::shared_ptr<const CellPlan> kept;
};

/// A run, or a stretch of it between two places that are passed without acceleration, with its time law.
struct PlannedRun {
  RunPlace place;
  BlockMotions motions;             ///< of the whole path
  RunPath path;                     ///< from the stretch on, and farther
  std::vector<PlacedPhase> phases;  ///< empty when it goes nowhere
  size_t cells = 0;                 ///< of the stretch
  bool last = true;                 ///< the run ends with it
};

/// Sum of all durations, s.
double duration(const std::vector<PlacedPhase>& phases);

/// How many cells of a run are planned at once, and how many of these, the last ones, only serve to see what
/// comes: a control looks no farther either. What lies more than `seen_ahead` cells behind a place may not
/// change the speed there, which only matters for runs with more than `planned` cells.
struct LookAheadReach {
  size_t planned = size_t{1} << 15U, seen_ahead = size_t{1} << 13U;
};

/// Whether the next stretch is planned on a thread of its own while one is in use.
enum class PlanAhead { kNo, kYes };

/// Plans a run stretch by stretch, from any place on, in bounded memory.
class RunPlanner {
 public:
  /// Machines, inverse and options must outlive it.
  RunPlanner(const BlockMotions& motions, const RunPlace& start, const kinematics::InverseKinematics& inverse,
             const MotionOptions& options, const LookAheadReach& reach = {},
             PlanAhead ahead = PlanAhead::kNo);
  RunPlanner(const RunPlanner&) = delete;
  RunPlanner& operator=(const RunPlanner&) = delete;
  /// The next stretch, at first that of the start; valid until the next call. Not to be called after the last
  /// one.
  const PlannedRun& next();

 private:
  PlannedRun make();
  /// A plan from here on, of which the phases up to `end` stand whatever follows.
  CellPlan plan(EvenPlace& end);

  LookAheadReach reach_;
  RunPathBuilder builder_;
  BlockMotions motions_;
  RunPlace place_;  ///< of what is planned next
  CellPlan rest_;   ///< of the last plan, behind its stretch
  PlanAhead ahead_;
  PlannedRun stretch_;              ///< handed out
  std::future<PlannedRun> coming_;  ///< the last member: its thread ends before the others go
};

/// Where the sampler of a run stands between two stretches.
struct RunClock {
  size_t tick = 0;         ///< cycles since the start of the run
  double time = 0.0;       ///< of the next cycle, from the start of the stretch, s
  double planned_s = 0.0;  ///< duration of all stretches before
  PathPoint before;
  Vec3 tip_before = Vec3::Zero();
};

/// The ticks of a run one after the other: cycles of `period_s` from its start at rest; the last one ends on
/// its end. Allocates nothing.
class RunSampler {
 public:
  explicit RunSampler(double period_s, const RunClock& clock = {}) : period_(period_s), clock_(clock) {}
  /// Goes on in this stretch; it must outlive the calls of next().
  void enter(const PlannedRun& stretch);
  /// The next cycles, as many as there is room for, kBatch at most; returns how many. None when the next one
  /// lies behind the stretch. Sets all but number, t_s and tool: u is the share of the block, element an
  /// index into the motions. Not `reached` where the machine does not follow the block: the axis values have
  /// to be found by continuity.
  size_t next(std::span<Cycle> cycles);
  static constexpr size_t kBatch = 32;
  /// Passes at most so many ticks without making them; returns how many. The last ones of the stretch are
  /// left, and the first tick that is made next has no feed of its own.
  size_t skip(size_t ticks);
  const RunClock& clock() const { return clock_; }

 private:
  void enter_phase();
  bool next_place(CellOffset& place);
  void set_poses(std::span<const PathPoint> points, std::span<Cycle> cycles);
  void fill(const PathPoint& at, Cycle& cycle);

  const PlannedRun* run_ = nullptr;
  std::optional<MotionReader> motions_;  ///< of the whole path
  std::optional<kinematics::ForwardChain> forward_;
  double period_;
  RunClock clock_;
  size_t ticks_ = 0;  ///< of the whole run; known in its last stretch
  size_t phase_ = 0;
  std::array<CellOffset, kBatch> places_;
  std::array<PathPoint, kBatch> points_;
  OpenPoints open_;
  // Where the axes lead the tip:
  std::array<kinematics::AxisValues, kBatch> led_q_;
  std::array<ToolPose, kBatch> led_pose_;
};

}  // namespace swarf::motion
