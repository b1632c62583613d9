// How deep a cell of the design answers for cuts: the linear bounds over whole cells against the depth of
// single places, where the corners of the cells tell nothing of what lies between them.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "base/rng.h"
#include "measure/column_range.h"
#include "stock/rays/ray_field.h"

namespace swarf::measure {
namespace {

/// A bar along x with this convex section (y, z), counter-clockwise as seen against x.
TriMesh bar(double length, const std::vector<Vec2>& section) {
  TriMesh mesh;
  const auto n = static_cast<uint32_t>(section.size());
  for (const double x : {0.0, length}) {
    for (const Vec2& p : section)
      mesh.positions.push_back({static_cast<float>(x), static_cast<float>(p.x()), static_cast<float>(p.y())});
  }
  for (uint32_t i = 0; i < n; ++i) {
    const uint32_t k = (i + 1) % n;
    mesh.triangles.push_back({i, n + k, n + i});
    mesh.triangles.push_back({i, k, n + k});
  }
  for (uint32_t i = 1; i + 1 < n; ++i) {
    mesh.triangles.push_back({0, i + 1, i});
    mesh.triangles.push_back({n, n + i, n + i + 1});
  }
  return mesh;
}

/// Against own_depth() at random places of all cells; how many places lie deeper than all corners of their
/// cell.
int compare_with_places(const TriMesh& mesh, double size_mm, uint64_t seed) {
  const stock::RayFieldPtr field = stock::rays_on_mesh(mesh, 0.5);
  Rng rng(seed);
  int beyond_corners = 0;
  constexpr double kDeep = 50.0;
  for (const RootCell& root : root_cells(*field, size_mm)) {
    if (!root.looks_down || root.cell.area_mm2() == 0.0) continue;
    const std::vector<CornerHeights> bounds = own_below(root.cell, *field, {kDeep, kDeep, kDeep});
    double corners = 0.0;
    for (const CellCorner& corner : root.cell.corners)
      corners = std::max(corners, field->own_depth(corner.point, corner.normal, kDeep));
    for (int i = 0; i < 8; ++i) {
      Vec3 l(rng.uniform(), rng.uniform(), rng.uniform());
      l /= l.sum();
      const CellCorner place = place_in(root.cell, l, root.bounds);
      const double own = field->own_depth(place.point, place.normal, kDeep);
      if (own > corners + 0.01) ++beyond_corners;
      for (const CornerHeights& bound : bounds) {
        const double most = l.x() * bound[0] + l.y() * bound[1] + l.z() * bound[2];
        // own_depth() itself is told within 1e-4 of it and the rounding of meshes.
        EXPECT_LE(own, most * (1.0 + 1e-3) + 1e-3) << place.point.transpose() << " seed " << seed;
      }
    }
  }
  return beyond_corners;
}

TEST(OwnBelow, IsNowhereLessThanThePlacesOwnDepth) {
  // A thin wall: all corners of its top stand on edges. A block, a wedge, a dovetail, a roof.
  const std::vector<Vec2> wall{{-0.125, -3}, {0.125, -3}, {0.125, 0}, {-0.125, 0}},
      block{{-4, -3}, {4, -3}, {4, 0}, {-4, 0}}, wedge{{0, 0}, {4, -2.25}, {4, 0}},
      dovetail{{-1, -2}, {1, -2}, {2.5, 0}, {-2.5, 0}}, roof{{-3, -1}, {3, -1}, {1, 0}, {0, 0.25}, {-1, 0}};
  int beyond_corners = 0;
  uint64_t seed = 1;
  for (const auto* section : {&wall, &block, &wedge, &dovetail, &roof}) {
    for (const double size : {0.7, 5.0})
      beyond_corners += compare_with_places(bar(6.0, *section), size, seed++);
  }
  EXPECT_GT(beyond_corners, 50) << "the corners' own depths would be no bound";
}

}  // namespace
}  // namespace swarf::measure
