// Signed distance of a point to the swept flat-end cylinder, in closed form, for scalars and for SIMD loops.
//
// In the tool frame the point moves on P + t D, t in [0,1]. Inside the cutter to a depth of
//   min(radius - rho(t), deep(t)),   rho = |xy|,   deep = z, or min(z, height - z) with the top end
// the sweep cuts as deep as the greatest of these. The first is greatest where the point passes the axis, the
// second at an end of the motion (or half way up). If the flank is the nearer face where the point passes the
// axis, that is the depth. Otherwise it grows with `deep` on the way to where that is greatest, up to the
// place where both are equal. With rho, deep and within = radius - deep where the point passes the axis, and
// on the rest of the way s |D|, with a = |D_xy|^2, along = xy . D_xy >= 0, rise = |D_z|:
//   rho^2 + 2 along s + a s^2 = (within - rise s)^2
//   s = c / (b + sqrt(d)),   c = within^2 - rho^2,   b = along + within rise
//   d = b^2 + (a - rise^2) c = along^2 + 2 along within rise + a c + rise^2 rho^2
// No term of the last form is negative, so nothing cancels, however short or steep the motion is.
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
/// Divisor that is never zero.
template <class T>
SWARF_KERNEL_INLINE T nonzero(T x) {
  constexpr T kTiny = T(1e-30);
  return (x < kTiny && x > -kTiny) ? kTiny : x;
}

}  // namespace kernel

/// kCapped false leaves out the top end: right wherever z <= height - (distance that matters).
template <class T, bool kCapped>
SWARF_KERNEL_INLINE T swept_distance(const MovingPoint<T>& m, T radius, T height) {
  using namespace kernel;
  constexpr T kTiny = T(1e-30);
  const T a = m.dx * m.dx + m.dy * m.dy, rise = std::abs(m.dz);
  const T nearest = clamp01(-(m.px * m.dx + m.py * m.dy) / max_of(a, kTiny));
  const T deepest = kCapped ? clamp01((T(0.5) * height - m.pz) / nonzero(m.dz)) : (m.dz > T(0) ? T(1) : T(0));
  const T x = m.px + nearest * m.dx, y = m.py + nearest * m.dy, z = m.pz + nearest * m.dz;
  const T rho = std::sqrt(x * x + y * y), deep = kCapped ? min_of(z, height - z) : z, within = radius - deep;
  const T forward = x * m.dx + y * m.dy, along = deepest < nearest ? -forward : forward;
  const T level = within * rise, c = (within - rho) * (within + rho), side = rise * rho;
  const T d = along * (along + level + level) + a * c + side * side;
  const T s = c / max_of(along + level + std::sqrt(max_of(d, T(0))), kTiny);
  const T way = min_of(max_of(s, T(0)), std::abs(deepest - nearest));
  return max_of(rho - radius, -(deep + way * rise));
}

}  // namespace swarf::stock
