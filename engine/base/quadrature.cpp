#include "base/quadrature.h"

#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>

namespace swarf {

double smooth_integral(const std::function<double(double)>& f, double a, double b) {
  return boost::math::quadrature::gauss<double, 7>::integrate([&f](double x) { return f(x); }, a, b);
}

double adaptive_integral(const std::function<double(double)>& f, double a, double b, double relative) {
  constexpr unsigned kHalvingsMax = 24;
  const auto value = [&f](double x) { return f(x); };
  return boost::math::quadrature::gauss_kronrod<double, 15>::integrate(value, a, b, kHalvingsMax, relative);
}

}  // namespace swarf
