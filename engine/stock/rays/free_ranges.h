// How far along its normal a ray answers for material: up to where another part of the design is nearer.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "stock/rays/ray_field.h"

namespace swarf::stock {

/// Points that a place sees under less than 15 degrees are no walls to it.
inline constexpr double kLeastWallSine = 0.25881904510252074;

/// Per ray of fields[which] the height up to which its foot is the nearest point of the whole design: the
/// radius of the ball that touches the design at the foot from outside and holds none of it (the medial
/// ball),
///   min over the design's points q of |q - p|^2 / (2 n.(q - p)),   n.(q - p) > sin(15 deg) |q - p|.
/// +infinity where the design turns away. In a slot each wall answers for the half on its side. The design's
/// points are the rays' feet, so the range is known to about the pitch; a foot closer to a concave corner
/// than half the pitch has range 0. Points that the ray sees under less than 15 degrees are left out: the
/// facets of a coarse mesh are no walls; so concave edges that turn by less than 30 degrees limit nothing.
std::vector<double> free_ranges(std::span<const RayFieldPtr> fields, size_t which);

/// The same range for any place of the design, between the feet too: never below the true one, and known to
/// about the pitch like that of the rays.
class FreeRange {
 public:
  struct Range {
    double mm;  ///< +infinity: nothing limits it
    Vec3 wall;  ///< the point of the design that does
  };

  explicit FreeRange(std::span<const RayFieldPtr> fields);
  ~FreeRange();
  FreeRange(FreeRange&&) noexcept;
  Range operator()(const Vec3& point, const Vec3& normal) const;

 private:
  std::vector<RayFieldPtr> fields_;
  std::unique_ptr<const class DesignTree> tree_;
};

}  // namespace swarf::stock
