#include "motion/cycles/cycle_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>

#include "base/check.h"
#include "base/units.h"
#include "kinematics/rotary_pair.h"
#include "motion/blocks/block_interpolator.h"
#include "motion/passes/pass_geometry.h"
#include "motion/speed/free_move.h"

namespace swarf::motion {
namespace {

using kinematics::Branch;
using kinematics::InverseOutcome;
using toolpath::BlockMove;
using toolpath::FreeMove;
using toolpath::SurfacePass;
using Clock = std::chrono::steady_clock;

/// Processor time of this thread: what a cycle of some microseconds takes, not what the machine does beside
/// it. The look at it takes .3 us, too much for the cycles of planned passes.
double thread_ns() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

/// Cycles of one off-line pass or free move, which are made at once.
constexpr double kListedMax = 2e7;
/// Elements must follow each other without a gap, mm and (per unit axis) rad. A tool that is set down on
/// patches rests within position::kPatchProof_mm.
constexpr double kJoinTolerance = 2.5 * position::kPatchProof_mm;

/// Whole cycles that a time takes; a hair too long does not count as one more.
double whole_cycles(double seconds, double period_s) {
  return std::ceil(seconds / period_s * (1.0 - 1e-12));
}

/// A standing tool.
ToolSample standing(const ToolPose& pose, SampleKind kind) {
  ToolSample sample;
  sample.pose = pose;
  sample.contact_W = pose.tip_W;
  sample.kind = kind;
  return sample;
}

}  // namespace

CycleStream::CycleStream(const CycleSource& source, const CyclePlace& from)
    : source_(source),
      place_(from),
      cycle_(from.cycle),
      element_(from.element),
      tool_(from.tool),
      before_(from.before),
      q_(from.before.q) {
  if (cycle_ == 0) {
    const std::vector<kinematics::Axis>& axes = source_.by_tool.front().axes;
    q_ = kinematics::AxisValues::Zero();
    for (size_t i = 0; i < axes.size(); ++i) q_[static_cast<Eigen::Index>(i)] = axes[i].home;
  }
  if (!from.run) return;
  run_.emplace();
  run_->first = from.run->first;
  run_->end = from.run->end;
  run_->planner = planner(*from.run);
  run_->sampler.emplace(source_.options->period_s, from.clock);
}

bool CycleStream::next(std::vector<Cycle>& window) {
  window.resize(kWindow);  // stays as long as it is: cycles are written over those of the last window
  window_ = window;
  made_ = 0;
  while (made_ < kWindow && go_on()) {
  }
  window.resize(made_);
  window_ = {};
  return made_ > 0;
}

/// The last cycle before the sought one is always made: the feed of a cycle is its way from there.
void CycleStream::pass_to(uint64_t cycle) {
  Cycle passed;
  window_ = std::span(&passed, 1);
  bool more = true;
  while (more && cycle_ < cycle) {
    if (may_skip()) cycle_ += run_->sampler->skip(cycle - cycle_ - 1);
    made_ = 0;
    more = go_on();
  }
  window_ = {};
}

/// Where the machine cannot follow, the axes depend on all cycles before.
bool CycleStream::may_skip() {
  if (!run_ || run_->stretch == nullptr) return false;
  if (!run_->followed) {
    const std::vector<BlockCurve>& curves = run_->stretch->path.curves;
    run_->followed =
        std::all_of(curves.begin(), curves.end(), [](const BlockCurve& curve) { return curve.followed(); });
  }
  return *run_->followed;
}

/// Records a cycle or several, or begins what comes next; false when nothing does.
bool CycleStream::go_on() {
  const bool more = advance();
  if (made_ > 0) before_ = window_[made_ - 1];
  return more;
}

bool CycleStream::advance() {
  if (run_) {
    run_on();
  } else if (pass_) {
    pass_on();
  } else if (driven_) {
    driven_on();
  } else if (samples_done_ < samples_.size()) {
    samples_on();
  } else if (element_ == source_.elements.size()) {
    return false;
  } else if (!source_.motions.empty()) {
    begin_run();
  } else {
    begin_element();
  }
  return true;
}

void CycleStream::mark_place() {
  place_ = {cycle_, element_, tool_, before_, std::nullopt, {}};
  place_.before.q = q_;
  if (!run_) return;
  place_.run = run_->stretch->place;
  place_.clock = run_->sampler->clock();
}

void CycleStream::begin_run() {
  mark_place();
  const BlockMotions& motions = source_.motions;
  const BlockMotion motion = motions[element_];
  const BlockMove& block = motion.block;
  tool_ = block.tool;
  // Another tool's tip stands elsewhere.
  const bool joins = element_ == 0 || motions.tool(element_ - 1) == block.tool;
  const bool starts = cycle_ == 0 || !joins;
  RunUnderWay run;
  run.first = element_;
  run.from = block.from;
  run.end = run_end(motions, element_);
  run.kind = is_rapid(block) ? SampleKind::kRapid : SampleKind::kCutting;
  sample_element_ = static_cast<int>(element_);
  if (starts) {
    record(standing(block.from, run.kind));
    if (block.axes) window_[made_ - 1].q = q_ = block.axes->from;
    if (!block.axes && inverse().pole_distance(block.from.axis_W) < kinematics::kPoleTolerance)
      window_[made_ - 1].q = q_ = motion.q_from;
  } else {
    require_join(block.from);
  }
  check_time(block.dwell_s, "dwells");
  run.dwell_ticks = whole_cycles(block.dwell_s, source_.options->period_s);
  if (!starts && turns_at_rest(motions[element_ - 1], motion)) {
    run.turn.emplace(inverse(), *motion.machine, block.from, q_, motion.q_from);
    check_time(run.turn->duration_s(), "turns at the pole");
    run.turn_ticks = whole_cycles(run.turn->duration_s(), source_.options->period_s);
  }
  run_.emplace(std::move(run));
}

/// First the dwell of the run's first block, then the turn of the rotary axes while the tool stands, then its
/// stretches.
void CycleStream::run_on() {
  RunUnderWay& run = *run_;
  if (run.standing < run.dwell_ticks) {
    record(standing(run.from, run.kind), {q_, InverseOutcome::kOk});
    run.standing += 1.0;
  } else if (run.standing < run.dwell_ticks + run.turn_ticks) {
    run.standing += 1.0;
    const double t = (run.standing - run.dwell_ticks) * source_.options->period_s;
    record(standing(run.from, run.kind), {run.turn->at(t), InverseOutcome::kOk});
  } else if (run.stretch == nullptr) {
    enter_stretch();
  } else if (sample_run()) {
    return;
  } else if (!run.stretch->last) {
    run.stretch = nullptr;
  } else {
    element_ = run.end;
    run_.reset();
  }
}

/// The next cycles of the stretch into the window; false when there are none.
bool CycleStream::sample_run() {
  const size_t count = run_->sampler->next(window_.subspan(made_));
  for (Cycle& cycle : window_.subspan(made_, count)) {
    sample_element_ = cycle.sample.element;
    if (!cycle.reached) {
      const Branch branch = inverse().solve_nearest(cycle.sample.pose, q_);
      cycle.reached = branch.outcome != InverseOutcome::kUnreachable;
      cycle.q = cycle.reached ? branch.q : q_;
    }
    q_ = cycle.q;
    number(cycle);
  }
  made_ += count;
  return count > 0;
}

std::unique_ptr<RunPlanner> CycleStream::planner(const RunPlace& start) const {
  return std::make_unique<RunPlanner>(source_.motions, start, inverse(), *source_.options, source_.reach,
                                      source_.plan_ahead);
}

void CycleStream::enter_stretch() {
  RunUnderWay& run = *run_;
  if (!run.planner) {
    RunPlace start;
    start.first = run.first;
    start.end = run.end;
    run.planner = planner(start);
    run.sampler.emplace(source_.options->period_s);
  }
  run.stretch = &run.planner->next();
  run.followed.reset();
  mark_place();
  run.sampler->enter(*run.stretch);
  check_time(duration(run.stretch->phases), "moves");
}

void CycleStream::begin_element() {
  mark_place();
  sample_element_ = static_cast<int>(element_);
  const toolpath::Element element = source_.elements[element_];
  if (const auto* move = std::get_if<FreeMove>(&element.what)) {
    if (move->feed_mm_s > 0.0)
      check_time((move->to.tip_W - move->from.tip_W).norm() / move->feed_mm_s, "moves", kListedMax);
    start_at(standing(move->from, SampleKind::kRapid));
    samples_ = sample_free_move(*move, source_.by_tool.front(), inverse(), *source_.options, q_);
  } else if (const auto* driven = std::get_if<toolpath::DrivenPass>(&element.what)) {
    begin_driven(*driven);
  } else {
    begin_pass(std::get<SurfacePass>(element.what));
  }
  samples_done_ = 0;
  ++element_;
}

void CycleStream::begin_pass(const SurfacePass& pass) {
  const bool offline = source_.options->mode == Mode::kOffline;
  check_time(pass_length(pass, pass.t_start, pass.t_end) / pass.feed_mm_s, "moves",
             offline ? kListedMax : kHoursMax * 3600.0 / source_.options->period_s);
  const toolpath::CurvePoint start = curve_at(*pass.surface, pass.curve, pass.t_start);
  ToolSample first = standing(contact_pose(pass, pass.t_start, toolpath::contact_end(*source_.cutter)),
                              SampleKind::kCutting);
  first.contact_W = start.C;
  first.u = start.u;
  first.v = start.v;
  start_at(first);
  samples_.clear();
  if (offline) {
    samples_ =
        sample_offline_pass(pass, *source_.cutter, source_.by_tool.front(), inverse(), *source_.options, q_);
    return;
  }
  pass_.emplace(source_.by_tool.front(), inverse(), *source_.cutter, *source_.options);
  pass_->begin(pass, q_);
}

void CycleStream::pass_on() {
  StepOutput out;
  const auto begin = Clock::now();
  pass_->step({}, out);
  const Branch branch = inverse().solve_nearest(out.pose, q_);
  const auto end = Clock::now();
  ToolSample sample;
  sample.pose = out.pose;
  sample.contact_W = out.contact_W;
  sample.u = out.u;
  sample.v = out.v;
  sample.feed_mm_s = out.feed_mm_s;
  sample.kind = SampleKind::kCutting;
  record(sample, branch, static_cast<float>(std::chrono::duration<double, std::nano>(end - begin).count()));
  if (out.finished) pass_.reset();
}

void CycleStream::begin_driven(const toolpath::DrivenPass& pass) {
  samples_.clear();
  check_time(pass.guide->end() / pass.feed_mm_s, "moves");
  driven_.emplace(pass, source_.by_tool.front(), inverse(), *source_.options, q_);
  ToolSample first = standing(driven_->start().pose, SampleKind::kCutting);
  first.contact_W = driven_->start().rest.contact_W;
  start_at(first);
}

void CycleStream::driven_on() {
  const double begin = thread_ns();
  const DrivenOutput out = driven_->step({});
  const Branch branch = inverse().solve_nearest(out.at.pose, q_);
  const double took = thread_ns() - begin;
  ToolSample sample;
  sample.pose = out.at.pose;
  sample.contact_W = out.at.rest.contact_W;
  sample.u = out.x;
  sample.feed_mm_s = out.feed_mm_s;
  sample.kind = SampleKind::kCutting;
  record(sample, branch, static_cast<float>(took));
  if (out.finished) driven_.reset();
}

void CycleStream::samples_on() {
  record(samples_[samples_done_++]);
}

/// Records the very first pose; others must be where the element before ended.
void CycleStream::start_at(const ToolSample& first) {
  if (cycle_ == 0) {
    record(first);
  } else {
    require_join(first.pose);
  }
}

void CycleStream::require_join(const ToolPose& pose) const {
  const ToolPose& before = before_.sample.pose;
  SWARF_CHECK((before.tip_W - pose.tip_W).norm() <= kJoinTolerance &&
                  (before.axis_W - pose.axis_W).norm() <= kJoinTolerance,
              fmt::format("element {} starts {:.3g} mm from where the one before ends", element_,
                          (before.tip_W - pose.tip_W).norm()));
}

void CycleStream::record(const ToolSample& sample) {
  record(sample, inverse().solve_nearest(sample.pose, q_));
}

void CycleStream::record(const ToolSample& sample, const Branch& branch, float cost_ns) {
  const bool reached = branch.outcome != InverseOutcome::kUnreachable;
  if (reached) q_ = branch.q;
  add(sample, reached, cost_ns);
}

void CycleStream::add(const ToolSample& sample, bool reached, float cost_ns) {
  Cycle& cycle = window_[made_++];
  cycle = {cycle_, sample, q_, reached, cost_ns};
  cycle.sample.element = sample_element_;
  number(cycle);
}

void CycleStream::number(Cycle& cycle) {
  cycle.number = cycle_;
  cycle.sample.t_s = static_cast<double>(cycle_++) * source_.options->period_s;
  cycle.sample.tool = static_cast<int16_t>(tool_);
}

/// Of the run under way the block that takes longest as programmed; the first, where none says a feed.
size_t CycleStream::slowest_of_run() const {
  size_t slowest = run_->first;
  double longest_s = 0.0;
  for (size_t i = run_->first; i < run_->end; ++i) {
    const BlockMove block = source_.elements.block(i);
    double seconds = block.duration_s;
    if (seconds == 0.0 && block.feed_mm_s > 0.0)
      seconds = (block.to.tip_W - block.from.tip_W).norm() / block.feed_mm_s;
    if (seconds > longest_s) {
      slowest = i;
      longest_s = seconds;
    }
  }
  return slowest;
}

/// Refuses what nobody means: a program of months, by a feed that is wrong by a power of ten.
void CycleStream::check_time(double seconds, const char* what, double cycles_max) const {
  const double period = source_.options->period_s;
  const double hours = (static_cast<double>(cycle_) * period + seconds) / 3600.0;
  const auto where = [&] {
    return source_.elements.where(run_ && run_->stretch != nullptr ? slowest_of_run()
                                                                   : static_cast<size_t>(sample_element_));
  };
  if (hours > kHoursMax) {
    throw InputError(
        "too-many-cycles", where(),
        fmt::format("the program {} for {:.3g} h up to here, more than {:g} h", what, hours, kHoursMax),
        "mend the feed or the dwell of this block");
  }
  if (seconds / period <= cycles_max) return;
  throw InputError("too-many-cycles", where(),
                   fmt::format("this pass or move takes {:.3g} cycles of {:g} ms, more than {:g}",
                               seconds / period, period * 1e3, cycles_max),
                   "raise its feed, or the period");
}

const kinematics::InverseKinematics& CycleStream::inverse() const {
  return source_.inverses[source_.inverses.size() == 1 ? 0 : static_cast<size_t>(tool_)];
}

}  // namespace swarf::motion
