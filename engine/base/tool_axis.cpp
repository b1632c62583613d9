#include "base/tool_axis.h"

#include <cmath>

#include "base/angles.h"

namespace swarf {

GreatCircle::GreatCircle(const Vec3& a, const Vec3& b) : a_(a), across_(Vec3::Zero()) {
  Vec3 normal = a.cross(b);
  if (normal.squaredNorm() == 0.0) {
    if (a.dot(b) > 0.0) return;
    Eigen::Index least = 0;
    a.cwiseAbs().minCoeff(&least);
    normal = a.cross(Vec3::Unit(least));
  }
  angle_ = angle_between(a, b);
  across_ = normal.cross(a).normalized();
}

Vec3 GreatCircle::at(double x) const {
  if (angle_ == 0.0) return a_;
  return std::cos(x * angle_) * a_ + std::sin(x * angle_) * across_;
}

Vec3 slerp(const Vec3& a, const Vec3& b, double x) {
  return GreatCircle(a, b).at(x);
}

ToolPose pose_between(const ToolPose& from, const ToolPose& to, double x) {
  return {from.tip_W + x * (to.tip_W - from.tip_W), slerp(from.axis_W, to.axis_W, x)};
}

}  // namespace swarf
