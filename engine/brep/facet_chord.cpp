#include "brep/facet_chord.h"

#include <algorithm>
#include <cmath>

namespace swarf::brep {

double to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 way = b - a;
  const double length2 = way.squaredNorm();
  const double along = length2 > 0.0 ? std::clamp((p - a).dot(way) / length2, 0.0, 1.0) : 0.0;
  return (p - a - along * way).norm();
}

namespace {

/// How far the surface lies from a flat facet between places x_k of it: by Taylor's formula at the corners
///   |S(sum l_k x_k) - sum l_k S(x_k)| <= 1/2 sum over pairs l_j l_k B_jk <= 1/6 max B_jk,
/// B_jk bounding the second derivative along the side from x_j to x_k over the facet's rectangle (see
/// measure/design_cell.h; the sum of l_j l_k over pairs is 1/3 at most).
double flatness(const surface::Surface& surface, const std::array<Vec2, 3>& x) {
  const Vec2 low = x[0].cwiseMin(x[1]).cwiseMin(x[2]).cwiseMax(Vec2::Zero());
  const Vec2 high = x[0].cwiseMax(x[1]).cwiseMax(x[2]).cwiseMin(Vec2::Ones());
  const surface::BendBounds b = surface.bend_bounds(low, high);
  double most = 0.0;
  for (size_t k = 0; k < 3; ++k) {
    const Vec2 d = x[(k + 1) % 3] - x[k];
    const double du2 = d.x() * d.x(), dv2 = d.y() * d.y();
    const Vec3 mean = du2 * b.uu.mean + 2.0 * d.x() * d.y() * b.uv.mean + dv2 * b.vv.mean;
    most = std::max(most, mean.norm() + (b.uu.stray + b.uv.stray) * du2 + (b.uv.stray + b.vv.stray) * dv2);
  }
  return most / 6.0;
}

double to_triangle(const Vec3& p, const std::array<Vec3, 3>& t) {
  const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  double nearest = to_segment(p, t[0], t[1]);
  bool within = normal.norm() > 0.0;
  for (size_t k = 0; k < 3; ++k) {
    const Vec3 &a = t[k], &b = t[(k + 1) % 3];
    nearest = std::min(nearest, to_segment(p, a, b));
    within = within && normal.dot((b - a).cross(p - a)) >= 0.0;
  }
  return within ? std::abs((p - t[0]).dot(normal)) / normal.norm() : nearest;
}

}  // namespace

double distance_bound(const surface::Surface& surface, const std::array<Vec2, 3>& x,
                      const std::array<Vec3, 3>& facet, double enough, int depth) {
  const double flat = flatness(surface, x);
  double corners = 0.0;
  for (const Vec2& place : x)
    corners = std::max(corners, to_triangle(surface.point(place.x(), place.y()), facet));
  constexpr int kDeepest = 8;
  constexpr double kLittle = 0.05;  // of what is enough: no division would win more
  if (corners + flat <= enough || corners > enough || flat < kLittle * enough || depth == kDeepest)
    return corners + flat;
  const Vec2 a = 0.5 * (x[0] + x[1]), b = 0.5 * (x[1] + x[2]), c = 0.5 * (x[2] + x[0]);
  double most = 0.0;
  for (const std::array<Vec2, 3>& part :
       {std::array<Vec2, 3>{x[0], a, c}, {a, x[1], b}, {c, b, x[2]}, {a, b, c}})
    most = std::max(most, distance_bound(surface, part, facet, enough, depth + 1));
  return most;
}

}  // namespace swarf::brep
