#include "measure/column_range.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "mesh/mesh_distance.h"
#include "stock/rays/free_ranges.h"

namespace swarf::measure {

double leaves_box(const Box& box, const Vec3& point, const Vec3& direction) {
  double enter = -kNever, leave = kNever;
  for (int a = 0; a < 3; ++a) {
    if (direction[a] == 0.0) {
      if (point[a] < box.lower[a] || point[a] > box.upper[a]) return -kNever;
      continue;
    }
    const double s0 = (box.lower[a] - point[a]) / direction[a], s1 = (box.upper[a] - point[a]) / direction[a];
    enter = std::max(enter, std::min(s0, s1));
    leave = std::min(leave, std::max(s0, s1));
  }
  constexpr double kOnFace = 1e-9;  // mm; designs often lie on the box
  return enter <= leave && enter <= kOnFace ? leave : -kNever;
}

Vec3 beyond(const Vec3& point, const Vec3& way, double own) {
  constexpr double kShare = 1.01, kLeast = 1e-4;  // mm
  return point + (kShare * own + kLeast) * way;
}

std::optional<CornerHeights> own_to_point(const DesignCell& cell, const Vec3& q) {
  double farthest = 0.0, along = kNever;
  for (const CellCorner& at : cell.corners) {
    farthest = std::max(farthest, (q - at.point).norm() + cell.flatness_mm);
    for (const CellCorner& corner : cell.corners) along = std::min(along, corner.normal.dot(q - at.point));
  }
  along -= cell.flatness_mm + cell.turn * farthest;
  if (!(along > stock::kLeastWallSine * farthest)) return std::nullopt;
  const double own = farthest * farthest / (2.0 * along);
  return CornerHeights{own, own, own};
}

std::optional<CornerHeights> own_to_facet(const DesignCell& cell, const TriMesh& mesh, uint32_t facet,
                                          const CornerHeights& ranges, double side) {
  const auto vertex = [&](size_t k) {
    const auto& p = mesh.positions[mesh.triangles[facet][k]];
    return Vec3(p[0], p[1], p[2]);
  };
  CornerHeights own{};
  for (size_t k = 0; k < 3; ++k) {
    const Vec3 &p = cell.corners[k].point, way = side * cell.corners[k].normal;
    const Vec3 q =
        mesh::closest_point_on_triangle(beyond(p, way, ranges[k]), vertex(0), vertex(1), vertex(2));
    const double h = way.dot(q - p);
    if (!(h > 0.0)) return std::nullopt;
    own[k] = (q - p).squaredNorm() / (2.0 * h);
  }
  return own;
}

double air_above(const DesignCell& cell, const stock::Stock& stock, double stock_bound_mm, double top_mm) {
  const double voxel = stock.voxel_mm();
  const Vec3 centre = cell.centroid(), normal = cell.mean_normal();
  double slice = 0.0;  // of the columns at height s about the centre line, per mm of height
  for (const CellCorner& corner : cell.corners) slice = std::max(slice, (corner.normal - normal).norm());
  const double least_step = 0.1 * voxel;
  double s = top_mm;
  while (s > 0.0) {
    const double radius = stock.air_radius_mm(centre + s * normal) - stock_bound_mm;
    const double aside = cell.radius() + cell.flatness_mm + s * (slice + cell.turn);
    if (!(radius > aside)) break;
    const double step = std::sqrt(radius * radius - aside * aside);
    if (step < least_step) break;
    s -= step;
  }
  return std::max(s, 0.0);
}

}  // namespace swarf::measure
