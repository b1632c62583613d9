// Convex primitives that can say how far they reach in a direction: triangles and solids of revolution.
#pragma once

#include <array>
#include <vector>

#include "base/frames.h"

namespace swarf::collision {

using Triangle = std::array<Vec3, 3>;

/// A convex solid of revolution: the hull of the circles that the corners of its profile draw about an axis.
struct RevolvedSolid {
  Vec3 foot = Vec3::Zero();   ///< where z is 0, mm
  Vec3 axis = Vec3::UnitZ();  ///< unit, towards greater z
  std::vector<Vec2> corners;  ///< (rho, z), mm, rho >= 0; at least one, in order of height
};

/// Heights in mm above the foot, low < high; radii not both 0.
RevolvedSolid frustum(const Vec3& foot, const Vec3& axis, double low, double high, double low_radius,
                      double high_radius);

/// The point of the solid that lies farthest in the direction (any length, not 0).
Vec3 support(const RevolvedSolid& solid, const Vec3& direction);

/// Least axis-aligned box around it, mm.
Box bounds(const RevolvedSolid& solid);
Box bounds(const Triangle& triangle);

}  // namespace swarf::collision
