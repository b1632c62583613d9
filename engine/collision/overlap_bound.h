// How deep bodies stand in each other over ways of the axes: found, and proven.
//
// The depth of a place is how far it lies from the surface of the body that it is in; asked for is the
// greatest over the surface of each body in the other, at any instant. A branch and bound over pieces of a
// surface (triangles, patches of solids of revolution) and spans of time; of one of them no place is deeper
// than the least of
//
//   1. the depth of its middle at the middle of the time, and how far its places lie from there and move;
//   2. the distance of its corners, at both ends of the time, from the facet that is nearest to its middle
//      (from the plane of any facet, where the body is convex), and the sagitta of the motion: a distance to
//      a convex set is convex. So faces that are pressed into faces, and slides along them, cost no more than
//      their corners;
//   3. what any place can lie deep in the body (greatest_depth.h): a tool that goes through a block is at
//   most its
//      radius deep in it, whatever the way.
#pragma once

#include "collision/containment.h"
#include "collision/pair_walk.h"

namespace swarf::collision {

struct DepthRange {
  double seen_mm = 0.0;   ///< of a place that is that deep
  double bound_mm = 0.0;  ///< no place is deeper; `budget` spent: more than kDepthTolerance above `seen_mm`
  Vec3 place_M = Vec3::Zero();
  double at = 0.0;  ///< index of the pose there; 1.5: half way from the second to the third
};

/// mm between both, where the search comes to its end.
inline constexpr double kDepthTolerance = 0.01;

/// Pieces that are looked at for two bodies that stand still.
inline constexpr size_t kStandingPieces = 8192;

/// Over the ways from pose `first` to pose `last`. A mesh whose shells overlap has the depth of the shell
/// whose surface is nearest, and no proof. `budget`: pieces that are looked at, at most.
DepthRange depth_over(const Encounter& pair, const BodyDepth& in_a, const BodyDepth& in_b, PathStretch poses,
                      size_t first, size_t last, size_t budget);

}  // namespace swarf::collision
