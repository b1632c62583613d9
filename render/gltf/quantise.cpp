#include "render/gltf/quantise.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace swarf::render {
namespace {

/// The power of two that is `least` or the next above it.
double power_of_two(double least) {
  return std::exp2(std::ceil(std::log2(std::max(least, double{std::numeric_limits<float>::min()}))));
}

}  // namespace

PositionGrid::PositionGrid(const Box& box) {
  // One step less than there are: the origin is rounded down.
  constexpr double kSteps = std::numeric_limits<uint16_t>::max() - 1.0;
  step_ = power_of_two(box.size().maxCoeff() / kSteps);
  for (int k = 0; k < 3; ++k) origin_[k] = step_ * std::floor(box.lower[k] / step_);
}

std::array<uint16_t, 3> PositionGrid::at(const std::array<float, 3>& position) const {
  constexpr double kLast = std::numeric_limits<uint16_t>::max();
  std::array<uint16_t, 3> steps{};
  for (int k = 0; k < 3; ++k) {
    const double place = std::round((double{position[static_cast<size_t>(k)]} - origin_[k]) / step_);
    steps[static_cast<size_t>(k)] = static_cast<uint16_t>(std::clamp(place, 0.0, kLast));
  }
  return steps;
}

double PositionGrid::error_mm() const {
  return 0.5 * std::sqrt(3.0) * step_;
}

std::optional<double> scalar_step(std::span<const float> values_um) {
  double farthest = 0.0;
  for (const float value : values_um) farthest = std::max(farthest, std::abs(double{value}));
  const double step = power_of_two(farthest / std::numeric_limits<int16_t>::max());
  if (0.5 * step > kScalarErrorUm) return std::nullopt;
  return step;
}

}  // namespace swarf::render
