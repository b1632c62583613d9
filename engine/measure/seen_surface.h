// Which points of the finished part the measuring rays of a parametric design have seen, and the deviation
// there. A ray sees the material between the design and where it ends on the ray: its own height, the walls
// of a gouge beside it and of what was left standing; and what hangs above a gap. Sides and bottom of the
// block no ray has seen.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "measure/design_projection.h"
#include "stock/rays/surface_dexels.h"

namespace swarf::measure {

/// A point belongs to a machined face only if its own normal agrees with the design's: not a side wall near
/// it.
inline constexpr double kFaceCosine = 0.8;

struct Seen {
  Foot foot;
  double deviation_mm = 0.0;  ///< excess > 0; off the face the point's own height over its foot
  bool on_face = false;       ///< on the machined face itself: the deviation is that of the rays
};

class SeenSurface {
 public:
  /// `slack_mm`: points of the part's surface are known to this, its mesh's error.
  SeenSurface(const stock::SurfaceDexels& dexels, double slack_mm);
  /// A point of the part's surface with its outward normal.
  std::optional<Seen> at(const Vec3& point, const Vec3& normal) const;
  /// The foot of a point near a ray's material.
  std::optional<Foot> foot_of(const Vec3& point) const;
  double slack_mm() const { return slack_mm_; }
  const stock::SurfaceDexels& dexels() const { return dexels_; }

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
  void add(uint32_t ray, double low_mm, double high_mm);
  /// Of those in the point's cell and beside it; of several the first.
  std::optional<uint32_t> nearest_ray(const Vec3& point) const;
  /// Least height and highest material of the rays around a foot, mm: of its cell and of those beside it,
  /// because a wall may stand anywhere between two rays and is known to the slack only.
  std::array<double, 2> heights_around(const Foot& foot) const;

  const stock::SurfaceDexels& dexels_;
  double slack_mm_, cell_mm_ = 0.0;
  std::vector<double> tops_mm_;                                   ///< of each ray: above gaps too
  std::unordered_map<Cell, std::vector<Place>, CellHash> cells_;  ///< along the rays, from design to material
  Cell first_cell_, last_cell_;                                   ///< of a box around all of them
};

}  // namespace swarf::measure
