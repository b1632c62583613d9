// The control cycles of a path one after the other, from its start or from any place where a stretch of it
// begins: equal to the last bit either way.
//
//   ToolPath --> surface pass --> SurfaceInterpolator (taylor1, surface) --+
//            --> surface pass --> straight segments (offline) -------------+--> ToolSample --> inverse --> q
//            --> driven pass  --> DrivenInterpolator ---------------------+
//            --> free move    --> straight tip, slerp axis ----------------+
//            --> blocks       --> their own law (block_motion.h), by runs --+
//
// Every pass and move, and every run of blocks (block_run.h), starts and ends at rest; between them nothing
// moves. The rotary branch is chosen once, nearest to home, and then follows by continuity; blocks that give
// axis values keep theirs. The first block of another tool begins with a cycle of its own; how the axes come
// there is not part of the program.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "cutter/cutter.h"
#include "motion/blocks/block_run.h"
#include "motion/blocks/pole_turn.h"
#include "motion/options.h"
#include "motion/passes/driven_interpolator.h"
#include "motion/passes/surface_interpolator.h"
#include "motion/tool_sample.h"
#include "toolpath/tool_path.h"

namespace swarf::motion {

/// What cycles are made from; spans and pointers are borrowed.
struct CycleSource {
  toolpath::Elements elements;
  BlockMotions motions;  ///< of a path of blocks, else empty
  /// The machine with each tool in its spindle (BlockMove::tool), or one for whatever tool.
  std::span<const kinematics::MachineModel> by_tool;
  std::span<const kinematics::InverseKinematics> inverses;  ///< of the same
  const cutter::Cutter* cutter = nullptr;                   ///< of surface passes
  const MotionOptions* options = nullptr;
  LookAheadReach reach;
  PlanAhead plan_ahead = PlanAhead::kNo;
};

/// Where an element or a stretch of a run begins.
struct CyclePlace {
  uint64_t cycle = 0;  ///< number of the next cycle
  size_t element = 0;  ///< the next one, or the first of the run
  int tool = 0;        ///< in the spindle before
  /// The cycle before; meaningless while `cycle` is 0.
  Cycle before;
  std::optional<RunPlace> run;  ///< inside a run: the stretch
  RunClock clock;
};

/// What is under way of a run: the dwell of its first block, a turn at rest, its stretches.
struct RunUnderWay {
  size_t first = 0, end = 0;
  ToolPose from;  ///< where it starts
  SampleKind kind = SampleKind::kCutting;
  double dwell_ticks = 0.0, turn_ticks = 0.0, standing = 0.0;  ///< cycles
  std::optional<PoleTurn> turn;
  std::unique_ptr<RunPlanner> planner;
  std::optional<RunSampler> sampler;
  const PlannedRun* stretch = nullptr;  ///< the planner's
  std::optional<bool> followed;         ///< the machine follows every block that the planner has looked at
};

class CycleStream {
 public:
  /// The source's spans must outlive it.
  explicit CycleStream(const CycleSource& source, const CyclePlace& from = {});

  /// Replaces the window by the next cycles, at most kWindow. False, and none, behind the last. Throws
  /// InputError "too-many-cycles" for programs that take longer than kHoursMax.
  bool next(std::vector<Cycle>& window);
  /// Goes on to this cycle, with which the next window then begins; those before it are only made where they
  /// must be for that. Costs next to nothing inside a stretch.
  void pass_to(uint64_t cycle);
  static constexpr size_t kWindow = 4096;
  static constexpr double kHoursMax = 1000.0;

  /// The last place that has been passed, before what the last window began with or inside it.
  const CyclePlace& place() const { return place_; }

 private:
  bool go_on();
  bool advance();
  bool may_skip();
  void begin_run();
  void run_on();
  bool sample_run();
  std::unique_ptr<RunPlanner> planner(const RunPlace& start) const;
  void enter_stretch();
  void begin_element();
  void begin_pass(const toolpath::SurfacePass& pass);
  void pass_on();
  void begin_driven(const toolpath::DrivenPass& pass);
  void driven_on();
  void samples_on();
  void mark_place();
  void start_at(const ToolSample& first);
  void require_join(const ToolPose& pose) const;
  void record(const ToolSample& sample);
  void record(const ToolSample& sample, const kinematics::Branch& branch, float cost_ns = -1.0F);
  void add(const ToolSample& sample, bool reached, float cost_ns);
  void number(Cycle& cycle);
  size_t slowest_of_run() const;
  void check_time(double seconds, const char* what, double cycles_max = 1e300) const;
  const kinematics::InverseKinematics& inverse() const;

  CycleSource source_;
  CyclePlace place_;
  std::span<Cycle> window_;  ///< being filled; what stands there means nothing yet
  size_t made_ = 0;          ///< of it
  uint64_t cycle_ = 0;
  size_t element_ = 0;  ///< the next one to begin
  int tool_ = 0;
  Cycle before_;
  kinematics::AxisValues q_;
  int sample_element_ = 0;  ///< of the cycle that comes
  // At most one of these is under way.
  std::optional<RunUnderWay> run_;
  std::optional<SurfaceInterpolator> pass_;
  std::optional<DrivenInterpolator> driven_;
  std::vector<ToolSample> samples_;
  size_t samples_done_ = 0;
};

}  // namespace swarf::motion
