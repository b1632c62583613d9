#include "motion/block_run.h"

#include <algorithm>
#include <cmath>

#include "motion/pole_turn.h"

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

size_t run_end(std::span<const BlockMotion> motions, size_t first) {
  size_t end = first + 1;
  while (end < motions.size() && !stops_between(*motions[end - 1].block, *motions[end].block) &&
         !turns_at_rest(motions[end - 1], motions[end]))
    ++end;
  return end;
}

PlannedRun plan_run(std::span<const BlockMotion> motions, size_t first, size_t end,
                    const kinematics::InverseKinematics& inverse, const MotionOptions& options) {
  PlannedRun run;
  run.first = first;
  run.motions = motions;
  run.path = run_path(motions.subspan(first, end - first), inverse, options);
  if (run.path.cells.empty()) return run;
  run.phases =
      plan_run(run.path.cells, axis_limits(*motions[first].machine, is_rapid(*motions[first].block)));
  run.duration_s = duration(run.phases);
  return run;
}

RunSampler::RunSampler(const PlannedRun& run, double period_s) : run_(run), period_(period_s) {
  if (run.phases.empty()) return;
  ticks_ = static_cast<size_t>(std::max(1.0, std::ceil(run.duration_s / period_s)));
  before_ = point_at(run.path, 0, 0.0);
  tip_before_ = run.motions[run.first + before_.block].block->from.tip_W;
}

bool RunSampler::next(BlockTick& tick) {
  if (tick_ == ticks_) return false;
  ++tick_;
  time_ += period_;
  // Times stay small, so that rounding does not show in the differences of the positions.
  while (phase_ < run_.phases.size() && time_ >= run_.phases[phase_].phase.duration)
    time_ -= run_.phases[phase_++].phase.duration;
  const std::vector<PathCell>& cells = run_.path.cells;
  if (tick_ == ticks_ || phase_ == run_.phases.size()) {
    fill(cells.size() - 1, cells.back().length, tick);
    return true;
  }
  const PlacedPhase& placed = run_.phases[phase_];
  size_t cell = placed.cell;
  double offset = placed.offset + placed.phase.way(time_);
  while (cell + 1 < cells.size() && offset > cells[cell].length) offset -= cells[cell++].length;
  fill(cell, std::clamp(offset, 0.0, cells[cell].length), tick);
  return true;
}

void RunSampler::fill(size_t cell, double offset, BlockTick& tick) {
  const PathPoint at = point_at(run_.path, cell, offset);
  const BlockMotion& motion = run_.motions[run_.first + at.block];
  const BlockCurve& curve = run_.path.curves[at.block];
  const bool rapid = is_rapid(*motion.block);
  tick.q = at.q;
  tick.followed = curve.followed();
  ToolSample& sample = tick.sample;
  sample = {};
  sample.pose = at.rounded || (motion.block->law == BlockLaw::kJoint && at.share < 1.0)
                    ? kinematics::forward(*motion.machine, at.q)
                    : pose_at(motion, at.share);
  sample.contact_W = sample.pose.tip_W;
  sample.u = at.share;
  sample.element = static_cast<int>(run_.first + at.block);
  sample.kind = rapid ? SampleKind::kRapid : SampleKind::kCutting;
  sample.rounded = at.rounded;
  const bool along = !rapid && !at.rounded && !before_.rounded && before_.block == at.block;
  const double way =
      along ? (at.share - before_.share) * curve.tip_way() : (sample.pose.tip_W - tip_before_).norm();
  sample.feed_mm_s = way / period_;
  before_ = at;
  tip_before_ = sample.pose.tip_W;
}

}  // namespace swarf::motion
