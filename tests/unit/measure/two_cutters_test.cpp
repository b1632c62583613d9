// Cusps between passes of two cutters: each height comes from the cutter of its own sweep.
#include <gtest/gtest.h>

#include "base/units.h"
#include "measure/measure.h"
#include "test_surfaces.h"

namespace swarf::measure {
namespace {

/// Height of the cusp between a ball of radius a over y = 0 and one of radius b over y = interval, both on
/// the plane z = 0: a - sqrt(a^2 - y^2) = b - sqrt(b^2 - (interval - y)^2).
double cusp_of_two_balls(double a, double b, double interval) {
  const auto height = [](double r, double y) { return r - std::sqrt(r * r - y * y); };
  double low = 0.0, high = interval;
  for (int i = 0; i < 100; ++i) {
    const double y = 0.5 * (low + high);
    (height(a, y) < height(b, interval - y) ? low : high) = y;
  }
  return height(a, low);
}

TEST(TwoCutters, AlternatingBallsLeaveTheCuspOfBoth) {
  constexpr double kInterval = 1.2, kA = 5.0, kB = 3.0;
  constexpr int kPasses = 9;
  const Passes passes = passes_along(
      [](int pass, double t) {
        return ToolPose{{-4.0 + 8.0 * t, (pass - kPasses / 2) * kInterval + 0.077, 0.0}, Vec3::UnitZ()};
      },
      kPasses, 10);
  const std::vector<stock::CutterSolid> solids{ball(kA, 60.0), ball(kB, 60.0)};
  std::vector<int> tools;
  for (const int pass : passes.pass_of_sweep) tools.push_back(pass % 2);
  const Box box{{-30, -30, -60}, {30, 30, 60}};
  stock::SurfaceDexels dexels(std::make_shared<Paraboloid>(0.0, 0.0, 3.0), 0.2, box);
  for (const stock::Sweep& sweep : passes.sweeps) {
    dexels.cut(std::span(&sweep, 1), solids[static_cast<size_t>(tools[sweep.block])]);
  }
  std::vector<Ridge> ridges;
  const SurfaceMetrics metrics = measure_surface(dexels, passes.sweeps, passes.pass_of_sweep,
                                                 SweepCutters(solids, tools), {1.0, 1e-4}, &ridges);
  EXPECT_LT(metrics.gouge_max_um, 1e-6);
  ASSERT_GT(ridges.size(), 100U);
  const double expected = um_from_mm(cusp_of_two_balls(kA, kB, kInterval));
  // One radius for both would give 36.06 or 60.61 um.
  for (const Ridge& ridge : ridges) {
    ASSERT_NEAR(ridge.height_um, expected, 1e-4 * expected) << ridge.point.transpose();
  }
}

}  // namespace
}  // namespace swarf::measure
