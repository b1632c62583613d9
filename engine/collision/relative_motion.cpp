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

MotionBounds RelativeMotion::bounds(const AxisSegment& segment, const Vec3& centre, double radius) const {
  MotionBounds sum;
  Vec3 at = centre;
  double spread = 0.0;  // how far the steps so far may carry a point from where they carry it at mid-time
  const AxisValues middle = segment.at(0.5);
  for (const RelativeStep& step : steps_) {
    const kinematics::Axis& axis = scene_->model.axes[static_cast<size_t>(step.axis)];
    const double rate = std::abs(segment.q1[step.axis] - segment.q0[step.axis]);
    const double stray = segment.stray[step.axis];
    const bool rotary = axis.kind == kinematics::AxisKind::kRotary;
    const double lever = rotary ? distance_to_axis(axis, at) + radius + spread : 1.0;
    if (rotary) sum.acceleration += rate * rate * lever + 2.0 * rate * sum.speed;
    sum.speed += rate * lever;
    sum.stray += stray * lever;
    spread += (0.5 * rate + stray) * lever;
    at = kinematics::axis_motion(axis, step.back ? -middle[step.axis] : middle[step.axis]) * at;
  }
  return sum;
}

Pose link_pose(const machine::MachineScene& scene, int link, const AxisValues& q) {
  return link < 0 ? Pose::Identity() : RelativeMotion(scene, -1, link).pose(q);
}

}  // namespace swarf::collision
