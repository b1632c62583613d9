// theory 6: a skew cylinder stands still, the work turns about z through 360 degrees; the core that remains
// is known in closed form. Seen from the work, the cutter goes round, axis and all: true five-axis flank
// cutting.
#include <gtest/gtest.h>

#include <limits>

#include "base/units.h"
#include "cutter_shapes.h"
#include "stock/rays/surface_dexels.h"
#include "stock/stock.h"
#include "stock_test_support.h"

namespace swarf::stock::hyperboloid_test {
namespace {

constexpr double kDistance = 30.0, kSkew = 20.0, kRadius = 5.0, kTipAt = -20.0;
const CutterSolid kCutter{kRadius, 80.0};

std::vector<Sweep> full_turn(int sweeps) {
  const double g = rad_from_deg(kSkew);
  const auto pose = [&](int i) {
    const Mat3 turn = Eigen::AngleAxisd(2.0 * kPi * i / sweeps, Vec3::UnitZ()).toRotationMatrix();
    const Vec3 axis(0, std::sin(g), std::cos(g));
    return ToolPose{turn * (Vec3(kDistance, 0, 0) + kTipAt * axis), turn * axis};
  };
  std::vector<Sweep> made;
  for (int i = 0; i < sweeps; ++i) made.push_back({pose(i), pose(i + 1), static_cast<uint32_t>(i)});
  return made;
}

/// Greatest distance of the remaining core from the exact one at height z, mm.
double core_error(double z, double rho) {
  Stock stock({{-31, -31, z - 2.0}, {31, 31, z + 2.0}}, 0.1);
  constexpr int kSweeps = 720;
  const std::vector<Sweep> sweeps = full_turn(kSweeps);
  stock.cut(sweeps, kCutter);
  double worst = 0.0;
  for (int i = 0; i < 500; ++i) {
    const double angle = 2.0 * kPi * i / 500.0;
    worst = std::max(worst, std::abs(stock.distance_mm({rho * std::cos(angle), rho * std::sin(angle), z})));
  }
  return worst;
}

TEST(Hyperboloid, CoreRadiusAtTheOracleHeights) {
  EXPECT_LT(core_error(0.0, 25.0), 0.01);
  EXPECT_LT(core_error(9.602891161, 25.198577496), 0.01);
  EXPECT_LT(core_error(38.334330944, 28.028236159), 0.01);
}

/// Greatest height that rays outward from the exact core leave, up or down, between the directions of the
/// poses, mm. As for dexels, what is cut off the far side of the core does not belong to a ray.
double ray_error(double z, double rho, const CutterSolid& cutter) {
  double worst = 0.0;
  const std::vector<Sweep> sweeps = full_turn(3600);
  for (int i = 0; i < 8; ++i) {
    const double angle = 0.1234 + 2.0 * kPi * i / 8.0;
    const Vec3 outward(std::cos(angle), std::sin(angle), 0.0);
    double least = std::numeric_limits<double>::infinity();
    for (const Sweep& sweep : sweeps) {
      const double height = ray_height(rho * outward + Vec3(0, 0, z), outward, sweep, cutter);
      if (height > -kSkin) least = std::min(least, height);
    }
    worst = std::max(worst, std::abs(least));
  }
  return worst;
}

TEST(Hyperboloid, RaysMeetTheCoreWithinAFifthOfAMicrometre) {
  // The second solid is the same cylinder, unrecognised: it goes the general way.
  const CutterSolid general =
      solid_of({ProfileWalk({0, 0}, -90).line(kRadius).turn_to(1e-9).line(80.0).close()});
  ASSERT_FALSE(general.is_cylinder());
  for (const CutterSolid& cutter : {kCutter, general}) {
    EXPECT_LT(ray_error(0.0, 25.0, cutter), 2e-4);
    EXPECT_LT(ray_error(9.602891161, 25.198577496, cutter), 2e-4);
    EXPECT_LT(ray_error(38.334330944, 28.028236159, cutter), 2e-4);
  }
}

}  // namespace
}  // namespace swarf::stock::hyperboloid_test
