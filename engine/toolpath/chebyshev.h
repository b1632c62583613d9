// A smooth profile along a pass: a polynomial in Chebyshev form.
#pragma once

#include <vector>

#include "toolpath/area.h"

namespace swarf::toolpath {

struct Chebyshev {
  double first = 0.0, last = 1.0;  ///< ends of its range; outside, the end values hold
  std::vector<double> coefficients;
  double at(double t) const;
};

/// Least squares over the grid, then lowered by the greatest excess over the values within 0 <= t <= 1.
Chebyshev fitted_from_below(const Grid& grid, const std::vector<double>& values, int degree);

}  // namespace swarf::toolpath
