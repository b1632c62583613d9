// Least values of a function of one number.
#pragma once

#include <functional>

namespace swarf {

struct Minimum {
  double at = 0.0, value = 0.0;
};

/// The least value of f between a and b, a < b, where it falls to one place and rises behind it: Brent's
/// method, to half the digits of a double in the place and to nearly all of them in the value.
Minimum least_between(const std::function<double(double)>& f, double a, double b);

/// The least value of f over [a, b]: the least of `intervals` + 1 even places, or what lies lower between its
/// neighbours. A dip between two places that none of them shows may be missed.
Minimum least_sampled(const std::function<double(double)>& f, double a, double b, int intervals);

/// The greatest value, by the same rule.
Minimum greatest_sampled(const std::function<double(double)>& f, double a, double b, int intervals);

}  // namespace swarf
