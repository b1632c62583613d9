#include "toolpath/chebyshev.h"

#include <Eigen/QR>
#include <algorithm>

namespace swarf::toolpath {

double Chebyshev::at(double t) const {
  const double x = std::clamp((2.0 * t - first - last) / (last - first), -1.0, 1.0);
  // Clenshaw's recurrence.
  double b1 = 0.0;
  double b2 = 0.0;
  for (size_t k = coefficients.size() - 1; k > 0; --k) {
    const double b = coefficients[k] + 2.0 * x * b1 - b2;
    b2 = b1;
    b1 = b;
  }
  return coefficients[0] + x * b1 - b2;
}

Chebyshev fitted_from_below(const Grid& grid, const std::vector<double>& values, int degree) {
  Eigen::MatrixXd basis(grid.size(), degree + 1);
  for (int j = 0; j < grid.size(); ++j) {
    const double x = 2.0 * j / grid.intervals - 1.0;
    basis(j, 0) = 1.0;
    basis(j, 1) = x;
    for (int k = 2; k <= degree; ++k) basis(j, k) = 2.0 * x * basis(j, k - 1) - basis(j, k - 2);
  }
  const Eigen::Map<const Eigen::VectorXd> right(values.data(), grid.size());
  const Eigen::VectorXd solution = basis.householderQr().solve(right);
  Chebyshev fit{grid.first, grid.last(), {solution.data(), solution.data() + solution.size()}};
  double excess = 0.0;
  for (int j = 0; j < grid.size(); ++j)
    if (grid.t(j) >= 0.0 && grid.t(j) <= 1.0) excess = std::max(excess, fit.at(grid.t(j)) - values[j]);
  fit.coefficients[0] -= excess;
  return fit;
}

}  // namespace swarf::toolpath
