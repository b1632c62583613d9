// The one seeded generator (splitmix64): the same numbers on every system, which <random> does not promise.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/frames.h"
#include "base/units.h"

namespace swarf {

/// Not for secrets: whoever sees one number knows all that follow.
class Rng {
 public:
  explicit Rng(uint64_t seed) : state_(seed) {}  // equal seeds give equal sequences

  uint64_t next() {  // 64 bits, evenly distributed
    uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  /// Uniform in [low, high).
  double uniform(double low = 0.0, double high = 1.0) {
    return low + (high - low) * (static_cast<double>(next() >> 11) * 0x1.0p-53);
  }
  /// Uniform on the unit sphere.
  Vec3 direction() {
    const double z = uniform(-1.0, 1.0);
    const double angle = uniform(0.0, 2.0 * kPi);
    const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
    return {r * std::cos(angle), r * std::sin(angle), z};
  }

 private:
  uint64_t state_;
};

}  // namespace swarf
