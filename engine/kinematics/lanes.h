// Sines, cosines and arc tangents of N numbers at once (N = 2, 4 or 8), where N calls of the library would
// follow each other. One code for every processor: the compiler makes vectors of what the target has.
//
//   x = n pi/2 + r, |r| <= pi/4   pi/2 in three parts, of 33 bits, 33 bits and the rest: n times one of
//                                 the first two is exact for n below 2^20
//   sin r, cos r                  Taylor, to r^17 and r^16: the next terms are below 1e-19 and 3e-18
//   atan t, |t| <= tan(pi/8)      t + t s P(s), s = t^2, P through 12 Chebyshev nodes: 1e-17. A larger
//                                 quotient b/a is turned back by pi/4: (b - a)/(b + a)
//
// tests/unit/kinematics/lanes_test.cpp states how close they come to the library. SLEEF 3.5 does the same: of
// its sines and cosines 30 % have other last bits, of its arc tangents 26 %, so every result would move; it
// takes 1.1 and 1.7 times as long for two numbers at once.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>

#include "base/instruction_sets.h"

namespace swarf::kinematics {

/// Angles beyond it are given to the library, rad: 16 000 turns.
inline constexpr double kLaneRange = 1e5;

namespace lanes {

template <int N>
struct Vector;
template <>
struct Vector<2> {
  using Numbers = double __attribute__((vector_size(16)));
  using Bits = int64_t __attribute__((vector_size(16)));
};
template <>
struct Vector<4> {
  using Numbers = double __attribute__((vector_size(32)));
  using Bits = int64_t __attribute__((vector_size(32)));
};
template <>
struct Vector<8> {
  using Numbers = double __attribute__((vector_size(64)));
  using Bits = int64_t __attribute__((vector_size(64)));
};
template <int N>
using Numbers = typename Vector<N>::Numbers;
/// Of as many whole numbers; of a comparison all bits are set where it holds.
template <int N>
using Bits = typename Vector<N>::Bits;

template <typename To, typename From>
SWARF_KERNEL_INLINE To same_bits(const From& from) {
  To to;
  static_assert(sizeof to == sizeof from);
  std::memcpy(&to, &from, sizeof to);
  return to;
}

/// `below` where x is below 0, else `other`; -0 counts as 0, and what is not a number as either. By its sign:
/// GCC 12 takes eight comparisons apart into single numbers where two of them are joined before they choose,
/// or where one is kept in a variable.
template <class T>
SWARF_KERNEL_INLINE T by_sign(const T& x, const T& below, const T& other) {
  using Signs = typename Vector<sizeof(T) / sizeof(double)>::Bits;
  const Signs sign = same_bits<Signs>(T(x + 0.0)) >> 63;
  return same_bits<T>(Signs((same_bits<Signs>(below) & sign) | (same_bits<Signs>(other) & ~sign)));
}

/// |r| <= pi/4. Polynomials in pairs, so that few of their steps wait for the one before.
template <typename Numbers>
SWARF_KERNEL_INLINE void small_sines(const Numbers& r, Numbers& sine, Numbers& cosine) {
  const Numbers s = r * r, s2 = s * s, s4 = s2 * s2;
  const Numbers odd_low = (-1.0 / 6.0 + s * (1.0 / 120.0)) + s2 * (-1.0 / 5040.0 + s * (1.0 / 362880.0));
  const Numbers odd_high = (-1.0 / 39916800.0 + s * (1.0 / 6227020800.0)) +
                           s2 * (-1.0 / 1307674368000.0 + s * (1.0 / 355687428096000.0));
  sine = r + r * s * (odd_low + s4 * odd_high);
  const Numbers even_low = (1.0 / 24.0 + s * (-1.0 / 720.0)) + s2 * (1.0 / 40320.0 + s * (-1.0 / 3628800.0));
  const Numbers even_high = (1.0 / 479001600.0 + s * (-1.0 / 87178291200.0)) + s2 * (1.0 / 20922789888000.0);
  const Numbers half = 0.5 * s;
  const Numbers rough = 1.0 - half;
  // What 1 - half lost comes back with the small terms.
  cosine = rough + (((1.0 - rough) - half) + s2 * (even_low + s4 * even_high));
}

/// atan(t) for |t| <= tan(pi/8).
template <typename Numbers>
SWARF_KERNEL_INLINE Numbers small_atan(const Numbers& t) {
  const Numbers s = t * t, s2 = s * s, s4 = s2 * s2;
  const Numbers low = (-0x1.5555555555555p-2 + s * 0x1.9999999999953p-3) +
                      s2 * (-0x1.249249248d7dcp-3 + s * 0x1.c71c71c303dbbp-4);
  const Numbers middle = (-0x1.745d165dc9713p-4 + s * 0x1.3b1392d519db1p-4) +
                         s2 * (-0x1.110e87b4357d2p-4 + s * 0x1.e19a0bfa3eef9p-5);
  const Numbers high = (-0x1.ac7a5a79b3f26p-5 + s * 0x1.74dccfb93fff0p-5) +
                       s2 * (-0x1.1b311bb48c215p-5 + s * 0x1.0acd9e91a5a35p-6);
  return t + t * (s * (low + s4 * (middle + s4 * high)));
}

/// Adding 1.5 * 2^52 leaves the nearest whole number in the last bits of numbers below 2^51.
inline constexpr double kWhole = 6755399441055744.0;

/// |x| <= kLaneRange.
template <int N>
SWARF_KERNEL_INLINE void sines(const Numbers<N>& x, Numbers<N>& sine, Numbers<N>& cosine) {
  constexpr double kHalfPiHigh = 0x1.921fb544p+0, kHalfPiMiddle = 0x1.0b4611a6p-34;
  constexpr double kHalfPiLow = 0x1.3198a2e037073p-69;
  const Numbers<N> shifted = x * (2.0 * std::numbers::inv_pi) + kWhole;
  const Numbers<N> n = shifted - kWhole;
  Numbers<N> s, c;
  small_sines<Numbers<N>>(((x - n * kHalfPiHigh) - n * kHalfPiMiddle) - n * kHalfPiLow, s, c);
  const auto quarter = same_bits<Bits<N>>(shifted);
  auto sine_bits = same_bits<Bits<N>>(s), cosine_bits = same_bits<Bits<N>>(c);
  const Bits<N> swap = (sine_bits ^ cosine_bits) & -(quarter & 1);
  sine = same_bits<Numbers<N>>(Bits<N>((sine_bits ^ swap) ^ ((quarter & 2) << 62)));
  cosine = same_bits<Numbers<N>>(Bits<N>((cosine_bits ^ swap) ^ (((quarter + 1) & 2) << 62)));
}

/// See lane_atan2().
template <int N>
SWARF_KERNEL_INLINE Numbers<N> atan2(const Numbers<N>& y, const Numbers<N>& along) {
  constexpr int64_t kSign = INT64_MIN;
  const auto y_bits = same_bits<Bits<N>>(y);
  const auto rise = same_bits<Numbers<N>>(Bits<N>(y_bits & ~kSign));
  const auto run = same_bits<Numbers<N>>(Bits<N>(same_bits<Bits<N>>(along) & ~kSign));
  // Comparisons in place, for GCC's sake: see by_sign().
  const Numbers<N> a = rise > run ? rise : run, b = rise > run ? run : rise;
  const Numbers<N> near = a * (std::numbers::sqrt2 - 1.0);
  const Numbers<N> zero = {}, eighth = zero + 0.25 * std::numbers::pi;
  const Numbers<N> t = (b > near ? b - a : b) / (b > near ? b + a : a);
  Numbers<N> turn = (b > near ? eighth : zero) + small_atan<Numbers<N>>(t);
  turn = rise > run ? 0.5 * std::numbers::pi - turn : turn;
  turn = by_sign<Numbers<N>>(along, std::numbers::pi - turn, turn);
  return same_bits<Numbers<N>>(Bits<N>(same_bits<Bits<N>>(turn) | (y_bits & kSign)));
}

}  // namespace lanes

template <int N>
void lane_sines(const double (&angle)[N], double (&sine)[N], double (&cosine)[N]) {
  for (const double one : angle) {
    if (std::abs(one) <= kLaneRange) continue;
    for (int i = 0; i < N; ++i) {
      sine[i] = std::sin(angle[i]);
      cosine[i] = std::cos(angle[i]);
    }
    return;
  }
  lanes::Numbers<N> s, c;
  lanes::sines<N>(lanes::same_bits<lanes::Numbers<N>>(angle), s, c);
  std::memcpy(sine, &s, sizeof sine);
  std::memcpy(cosine, &c, sizeof cosine);
}

/// std::atan2 of each pair; x and y are finite and not both zero. -0 counts as 0 in x.
template <int N>
void lane_atan2(const double (&y)[N], const double (&x)[N], double (&angle)[N]) {
  const lanes::Numbers<N> turn =
      lanes::atan2<N>(lanes::same_bits<lanes::Numbers<N>>(y), lanes::same_bits<lanes::Numbers<N>>(x));
  std::memcpy(angle, &turn, sizeof angle);
}

}  // namespace swarf::kinematics
