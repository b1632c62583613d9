#include "stock/sweep/sweep.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "cutter/cutting_pieces.h"
#include "stock/sweep/sweep_map.h"

namespace swarf::stock {
namespace {

/// How far the cutter at `pose` lies from the sweep at its best matching instant: the tip's distance plus the
/// axis's deviation at the end of the lever. Both are linear in t, so the instant is a quadratic's minimum.
double deviation(const SweepMap& map, const ToolPose& pose, double lever_mm) {
  const Vec3 tip_start = map.start(pose.tip_W);
  const Vec3 tip_change = map.end(pose.tip_W) - tip_start;
  const Vec3 axis_start = map.R0t * pose.axis_W - Vec3::UnitZ();
  const Vec3 axis_change = map.R1t * pose.axis_W - map.R0t * pose.axis_W;
  const double lever2 = lever_mm * lever_mm;
  const double slope = tip_start.dot(tip_change) + lever2 * axis_start.dot(axis_change);
  const double bend = tip_change.squaredNorm() + lever2 * axis_change.squaredNorm();
  const double t = bend > 0.0 ? std::clamp(-slope / bend, 0.0, 1.0) : 0.0;
  return (tip_start + t * tip_change).norm() + lever_mm * (axis_start + t * axis_change).norm();
}

/// Greatest deviation of the poses between `first` and `last`; stops at the first above the tolerance.
double chain_deviation(std::span<const ToolPose> poses, size_t first, size_t last, double lever_mm,
                       double tolerance_mm) {
  const SweepMap map = sweep_map({poses[first], poses[last], 0});
  double worst = 0.0;
  for (size_t k = first + 1; k < last && worst <= tolerance_mm; ++k) {
    worst = std::max(worst, deviation(map, poses[k], lever_mm));
  }
  return worst;
}

/// The farthest pose up to `limit` that one sweep from `first` reaches within the tolerance: doubled until it
/// fails, then bisected. Every accepted end has been checked against all the poses it skips.
size_t reach(std::span<const ToolPose> poses, size_t first, size_t limit, double lever_mm,
             double tolerance_mm) {
  const auto fits = [&](size_t last) {
    return chain_deviation(poses, first, last, lever_mm, tolerance_mm) <= tolerance_mm;
  };
  size_t good = first + 1;
  size_t step = 1;
  while (good < limit && fits(std::min(good + step, limit))) {
    good = std::min(good + step, limit);
    step *= 2;
  }
  size_t bad = std::min(good + step, limit + 1);
  while (bad - good > 1) {
    const size_t middle = good + (bad - good) / 2;
    (fits(middle) ? good : bad) = middle;
  }
  return good;
}

}  // namespace

CutterSolid::CutterSolid(double flat_radius, double flute_height)
    : radius(flat_radius),
      height(flute_height),
      pieces{cutter::ConvexPiece::cylinder(flat_radius, flute_height)} {}

CutterSolid::CutterSolid(const cutter::Cutter& cutter)
    : radius(0.0), height(cutter.flute_length_mm), pieces(cutter::cutting_pieces(cutter)) {
  for (const cutter::ConvexPiece& piece : pieces) radius = std::max(radius, piece.radius);
}

MergedSweeps merge_sweeps(std::span<const ToolPose> poses, std::span<const uint8_t> breaks, double lever_mm,
                          double tolerance_mm) {
  SWARF_CHECK(breaks.size() == poses.size(), "one break flag per pose");
  MergedSweeps merged;
  double tick_bound = 0.0, chain_bound = 0.0;
  for (size_t i = 1; i < poses.size(); ++i) {
    if (!breaks[i]) {
      tick_bound = std::max(tick_bound, motion_bound({poses[i - 1], poses[i], 0}, lever_mm));
    }
  }
  for (size_t first = 0; first + 1 < poses.size();) {
    if (breaks[first + 1]) {
      ++first;
      continue;
    }
    size_t limit = first + 1;
    while (limit + 1 < poses.size() && !breaks[limit + 1]) ++limit;
    while (first < limit) {
      const size_t last = reach(poses, first, limit, lever_mm, tolerance_mm);
      chain_bound = std::max(chain_bound, chain_deviation(poses, first, last, lever_mm, tolerance_mm));
      merged.sweeps.push_back({poses[first], poses[last], static_cast<uint32_t>(last)});
      first = last;
    }
  }
  merged.error_bound_mm = chain_bound + tick_bound;
  return merged;
}

}  // namespace swarf::stock
