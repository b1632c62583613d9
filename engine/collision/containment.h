// One body wholly inside the other, and how deep bodies stand in each other.
#pragma once

#include <limits>
#include <memory>

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
  /// A point whose distance to the mesh was looked up.
  struct Looked {
    Vec3 point = Vec3::Zero();
    double to_surface_mm = std::numeric_limits<double>::infinity();
  };
  /// depth() where it is more than `least`, else anything from 0 to it. Most points need no search for the
  /// nearest surface: none is deeper than the body's box is there, and from the last point on the distance
  /// grows no faster than the way to it.
  double depth_beyond(double least, const Vec3& point, Looked& last) const;

 private:
  const Body* body_;
  /// Made when it is first asked for: most bodies never touch another, and it takes most of their memory.
  struct Surface;
  std::shared_ptr<Surface> surface_;
};

struct Depth {
  double depth_mm = 0.0;
  Vec3 place_M = Vec3::Zero();
};

/// A measure of the overlap at these axis values: how deep the deepest corner of one body lies in the other.
/// Corners are those of triangles, and eight points on each circle of a solid of revolution. It falls short
/// of the overlap where edges cross and no corner lies inside, and is 0 then. `least`: what is no deeper, mm,
/// is not looked for, and 0 then.
Depth overlap_depth(const Encounter& pair, const BodyDepth& in_a, const BodyDepth& in_b, const AxisValues& q,
                    double least = 0.0);

}  // namespace swarf::collision
