// Numbers of several sweeps, or several columns, at once: what their kernels choose by. Internal to this
// folder.
//
// A comparison chooses where it stands: GCC 12 takes eight apart into single numbers where two of them are
// joined before they choose, or where one is kept in a variable.
#pragma once

#include <cstring>

#include "base/instruction_sets.h"

namespace swarf::measure {

template <int N>
struct LaneVector;
template <>
struct LaneVector<2> {
  using Numbers = double __attribute__((vector_size(16)));
};
template <>
struct LaneVector<4> {
  using Numbers = double __attribute__((vector_size(32)));
};
template <>
struct LaneVector<8> {
  using Numbers = double __attribute__((vector_size(64)));
};
template <int N>
using Numbers = typename LaneVector<N>::Numbers;

/// As std::max(b, a).
template <class T>
SWARF_KERNEL_INLINE T max_of(const T& a, const T& b) {
  return a > b ? a : b;
}
/// As std::min(b, a).
template <class T>
SWARF_KERNEL_INLINE T min_of(const T& a, const T& b) {
  return a < b ? a : b;
}
template <class T>
SWARF_KERNEL_INLINE T size_of(const T& a) {
  return max_of<T>(a, -a);
}
template <class T>
SWARF_KERNEL_INLINE T all_of(double x) {
  return T{} + x;
}
template <class T>
SWARF_KERNEL_INLINE T load(const double* numbers) {
  T loaded;
  std::memcpy(&loaded, numbers, sizeof loaded);
  return loaded;
}
template <class T>
SWARF_KERNEL_INLINE void store(const T& numbers, double* to) {
  std::memcpy(to, &numbers, sizeof numbers);
}

}  // namespace swarf::measure
