// Angles: whole turns, degrees that are exact where a drawing has them, the angle between two directions.
#pragma once

#include <cmath>

#include "base/frames.h"
#include "base/units.h"

namespace swarf {

inline constexpr double kTurn = 2.0 * kPi;

/// Sine and cosine of degrees, exact at multiples of 90.
inline double sin_deg(double deg) {
  const double turn = std::fmod(deg, 360.0);
  const double at = turn < 0.0 ? turn + 360.0 : turn;
  if (at == 0.0 || at == 180.0) return 0.0;
  if (at == 90.0) return 1.0;
  if (at == 270.0) return -1.0;
  return std::sin(rad_from_deg(deg));
}
inline double cos_deg(double deg) {
  return sin_deg(deg + 90.0);
}

/// Rotation about X, Y or Z (0, 1, 2), whose sine and cosine are given.
inline Mat3 axis_rotation(int axis, double sine, double cosine) {
  const int b = (axis + 1) % 3, d = (axis + 2) % 3;
  Mat3 R = Mat3::Identity();
  R(b, b) = R(d, d) = cosine;
  R(d, b) = sine;
  R(b, d) = -sine;
  return R;
}
/// The same by degrees; exact at quarter turns.
inline Mat3 rotation_deg(int axis, double deg) {
  return axis_rotation(axis, sin_deg(deg), cos_deg(deg));
}

/// Between two directions of any length, [0, pi]; exact to rounding near 0 and pi too.
inline double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}
/// From a to b about `axis`, both square to it, counter-clockwise seen from its tip: (-pi, pi]. The axis has
/// length 1.
inline double signed_angle(const Vec3& axis, const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).dot(axis), a.dot(b));
}

}  // namespace swarf
