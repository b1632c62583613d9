// A point that passes a convex piece on a straight line X(t) = P + t D of the tool's frame: where it comes
// nearest, in double precision and with a certificate. Internal to this folder.
//
// F is convex in space (convex_piece.h), so every point X_k of the line gives a tangent that lies below F:
//   F(t) >= F(X_k) + (t - t_k) n_k . D,          n_k = gradient of F at X_k (where F has a kink: one of them)
// A bracket whose tangents fall towards each other holds the minimum between their crossing (a lower bound,
// `floor`) and the least F met so far. Three kinds of step shrink it in turn: to the crossing of the tangents
// (exact for kinks), to the zero of the slope's secant (exact for parabolas), to the middle (halves the
// bracket, so the number of steps is bounded whatever the profile).
#pragma once

#include "base/frames.h"
#include "cutter/convex_piece.h"

namespace swarf::stock {

struct Nearest {
  double t = 0.0;
  double value = 0.0;  ///< F at t, mm: never below the minimum
  double floor = 0.0;  ///< mm: never above the minimum; value - floor <= the gap asked for
  /// The mean of gradients whose slope along the motion is zero (or points out of the interval at its end),
  /// so F(X) >= floor + normal . (X - X(t)) for every X = X(t') + any offset. Not longer than 1; tool frame.
  Vec3 normal = Vec3::Zero();
};

/// mm; about a hundred roundings of coordinates of 100 mm.
inline constexpr double kNearestGap = 1e-12;

/// Least F over t_low <= t <= t_high; value - floor <= gap_mm.
Nearest nearest_instant(const cutter::ConvexPiece& piece, const Vec3& P, const Vec3& D, double t_low = 0.0,
                        double t_high = 1.0, double gap_mm = kNearestGap);

}  // namespace swarf::stock
