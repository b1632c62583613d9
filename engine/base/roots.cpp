#include "base/roots.h"

#include <algorithm>

#include "base/check.h"

namespace swarf {
namespace {

double horner(std::span<const double> c, double t) {
  double value = 0.0;
  for (size_t k = c.size(); k-- > 0;) value = value * t + c[k];
  return value;
}

/// The root between a and b, where the signs differ: false position with Illinois' halving, bisection at
/// least every third step.
double bracketed_root(std::span<const double> c, double a, double b, double at_a, double at_b) {
  for (int step = 0; step < 200; ++step) {
    const double middle = 0.5 * (a + b);
    if (middle <= a || middle >= b) break;
    double t = step % 3 == 2 ? middle : b - at_b * ((b - a) / (at_b - at_a));
    if (!(t > a && t < b)) t = middle;
    const double value = horner(c, t);
    if (value == 0.0) return t;
    if ((value > 0.0) == (at_b > 0.0)) {
      b = t;
      at_b = value;
      at_a *= 0.5;
    } else {
      a = t;
      at_a = value;
      at_b *= 0.5;
    }
  }
  return 0.5 * (a + b);
}

}  // namespace

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
      roots.t[static_cast<size_t>(roots.count++)] = bracketed_root(coefficients, a, b, at_a, at_b);
    }
    a = b;
    at_a = at_b;
  }
  return roots;
}

}  // namespace swarf
