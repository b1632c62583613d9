#include "collision/relative_motion.h"

#include <algorithm>
#include <cmath>

namespace swarf::collision {
namespace {

/// The link and those that carry it, to the floor.
std::vector<int> carriers(const machine::MachineScene& scene, int link) {
  std::vector<int> found;
  for (; link >= 0; link = scene.links[static_cast<size_t>(link)].parent) found.push_back(link);
  return found;
}

int axis_of(const machine::MachineScene& scene, int link) {
  return scene.links[static_cast<size_t>(link)].axis;
}

double distance_to_axis(const kinematics::Axis& axis, const Vec3& point) {
  const Vec3 from = point - axis.origin_M;
  return (from - from.dot(axis.direction_M) * axis.direction_M).norm();
}

}  // namespace

std::vector<RelativeStep> steps_between(const machine::MachineScene& scene, int link_a, int link_b) {
  std::vector<int> of_a = carriers(scene, link_a), of_b = carriers(scene, link_b);
  while (!of_a.empty() && !of_b.empty() && of_a.back() == of_b.back()) {
    of_a.pop_back();
    of_b.pop_back();
  }
  std::vector<RelativeStep> steps;
  for (const int link : of_b) {
    if (axis_of(scene, link) >= 0) steps.push_back({axis_of(scene, link), false});
  }
  for (size_t n = of_a.size(); n-- > 0;) {
    if (axis_of(scene, of_a[n]) >= 0) steps.push_back({axis_of(scene, of_a[n]), true});
  }
  return steps;
}

Pose RelativeMotion::pose(const AxisValues& q) const {
  Pose pose = Pose::Identity();
  for (const RelativeStep& step : steps_) {
    const kinematics::Axis& axis = scene_->model.axes[static_cast<size_t>(step.axis)];
    pose = kinematics::axis_motion(axis, step.back ? -q[step.axis] : q[step.axis]) * pose;
  }
  return pose;
}

double StepBound::share(const Vec3& n) const {
  const double along = std::abs(n.dot(axis));
  // What rounding hides near a right angle.
  const double reach = rotary ? std::sqrt(std::max(0.0, 1.0 - along * along)) + 2e-8 : along;
  return std::min(1.0, reach + wobble);
}

double MotionBounds::slack(double square) const {
  double sum = 0.0;
  for (const StepBound& step : steps) sum += step.acceleration * square + step.stray;
  return sum;
}

double MotionBounds::slack(const Vec3& n, double square) const {
  double sum = 0.0;
  for (const StepBound& step : steps) {
    const double most = step.acceleration * square + step.stray;
    if (most > 0.0) sum += most * step.share(n);
  }
  return sum;
}

MotionBounds RelativeMotion::bounds(const AxisSegment& segment, const Vec3& centre, double radius) const {
  MotionBounds sum;
  Vec3 at = centre;
  double spread = 0.0;  // how far the steps so far may carry a point from where they carry it at mid-time
  const AxisValues middle = segment.at(0.5);
  for (const RelativeStep& step : steps_) {
    const kinematics::Axis& axis = scene_->model.axes[static_cast<size_t>(step.axis)];
    const double rate = std::abs(segment.q1[step.axis] - segment.q0[step.axis]);
    const double stray = segment.stray[step.axis];
    StepBound bound{axis.kind == kinematics::AxisKind::kRotary, axis.direction_M, 0.0, 0.0, 0.0};
    const double lever = bound.rotary ? distance_to_axis(axis, at) + radius + spread : 1.0;
    if (bound.rotary) bound.acceleration = rate * rate * lever + 2.0 * rate * sum.speed;
    bound.stray = stray * lever;
    sum.speed += rate * lever;
    spread += (0.5 * rate + stray) * lever;
    const Pose moved = kinematics::axis_motion(axis, step.back ? -middle[step.axis] : middle[step.axis]);
    at = moved * at;
    for (StepBound& before : sum.steps) {
      before.axis = moved.linear() * before.axis;
      if (bound.rotary) before.wobble += 0.5 * rate + stray;
    }
    sum.steps.push_back(bound);
  }
  return sum;
}

Pose link_pose(const machine::MachineScene& scene, int link, const AxisValues& q) {
  return link < 0 ? Pose::Identity() : RelativeMotion(scene, -1, link).pose(q);
}

}  // namespace swarf::collision
