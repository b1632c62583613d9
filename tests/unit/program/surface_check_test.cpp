#include "program/surface_blocks/check.h"

#include <gtest/gtest.h>

#include <string>

#include "base/rng.h"

namespace swarf::program::surface_check_test {
namespace {

using surface::PolynomialSurface;

/// 100 mm square plane with x replaced by the given powers of u.
PolynomialSurface with_x(const std::vector<double>& powers) {
  const int degree = static_cast<int>(powers.size()) - 1;
  std::vector<Vec3> coefficients(powers.size() * 2, Vec3::Zero());
  for (size_t i = 0; i < powers.size(); ++i) coefficients[2 * i].x() = powers[i];
  coefficients[1].y() = 100.0;
  return {degree, 1, coefficients, 1};
}

TEST(DegeneratePoint, PassesRegularSurfaces) {
  EXPECT_FALSE(find_degenerate_point(with_x({0, 100})));
  EXPECT_FALSE(find_degenerate_point(with_x({0, 0.001})));        // a thin strip
  EXPECT_FALSE(find_degenerate_point(with_x({0, 0.1, 0, 100})));  // Su falls to a thousandth, not to zero
  const std::vector<Vec3> dome = {{-50, -40, 0}, {0, 80, 60}, {0, 0, -60}, {100, 0, 80}, {0, 0, 0},
                                  {0, 0, 0},     {0, 0, -80}, {0, 0, 0},   {0, 0, 0}};
  EXPECT_FALSE(find_degenerate_point({2, 2, dome, 1}));
}

TEST(DegeneratePoint, PassesRandomSurfacesWithoutFolds) {
  Rng rng(11);
  for (int trial = 0; trial < 100; ++trial) {
    const double a = rng.uniform(-0.4, 0.4);
    const double b = rng.uniform(-0.2, 0.2);
    // x' = 100 (1 + 2 a u + 3 b u^2) stays above 0 unless the numbers below say otherwise.
    double lowest = 1.0;
    for (int i = 0; i <= 1000; ++i)
      lowest = std::min(lowest, 1.0 + 2.0 * a * i * 1e-3 + 3.0 * b * i * i * 1e-6);
    EXPECT_EQ(find_degenerate_point(with_x({0, 100, 100 * a, 100 * b})).has_value(), lowest <= 0.0)
        << "x powers 0, 100, " << 100 * a << ", " << 100 * b << ", least x' / 100 " << lowest;
  }
}

TEST(DegeneratePoint, FindsFoldsAnywhere) {
  Rng rng(12);
  for (int trial = 0; trial < 200; ++trial) {
    const double at = rng.uniform(0.0, 1.0);
    const auto spot = find_degenerate_point(with_x({0, -200 * at, 100}));
    ASSERT_TRUE(spot) << "fold at u = " << at;
    EXPECT_NEAR(spot->u, at, 1e-8);
  }
}

TEST(DegeneratePoint, FindsZerosWithoutAFoldAnywhere) {
  Rng rng(13);
  for (int trial = 0; trial < 200; ++trial) {
    const double at = rng.uniform(0.0, 1.0);
    const auto spot = find_degenerate_point(with_x({0, 300 * at * at, -300 * at, 100}));
    ASSERT_TRUE(spot) << "zero at u = " << at;
    EXPECT_NEAR(spot->u, at, 1e-4);
  }
}

TEST(DegeneratePoint, FindsPolesAtEdges) {
  // Cone tip at u = 1: x = (1-u) v, y = (1-u), z = u.
  const std::vector<Vec3> tip = {{0, 50, 0}, {50, 0, 0}, {0, -50, 50}, {-50, 0, 0}};
  const auto spot = find_degenerate_point({1, 1, tip, 1});
  ASSERT_TRUE(spot);
  EXPECT_EQ(spot->u, 1.0);
}

TEST(DegeneratePoint, FindsSurfacesThatAreLinesOrPoints) {
  EXPECT_TRUE(find_degenerate_point({1, 1, {{0, 0, 0}, {3, 3, 3}, {7, 7, 7}, {0, 0, 0}}, 1}));
  EXPECT_TRUE(find_degenerate_point({1, 1, {{5, 5, 5}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, 1}));
}

TEST(DegeneratePoint, ReportsOverflow) {
  const auto spot = find_degenerate_point(with_x({0, 1e307, 1e308}));
  ASSERT_TRUE(spot);
  EXPECT_FALSE(spot->finite);
}

TEST(BezierConversion, SeesAWrongControlPoint) {
  std::vector<Vec3> net = {{0, 0, 0}, {0, 9, 0}, {9, 0, 0}, {9, 9, 1}};
  const auto shape = PolynomialSurface::from_bezier(1, 1, net, 1);
  EXPECT_LT(bezier_conversion_error(shape, net), 1e-14);
  net[3].z() += 0.25;
  EXPECT_NEAR(bezier_conversion_error(shape, net), 0.25, 1e-14);
}

}  // namespace
}  // namespace swarf::program::surface_check_test
