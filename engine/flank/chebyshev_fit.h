// The shift of a few unknowns that makes the greatest of many errors least.
#pragma once

#include <array>
#include <span>

namespace swarf::flank {

inline constexpr int kMostUnknowns = 3;
using Shift = std::array<double, kMostUnknowns>;

/// Errors e_j + sum_i slope_j[i] x_i at places j in order: the x that makes max |error| least over the places
/// (exchange of one place at a time, Stiefel 1959). The slopes must form a Chebyshev system over the places
/// (polynomial-like: no combination vanishes at `unknowns` places). `unknowns` 1 to 3, fewer than places.
Shift least_maximum(std::span<const double> errors, std::span<const Shift> slopes, int unknowns);

}  // namespace swarf::flank
