// Rotation of a vector about a unit axis from the sine and cosine of its angle.
#pragma once

#include "base/frames.h"

namespace swarf::kinematics {

/// Which coordinate axis a direction lies along, either way.
enum class Along { kX, kY, kZ, kNone };

inline Along along(const Vec3& direction) {
  const bool no_x = direction.x() == 0.0, no_y = direction.y() == 0.0, no_z = direction.z() == 0.0;
  if (no_y && no_z) return Along::kX;
  if (no_x && no_z) return Along::kY;
  return no_x && no_y ? Along::kZ : Along::kNone;
}

/// Rodrigues' formula; `direction` is a unit vector with along(direction) == way, `sine` and `cosine` belong
/// to one angle. Directions along X, Y or Z, which most machines have, take six operations instead of thirty.
inline Vec3 rotate(Along way, const Vec3& direction, double sine, double cosine, const Vec3& x) {
  if (way == Along::kX) {
    const double s = sine * direction.x();
    return {x.x(), cosine * x.y() - s * x.z(), s * x.y() + cosine * x.z()};
  }
  if (way == Along::kZ) {
    const double s = sine * direction.z();
    return {cosine * x.x() - s * x.y(), s * x.x() + cosine * x.y(), x.z()};
  }
  if (way == Along::kY) {
    const double s = sine * direction.y();
    return {cosine * x.x() + s * x.z(), x.y(), cosine * x.z() - s * x.x()};
  }
  return cosine * x + sine * direction.cross(x) + ((1.0 - cosine) * direction.dot(x)) * direction;
}

inline Vec3 rotate(const Vec3& direction, double sine, double cosine, const Vec3& x) {
  return rotate(along(direction), direction, sine, cosine, x);
}

}  // namespace swarf::kinematics
