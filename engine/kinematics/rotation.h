// Rotation of a vector about a unit axis from the sine and cosine of its angle.
#pragma once

#include "base/frames.h"

namespace swarf::kinematics {

/// Rodrigues' formula; `direction` is a unit vector, `sine` and `cosine` belong to one angle. Directions
/// along X, Y or Z, which most machines have, take the short way: six operations instead of thirty.
inline Vec3 rotate(const Vec3& direction, double sine, double cosine, const Vec3& x) {
  const bool no_x = direction.x() == 0.0, no_y = direction.y() == 0.0, no_z = direction.z() == 0.0;
  if (no_y && no_z) {
    const double s = sine * direction.x();
    return {x.x(), cosine * x.y() - s * x.z(), s * x.y() + cosine * x.z()};
  }
  if (no_x && no_y) {
    const double s = sine * direction.z();
    return {cosine * x.x() - s * x.y(), s * x.x() + cosine * x.y(), x.z()};
  }
  if (no_x && no_z) {
    const double s = sine * direction.y();
    return {cosine * x.x() + s * x.z(), x.y(), cosine * x.z() - s * x.x()};
  }
  return cosine * x + sine * direction.cross(x) + ((1.0 - cosine) * direction.dot(x)) * direction;
}

}  // namespace swarf::kinematics
