// A ray against one sweep: the lowest point of the ray that the cutter passes through; in closed form for the
// flat end mill, by the certified search of convex_ray.h for every other piece.
//
// In the tool frame the point at height s above the design stands, at instant t, at
//   X(t, s) = P + t D + s N + t s E        (E = 0 for a translation)
// and the sweep removes the set of (t, s) with |X_xy| <= radius, 0 <= X_z <= height, 0 <= t <= 1. Its lowest
// s lies at one of a few points: an end of the motion (t = 0 or 1); where the ray passes through the rim of
// the bottom or top disc; where it grazes the flank. For a translation the set is convex and each of these is
// a linear or quadratic equation, exact. With rotation t s E is linearised about the candidate itself and
// solved again (Newton's method), so the result is exact for the
// sweep's own definition, which differs from the rigid motion by motion_bound.
#pragma once

#include <limits>

#include "stock/sweep/sweep.h"
#include "stock/sweep/sweep_map.h"

namespace swarf::stock {

/// As ray_height(point, normal, sweep, cutter) with the sweep's map made beforehand. What lies above
/// `highest` may be told as a miss.
double ray_height(const Vec3& point, const Vec3& normal, const SweepMap& map, const CutterSolid& cutter,
                  double highest = std::numeric_limits<double>::infinity());

/// The part of a ray that the sweep of one convex piece covers, mm along the normal.
struct RayInterval {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  bool hit() const { return low <= high; }
};

/// Lowest and highest point of the ray in the sweep, each as exact as ray_height. For a translation all
/// between them is covered; a turn of the axis can leave a gap, because its sweep need not be convex.
RayInterval ray_interval(const Vec3& point, const Vec3& normal, const SweepMap& map,
                         const cutter::ConvexPiece& piece);

}  // namespace swarf::stock
