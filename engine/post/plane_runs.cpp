#include "post/plane_runs.h"

#include "base/angles.h"
#include "base/units.h"
#include "kinematics/model_check.h"

namespace swarf::post {
namespace {

constexpr double kPlaneTurnRad = 0.1 * kPi / 180.0;

}  // namespace

std::vector<PlaneRun> plane_runs(const Follower& follower, std::span<const program::Move> moves,
                                 std::span<const HoleSpan> holes, bool free_start) {
  const auto turns = [&](const program::Move& move) {
    return angle_between(snapped(follower, move.from).axis_W, snapped(follower, move.to).axis_W) > 1e-12;
  };
  const auto within_hole = [&](size_t i) {
    const HoleSpan* hole = hole_before(holes, i);
    return hole != nullptr && i < hole->end() ? hole : nullptr;
  };
  const auto may_enter = [&](size_t i) {
    const HoleSpan* hole = within_hole(i);
    if (hole != nullptr && i != hole->begin()) return false;
    return i == 0 ? free_start || moves[0].rapid : moves[i - 1].rapid;
  };
  const auto may_leave = [&](size_t i) {
    return within_hole(i) == nullptr && (i == moves.size() || moves[i].rapid);
  };
  std::vector<PlaneRun> runs;
  for (size_t i = 0; i < moves.size(); ++i) {
    PlaneRun run{i, i, false, nullptr};
    while (run.last < moves.size() && !turns(moves[run.last])) ++run.last;
    i = run.last;
    while (run.first < run.last && !may_enter(run.first)) ++run.first;
    while (run.last > run.first && !may_leave(run.last)) --run.last;
    if (run.last > run.first) runs.push_back(run);
  }
  return runs;
}

std::shared_ptr<const TiltedPlane> plane_at(const Follower& follower, const PlaneRules& rules,
                                            const ToolPose& pose, const kinematics::AxisValues& q) {
  TiltedPlane plane = tilted_plane(pose.axis_W, rules);
  const kinematics::Branch stands = follower.inverse.solve_nearest({pose.tip_W, plane.R.col(2)}, q);
  if (!fault_of(follower, stands, pose).code.empty()) return nullptr;
  if (greatest_turn(follower.machine, q, stands.q) > kPlaneTurnRad) return nullptr;
  plane.positive = stands.q[kinematics::rotary_order(follower.machine).back()] >= 0.0;
  return std::make_shared<const TiltedPlane>(plane);
}

bool same_plane(const TiltedPlane* a, const TiltedPlane* b) {
  if (a == nullptr || b == nullptr) return a == b;
  return a->turns_deg == b->turns_deg && a->positive == b->positive;
}

}  // namespace swarf::post
