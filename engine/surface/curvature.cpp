#include "surface/curvature.h"

#include <algorithm>
#include <cmath>

namespace swarf::surface {

Shape shape_at(const Derivatives& d, int outward_sign) {
  Shape shape;
  shape.point = d.S;
  shape.normal = outward_sign * d.Su.cross(d.Sv).normalized();
  shape.e1 = d.Su.normalized();
  shape.e2 = shape.normal.cross(shape.e1);
  // With B the 2x2 matrix of (Su, Sv) in (e1, e2), the second fundamental form II = B' K B; convex > 0 is
  // -II.
  Mat2 basis;
  basis << d.Su.dot(shape.e1), d.Sv.dot(shape.e1), d.Su.dot(shape.e2), d.Sv.dot(shape.e2);
  Mat2 second;
  const double L = d.Suu.dot(shape.normal);
  const double M = d.Suv.dot(shape.normal);
  const double N = d.Svv.dot(shape.normal);
  second << L, M, M, N;
  const Mat2 inverse = basis.inverse();
  shape.K = -(inverse.transpose() * second * inverse);
  return shape;
}

double normal_curvature(const Shape& shape, const Vec2& t) {
  return t.dot(shape.K * t);
}

double gaussian_curvature(const Shape& shape) {
  return shape.K.determinant();
}

PrincipalCurvatures principal_curvatures(const Shape& shape) {
  const double mean = 0.5 * shape.K.trace();
  const double half_gap =
      std::hypot(0.5 * (shape.K(0, 0) - shape.K(1, 1)), 0.5 * (shape.K(0, 1) + shape.K(1, 0)));
  return {mean - half_gap, mean + half_gap};
}

}  // namespace swarf::surface
