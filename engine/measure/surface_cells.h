// The surface of a mesh divided into small cells: triangles halved along their longest edges.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "base/frames.h"
#include "mesh/signed_distance.h"

namespace swarf::measure {

using Corners = std::array<Vec3, 3>;

/// Side i runs from corner i to corner i + 1.
size_t longest_side(const Corners& corners);
double area_of(const Corners& corners);
Vec3 centroid_of(const Corners& corners);
/// Greatest distance of a corner from the centroid: of every point of the triangle.
double radius_of(const Corners& corners);
/// The two halves on either side of the longest side's bisector; the first has that side's first corner.
std::array<Corners, 2> halves_of(const Corners& corners);

struct SurfaceCell {
  std::array<uint32_t, 3> corners;  ///< of SurfaceCells::points
  uint32_t triangle = 0;            ///< of the mesh
  uint32_t child = 0;               ///< the first of its two halves; 0: a leaf
};

/// All halvings are kept, so that the leaf of a point is found. Two cells that share an edge halve it at the
/// same point.
class SurfaceCells {
 public:
  /// One cell per triangle, in the mesh's order.
  explicit SurfaceCells(const mesh::SignedDistance& mesh);
  void halve(uint32_t cell);

  size_t size() const { return cells_.size(); }
  const SurfaceCell& operator[](size_t cell) const { return cells_[cell]; }
  bool is_leaf(size_t cell) const { return cells_[cell].child == 0; }
  Corners corners(size_t cell) const;
  const std::vector<Vec3>& points() const { return points_; }
  /// Calls visit(point) for a cell's corners and for all the middles on its sides, which smaller neighbours
  /// have as corners.
  template <typename Visit>
  void each_point(size_t cell, const Visit& visit) const {
    for (size_t i = 0; i < 3; ++i) {
      const uint32_t a = cells_[cell].corners[i];
      visit(a);
      each_middle(a, cells_[cell].corners[(i + 1) % 3], visit);
    }
  }
  /// The leaf of a triangle that holds a point on it.
  uint32_t leaf_at(uint32_t triangle, const Vec3& point) const;

 private:
  static uint64_t edge_key(uint32_t a, uint32_t b) {
    return uint64_t{std::min(a, b)} << 32U | std::max(a, b);
  }
  template <typename Visit>
  void each_middle(uint32_t a, uint32_t b, const Visit& visit) const {
    if (middles_.empty()) return;
    const auto found = middles_.find(edge_key(a, b));
    if (found == middles_.end()) return;
    visit(found->second);
    each_middle(a, found->second, visit);
    each_middle(found->second, b, visit);
  }

  std::vector<Vec3> points_;
  std::vector<SurfaceCell> cells_;
  std::unordered_map<uint64_t, uint32_t> middles_;  ///< looked up only: its order never shows
};

}  // namespace swarf::measure
