// A tool on its straight way from one pose to another: the tip on a line, the axis on a great circle.
#pragma once

#include "base/frames.h"

namespace swarf {

/// The great circle from a to b, both unit vectors, found once for many places on it. Opposite axes, between
/// which no great circle is the shortest, turn about the coordinate direction that is least along a.
class GreatCircle {
 public:
  GreatCircle(const Vec3& a, const Vec3& b);
  /// At share x of the way, 0 to 1.
  Vec3 at(double x) const;

 private:
  Vec3 a_, across_;
  double angle_ = 0.0;  ///< rad; 0: a and b are one direction
};

/// Axis on the great circle from a to b at share x of the way, 0 to 1 (GreatCircle).
Vec3 slerp(const Vec3& a, const Vec3& b, double x);

/// Pose at share x of the way, 0 to 1.
ToolPose pose_between(const ToolPose& from, const ToolPose& to, double x);

}  // namespace swarf
