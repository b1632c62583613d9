// Integral of a function of one number.
#pragma once

#include <functional>

namespace swarf {

/// Gauss' rule with seven points, exact for polynomials of degree 13: for pieces over which f is smooth.
double smooth_integral(const std::function<double(double)>& f, double a, double b);

}  // namespace swarf
