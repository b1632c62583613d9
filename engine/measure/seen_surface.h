// Which points of the finished part the measuring rays of a parametric design have seen, and the deviation
// there. A ray sees the material between the design and where it ends on the ray: its own height, the walls
// of a gouge beside it and of what was left standing. Sides and bottom of the block no ray has seen.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "measure/design_projection.h"
#include "stock/rays/surface_dexels.h"

namespace swarf::measure {

struct Seen {
  Foot foot;
  double deviation_mm = 0.0;  ///< excess > 0
  bool on_face = false;       ///< on the machined face itself: the deviation is that of the rays
};

class SeenSurface {
 public:
  /// `slack_mm`: points of the part's surface are known to this, its mesh's error.
  SeenSurface(const stock::SurfaceDexels& dexels, double slack_mm);
  /// A point of the part's surface with its outward normal.
  std::optional<Seen> at(const Vec3& point, const Vec3& normal) const;

 private:
  using Cell = std::array<int32_t, 3>;
  struct CellHash {
    size_t operator()(const Cell& cell) const;
  };
  struct Place {
    Vec3 point;
    uint32_t ray;
  };
  Cell cell_of(const Vec3& point) const;
  void add(const Vec3& point, uint32_t ray) { cells_[cell_of(point)].push_back({point, ray}); }
  std::optional<uint32_t> nearest_ray(const Vec3& point) const;
  /// Least and greatest height of the rays around a foot, mm: of its cell and of those beside it, because a
  /// wall may stand anywhere between two rays and is known to the slack only.
  std::array<double, 2> heights_around(const Foot& foot) const;

  const stock::SurfaceDexels& dexels_;
  double slack_mm_, cell_mm_ = 0.0;
  std::unordered_map<Cell, std::vector<Place>, CellHash> cells_;  ///< along the rays, from design to material
};

}  // namespace swarf::measure
