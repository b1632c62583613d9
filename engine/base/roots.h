// Real roots: of a function between two places of different sign, of polynomials in [0,1].
#pragma once

#include <array>
#include <functional>
#include <span>

namespace swarf {

/// The place between a and b, a < b, where a continuous function changes its sign, to the last bits; at_a and
/// at_b are its values there, of different sign. Alefeld, Potra and Shi's algorithm 748.
double bracketed_root(const std::function<double(double)>& f, double a, double b, double at_a, double at_b);

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
