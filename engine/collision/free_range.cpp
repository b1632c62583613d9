#include "collision/free_range.h"

#include <algorithm>

#include "collision/containment.h"

namespace swarf::collision {
namespace {

constexpr uint64_t kTriplesMost = 512;  ///< of one search: about as long as the walk over a stretch
constexpr int kPauseMost = 64;          ///< stretches

/// The box on the axes between the pair; the others do not matter and are 0.
AxisBox on_axes_of(const Encounter& pair, const AxisBox& box) {
  AxisBox on;
  for (const RelativeStep& step : pair.b_from_a.steps()) {
    on.low[step.axis] = box.low[step.axis];
    on.high[step.axis] = box.high[step.axis];
  }
  return on;
}

bool lies_in(const AxisBox& inner, const AxisBox& outer) {
  return (inner.low.array() >= outer.low.array()).all() && (inner.high.array() <= outer.high.array()).all();
}

AxisBox hull(const AxisBox& a, const AxisBox& b) {
  return {a.low.cwiseMin(b.low), a.high.cwiseMax(b.high)};
}

/// Twice as wide, but no wider than the travel for what lies beyond the box.
AxisBox widened(const machine::MachineScene& scene, const AxisBox& box) {
  AxisBox wide = box;
  for (size_t i = 0; i < scene.model.axes.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double more = 0.5 * (box.high[row] - box.low[row]);
    wide.low[row] = std::min(box.low[row], std::max(box.low[row] - more, scene.model.axes[i].min));
    wide.high[row] = std::max(box.high[row], std::min(box.high[row] + more, scene.model.axes[i].max));
  }
  return wide;
}

}  // namespace

AxisBox box_of(PathStretch poses) {
  AxisBox box{poses.front().q, poses.front().q};
  for (const PathPose& pose : poses) box = hull(box, {pose.q, pose.q});
  return box;
}

bool FreeRange::try_box(const Encounter& pair, const AxisBox& box, double least, double tolerance) {
  AxisSegment segment;
  segment.q0 = segment.q1 = 0.5 * (box.low + box.high);
  segment.stray = (box.high - segment.q0).cwiseMax(segment.q0 - box.low);
  ApproachQuery query;
  query.limit = least + tolerance;
  query.tolerance = tolerance;
  query.budget = kTriplesMost;
  const Approach found = closest_approach(pair, segment, query);
  if (found.within || found.given_up || one_holds_other(pair, segment.q0)) return false;
  free_ = box;
  return known_ = true;
}

bool FreeRange::find(const Encounter& pair, const AxisBox& box, double least, double tolerance) {
  const auto attempt = [&](const AxisBox& wanted) { return try_box(pair, wanted, least, tolerance); };
  if (known_ && attempt(widened(*pair.scene, hull(free_, box)))) return true;
  return attempt(widened(*pair.scene, box)) || attempt(box);
}

bool FreeRange::covers(const Encounter& pair, const AxisBox& box, double least, double tolerance) {
  const AxisBox wanted = on_axes_of(pair, box);
  if (known_ && lies_in(wanted, free_)) return true;
  if (pause_ > 0) {
    --pause_;
    return false;
  }
  if (find(pair, wanted, least, tolerance)) {
    next_pause_ = 1;
    return true;
  }
  pause_ = next_pause_;
  next_pause_ = std::min(2 * next_pause_, kPauseMost);
  return false;
}

}  // namespace swarf::collision
