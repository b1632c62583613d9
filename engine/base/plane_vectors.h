// Vectors of a plane.
#pragma once

#include "base/frames.h"

namespace swarf {

/// The z of the product in space: twice the area that a and b span, positive where b lies to the left of a.
inline double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Turned to the left by a right angle.
inline Vec2 left(const Vec2& v) {
  return {-v.y(), v.x()};
}

}  // namespace swarf
