// Sample points that cover each pixel's integral evenly: a Kronecker lattice, shifted from pixel to pixel.
#pragma once

#include <array>
#include <cstdint>

#include "base/rng.h"

namespace swarf::render {

/// A square of the ranks 0..1 in which near ranks stand far apart, repeating without seams: blue noise, made
/// by setting one pixel after the other where the field of those already set is weakest (the void-filling
/// half of Ulichney's void-and-cluster, 1993).
class BlueNoise {
 public:
  static constexpr int kSize = 64;
  BlueNoise();
  float at(int x, int y) const { return rank_[(y & (kSize - 1)) * kSize + (x & (kSize - 1))]; }

 private:
  std::array<float, size_t{kSize} * kSize> rank_{};
};

/// Numbers for one sample of one pixel: pair k of sample i is the i-th point of the R2 sequence (Roberts
/// 2018, plastic number) under a shift that depends on pixel, pair and seed only. Neighbouring pixels get
/// shifts far apart, so that what noise is left is fine-grained.
class Sampler {
 public:
  Sampler(const BlueNoise& noise, int x, int y, uint32_t sample, uint32_t seed)
      : noise_(noise), pairs_(seed), x_(x), y_(y), sample_(sample) {}

  /// The next pair in [0, 1)^2.
  Eigen::Vector2f next();

 private:
  const BlueNoise& noise_;
  Rng pairs_;
  int x_, y_;
  double sample_;
};

}  // namespace swarf::render
