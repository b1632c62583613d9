// The nearest place of a surface to a point against a dense search that knows nothing of derivatives, and
// that of a design of faces against a closed form.
#include "stock/rays/surface_foot.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"
#include "base/units.h"
#include "stock/rays/ray_field.h"
#include "surface/analytic.h"
#include "surface/polynomial.h"

namespace swarf::stock {
namespace {

constexpr double kAside = 1e-5;  // mm: the foot, .01 um

/// Squares of 41 x 41 places, ever smaller, each about the best place of the one before.
SurfaceFoot dense_search(const surface::Surface& surface, const std::array<Vec2, 3>& uv, const Vec3& point) {
  constexpr int kSide = 40;
  SurfaceFoot best{{}, {}, 1e300};
  Vec2 middle(0.5, 0.5), at = middle;
  for (double half = 0.5; half > 1e-9; half *= 0.25) {
    for (int i = 0; i <= kSide; ++i) {
      for (int j = 0; j <= kSide; ++j) {
        Vec2 l = middle + half * (2.0 / kSide * Vec2(i, j) - Vec2::Ones());
        l = l.cwiseMax(0.0);
        l /= std::max(1.0, l.sum());
        const Vec2 x = uv[0] + l.x() * (uv[1] - uv[0]) + l.y() * (uv[2] - uv[0]);
        const Vec3 S = surface.point(x.x(), x.y());
        if ((S - point).norm() >= best.distance_mm) continue;
        best = {S, x, (S - point).norm()};
        at = l;
      }
    }
    middle = at;
  }
  return best;
}

/// A saddle with a twist, radii of curvature from 8 mm.
surface::PolynomialSurface saddle() {
  const Vec3 zero = Vec3::Zero();
  return {2, 2,
          std::vector<Vec3>{
              {-10, -8, 0}, {1, 16, -6}, {0, 2, 6}, {20, 0, 8}, {0, 3, 5}, zero, {1, 0, -9}, zero, zero},
          1};
}

TEST(SurfaceFoot, IsThatOfADenseSearch) {
  const surface::PolynomialSurface surface = saddle();
  Rng rng(71);
  const auto within = [&](double low, double high) { return low + (high - low) * rng.uniform(); };
  int sides = 0;
  for (int n = 0; n < 60; ++n) {
    // A part of the surface some mm wide, and a point over it or a little beside, up to 4 mm away.
    const Vec2 corner(within(0.1, 0.7), within(0.1, 0.7));
    const std::array<Vec2, 3> uv{corner, corner + Vec2(0.2, within(0.0, 0.1)),
                                 corner + Vec2(within(0.0, 0.1), 0.2)};
    const Vec2 under = corner + Vec2(within(-0.03, 0.15), within(-0.03, 0.15));
    const surface::Derivatives d = surface.derivatives(under.x(), under.y());
    const Vec3 point = d.S + within(-4.0, 4.0) * surface::outward_normal(surface, d);
    const SurfaceFoot dense = dense_search(surface, uv, point);
    const SurfaceFoot foot = surface_foot(surface, uv, {1.0 / 3.0, 1.0 / 3.0}, point);
    EXPECT_LE((foot.point - dense.point).norm(), kAside) << n << ": " << point.transpose();
    EXPECT_LE(foot.distance_mm, dense.distance_mm + 1e-10) << n;
    if ((foot.uv - under).norm() > 1e-6) ++sides;
  }
  EXPECT_GE(sides, 10) << "some feet lie on a side of the triangle";
}

/// Half a shaft of R20 in facets whose chords are `sides` to the half turn.
DesignMesh shaft_of_facets(double radius, int sides) {
  surface::Turn turn;
  turn.axis_W = Vec3::UnitX();
  turn.from_rad = 0.0;
  turn.to_rad = kPi;
  auto under = std::make_shared<surface::UnderFacets>();
  under->surfaces.push_back(surface::cylinder_surface(turn, radius, 10.0, surface::MaterialSide::kConvex));
  under->is_plane.push_back(0);
  under->chord_mm = radius * (1.0 - std::cos(0.5 * kPi / sides));
  const surface::Surface& shaft = *under->surfaces.front();
  TriMesh mesh;
  for (int i = 0; i <= sides; ++i)
    for (const double v : {0.0, 1.0}) {
      const Vec3 p = shaft.point(static_cast<double>(i) / sides, v);
      mesh.positions.push_back(
          {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
    }
  for (uint32_t i = 0; i < static_cast<uint32_t>(sides); ++i) {
    const double u0 = static_cast<double>(i) / sides, u1 = static_cast<double>(i + 1) / sides;
    mesh.triangles.push_back({2 * i, 2 * i + 2, 2 * i + 3});
    under->facets.push_back({0, {Vec2(u0, 0), Vec2(u1, 0), Vec2(u1, 1)}});
    mesh.triangles.push_back({2 * i, 2 * i + 3, 2 * i + 1});
    under->facets.push_back({0, {Vec2(u0, 0), Vec2(u1, 1), Vec2(u0, 1)}});
  }
  return DesignMesh(mesh, under);
}

/// The facet that is nearest need not be the one over which the nearest place lies: facets of 12 degrees tie
/// over their edges, far outside as far inside.
TEST(SurfaceFoot, OfADesignIsTheNearestOfAllItsFacets) {
  constexpr double kRadius = 20.0;
  const DesignMesh design = shaft_of_facets(kRadius, 15);
  Rng rng(72);
  size_t elsewhere = 0;
  for (int n = 0; n < 500; ++n) {
    const double angle = kPi * (0.05 + 0.9 * rng.uniform()), r = kRadius + 12.0 * (rng.uniform() - 0.4);
    const double x = 1.0 + 8.0 * rng.uniform();
    const Vec3 on = kRadius * Vec3(0, std::cos(angle), std::sin(angle));
    const bool turned = (design.nearest(Vec3(x, 0, 30.0)).point - Vec3(x, 0, kRadius)).norm() > 1.0;
    const Vec3 foot = Vec3(x, on.y(), turned ? -on.z() : on.z());
    const Vec3 point = Vec3(x, r / kRadius * foot.y(), r / kRadius * foot.z());
    const DesignMesh::Place place = design.nearest(point);
    EXPECT_LE((place.point - foot).norm(), kAside) << point.transpose();
    EXPECT_NEAR(place.distance_mm, std::abs(r - kRadius), 1e-9);
    if (design.distance.nearest(point).triangle != place.triangle) ++elsewhere;
  }
  EXPECT_GE(elsewhere, 5U) << "the nearest facet is not always the right one";
}

}  // namespace
}  // namespace swarf::stock
