#include "base/quadrature.h"

#include <boost/math/quadrature/gauss.hpp>

namespace swarf {

double smooth_integral(const std::function<double(double)>& f, double a, double b) {
  return boost::math::quadrature::gauss<double, 7>::integrate([&f](double x) { return f(x); }, a, b);
}

}  // namespace swarf
