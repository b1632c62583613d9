// Two points side by side, and turning them: what the inverse walks both branches of a pose with, or the
// poses of two cycles. The same operations in the same order as rotation.h, so that no bit of a result
// depends on what stands beside it.
#pragma once

#include "kinematics/lanes.h"
#include "kinematics/rotation.h"

namespace swarf::kinematics {

using Pair = lanes::Vector<2>::Numbers;

/// Two points or directions.
struct Points {
  Pair x, y, z;
};

inline Pair both(double value) {
  return Pair{value, value};
}
inline Points both(const Vec3& point) {
  return {both(point.x()), both(point.y()), both(point.z())};
}
inline Points side_by_side(const Vec3& a, const Vec3& b) {
  return {Pair{a.x(), b.x()}, Pair{a.y(), b.y()}, Pair{a.z(), b.z()}};
}
inline Points operator-(const Points& a, const Points& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Points operator+(const Points& a, const Points& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Points operator*(const Pair& factor, const Points& a) {
  return {factor * a.x, factor * a.y, factor * a.z};
}
inline Pair squared_norm(const Points& a) {
  return a.x * a.x + (a.y * a.y + a.z * a.z);
}

/// See rotate() of one vector.
inline Points rotate(Along way, const Vec3& direction, const Pair& sine, const Pair& cosine,
                     const Points& p) {
  if (way == Along::kX) {
    const Pair s = sine * direction.x();
    return {p.x, cosine * p.y - s * p.z, s * p.y + cosine * p.z};
  }
  if (way == Along::kZ) {
    const Pair s = sine * direction.z();
    return {cosine * p.x - s * p.y, s * p.x + cosine * p.y, p.z};
  }
  if (way == Along::kY) {
    const Pair s = sine * direction.y();
    return {cosine * p.x + s * p.z, p.y, cosine * p.z - s * p.x};
  }
  const Points d = both(direction);
  const Points cross{d.y * p.z - d.z * p.y, d.z * p.x - d.x * p.z, d.x * p.y - d.y * p.x};
  const Pair along = (1.0 - cosine) * (d.x * p.x + (d.y * p.y + d.z * p.z));
  return (cosine * p + sine * cross) + along * d;
}

}  // namespace swarf::kinematics
