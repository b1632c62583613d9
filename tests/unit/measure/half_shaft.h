// A design of an exact surface under coarse facets.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "base/units.h"
#include "mesh/tri_mesh.h"
#include "surface/analytic.h"
#include "surface/under_facets.h"

namespace swarf::measure {

inline constexpr double kShaftRadius = 20.0;

/// The top of a shaft along x, highest at z = 0, its flanks and its lower side: half a cylinder as a closed
/// body.
struct HalfShaft {
  TriMesh mesh;
  surface::UnderFacetsPtr under;
};

inline HalfShaft half_shaft(int sides, double half_length = 5.0) {
  surface::Turn turn;
  turn.base_W = {-half_length, 0, -kShaftRadius};
  turn.axis_W = Vec3::UnitX();
  turn.from_rad = 0.0;
  turn.to_rad = kPi;
  auto under = std::make_shared<surface::UnderFacets>();
  under->surfaces.push_back(
      surface::cylinder_surface(turn, kShaftRadius, 2.0 * half_length, surface::MaterialSide::kConvex));
  under->is_plane.push_back(0);
  const surface::Surface& shaft = *under->surfaces.front();
  HalfShaft part;
  const auto add = [&](const Vec3& p) {
    part.mesh.positions.push_back(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
    return static_cast<uint32_t>(part.mesh.positions.size() - 1);
  };
  const auto facet = [&](std::array<uint32_t, 3> corners, const surface::FacetOnSurface& on) {
    part.mesh.triangles.push_back(corners);
    under->facets.push_back(on);
  };
  std::vector<uint32_t> low, high;
  for (int i = 0; i <= sides; ++i) {
    const double u = static_cast<double>(i) / sides;
    low.push_back(add(shaft.point(u, 0.0)));
    high.push_back(add(shaft.point(u, 1.0)));
  }
  const bool turned = surface::outward_normal(shaft, shaft.derivatives(0.5, 0.5)).z() < 0.0;
  EXPECT_FALSE(turned);
  // Counter-clockwise from outside, whichever way u turns about the axis.
  const Vec3 across = (shaft.point(0.6, 0.5) - shaft.point(0.5, 0.5)).cross(Vec3::UnitX());
  const bool flip = across.z() < 0.0;
  const auto both = [&](std::array<uint32_t, 3> c, surface::FacetOnSurface on) {
    if (flip) {
      std::swap(c[1], c[2]);
      std::swap(on.uv[1], on.uv[2]);
    }
    facet(c, on);
  };
  const uint32_t left = add({-half_length, 0, -kShaftRadius}), right = add({half_length, 0, -kShaftRadius});
  for (int i = 0; i < sides; ++i) {
    const double u0 = static_cast<double>(i) / sides, u1 = static_cast<double>(i + 1) / sides;
    const auto k = static_cast<size_t>(i);
    both({low[k], low[k + 1], high[k + 1]}, {0, {Vec2(u0, 0), Vec2(u1, 0), Vec2(u1, 1)}});
    both({low[k], high[k + 1], high[k]}, {0, {Vec2(u0, 0), Vec2(u1, 1), Vec2(u0, 1)}});
    both({left, low[k + 1], low[k]}, {});
    both({right, high[k], high[k + 1]}, {});
  }
  const auto last = static_cast<size_t>(sides);
  both({low[0], high[0], right}, {});
  both({low[0], right, left}, {});
  both({low[last], right, high[last]}, {});
  both({low[last], left, right}, {});
  part.under = under;
  return part;
}

}  // namespace swarf::measure
