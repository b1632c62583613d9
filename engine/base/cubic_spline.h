// A C2 cubic spline on a uniform grid, the curve w(t) that carries a tool pass over a surface.
#pragma once

#include <vector>

namespace swarf {

/// Interpolates values at uniform abscissae; not-a-knot ends, so that smooth data keep their order
/// (error h^4 |w''''| / 384). Outside the grid the end cubics continue.
class CubicSpline {
 public:
  struct Value {
    double w = 0.0;
    double dw = 0.0;   ///< dw/dt
    double ddw = 0.0;  ///< d2w/dt2
  };

  CubicSpline() = default;
  /// `values[i]` stands at t = first + i * step. Needs at least four values; step > 0.
  CubicSpline(double first, double step, std::vector<double> values);
  /// The same value everywhere.
  static CubicSpline constant(double value);

  Value at(double t) const;  ///< with both derivatives
  const std::vector<double>& values() const { return values_; }

 private:
  double first_ = 0.0;
  double step_ = 1.0;
  std::vector<double> values_;
  std::vector<double> second_;  ///< w'' at the knots
};

}  // namespace swarf
