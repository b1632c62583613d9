// Curvature of a surface: the shape matrix K and what follows from it. Convex is positive throughout:
// seen from outside the material, a dome has K positive definite.
#pragma once

#include "surface/surface.h"

namespace swarf::surface {

/// Frame and shape at one point. e1, e2, normal is right-handed and orthonormal; K is symmetric in (e1,e2),
/// 1/mm.
struct Shape {
  Vec3 point, normal, e1, e2;
  Mat2 K;
  /// Coordinates of a tangent vector in (e1,e2).
  Vec2 in_tangent(const Vec3& direction) const { return {direction.dot(e1), direction.dot(e2)}; }
};

/// Shape at (u,v) from first and second fundamental forms; `outward_sign` as in Surface.
Shape shape_at(const Derivatives& d, int outward_sign);

/// t'Kt for a unit tangent t given in (e1,e2), 1/mm.
double normal_curvature(const Shape& shape, const Vec2& unit_tangent);

/// det K, 1/mm^2.
double gaussian_curvature(const Shape& shape);

struct PrincipalCurvatures {
  double low, high;  ///< low <= high, 1/mm
};
PrincipalCurvatures principal_curvatures(const Shape& shape);

}  // namespace swarf::surface
