// What a triangle adds to how often a closed surface, turned outward, winds around a point: 0 outside, 1
// inside, 2 where the surface covers a place twice, -1 where it is turned inside out.
#pragma once

#include <array>
#include <optional>

#include "base/frames.h"

namespace swarf::mesh {

/// The solid angle of the triangle from the point, over 4 pi (van Oosterom & Strackee 1983). The sum over a
/// closed surface is its winding number.
double solid_angle(const std::array<Vec3, 3>& triangle, const Vec3& point);

/// The ray leaves (+1) or enters (-1) the solid through the triangle, or misses it (0); none: not to be told
/// from its edges or from the point. After Moeller & Trumbore (1997). Without one "none" the sum over a
/// closed surface is its winding number.
std::optional<int> ray_crossing(const std::array<Vec3, 3>& triangle, const Vec3& point, const Vec3& ray);

/// Rays for it: across no axis, plane or diagonal that parts are drawn along; of about length 1.
const std::array<Vec3, 3>& winding_rays();

}  // namespace swarf::mesh
