#include "collision/convex_shape.h"

#include <cmath>

namespace swarf::collision {
namespace {

constexpr double kLeastAcross = 1e-12;

/// What a direction has across the axis, of length 1, and how much of it; 0 where it is no more than
/// rounding. Taken off twice, for the first time leaves the rounding of the direction along the axis.
double split_across(const Vec3& direction, const Vec3& axis, double along, Vec3& across) {
  across = direction - along * axis;
  across -= across.dot(axis) * axis;
  const double radial = across.norm();
  if (radial <= kLeastAcross * direction.norm()) return 0.0;
  across /= radial;
  return radial;
}

}  // namespace

RevolvedSolid frustum(const Vec3& foot, const Vec3& axis, double low, double high, double low_radius,
                      double high_radius) {
  return {foot, axis, {{low_radius, low}, {high_radius, high}}};
}

Vec3 support(const RevolvedSolid& solid, const Vec3& direction) {
  const double along = direction.dot(solid.axis);
  Vec3 across;
  const double radial = split_across(direction, solid.axis, along, across);
  const Vec2* best = &solid.corners.front();
  double most = best->x() * radial + best->y() * along;
  for (const Vec2& corner : solid.corners) {
    const double reach = corner.x() * radial + corner.y() * along;
    if (reach > most) {
      most = reach;
      best = &corner;
    }
  }
  Vec3 point = solid.foot + best->y() * solid.axis;
  if (radial > 0.0) point += best->x() * across;
  return point;
}

Box bounds(const RevolvedSolid& solid) {
  Box box{Vec3::Constant(INFINITY), Vec3::Constant(-INFINITY)};
  for (const Vec2& corner : solid.corners) {
    const Vec3 centre = solid.foot + corner.y() * solid.axis;
    for (int k = 0; k < 3; ++k) {
      const double tilt = solid.axis[k];
      const double reach = corner.x() * std::sqrt(std::max(0.0, 1.0 - tilt * tilt));
      box.lower[k] = std::min(box.lower[k], centre[k] - reach);
      box.upper[k] = std::max(box.upper[k], centre[k] + reach);
    }
  }
  return box;
}

Box bounds(const Triangle& triangle) {
  return {triangle[0].cwiseMin(triangle[1]).cwiseMin(triangle[2]),
          triangle[0].cwiseMax(triangle[1]).cwiseMax(triangle[2])};
}

}  // namespace swarf::collision
