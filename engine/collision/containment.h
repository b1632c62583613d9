// One body wholly inside the other, and how deep bodies stand in each other.
#pragma once

#include <memory>
#include <span>

#include "collision/closest_approach.h"
#include "mesh/signed_distance.h"

namespace swarf::collision {

/// Whether at these axis values some connected part of one body starts inside the other, which must be closed
/// (an open one holds nothing). Where the surfaces do not touch that part lies inside with all of it; and as
/// long as they do not touch it stays there or outside, so one look tells about the whole of a free motion.
bool one_holds_other(const Encounter& pair, const AxisValues& q);

/// Distances to the surface of a body.
class BodyDepth {
 public:
  explicit BodyDepth(const Body& body);
  /// How deep a point of the home drawing lies in the body, mm; 0 outside, and always in an open mesh. In a
  /// mesh whose shells overlap it is the depth in the one whose surface is nearest.
  double depth(const Vec3& point) const;
  /// The same inside; outside, how far the point lies from the body at least, below 0. -infinity where
  /// nothing has an inside.
  double signed_depth(const Vec3& point) const;
  /// No place of the points' hull lies deeper: by the distance of the points from the facet that is nearest
  /// to `middle`, of a convex mesh from the plane of any facet, and by the sides of the solids there.
  double hull_bound(const Vec3& middle, std::span<const Vec3> points) const;

 private:
  const mesh::SignedDistance* surface() const;

  const Body* body_;
  /// Made when it is first asked for: most bodies never touch another, and it takes most of their memory.
  struct Surface;
  std::shared_ptr<Surface> surface_;
};

struct Depth {
  double depth_mm = 0.0;
  Vec3 place_M = Vec3::Zero();
};

/// The deepest place of one's surface in the other at these axis values; none that is more than 0.01 mm
/// deeper where bodies have no more than some hundred facets there (overlap_bound.h: kStandingPieces).
Depth deepest_overlap(const Encounter& pair, const BodyDepth& in_a, const BodyDepth& in_b,
                      const AxisValues& q);

}  // namespace swarf::collision
