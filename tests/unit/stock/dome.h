// DOME, the reference surface of theory 1.6, and passes over it with the axis on the normal.
#pragma once

#include <memory>
#include <vector>

#include "stock/sweep/sweep.h"
#include "surface/polynomial.h"

namespace swarf::stock {

/// z = 80u - 80u^2 + c v - c v^2 over x = 100u - 50, y = 80v - 40; DOME has c = 60.
inline surface::SurfacePtr dome(double c = 60.0) {
  const Vec3 zero = Vec3::Zero();
  return std::make_shared<surface::PolynomialSurface>(
      2, 2,
      std::vector<Vec3>{
          {-50, -40, 0}, {0, 80, c}, {0, 0, -c}, {100, 0, 80}, zero, zero, {0, 0, -80}, zero, zero},
      1);
}

inline ToolPose dome_pose(const surface::Surface& surface, double u, double v) {
  const surface::Derivatives d = surface.derivatives(u, v);
  return {d.S, surface::outward_normal(surface, d)};
}

/// Zigzag passes v = const between v_low and v_high, u from -0.02 to 1.02; nothing is swept between passes.
inline std::vector<Sweep> dome_passes(double v_low, double v_high, int passes, int sweeps_per_pass) {
  const surface::SurfacePtr surface = dome();
  std::vector<Sweep> sweeps;
  for (int pass = 0; pass < passes; ++pass) {
    const double v = v_low + (v_high - v_low) * pass / std::max(1, passes - 1);
    const auto at = [&](int i) {
      const double t = static_cast<double>(i) / sweeps_per_pass;
      return dome_pose(*surface, -0.02 + 1.04 * (pass % 2 == 0 ? t : 1.0 - t), v);
    };
    for (int i = 0; i < sweeps_per_pass; ++i) {
      sweeps.push_back({at(i), at(i + 1), static_cast<uint32_t>(sweeps.size())});
    }
  }
  return sweeps;
}

}  // namespace swarf::stock
