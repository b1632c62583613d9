// A ray against the sweep of one convex piece, for any profile and any motion. Internal to this folder.
//
// In the tool frame the ray's point at height s stands, at instant t, at X(t, s) = P + t D + s N(t), with
// N(t) = N0 + t (N1 - N0). phi(s) = min over t of F(X(t, s)) is the distance of the sweep; its lowest root is
// sought from below by Newton's method with a slope that cannot overshoot:
//   Let n be the mean gradient at phi(s0) (convex_motion.h). F is convex in space and n is perpendicular to
//   the motion (or the motion ends there), so for every t and every s >= s0
//     F(X(t, s)) >= floor(s0) + (s - s0) n . N(t) >= floor(s0) + (s - s0) min(n . N0, n . N1).
//   The step to the root of the right-hand side stays below the sweep; where the slope is not negative the
//   ray misses it. For a translation N0 = N1: this is Newton's method on a convex function, monotone and of
//   second order. With a turn theta the error shrinks by a factor of about theta per step; where that is too
//   slow (grazing rays, long turns) the motion is split into halves, whose slopes lie closer together.
#pragma once

#include "cutter/convex_piece.h"
#include "stock/sweep/sweep_map.h"

namespace swarf::stock {

/// Lowest s in the sweep of the piece, within 1e-7 mm (1e-10 unless the ray grazes); +infinity when the ray
/// misses it or meets it above `highest` only.
double lowest_in_sweep(const cutter::ConvexPiece& piece, const Vec3& point, const Vec3& direction,
                       const SweepMap& map, double highest);

}  // namespace swarf::stock
