// What pictures colour: the face, walls and bottom of a gouge, what was left standing; never the block's
// sides.
#include "measure/seen_surface.h"

#include <gtest/gtest.h>

#include <memory>

#include "stock/rays/surface_dexels.h"
#include "surface/analytic.h"

namespace swarf::measure {
namespace {

constexpr double kDepth = 0.828, kSlack = 0.12;  // mm; 0.6 voxels of 0.2
const stock::CutterSolid kDrill{1.0, 25.0}, kMill{5.0, 25.0};

/// z = 0 over 20 x 20 under 3 mm of stock: faced for x < 5, a hole of D2 at (-3, 0), the rest stands.
stock::SurfaceDexels drilled_plane() {
  const auto plane =
      std::make_shared<surface::PlaneSurface>(Vec3(-10, -10, 0), Vec3(20, 0, 0), Vec3(0, 20, 0));
  stock::SurfaceDexels dexels(plane, 0.2, {{-10, -10, -8}, {10, 10, 3}});
  std::vector<stock::Sweep> rows;
  for (double y = -10.0; y <= 10.0; y += 4.0)
    rows.push_back(
        {{{-20, y, 0}, Vec3::UnitZ()}, {{0, y, 0}, Vec3::UnitZ()}, static_cast<uint32_t>(rows.size())});
  dexels.cut(rows, kMill);
  const std::vector<stock::Sweep> hole{{{{-3, 0, 5}, Vec3::UnitZ()}, {{-3, 0, -kDepth}, Vec3::UnitZ()}, 100}};
  dexels.cut(hole, kDrill);
  return dexels;
}

TEST(SeenSurface, GougesHaveTheirDepthAndTheBlockNone) {
  const stock::SurfaceDexels dexels = drilled_plane();
  const SeenSurface seen(dexels, kSlack);
  const auto deviation = [&](const Vec3& point, const Vec3& normal) {
    const auto here = seen.at(point, normal);
    return here ? here->deviation_mm : -1e9;
  };
  const Vec3 up = Vec3::UnitZ(), in = Vec3::UnitX();
  EXPECT_NEAR(deviation({-3.1, 0.1, -kDepth + 0.05}, up), -kDepth, 1e-9) << "the rays' own height";
  EXPECT_NEAR(deviation({-3, 0, -kDepth}, up), -kDepth, 1e-9);
  EXPECT_NEAR(deviation({-4, 0, -0.4}, in), -0.4, 1e-9) << "the wall of the hole";
  EXPECT_NEAR(deviation({-3, 1, -0.7}, -Vec3::UnitY()), -0.7, 1e-9);
  EXPECT_NEAR(deviation({2, 2, 0.01}, up), 0.0, 1e-9);
  EXPECT_NEAR(deviation({8, 1, 3}, up), 3.0, 1e-9) << "never cut";
  EXPECT_NEAR(deviation({5, 0, 1.5}, -in), 1.5, 1e-9) << "the wall of what stands";
  EXPECT_FALSE(seen.at({0, 0, -8}, -up).has_value()) << "the block's bottom";
  EXPECT_FALSE(seen.at({-10, 0, -4}, -in).has_value()) << "its side";
  EXPECT_FALSE(seen.at({-10, 5, -0.05}, -in).has_value()) << "its side, beside the face";
}

}  // namespace
}  // namespace swarf::measure
