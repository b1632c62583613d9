// Rotation of a vector about a unit axis from the sine and cosine of its angle.
#pragma once

#include "base/frames.h"

namespace swarf::kinematics {

/// Rodrigues' formula; `direction` is a unit vector, `sine` and `cosine` belong to one angle.
inline Vec3 rotate(const Vec3& direction, double sine, double cosine, const Vec3& x) {
  return cosine * x + sine * direction.cross(x) + ((1.0 - cosine) * direction.dot(x)) * direction;
}

}  // namespace swarf::kinematics
