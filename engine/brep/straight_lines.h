// Surfaces of straight lines whose ends move alike: cylinders and cones. Internal to this folder.
//
// With v along the lines, Su(u, v) = (a + b v) D(u), a + b v >= 0. Let a facet have the corners
// S(u_k, v_k) and q be its point of the shares l_k. With v' = sum l_k v_k and u' the mean of u_k by the
// weights l_k (a + b v_k), the terms of first order of q - S(u', v') cancel and those of second order leave
//   |q - S(u', v')| <= 1/2 max|Suu| var(u) <= 1/8 max|Suu| (u_max - u_min)^2.
#pragma once

#include <array>
#include <optional>

#include "surface/surface.h"

namespace swarf::brep {

/// The parameter that runs along such lines: 0 is u, 1 is v; nothing for other surfaces.
std::optional<int> straight_lines(const surface::Surface& surface);

/// No point of the facet, nor of the surface under it, is farther from the other than this, mm. `x` are the
/// parameters of its corners `facet`, `along` is told by straight_lines().
double straight_bound(const surface::Surface& surface, int along, const std::array<Vec2, 3>& x,
                      const std::array<Vec3, 3>& facet);

/// The same of a side between two places of the surface.
double straight_bound(const surface::Surface& surface, int along, const Vec2& from, const Vec2& to);

}  // namespace swarf::brep
