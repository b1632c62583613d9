#include "base/roots.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cstdint>
#include <limits>

#include "base/check.h"

namespace swarf {
namespace {

double horner(std::span<const double> c, double t) {
  double value = 0.0;
  for (size_t k = c.size(); k-- > 0;) value = value * t + c[k];
  return value;
}

}  // namespace

double bracketed_root(const std::function<double(double)>& f, double a, double b, double at_a, double at_b) {
  using boost::math::tools::eps_tolerance;
  constexpr int kBits = std::numeric_limits<double>::digits;
  std::uintmax_t steps = 200;
  const auto [low, high] = boost::math::tools::toms748_solve([&f](double t) { return f(t); }, a, b, at_a,
                                                             at_b, eps_tolerance<double>(kBits), steps);
  return 0.5 * (low + high);
}

UnitRoots unit_roots(std::span<const double> coefficients) {
  SWARF_CHECK(coefficients.size() <= kRootDegreeMax + 1, "degree of a polynomial whose roots are sought");
  UnitRoots roots;
  const size_t degree = coefficients.empty() ? 0 : coefficients.size() - 1;
  if (std::all_of(coefficients.begin(), coefficients.end(), [](double c) { return c == 0.0; })) return roots;
  std::array<double, kRootDegreeMax + 1> slope{};
  for (size_t k = 0; k < degree; ++k) slope[k] = static_cast<double>(k + 1) * coefficients[k + 1];
  const UnitRoots turns = degree > 1 ? unit_roots({slope.data(), degree}) : UnitRoots{};
  double a = 0.0, at_a = horner(coefficients, a);
  if (at_a == 0.0) roots.t[static_cast<size_t>(roots.count++)] = a;
  for (int i = 0; degree > 0 && i <= turns.count; ++i) {
    const double b = i < turns.count ? turns.t[static_cast<size_t>(i)] : 1.0;
    const double at_b = horner(coefficients, b);
    if (at_b == 0.0 && b > a) {
      roots.t[static_cast<size_t>(roots.count++)] = b;
    } else if ((at_a < 0.0 && at_b > 0.0) || (at_a > 0.0 && at_b < 0.0)) {
      roots.t[static_cast<size_t>(roots.count++)] =
          bracketed_root([&](double t) { return horner(coefficients, t); }, a, b, at_a, at_b);
    }
    a = b;
    at_a = at_b;
  }
  return roots;
}

}  // namespace swarf
