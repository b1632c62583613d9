#include "stock/rays/tile_bounds.h"

#include <algorithm>
#include <cmath>

#include "stock/sweep/convex_motion.h"

namespace swarf::stock {
namespace {

/// Lowest height that the bottom plane of one pose can leave in the tile, or -infinity where the bound does
/// not apply. For feet below the plane s = -a.(x - tip) / (a.n) >= -a.(x - tip), because a.n <= 1.
double plane_bound(const RayTile& tile, const Vec3& axis, const Vec3& tip) {
  const Vec3 a = tile.frame * axis;
  const bool tool_side = a.z() > tile.normal_spread;  // a.n > 0 for every ray of the tile
  if (!tool_side) return -std::numeric_limits<double>::infinity();
  const double nearest =
      axis.dot(tile.origin - tip) + a.cwiseProduct(tile.low).cwiseMax(a.cwiseProduct(tile.high)).sum();
  return nearest <= 0.0 ? -nearest : -std::numeric_limits<double>::infinity();
}

/// Least z in the tool frame of the tile's points in the extent: foot + s n, |n - mean normal| <= spread.
double lowest_z(const RayTile& tile, const Vec3& axis, const Vec3& tip, const Extent& extent) {
  const Vec3 a = tile.frame * axis;
  const double foot =
      axis.dot(tile.origin - tip) + a.cwiseProduct(tile.low).cwiseMin(a.cwiseProduct(tile.high)).sum();
  const auto along = [&](double s) { return s * a.z() - std::abs(s) * tile.normal_spread; };
  return foot + std::min(along(extent.low), along(extent.high));
}

}  // namespace

Ball ball_around(const RayTile& tile, const Extent& extent) {
  const double low = tile.low.z() + extent.low, high = tile.high.z() + extent.high;
  const Vec3 feet = 0.5 * (tile.low + tile.high);
  const Vec3 local(feet.x(), feet.y(), 0.5 * (low + high));
  const double sideways =
      std::hypot(0.5 * (tile.high.x() - tile.low.x()), 0.5 * (tile.high.y() - tile.low.y()));
  const double fan = tile.normal_spread * std::max(std::abs(extent.low), std::abs(extent.high));
  return {tile.origin + tile.frame.transpose() * local, std::hypot(sideways + fan, 0.5 * (high - low) + fan)};
}

bool pieces_above(const RayTile& tile, const SweepMap& map, const CutterSolid& cutter, double highest) {
  // The box of the rays' points at the material's top, or at the design where the top lies below that.
  const double s = std::max(highest, 0.0), fan = s * tile.normal_spread;
  const Vec3 half = 0.5 * (tile.high - tile.low) + Vec3::Constant(fan);
  const Vec3 middle =
      tile.origin + tile.frame.transpose() * (0.5 * (tile.low + tile.high) + Vec3(0.0, 0.0, s));
  const Vec3 start = map.start(middle), way = map.end(middle) - start;
  return std::all_of(cutter.pieces.begin(), cutter.pieces.end(), [&](const cutter::ConvexPiece& piece) {
    const Nearest nearest = nearest_instant(piece, start, way);
    // F >= floor + n . (X - X(t)); X - X(t) is a mean of both ends' rotations of the same offset. Down the
    // rays F must not fall.
    const auto least = [&](const Mat3& Rt) {
      const Vec3 n = tile.frame * (Rt.transpose() * nearest.normal);
      const bool rises_downward = n.z() + tile.normal_spread <= 0.0;
      return rises_downward ? -n.cwiseAbs().dot(half) : -std::numeric_limits<double>::infinity();
    };
    return nearest.floor + std::min(least(map.R0t), least(map.R1t)) > kBoundSlack;
  });
}

bool run_above(const RayTile& tile, const SweepRun& run, double highest) {
  const Vec3 axis = run.Rt.row(2).transpose(), a = tile.frame * axis;
  if (a.z() <= tile.normal_spread + run.axis_spread) return false;
  // plane_bound of any pose of the run: axis' . (x - tip') <= axis . (x - tip) + |axis' - axis| |x - tip'|
  // + axis . (tip - tip').
  const Vec3 half = 0.5 * (tile.high - tile.low);
  const Vec3 offset = tile.frame * (tile.origin - run.tip) + tile.low + half;
  const double farthest = offset.norm() + half.norm() + run.tip_spread;
  const double nearest = a.dot(offset) + a.cwiseAbs().dot(half) + run.axis_spread * farthest + run.rise;
  return nearest <= 0.0 && -nearest > highest + kBoundSlack;
}

bool plane_above(const RayTile& tile, const SweepMap& map, double highest) {
  return std::min(plane_bound(tile, map.R0t.row(2).transpose(), map.tip0),
                  plane_bound(tile, map.R1t.row(2).transpose(), map.tip1)) > highest + kBoundSlack;
}

bool beyond_top(const RayTile& tile, const SweepMap& map, const Extent& extent, double cutter_height) {
  return std::min(lowest_z(tile, map.R0t.row(2).transpose(), map.tip0, extent),
                  lowest_z(tile, map.R1t.row(2).transpose(), map.tip1, extent)) > cutter_height + kBoundSlack;
}

}  // namespace swarf::stock
