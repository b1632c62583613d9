// The share of a sweep in which a piece of the cutter comes near a leaf. A kernel that looks at no more than
// this handles coordinates as large as the cutter, however long the sweep is, and rounds accordingly.
// Internal to this folder.
#pragma once

#include <algorithm>

#include "base/frames.h"
#include "cutter/convex_piece.h"

namespace swarf::stock {

/// From which to which t of the sweep.
struct Window {
  double low = 0.0, high = 1.0;
  bool empty() const { return !(low <= high); }
  void clip(double a, double b) {
    low = std::max(low, std::min(a, b));
    high = std::min(high, std::max(a, b));
  }
  static Window nothing() { return {1.0, 0.0}; }
};

/// The bounds of reach are taken this much wider, mm: more than the rounding of the floats they decide about.
inline constexpr double kReachSlack = 1e-3;

/// The time in which P + t D lies within `reach` of the cylinder around the piece.
Window time_in_reach(const cutter::ConvexPiece& piece, const Vec3& P, const Vec3& D, double reach);

/// From a leaf's centre to its farthest voxel, mm.
double leaf_radius(double voxel_mm);

/// A sweep of a plain cylinder is shortened where its ends lie farther away than this many times the reach.
inline constexpr double kFarFactor = 2.0;

/// Bound on the error of a voxel's distance to a plain cylinder's sweep, mm, for sweeps of any length. With M
/// the greatest distance of a voxel that the kernel looks at from the axis and along it and u = 6e-8 half the
/// spacing of floats at 1:
///   16 u M  positions: start and change are rounded, then joined (11 roundings in each direction)
///   32 u M  the place nearest to the axis and the way on (sweep_distance.h). No terms of s cancel, so that
///           s rise, which is no more than the depth it stands for, has 11 roundings. `along` is 4 u L |D_xy|
///           off, and s rise by 8 u L for it, because b + sqrt(d) >= |D_xy| times that depth. Radius, rho and
///           sums: 6. From (sqrt(d) - b) / (a - rise^2), where rise <= |D_xy| / 2: 8 u sqrt(d) rise / (a -
///           rise^2)
///           <= 20 u M, with the others 30.
double cylinder_kernel_error_mm(const cutter::ConvexPiece& piece, double voxel_mm, double band_mm);

}  // namespace swarf::stock
