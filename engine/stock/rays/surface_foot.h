// The nearest place of a part of a surface to a point. Internal to this folder.
//
// Over a triangle of parameters x(l) = uv0 + l0 (uv1 - uv0) + l1 (uv2 - uv0), l0, l1 >= 0, l0 + l1 <= 1, the
// function 1/2 |S - p|^2 has the gradient -(p - S).S_i and the second derivatives S_i.S_j - (p - S).S_ij.
// Newton's step is taken where these are positive definite, Gauss and Newton's (without the last term) where
// they are not; it is halved while the distance does not fall. At a side that it leads out of it goes along
// the side, so the end is inside, where the way to the point is the normal, or on the side or at the corner
// that is nearest.
#pragma once

#include <array>

#include "surface/surface.h"

namespace swarf::stock {

struct SurfaceFoot {
  Vec3 point = Vec3::Zero();  ///< mm
  Vec2 uv = Vec2::Zero();
  double distance_mm = 0.0;
};

/// `start`: the two shares l to begin with, within the triangle. A local minimum: where the point is farther
/// away than the surface's radius of curvature there may be others. The last step is shorter than 1e-6 mm.
SurfaceFoot surface_foot(const surface::Surface& surface, const std::array<Vec2, 3>& uv, const Vec2& start,
                         const Vec3& point);

}  // namespace swarf::stock
