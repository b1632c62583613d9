// N points side by side (N = 2, 4 or 8), and turning them: what the inverse walks both branches of a pose
// with, or the poses of some cycles. The same operations in the same order as rotation.h, so that no bit of a
// result depends on what stands beside it.
#pragma once

#include "kinematics/lanes.h"
#include "kinematics/rotation.h"

namespace swarf::kinematics {

using lanes::Bits;
using lanes::Numbers;
using Pair = Numbers<2>;

/// Points or directions.
template <int N>
struct LanePoints {
  Numbers<N> x, y, z;
};
/// Two.
using Points = LanePoints<2>;

template <int N>
SWARF_KERNEL_INLINE Numbers<N> spread(double value) {
  return Numbers<N>{} + value;
}
template <int N>
SWARF_KERNEL_INLINE LanePoints<N> spread(const Vec3& point) {
  return {spread<N>(point.x()), spread<N>(point.y()), spread<N>(point.z())};
}
inline Pair both(double value) {
  return Pair{value, value};
}
inline Points both(const Vec3& point) {
  return {both(point.x()), both(point.y()), both(point.z())};
}
inline Points side_by_side(const Vec3& a, const Vec3& b) {
  return {Pair{a.x(), b.x()}, Pair{a.y(), b.y()}, Pair{a.z(), b.z()}};
}
template <int N>
SWARF_KERNEL_INLINE LanePoints<N> operator-(const LanePoints<N>& a, const LanePoints<N>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <int N>
SWARF_KERNEL_INLINE LanePoints<N> operator+(const LanePoints<N>& a, const LanePoints<N>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <int N>
SWARF_KERNEL_INLINE LanePoints<N> operator*(const Numbers<N>& factor, const LanePoints<N>& a) {
  return {factor * a.x, factor * a.y, factor * a.z};
}
template <int N>
SWARF_KERNEL_INLINE Numbers<N> squared_norm(const LanePoints<N>& a) {
  return a.x * a.x + (a.y * a.y + a.z * a.z);
}

/// See rotate() of one vector.
template <int N>
SWARF_KERNEL_INLINE LanePoints<N> rotate(Along way, const Vec3& direction, const Numbers<N>& sine,
                                         const Numbers<N>& cosine, const LanePoints<N>& p) {
  if (way == Along::kX) {
    const Numbers<N> s = sine * direction.x();
    return {p.x, cosine * p.y - s * p.z, s * p.y + cosine * p.z};
  }
  if (way == Along::kZ) {
    const Numbers<N> s = sine * direction.z();
    return {cosine * p.x - s * p.y, s * p.x + cosine * p.y, p.z};
  }
  if (way == Along::kY) {
    const Numbers<N> s = sine * direction.y();
    return {cosine * p.x + s * p.z, p.y, cosine * p.z - s * p.x};
  }
  const LanePoints<N> d = spread<N>(direction);
  const LanePoints<N> cross{d.y * p.z - d.z * p.y, d.z * p.x - d.x * p.z, d.x * p.y - d.y * p.x};
  const Numbers<N> along = (1.0 - cosine) * (d.x * p.x + (d.y * p.y + d.z * p.z));
  return (cosine * p + sine * cross) + along * d;
}

}  // namespace swarf::kinematics
