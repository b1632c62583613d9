// What a sweep can raise in one leaf at most. Internal to this folder.
//
// F, the cutter's implicit function, is convex: with its gradient g at any point Xm,  F(X) >= F(Xm) + g.(X -
// Xm). In the tool frame a voxel x of the leaf stands at X(t, x), linear in t and in x, so what the sweep
// writes there,
//   -min over t of F(X(t, x))  <=  max over t = 0, 1 of  -F(Xm) - g.(X(t, x) - Xm),
// lies below the greater of two linear functions of x; g may be the gradient of any face or round of the
// cutter, because each of them lies below F. With Xm = the leaf's centre at half time the bound is tight.
#pragma once

#include "stock/level_set/stock_grid_internal.h"
#include "stock/sweep/sweep_map.h"

namespace swarf::stock {

/// One convex piece of the cutter on one sweep.
struct SweptPiece {
  SweepMap map;
  const cutter::ConvexPiece* piece = nullptr;
};

/// Upper bound of what a swept piece writes near a point, mm: the greater of
///   start + start_slope . (x - point)  and  end + end_slope . (x - point).
struct LinearBound {
  double start = 0.0, end = 0.0;
  Vec3 start_slope, end_slope;
};
/// Two such bounds, of the two faces or rounds that lie outermost there: at a rim each is loose alone.
struct ReachBound {
  LinearBound of_face[2];
};
/// `start`, `end`: the point in the tool frame at both ends of the sweep.
ReachBound reach_bound(const SweptPiece& swept, const Vec3& start, const Vec3& end);

}  // namespace swarf::stock
