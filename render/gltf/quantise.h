// 16 bits for a float, with the error stated: positions on a grid, scalars in steps.
//
// Steps are powers of two and the grid's origin is a multiple of its step, so that a reader who multiplies
// and adds in floats or doubles finds the same numbers.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "base/frames.h"

namespace swarf::render {

/// The grid that positions within a box are rounded to. Meshes that share an edge must share the grid, or the
/// edge opens.
class PositionGrid {
 public:
  explicit PositionGrid(const Box& box);
  /// Steps from the origin, each 0..65535.
  std::array<uint16_t, 3> at(const std::array<float, 3>& position) const;
  const Vec3& origin() const { return origin_; }
  double step_mm() const { return step_; }
  /// No position is moved farther: half the diagonal of a step, mm.
  double error_mm() const;

 private:
  Vec3 origin_;
  double step_;
};

/// A scalar that would be off by more is kept as a float, um: half of what deviations must keep.
inline constexpr double kScalarErrorUm = 0.05;

/// The step of signed 16-bit numbers that hold all of these finite values, um; none where half of it were
/// more than kScalarErrorUm.
std::optional<double> scalar_step(std::span<const float> values_um);

}  // namespace swarf::render
