// Random sweeps and brute-force references shared by the stock tests.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/rng.h"
#include "stock/sweep/sweep.h"
#include "stock/sweep/sweep_map.h"

namespace swarf::stock {

inline std::string text(const Vec3& v) {
  return fmt::format("{{{:.17g}, {:.17g}, {:.17g}}}", v.x(), v.y(), v.z());
}
/// Ready to paste as a C++ initialiser.
inline std::string text(const Sweep& s) {
  return fmt::format("Sweep{{{{{}, {}}}, {{{}, {}}}, {}}}", text(s.start.tip_W), text(s.start.axis_W),
                     text(s.end.tip_W), text(s.end.axis_W), s.block);
}

/// `turn_rad` is the greatest turn of the axis; 0 gives translations.
inline Sweep random_sweep(Rng& rng, double place, double travel, double turn_rad) {
  Sweep sweep;
  sweep.start.tip_W = place * rng.direction() * rng.uniform();
  sweep.start.axis_W = rng.direction();
  sweep.end.tip_W = sweep.start.tip_W + travel * rng.direction() * rng.uniform();
  const Vec3 about = sweep.start.axis_W.cross(rng.direction()).normalized();
  const double turn = turn_rad * rng.uniform();
  sweep.end.axis_W = turn_rad == 0.0 ? sweep.start.axis_W
                                     : Vec3(Eigen::AngleAxisd(turn, about) * sweep.start.axis_W).normalized();
  return sweep;
}

/// F of the cutter for a point in its frame.
inline double cutter_value(const Vec3& X, const CutterSolid& cutter) {
  return std::max({X.head<2>().norm() - cutter.radius, -X.z(), X.z() - cutter.height});
}

/// A straight chain of sweeps of equal length from `from` to `to`.
inline std::vector<Sweep> straight_sweeps(const ToolPose& from, const ToolPose& to, int count) {
  std::vector<Sweep> sweeps;
  const auto pose = [&](int i) {
    const double t = static_cast<double>(i) / count;
    return ToolPose{(1.0 - t) * from.tip_W + t * to.tip_W,
                    Vec3((1.0 - t) * from.axis_W + t * to.axis_W).normalized()};
  };
  for (int i = 0; i < count; ++i) sweeps.push_back({pose(i), pose(i + 1), static_cast<uint32_t>(i)});
  return sweeps;
}

}  // namespace swarf::stock
