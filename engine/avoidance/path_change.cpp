#include "avoidance/path_change.h"

#include <cmath>

namespace swarf::avoidance {
namespace {

/// The outline's point that lies farthest against the axis `a` when the tool leans by `angle`: of those that
/// lie equally far the outermost, on which it comes to stand.
Vec2 lowest(const std::vector<cutter::OutlineElement>& outline, double angle) {
  constexpr double kLevel = 1e-12;
  const Vec2 down(std::sin(angle), -std::cos(angle));
  Vec2 best = outline.front().from;
  const auto offer = [&](const Vec2& p) {
    const double more = (p - best).dot(down);
    if (more > kLevel || (more > -kLevel && p.x() > best.x())) best = p;
  };
  for (const cutter::OutlineElement& one : outline) {
    offer(one.from);
    offer(one.to);
    if (one.radius <= 0.0) continue;
    // On the arc, where it faces down: between the outward directions of its ends.
    const Vec2 first = cutter::outward(cutter::start_tangent(one)),
               last = cutter::outward(cutter::end_tangent(one));
    const auto turns_left = [](const Vec2& u, const Vec2& v) { return u.x() * v.y() - u.y() * v.x() >= 0.0; };
    if (turns_left(first, down) && turns_left(down, last)) offer(one.centre + one.radius * down);
  }
  return best;
}

}  // namespace

const char* change_name(ChangeKind kind) {
  switch (kind) {
    case ChangeKind::kLead:
      return "lead";
    case ChangeKind::kTilt:
      return "tilt";
    case ChangeKind::kLift:
      break;
  }
  return "lift";
}

double& PathChange::of(ChangeKind kind) {
  return kind == ChangeKind::kLead ? lead_rad : kind == ChangeKind::kTilt ? tilt_rad : lift_mm;
}

double PathChange::of(ChangeKind kind) const {
  return PathChange(*this).of(kind);
}

ToolPose changed_pose(const ToolPose& pose, const Vec3& feed_W,
                      const std::vector<cutter::OutlineElement>& outline, const PathChange& change) {
  const Vec3 a = pose.axis_W;
  ToolPose changed = pose;
  const double angle = std::hypot(change.lead_rad, change.tilt_rad);
  if (angle > 0.0) {
    const Vec3 forward = (feed_W - feed_W.dot(a) * a).normalized(), left = a.cross(forward);
    const Vec3 d = (change.lead_rad * forward + change.tilt_rad * left) / angle;
    changed.axis_W = (std::cos(angle) * a + std::sin(angle) * d).normalized();
    const Vec3 out = std::cos(angle) * d - std::sin(angle) * a;  // square to a', towards its low side
    const Vec2 before = lowest(outline, 0.0), after = lowest(outline, angle);
    changed.tip_W += before.x() * d + before.y() * a - after.x() * out - after.y() * changed.axis_W;
  }
  changed.tip_W += change.lift_mm * a;
  return changed;
}

}  // namespace swarf::avoidance
