#include "post/holes.h"

#include <algorithm>

namespace swarf::post {

const HoleSpan* hole_before(std::span<const HoleSpan> holes, size_t move) {
  const auto after = std::lower_bound(holes.begin(), holes.end(), move,
                                      [](const HoleSpan& one, size_t at) { return one.first < at; });
  return after == holes.begin() ? nullptr : &*(after - 1);
}

const HoleSpan* hole_at(std::span<const HoleSpan> holes, size_t move) {
  const HoleSpan* hole = hole_before(holes, move + 1);
  return hole != nullptr && hole->first == move ? hole : nullptr;
}

bool has_word_for(const PostAbilities& can, const HoleSpan& hole) {
  const program::ClCycle& cycle = hole.hole.cycle;
  if (cycle.retract_mm < cycle.clear_mm || !(cycle.depth_mm > 0.0)) return false;
  const bool pecks_alike = cycle.first_step_mm == 0.0 || cycle.first_step_mm == cycle.step_mm;
  switch (cycle.kind) {
    case program::ClCycleKind::kDrill:
    case program::ClCycleKind::kFace:
      return cycle.dwell_s > 0.0 ? can.drill_dwell : can.drill;
    case program::ClCycleKind::kDeep:
      return can.deep && pecks_alike && cycle.dwell_s == 0.0;
    case program::ClCycleKind::kChipBreak:
      return can.chip_break && pecks_alike && cycle.dwell_s == 0.0;
    case program::ClCycleKind::kBore:
      return cycle.dwell_s > 0.0 ? can.bore_dwell : can.bore;
    case program::ClCycleKind::kTap:
      return can.tap && hole.spindle_rpm > 0.0;
  }
  return false;
}

bool stands_along_z(const Follower& follower, program::nc::WorkSpace& space, const HoleSpan& hole,
                    const kinematics::AxisValues& q) {
  using kinematics::Branch;
  using kinematics::InverseOutcome;
  constexpr double kAlongZ = 1e-9;
  const ToolPose at = snapped(follower, hole.hole.at);
  const Branch low = follower.inverse.solve_nearest(at, q);
  const Branch high = follower.inverse.solve_nearest({at.tip_W + at.axis_W, at.axis_W}, low.q);
  if (low.outcome == InverseOutcome::kUnreachable || high.outcome == InverseOutcome::kUnreachable)
    return false;
  const auto point = [&](const kinematics::AxisValues& there) {
    return space.program_from_linear(space.linear_of(there), space.rotary_of(there));
  };
  return (point(high.q) - point(low.q) - Vec3::UnitZ()).norm() < kAlongZ;
}

}  // namespace swarf::post
