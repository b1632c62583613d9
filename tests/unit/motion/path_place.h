// Derivatives of the axes along a run's path, for oracles of look-ahead: by differences of its points alone.
#pragma once

#include <algorithm>

#include "motion/blocks/block_run.h"

namespace swarf::motion {

struct PathRates {
  kinematics::AxisValues first, second, third;
};

/// Within the cell, so that no break at its ends is met.
inline PathRates path_rates(const RunPath& path, size_t cell, double offset) {
  const double own = path.cells[cell].length, h = std::min(0.01, own / 8.0);
  offset = std::clamp(offset, 2.0 * h, own - 2.0 * h);
  const auto q = [&](int i) { return point_at(path, cell, offset + i * h).q; };
  return {(8.0 * (q(1) - q(-1)) - (q(2) - q(-2))) / (12.0 * h), (q(1) - 2.0 * q(0) + q(-1)) / (h * h),
          (q(2) - 2.0 * q(1) + 2.0 * q(-1) - q(-2)) / (2.0 * h * h * h)};
}

}  // namespace swarf::motion
