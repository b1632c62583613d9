// Independent checks of a surface before anything may move over it.
#pragma once

#include <optional>
#include <vector>

#include "surface/polynomial.h"

namespace swarf::program {

/// |Su x Sv| below this share of max|Su| max|Sv| counts as zero: with the search's last step of 1e-12 in the
/// parameters, rounding stays well below it, while no surface that a cutter can follow comes near it.
inline constexpr double kDegenerateShare = 1e-9;
/// Largest distance, mm, between a Bezier net and the power basis made from it (1 nm; gouges are told to 50
/// nm).
inline constexpr double kBezierToleranceMm = 1e-6;

struct WeakSpot {
  double u = 0.0, v = 0.0;
  bool finite = true;  ///< false: a derivative at (u,v) overflows
};

/// Where |Su x Sv| vanishes on the unit square, its edges included; nothing when the surface is regular.
///
/// 1. Grid of 8 cells per degree along each parameter, at least 32 and at most 128: the share q = |Su x Sv| /
/// (max|Su| max|Sv|).
/// 2. From each local minimum of q below a tenth of its maximum, and from both ends of each cell edge over
///    which Su x Sv turns by more than 90 degrees (a fold), a compass search over 8 neighbours with halving
///    steps.
/// Limit: an isolated zero between grid points whose neighbourhood is narrower than a cell can be missed.
std::optional<WeakSpot> find_degenerate_point(const surface::PolynomialSurface& surface);

/// Largest distance, mm, on a 9 x 9 grid between `surface` and de Casteljau's point of the control net it was
/// made from: what the conversion to the power basis lost.
double bezier_conversion_error(const surface::PolynomialSurface& surface,
                               const std::vector<Vec3>& control_points);

}  // namespace swarf::program
