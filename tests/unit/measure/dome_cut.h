// A dome finished by iso-parametric passes, as level set and as surface dexels.
#pragma once

#include <memory>
#include <vector>

#include "stock/rays/surface_dexels.h"
#include "stock/stock.h"
#include "surface/polynomial.h"

namespace swarf::measure {

/// Flutes as long as the stock is high: shorter ones leave material hanging over the edges of the dome.
inline const stock::CutterSolid kCutter{5.0, 60.0};
inline const Box kDomeBox{{-55, -45, -10}, {55, 45, 45}};

/// DOME of theory 1.6.
inline surface::SurfacePtr dome() {
  const Vec3 zero = Vec3::Zero();
  return std::make_shared<surface::PolynomialSurface>(
      2, 2,
      std::vector<Vec3>{
          {-50, -40, 0}, {0, 80, 60}, {0, 0, -60}, {100, 0, 80}, zero, zero, {0, 0, -80}, zero, zero},
      1);
}

struct Passes {
  std::vector<stock::Sweep> sweeps;
  std::vector<int> pass_of_sweep;
};

/// Zigzag passes at constant v (along_u) or u, one sweep per `step` of the parameter, running `overrun`
/// beyond the surface on all sides.
inline Passes dome_passes(const surface::Surface& surface, bool along_u, int passes, double step,
                          double overrun) {
  Passes made;
  const int count = static_cast<int>((1.0 + 2.0 * overrun) / step);
  for (int pass = 0; pass < passes; ++pass) {
    const double across = -overrun + (1.0 + 2.0 * overrun) * pass / (passes - 1);
    const auto at = [&](int i) {
      const double t = -overrun + (1.0 + 2.0 * overrun) * (pass % 2 == 0 ? i : count - i) / count;
      const surface::Derivatives d =
          along_u ? surface.derivatives(t, across) : surface.derivatives(across, t);
      return ToolPose{d.S, surface::outward_normal(surface, d)};
    };
    for (int i = 0; i < count; ++i) {
      made.sweeps.push_back({at(i), at(i + 1), static_cast<uint32_t>(made.sweeps.size())});
      made.pass_of_sweep.push_back(pass);
    }
  }
  return made;
}

}  // namespace swarf::measure
