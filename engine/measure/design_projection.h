// From a point near the design to its foot on the design surface: the (u,v) whose normal passes through it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "base/frames.h"
#include "stock/rays/surface_dexels.h"

namespace swarf::measure {

struct Foot {
  double u = 0.0, v = 0.0;
  double height_mm = 0.0;  ///< along the outward normal: > 0 above the design
  Vec3 normal = Vec3::UnitZ();
  double to_edge_mm = 0.0;  ///< along the surface to the nearest edge of the patch, to first order
};

/// The foot that Newton steps find from a ray near it, inside the unit square; nothing beyond the patch's
/// edge or the centre of curvature. However far the point lies from the design.
std::optional<Foot> foot_near(const stock::SurfaceDexels& dexels, uint32_t ray, const Vec3& point);

/// Finds feet by the nearest measuring ray (hashed cells of the grid) and Newton steps on the surface.
class DesignProjection {
 public:
  /// Parametric designs only. `reach_mm`: points farther from the design than this have no foot.
  DesignProjection(const stock::SurfaceDexels& dexels, double reach_mm);
  /// The foot inside the unit square, or nothing when the point is out of reach or beyond the edge.
  std::optional<Foot> project(const Vec3& point) const;

 private:
  using Cell = std::array<int32_t, 3>;
  struct CellHash {
    size_t operator()(const Cell& cell) const;
  };
  Cell cell_of(const Vec3& point) const;
  /// Index of the ray whose foot is nearest, among the cells around the point; -1: none.
  int64_t nearest_ray(const Vec3& point) const;

  const stock::SurfaceDexels& dexels_;
  double reach_mm_, cell_mm_;
  std::unordered_map<Cell, std::vector<uint32_t>, CellHash> cells_;
};

/// Bilinear height of the rays around (u,v), mm.
double height_at(const stock::SurfaceDexels& dexels, double u, double v);

/// Block that owns the ray nearest to (u,v); kUncut when it was never cut.
uint32_t block_at(const stock::SurfaceDexels& dexels, double u, double v);

}  // namespace swarf::measure
