#include "base/cubic_spline.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.h"

namespace swarf {

CubicSpline::CubicSpline(double first, double step, std::vector<double> values)
    : first_(first), step_(step), values_(std::move(values)), second_(values_.size(), 0.0) {
  const size_t n = values_.size();
  SWARF_CHECK(n >= 4 && step > 0.0, "a spline needs four values and a positive step");
  // m[i-1] + 4 m[i] + m[i+1] = 6 (w[i-1] - 2 w[i] + w[i+1]) / h^2; not-a-knot: m[0] = 2 m[1] - m[2],
  // which turns the first and the last equation into 6 m = right side.
  const double scale = 6.0 / (step_ * step_);
  std::vector<double> diagonal(n, 4.0);
  std::vector<double> right(n, 0.0);
  for (size_t i = 1; i + 1 < n; ++i) right[i] = scale * (values_[i - 1] - 2.0 * values_[i] + values_[i + 1]);
  second_[1] = right[1] / 6.0;
  second_[n - 2] = right[n - 2] / 6.0;
  if (n > 4) {
    right[2] -= second_[1];
    right[n - 3] -= second_[n - 2];
    for (size_t i = 3; i + 2 < n; ++i) {
      const double factor = 1.0 / diagonal[i - 1];
      diagonal[i] -= factor;
      right[i] -= factor * right[i - 1];
    }
    second_[n - 3] = right[n - 3] / diagonal[n - 3];
    for (size_t i = n - 4; i >= 2; --i) second_[i] = (right[i] - second_[i + 1]) / diagonal[i];
  }
  second_[0] = 2.0 * second_[1] - second_[2];
  second_[n - 1] = 2.0 * second_[n - 2] - second_[n - 3];
}

CubicSpline CubicSpline::constant(double value) {
  return {0.0, 1.0, {value, value, value, value}};
}

CubicSpline::Value CubicSpline::at(double t) const {
  const double x = (t - first_) / step_;
  const auto last = static_cast<double>(values_.size() - 2);
  const auto i = static_cast<size_t>(std::clamp(std::floor(x), 0.0, last));
  const double b = x - static_cast<double>(i);
  const double a = 1.0 - b;
  const double h2 = step_ * step_;
  const double m0 = second_[i];
  const double m1 = second_[i + 1];
  Value value;
  value.w = a * values_[i] + b * values_[i + 1] + ((a * a * a - a) * m0 + (b * b * b - b) * m1) * h2 / 6.0;
  value.dw = (values_[i + 1] - values_[i]) / step_ +
             ((3.0 * b * b - 1.0) * m1 - (3.0 * a * a - 1.0) * m0) * step_ / 6.0;
  value.ddw = a * m0 + b * m1;
  return value;
}

}  // namespace swarf
