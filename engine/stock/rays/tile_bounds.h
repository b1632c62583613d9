// Bounds that rule a sweep out for a whole tile of rays. Internal to this folder.
#pragma once

#include <algorithm>
#include <limits>

#include "stock/rays/ray_field.h"
#include "stock/sweep/sweep.h"
#include "stock/sweep/sweep_map.h"

namespace swarf::stock {

/// Bounds are compared with this slack, so that their own rounding never decides; mm.
inline constexpr double kBoundSlack = 1e-9;

/// From here down a cut may be a mere touch (ray_cut.h), mm below the design; above, a touch changes nothing
/// that is measured.
inline constexpr double kNoteworthy = 1e-3;

/// Consecutive sweeps with a bound of how far their poses lie from the middle one.
struct SweepRun {
  size_t begin = 0, end = 0;
  Mat3 Rt = Mat3::Identity();
  Vec3 tip = Vec3::Zero();
  double tip_spread = 0.0, axis_spread = 0.0;  ///< mm; |axis - axis of the middle|
  double rise = 0.0;                           ///< of a tip below the middle one along the middle axis, mm
};

/// From which to which s some rays of a tile have material; none when low > high.
struct Extent {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  bool empty() const { return !(low <= high); }
};

/// A ball that holds all points of the tile's rays in an extent.
struct Ball {
  Vec3 centre;
  double radius;
};
Ball ball_around(const RayTile& tile, const Extent& extent);

/// Distance to the standing cutter's cylinder from a point in its frame; 1-Lipschitz.
inline double cutter_distance(const Vec3& X, const CutterSolid& cutter) {
  return std::max({X.head<2>().norm() - cutter.radius, -X.z(), X.z() - cutter.height});
}

inline bool run_misses(const SweepRun& run, const Ball& ball, const CutterSolid& cutter) {
  const Vec3 offset = ball.centre - run.tip;
  const double spread = run.tip_spread + run.axis_spread * offset.norm();
  return cutter_distance(run.Rt * offset, cutter) - spread > ball.radius + kBoundSlack;
}

inline bool sweep_misses(const SweepMap& map, const Ball& ball, const CutterSolid& cutter) {
  const Vec3 X = map.start(ball.centre);
  const double travel = (map.end(ball.centre) - X).norm();
  return cutter_distance(X, cutter) - travel > ball.radius + kBoundSlack;
}

/// The standing cutter holds the ball, its bottom aside, at both ends of the sweep: what of the tile's rays
/// lies above the bottom plane is gone.
inline bool disc_holds(const SweepMap& map, const Ball& ball, const CutterSolid& cutter) {
  constexpr double kProbe = 1e-5;  // mm; rays are asked a little above where they are cut (cut_from)
  const Vec3 X = map.start(ball.centre), Y = map.end(ball.centre);
  const double reach = ball.radius + kProbe, beside = cutter.radius - reach;
  return beside > 0.0 && std::max(X.head<2>().squaredNorm(), Y.head<2>().squaredNorm()) < beside * beside &&
         std::max(X.z(), Y.z()) + reach < cutter.height;
}

/// The bottom planes of all the run's sweeps leave more than `highest` on every ray of the tile, which all
/// leave on the tool's side.
bool run_above(const RayTile& tile, const SweepRun& run, double highest);

/// The bottom plane leaves more than `highest` on every ray of the tile, which all leave on the tool's side.
bool plane_above(const RayTile& tile, const SweepMap& map, double highest);

/// The same for any cutter: no piece comes down to the rays' material, by the tangent plane of its sweep at
/// the tile.
bool pieces_above(const RayTile& tile, const SweepMap& map, const CutterSolid& cutter, double highest);

/// All points of the tile's rays in the extent lie beyond the cutter's top, at both ends of the sweep.
bool beyond_top(const RayTile& tile, const SweepMap& map, const Extent& extent, double cutter_height);

}  // namespace swarf::stock
