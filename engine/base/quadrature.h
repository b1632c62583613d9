// Integrals of a function of one number.
#pragma once

#include <functional>

namespace swarf {

/// Gauss' rule with seven points, exact for polynomials of degree 13: for pieces over which f is smooth.
double smooth_integral(const std::function<double(double)>& f, double a, double b);

/// Gauss and Kronrod's pair with 15 points, halving where the two disagree by more than `relative` of the
/// integral of |f|, 24 times at most.
double adaptive_integral(const std::function<double(double)>& f, double a, double b, double relative);

}  // namespace swarf
