#include "measure/surface_cells.h"

#include <algorithm>
#include <cmath>

namespace swarf::measure {

size_t longest_side(const Corners& corners) {
  size_t longest = 0;
  double most = -1.0;
  for (size_t i = 0; i < 3; ++i) {
    const double length = (corners[(i + 1) % 3] - corners[i]).squaredNorm();
    if (length <= most) continue;
    most = length;
    longest = i;
  }
  return longest;
}

double area_of(const Corners& corners) {
  return 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
}

Vec3 centroid_of(const Corners& corners) {
  return (corners[0] + corners[1] + corners[2]) / 3.0;
}

double radius_of(const Corners& corners) {
  const Vec3 centre = centroid_of(corners);
  double squared = 0.0;
  for (const Vec3& corner : corners) squared = std::max(squared, (corner - centre).squaredNorm());
  return std::sqrt(squared);
}

std::array<Corners, 2> halves_of(const Corners& corners) {
  const size_t i = longest_side(corners);
  const Vec3 &a = corners[i], &b = corners[(i + 1) % 3], &apex = corners[(i + 2) % 3];
  const Vec3 middle = 0.5 * (a + b);
  return {Corners{a, middle, apex}, Corners{middle, b, apex}};
}

SurfaceCells::SurfaceCells(const mesh::SignedDistance& mesh) {
  const TriMesh& triangles = mesh.mesh();
  points_.reserve(triangles.positions.size());
  for (const auto& p : triangles.positions) points_.emplace_back(p[0], p[1], p[2]);
  cells_.reserve(triangles.triangles.size());
  for (uint32_t t = 0; t < triangles.triangles.size(); ++t) cells_.push_back({triangles.triangles[t], t, 0});
}

Corners SurfaceCells::corners(size_t cell) const {
  const auto& c = cells_[cell].corners;
  return {points_[c[0]], points_[c[1]], points_[c[2]]};
}

void SurfaceCells::halve(uint32_t cell) {
  const size_t i = longest_side(corners(cell));
  const SurfaceCell whole = cells_[cell];
  const uint32_t a = whole.corners[i], b = whole.corners[(i + 1) % 3], apex = whole.corners[(i + 2) % 3];
  const auto [found, is_new] = middles_.try_emplace(edge_key(a, b), static_cast<uint32_t>(points_.size()));
  if (is_new) points_.emplace_back(0.5 * (points_[a] + points_[b]));
  const uint32_t middle = found->second;
  cells_[cell].child = static_cast<uint32_t>(cells_.size());
  cells_.push_back({{a, middle, apex}, whole.triangle, 0});
  cells_.push_back({{middle, b, apex}, whole.triangle, 0});
}

uint32_t SurfaceCells::leaf_at(uint32_t triangle, const Vec3& point) const {
  uint32_t cell = triangle;
  while (cells_[cell].child != 0) {
    // The halves share the middle and the apex; the first has corner a.
    const uint32_t first = cells_[cell].child;
    const auto& c = cells_[first].corners;
    const Vec3 &a = points_[c[0]], &middle = points_[c[1]], &apex = points_[c[2]];
    const Vec3 normal = (middle - a).cross(apex - a);
    const Vec3 across = (apex - middle).cross(normal);  // away from a
    cell = (point - middle).dot(across) * (a - middle).dot(across) >= 0.0 ? first : first + 1;
  }
  return cell;
}

}  // namespace swarf::measure
