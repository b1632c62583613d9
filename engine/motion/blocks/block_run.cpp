#include "motion/blocks/block_run.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "motion/blocks/pole_turn.h"

namespace swarf::motion {
namespace {

using toolpath::BlockLaw;
using toolpath::BlockMove;

bool stops_between(const BlockMove& before, const BlockMove& after) {
  if (before.exact_stop || after.dwell_s > 0.0 || before.tool != after.tool) return true;
  if (is_rapid(before) != is_rapid(after)) return true;
  return is_rapid(before) && !(before.corner_tolerance_mm > 0.0);
}

}  // namespace

size_t run_end(const BlockMotions& motions, size_t first) {
  BlockMotion before = motions[first];
  size_t end = first + 1;
  for (; end < motions.size(); ++end) {
    const BlockMotion motion = motions[end];
    if (stops_between(before.block, motion.block) || turns_at_rest(before, motion)) break;
    before = motion;
  }
  return end;
}

double duration(const std::vector<PlacedPhase>& phases) {
  double time = 0.0;
  for (const PlacedPhase& placed : phases) time += placed.phase.duration;
  return time;
}

RunPlanner::RunPlanner(const BlockMotions& motions, const RunPlace& start,
                       const kinematics::InverseKinematics& inverse, const MotionOptions& options,
                       const LookAheadReach& reach, PlanAhead ahead)
    : reach_(reach),
      builder_(motions.subspan(start.first, start.end - start.first), inverse, options, start.path),
      motions_(motions),
      place_(start),
      ahead_(ahead) {}

const PlannedRun& RunPlanner::next() {
  stretch_ = coming_.valid() ? coming_.get() : make();
  if (ahead_ == PlanAhead::kYes && !stretch_.last)
    coming_ = std::async(std::launch::async, [this] { return make(); });
  return stretch_;
}

PlannedRun RunPlanner::make() {
  EvenPlace end;
  CellPlan plan = this->plan(end);
  PlannedRun stretch;
  stretch.place = place_;
  stretch.motions = motions_;
  stretch.cells = end.cell;
  stretch.last = builder_.at_end() && end.cell == builder_.path().cells.size();
  stretch.phases.assign(plan.phases.begin(), plan.phases.begin() + static_cast<ptrdiff_t>(end.phases));
  stretch.path = builder_.take(end.cell);
  if (stretch.last) return stretch;
  rest_ = {};
  for (size_t i = end.phases; i < plan.phases.size(); ++i) {
    rest_.phases.push_back(plan.phases[i]);
    rest_.phases.back().cell -= end.cell;
  }
  for (const EvenPlace& place : plan.places) {
    if (place.phases > end.phases)
      rest_.places.push_back({place.cell - end.cell, place.speed, place.phases - end.phases});
  }
  place_.path = builder_.place(0);
  place_.plan = {end.speed, stretch.path.cells[end.cell - 1].speed};
  place_.kept = nullptr;
  return stretch;
}

CellPlan RunPlanner::plan(EvenPlace& end) {
  for (size_t cells = reach_.planned;; cells *= 2) {
    builder_.extend(cells);
    const std::vector<PathCell>& path = builder_.path().cells;
    if (path.empty()) return {};
    std::optional<CellPlan> plan;
    if (!place_.kept) plan = plan_cells(path, builder_.limits(), place_.plan);
    if (!plan) {
      if (!place_.kept) place_.kept = std::make_shared<const CellPlan>(rest_);
      end = place_.kept->places.back();
      builder_.extend(end.cell + 1);  // does the run go on behind it?
      return *place_.kept;
    }
    end = plan->places.back();
    if (builder_.at_end()) return std::move(*plan);
    const size_t settled = path.size() - std::min(path.size(), reach_.seen_ahead);
    for (const EvenPlace& place : plan->places) {
      if (place.cell > 0 && place.cell <= settled) end = place;
    }
    if (end.cell <= settled) return std::move(*plan);
  }
}

void RunSampler::enter(const PlannedRun& stretch) {
  run_ = &stretch;
  if (!motions_) motions_.emplace(stretch.motions);
  phase_ = 0;
  if (stretch.phases.empty()) return;
  forward_.emplace(*motions_->at(stretch.place.first).machine);
  if (clock_.tick == 0 && clock_.planned_s == 0.0) {
    clock_.time = period_;
    clock_.before = point_at(stretch.path, 0, 0.0);
    clock_.tip_before = motions_->at(stretch.place.first + clock_.before.block).block.from.tip_W;
  }
  for (const PlacedPhase& placed : stretch.phases) clock_.planned_s += placed.phase.duration;
  if (stretch.last) ticks_ = static_cast<size_t>(std::max(1.0, std::ceil(clock_.planned_s / period_)));
}

/// The phase of the next tick. Times stay small, so that rounding does not show in the differences of the
/// positions.
void RunSampler::enter_phase() {
  while (phase_ < run_->phases.size() && clock_.time >= run_->phases[phase_].phase.duration)
    clock_.time -= run_->phases[phase_++].phase.duration;
}

size_t RunSampler::skip(size_t ticks) {
  size_t skipped = 0;
  for (; skipped < ticks; ++skipped) {
    enter_phase();
    if (phase_ + 1 >= run_->phases.size() || (run_->last && clock_.tick + 2 >= ticks_)) break;
    ++clock_.tick;
    clock_.time += period_;
  }
  return skipped;
}

/// False when the next tick lies behind the stretch.
bool RunSampler::next_place(CellOffset& place) {
  if (run_->last && clock_.tick == ticks_) return false;
  enter_phase();
  if (!run_->last && phase_ == run_->phases.size()) return false;
  ++clock_.tick;
  const std::vector<PathCell>& cells = run_->path.cells;
  if (phase_ == run_->phases.size() || (run_->last && clock_.tick == ticks_)) {
    place = {cells.size() - 1, cells.back().length};
  } else {
    const PlacedPhase& placed = run_->phases[phase_];
    const PathCell *cell = &cells[placed.cell], *last = &cells.back();
    double offset = placed.offset + placed.phase.way(clock_.time);
    while (cell != last && offset > cell->length) offset -= (cell++)->length;
    place = {static_cast<size_t>(cell - cells.data()), std::clamp(offset, 0.0, cell->length)};
  }
  clock_.time += period_;
  return true;
}

size_t RunSampler::next(std::span<Cycle> cycles) {
  size_t count = 0;
  while (count < std::min(kBatch, cycles.size()) && next_place(places_[count])) ++count;
  const auto points = std::span(points_).first(count);
  points_at(run_->path, std::span(places_).first(count), points, open_);
  set_poses(points, cycles);
  for (size_t i = 0; i < count; ++i) fill(points[i], cycles[i]);
  return count;
}

/// Where the axes lead the tip, side by side; else by the block's law.
void RunSampler::set_poses(std::span<const PathPoint> points, std::span<Cycle> cycles) {
  std::array<size_t, kBatch> led;
  size_t count = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const PathPoint& at = points[i];
    const BlockMotion& motion = motions_->at(run_->place.first + at.block);
    if (at.rounded || (motion.block.law == BlockLaw::kJoint && at.share < 1.0)) {
      led_q_[count] = at.q;
      led[count++] = i;
    } else if (at.pose) {
      cycles[i].sample.pose = *at.pose;
    } else {
      cycles[i].sample.pose = pose_at(motion, at.share);
    }
  }
  forward_->at(std::span(led_q_).first(count), led_pose_);
  for (size_t i = 0; i < count; ++i) cycles[led[i]].sample.pose = led_pose_[i];
}

void RunSampler::fill(const PathPoint& at, Cycle& cycle) {
  const size_t index = run_->place.first + at.block;
  const BlockMotion& motion = motions_->at(index);
  const BlockCurve& curve = run_->path.curve(at.block);
  const bool rapid = is_rapid(motion.block);
  cycle.q = at.q;
  cycle.reached = curve.followed();
  cycle.cost_ns = -1.0F;
  ToolSample& sample = cycle.sample;
  sample.contact_W = sample.pose.tip_W;
  sample.u = at.share;
  sample.v = 0.0;
  sample.element = static_cast<int>(index);
  sample.kind = rapid ? SampleKind::kRapid : SampleKind::kCutting;
  sample.rounded = at.rounded;
  PathPoint& before = clock_.before;
  const bool along = !rapid && !at.rounded && !before.rounded && before.block == at.block;
  const double way =
      along ? (at.share - before.share) * curve.tip_way() : (sample.pose.tip_W - clock_.tip_before).norm();
  sample.feed_mm_s = way / period_;
  before = at;
  clock_.tip_before = sample.pose.tip_W;
}

}  // namespace swarf::motion
