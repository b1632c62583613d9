// Signed distance of a point to the swept flat-end cylinder, in closed form, for scalars and for SIMD loops.
//
// In the tool frame the point moves on P + t D, t in [0,1]. The cutter's implicit function along that line is
//   F(t) = max(rho(t), -z(t), z(t) - height),   rho = |xy| - radius
// and the sweep's is min over t. rho is convex and z linear, so the minimum of the largest of the three lies
// at the minimum of one of them or at the crossing of two: a fixed list of candidates, no iteration.
// Exact zero level; outside an edge the max norm underestimates the Euclidean distance.
#pragma once

#include <cmath>

#include "base/instruction_sets.h"

namespace swarf::stock {

/// Position in the tool frame at t = 0 and its change up to t = 1, mm.
template <class T>
struct MovingPoint {
  T px, py, pz, dx, dy, dz;
};

namespace kernel {

// Ternaries and not std::min: they compile to one instruction each and keep the loops vectorised.
template <class T>
SWARF_KERNEL_INLINE T max_of(T a, T b) {
  return a > b ? a : b;
}
template <class T>
SWARF_KERNEL_INLINE T min_of(T a, T b) {
  return a < b ? a : b;
}
template <class T>
SWARF_KERNEL_INLINE T clamp01(T t) {
  return min_of(max_of(t, T(0)), T(1));
}
/// Divisor that is never zero; the quotient then is a wrong but harmless candidate (candidates only lower F).
template <class T>
SWARF_KERNEL_INLINE T nonzero(T x) {
  constexpr T kTiny = T(1e-30);
  return (x < kTiny && x > -kTiny) ? kTiny : x;
}

/// |xy|^2 along the line: a t^2 + 2 b t + c.
template <class T>
struct Quadratic {
  T a, b, c;
};

template <class T, bool kCapped>
SWARF_KERNEL_INLINE T distance_at(const MovingPoint<T>& m, const Quadratic<T>& q, T radius, T height, T t) {
  const T rho2 = max_of(q.c + t * (T(2) * q.b + t * q.a), T(0));
  const T z = m.pz + t * m.dz;
  T distance = max_of(std::sqrt(rho2) - radius, -z);
  if (kCapped) distance = max_of(distance, z - height);
  return distance;
}

/// Least F at the two parameters where |xy| = w + t wd.
template <class T, bool kCapped>
SWARF_KERNEL_INLINE T distance_at_crossings(const MovingPoint<T>& m, const Quadratic<T>& q, T radius,
                                            T height, T w, T wd) {
  const T a = q.a - wd * wd;
  const T b = q.b - w * wd;
  const T c = q.c - w * w;
  const T root = std::sqrt(max_of(b * b - a * c, T(0)));
  const T k = b > T(0) ? -(b + root) : root - b;
  const T first = distance_at<T, kCapped>(m, q, radius, height, clamp01(k / nonzero(a)));
  const T second = distance_at<T, kCapped>(m, q, radius, height, clamp01(c / nonzero(k)));
  return min_of(first, second);
}

}  // namespace kernel

/// kCapped false leaves out the top end: right wherever z <= height - (distance that matters).
template <class T, bool kCapped>
SWARF_KERNEL_INLINE T swept_distance(const MovingPoint<T>& m, T radius, T height) {
  using namespace kernel;
  const Quadratic<T> q{m.dx * m.dx + m.dy * m.dy, m.px * m.dx + m.py * m.dy, m.px * m.px + m.py * m.py};
  const T nearest = clamp01(-q.b / nonzero(q.a));
  const T highest = m.dz > T(0) ? T(1) : T(0);
  T best = min_of(distance_at<T, kCapped>(m, q, radius, height, nearest),
                  distance_at<T, kCapped>(m, q, radius, height, highest));
  best = min_of(best, distance_at_crossings<T, kCapped>(m, q, radius, height, radius - m.pz, -m.dz));
  if (kCapped) {
    const T middle = clamp01((T(0.5) * height - m.pz) / nonzero(m.dz));
    best = min_of(best, distance_at<T, true>(m, q, radius, height, T(1) - highest));
    best = min_of(best, distance_at<T, true>(m, q, radius, height, middle));
    best = min_of(best, distance_at_crossings<T, true>(m, q, radius, height, radius - height + m.pz, m.dz));
  }
  return best;
}

}  // namespace swarf::stock
