// Real roots: of a function between two places of different sign, of polynomials in [0,1].
#pragma once

#include <array>
#include <span>

namespace swarf {

/// The place between a and b where a continuous function changes its sign, to the last bits; at_a and at_b
/// are its values there, of different sign. False position with Illinois' halving, bisection at least every
/// third step.
template <typename F>
double bracketed_root(const F& f, double a, double b, double at_a, double at_b) {
  for (int step = 0; step < 200; ++step) {
    const double middle = 0.5 * (a + b);
    if (middle <= a || middle >= b) break;
    double t = step % 3 == 2 ? middle : b - at_b * ((b - a) / (at_b - at_a));
    if (!(t > a && t < b)) t = middle;
    const double value = f(t);
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

inline constexpr int kRootDegreeMax = 6;

/// Roots found, ascending.
struct UnitRoots {
  std::array<double, kRootDegreeMax + 1> t{};
  int count = 0;
  std::span<const double> all() const& { return {t.data(), static_cast<size_t>(count)}; }
  std::span<const double> all() const&& = delete;  // it would outlive what it shows
};

/// Every t in [0,1] where sum coefficients[k] t^k changes its sign, to the last bits of double. The roots of
/// the derivative, found the same way, divide [0,1] into pieces without a turn; each piece holds one root at
/// most and shows it by its signs at both ends. A root without a change of sign (an even one) counts only
/// where rounding shows one; a polynomial that is zero everywhere has none. At most kRootDegreeMax + 1
/// coefficients.
UnitRoots unit_roots(std::span<const double> coefficients);

}  // namespace swarf
