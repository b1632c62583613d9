#include "base/minima.h"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <limits>

namespace swarf {

Minimum least_between(const std::function<double(double)>& f, double a, double b) {
  constexpr int kBits = std::numeric_limits<double>::digits / 2;  // finer places differ by rounding alone
  const auto value = [&f](double x) { return f(x); };
  const auto [at, least] = boost::math::tools::brent_find_minima(value, a, b, kBits);
  return {at, least};
}

Minimum least_sampled(const std::function<double(double)>& f, double a, double b, int intervals) {
  const double step = (b - a) / intervals;
  Minimum best{a, f(a)};
  for (int i = 1; i <= intervals; ++i) {
    const double x = i < intervals ? a + i * step : b, value = f(x);
    if (value < best.value) best = {x, value};
  }
  const Minimum refined = least_between(f, std::max(a, best.at - step), std::min(b, best.at + step));
  return refined.value < best.value ? refined : best;
}

Minimum greatest_sampled(const std::function<double(double)>& f, double a, double b, int intervals) {
  const Minimum least = least_sampled([&f](double x) { return -f(x); }, a, b, intervals);
  return {least.at, -least.value};
}

}  // namespace swarf
