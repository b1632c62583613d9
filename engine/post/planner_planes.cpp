// When the coordinates change: planes, and cycles in them.
#include <algorithm>

#include "base/units.h"
#include "post/planner.h"

namespace swarf::post {

using kinematics::AxisValues;

namespace {

/// A rotary axis is turned and, with kCycles, a plane would keep a cycle that nothing else does.
bool wants_plane(const PostAbilities& can, const Follower& follower, program::nc::WorkSpace& space,
                 std::span<const HoleSpan> holes, const PlaneRun& run, const AxisValues& q) {
  const std::array<double, 3> rotary = space.rotary_of(q);
  if (std::none_of(rotary.begin(), rotary.end(), [](double one) { return std::abs(one) > kTurned; }))
    return false;
  if (can.plane.use == PlaneUse::kConstant) return true;
  return std::any_of(holes.begin(), holes.end(), [&](const HoleSpan& one) {
    return one.begin() >= run.first && one.first < run.last && has_word_for(can, one) &&
           !stands_along_z(follower, space, one, q);
  });
}

}  // namespace

/// The plane that this move is written in. Where it is another one than before, a step without a way says
/// where the axes stand in it: the start of what follows.
void Planner::change_plane(size_t move, Plan& plan) const {
  while (plan.run < plan.runs.size() && plan.runs[plan.run].last <= move) ++plan.run;
  const bool inside = plan.run < plan.runs.size() && plan.runs[plan.run].first <= move;
  if (inside && !plan.runs[plan.run].asked) {
    PlaneRun& run = plan.runs[plan.run];
    run.asked = true;
    if (wants_plane(setup_.abilities, *follower_, *space_, holes_, run, plan.q))
      run.tilt = plane_at(*follower_, setup_.abilities.plane, snapped(*follower_, moves_[move].from), plan.q);
    if (same_plane(run.tilt.get(), plan.tilt.get())) run.tilt = plan.tilt;
  }
  const std::shared_ptr<const TiltedPlane> next = inside ? plan.runs[plan.run].tilt : nullptr;
  if (next == plan.tilt) return;
  if (next && !plan.stretch.steps.empty()) without_tcp(plan.stretch.steps.size() - 1, plan);
  plan.tilt = next;
  plan.summary.tilts += next ? 1 : 0;
  stand(moves_[move], plan);
}

/// A step without a way, at the start of the move, in the coordinates that hold from here on.
void Planner::stand(const program::Move& move, Plan& plan) const {
  ToolPose pose = snapped(*follower_, move.from);
  if (plan.tilt) pose.axis_W = plan.tilt->R.col(2);
  const AxisValues q = follower_->inverse.solve_nearest(pose, plan.q).q;
  PlanStep step = step_at(move, pose, q, StepKind::kRapid, setup_.rules.tcp, plan.tilt);
  step.feed_mm_s = 0.0;
  add_step(std::move(step), 0.0, plan);
}

/// The hole's moves from `at` on; the first one behind them.
size_t Planner::add_span(const HoleSpan& span, size_t at, std::vector<size_t>& steps_before,
                         Plan& plan) const {
  const size_t arrival = plan.stretch.steps.size();
  size_t i = at;
  const auto add_single = [&] {
    if (i >= steps_before.size()) steps_before.push_back(plan.stretch.steps.size());
    add_move(moves_[i++], plan);
  };
  while (i < span.begin() && !plan.fault) add_single();
  if (plan.fault) return i;
  change_plane(i, plan);
  const bool square = plan.tilt || stands_along_z(*follower_, *space_, span, plan.q);
  if (!square || !has_word_for(setup_.abilities, span)) {
    while (i < span.end() && !plan.fault) add_single();
    return i;
  }
  add_hole(span, plan);
  const bool approached = arrival > 0 && plan.stretch.steps[arrival - 1].kind == StepKind::kApproach;
  without_tcp(approached ? arrival - 1 : arrival, plan);
  while (steps_before.size() < span.end()) steps_before.push_back(plan.stretch.steps.size());
  return span.end();
}

}  // namespace swarf::post
