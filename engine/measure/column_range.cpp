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

double own_way(double away, double along, double share) {
  const double root = along * along - (1.0 - share * share) * away * away;
  return along > 0.0 && root >= 0.0 ? away * away / (along + std::sqrt(root)) : kNever;
}

std::optional<CornerHeights> own_to_point(const DesignCell& cell, const Vec3& q, double share) {
  double farthest = 0.0, along = kNever;
  for (const CellCorner& at : cell.corners) {
    farthest = std::max(farthest, (q - at.point).norm() + cell.flatness_mm);
    for (const CellCorner& corner : cell.corners) along = std::min(along, corner.normal.dot(q - at.point));
  }
  along -= cell.flatness_mm + cell.turn * farthest;
  if (!(along > stock::kLeastWallSine * farthest)) return std::nullopt;
  if (share < 1.0) along -= stock::kFloatMesh;
  const double own = own_way(farthest, along, share);
  if (own == kNever) return std::nullopt;
  return CornerHeights{own, own, own};
}

std::optional<CornerHeights> own_to_facet(const DesignCell& cell, const TriMesh& mesh, uint32_t facet,
                                          const CornerHeights& ranges, double side, double share,
                                          double stray_mm) {
  const auto vertex = [&](size_t k) {
    const auto& p = mesh.positions[mesh.triangles[facet][k]];
    return Vec3(p[0], p[1], p[2]);
  };
  CornerHeights own{};
  for (size_t k = 0; k < 3; ++k) {
    const Vec3 &p = cell.corners[k].point, way = side * cell.corners[k].normal;
    own[k] = kNever;
    Vec3 middle = beyond(p, way, ranges[k]);
    // Each step halves the digits that are missing, as Newton's for a square root. A facet that begins beside
    // the corner, no farther along the column, is looked at from farther along.
    constexpr int kSteps = 4;
    for (int step = 0; step < kSteps; ++step) {
      const Vec3 to = mesh::closest_point_on_triangle(middle, vertex(0), vertex(1), vertex(2)) - p;
      const double away = to.norm() + stray_mm, along = way.dot(to) - stray_mm;
      if (!(away > 0.0)) break;
      const double radius = own_way(away, share < 1.0 ? along - stock::kFloatMesh : along, share);
      own[k] = std::min(own[k], radius);
      middle = p + (radius < kNever ? radius : 2.0 * away) * way;
    }
    if (own[k] == kNever) return std::nullopt;
  }
  return own;
}

namespace {

/// The corner's own depth need not be known closer than this, of itself: it only says where to look.
constexpr double kShareOfDepth = 1e-3;

/// Of a curved cell: by the place of the design that is nearest to a corner's column as deep as the cell is
/// wide, or where it ends to be the corner's own.
std::optional<CornerHeights> own_to_place_below(const DesignCell& cell, const stock::DesignMesh& design,
                                                size_t corner, double depth, double share) {
  DesignCell below = cell;
  for (CellCorner& at : below.corners) at.normal = -at.normal;
  if (design.under != nullptr) below.flatness_mm += design.under->chord_mm;
  const CellCorner& at = below.corners[corner];
  const Vec3 middle = beyond(at.point, at.normal, std::max(depth, cell.radius()));
  return own_to_point(below, design.distance.nearest(middle).point, share);
}

/// RayField::own_depth of any place of the cell: facets without faces under them have leaning normals, unless
/// they are flat.
double own_share(const DesignCell& cell, const stock::DesignMesh& design) {
  const Vec3 across =
      (cell.corners[1].point - cell.corners[0].point).cross(cell.corners[2].point - cell.corners[0].point);
  const bool own_normal =
      is_flat(cell) && std::abs(across.dot(cell.corners[0].normal)) >= (1.0 - 1e-9) * across.norm();
  return design.under != nullptr || own_normal ? stock::kOwnShare : stock::kOwnShareLeaning;
}

}  // namespace

std::vector<CornerHeights> own_below(const DesignCell& cell, const stock::RayField& field,
                                     const CornerHeights& through) {
  std::vector<CornerHeights> bounds;
  if (field.design == nullptr) return bounds;
  const stock::DesignMesh& design = *field.design;
  const double share = own_share(cell, design);
  CornerHeights depths{};
  for (size_t k = 0; k < 3; ++k) {
    const CellCorner& at = cell.corners[k];
    depths[k] = field.own_depth(at.point, at.normal, std::max(0.0, through[k]), kShareOfDepth);
  }
  for (size_t k = 0; k < 3; ++k) {
    const CellCorner& at = cell.corners[k];
    std::optional<CornerHeights> own;
    if (is_flat(cell)) {
      const uint32_t facet = design.distance.nearest(beyond(at.point, -at.normal, depths[k])).triangle;
      const bool curved = design.under != nullptr && design.under->is_curved(facet);
      own =
          own_to_facet(cell, design.mesh, facet, depths, -1.0, share, curved ? design.under->chord_mm : 0.0);
    } else {
      own = own_to_place_below(cell, design, k, depths[k], share);
    }
    if (own) bounds.push_back(*own);
  }
  return bounds;
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
