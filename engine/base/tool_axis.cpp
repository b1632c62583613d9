#include "base/tool_axis.h"

#include <cmath>

#include "base/angles.h"

namespace swarf {

Vec3 slerp(const Vec3& a, const Vec3& b, double x) {
  const double angle = angle_between(a, b);
  Vec3 normal = a.cross(b);
  if (normal.squaredNorm() == 0.0) {
    if (a.dot(b) > 0.0) return a;
    Eigen::Index least = 0;
    a.cwiseAbs().minCoeff(&least);
    normal = a.cross(Vec3::Unit(least));
  }
  const Vec3 across = normal.cross(a).normalized();
  return std::cos(x * angle) * a + std::sin(x * angle) * across;
}

ToolPose pose_between(const ToolPose& from, const ToolPose& to, double x) {
  return {from.tip_W + x * (to.tip_W - from.tip_W), slerp(from.axis_W, to.axis_W, x)};
}

}  // namespace swarf
