// How far an arc of CL data goes round.
#pragma once

#include <cmath>

#include "base/angles.h"
#include "base/frames.h"
#include "base/units.h"

namespace swarf::program {

/// Ends nearer than this in the arc's plane are the same point: a whole circle, mm.
inline constexpr double kWholeCircle = 1e-6;

/// The part of v across the unit normal.
inline Vec3 flat_in(const Vec3& v, const Vec3& normal) {
  return v - v.dot(normal) * normal;
}

/// Counter-clockwise from a to b about the unit normal, rad, in (0, 2 pi].
inline double swept_angle(const Vec3& a, const Vec3& b, const Vec3& normal) {
  const Vec3 u = flat_in(a, normal), v = flat_in(b, normal);
  if ((v - u).norm() < kWholeCircle) return 2.0 * kPi;
  const double angle = signed_angle(normal, u, v);
  return angle > 0.0 ? angle : angle + 2.0 * kPi;
}

}  // namespace swarf::program
