#include "render/ray/sampler.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace swarf::render {
namespace {

/// Width of the field round a set pixel, in pixels (Ulichney's choice).
constexpr double kSigma = 1.5;

float below_one(double x) {
  return std::min(static_cast<float>(x - std::floor(x)), 0x1.fffffep-1F);
}

}  // namespace

BlueNoise::BlueNoise() {
  constexpr int kCells = kSize * kSize;
  std::vector<float> bump(kCells), field(kCells);
  Rng rng(1);
  for (int i = 0; i < kCells; ++i) {
    const int x = std::min(i % kSize, kSize - i % kSize), y = std::min(i / kSize, kSize - i / kSize);
    bump[i] = static_cast<float>(std::exp(-(x * x + y * y) / (2.0 * kSigma * kSigma)));
    field[i] = static_cast<float>(rng.uniform(0.0, 1e-3));  // breaks the ties of an empty field
  }
  for (int rank = 0; rank < kCells; ++rank) {
    const auto chosen = static_cast<int>(std::min_element(field.begin(), field.end()) - field.begin());
    rank_[chosen] = static_cast<float>(rank) / kCells;
    for (int y = 0; y < kSize; ++y) {
      const int row = ((y - chosen / kSize) & (kSize - 1)) * kSize;
      for (int x = 0; x < kSize; ++x)
        field[y * kSize + x] += bump[row + ((x - chosen % kSize) & (kSize - 1))];
    }
    field[chosen] += static_cast<float>(kCells);  // never again
  }
}

Eigen::Vector2f Sampler::next() {
  constexpr double kStep1 = 0.7548776662466927, kStep2 = 0.5698402909980532;
  const uint64_t place = pairs_.next();
  const auto shift = [&](int bits) {
    return noise_.at(x_ + static_cast<int>((place >> bits) & 63),
                     y_ + static_cast<int>((place >> (bits + 6)) & 63));
  };
  return {below_one(shift(0) + kStep1 * sample_), below_one(shift(12) + kStep2 * sample_)};
}

}  // namespace swarf::render
