// The oracles of theory 1.6 on the surface DOME.
#include <array>
#include <cmath>

#include "surface/curvature.h"
#include "unit/surface/test_surfaces.h"

namespace swarf::surface {
namespace {

/// Gauss-Legendre points and weights on [0,1] for five-point panels.
template <typename F>
double integral(F f, int panels) {
  constexpr std::array<double, 5> kNode = {-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                                           0.9061798459386640};
  constexpr std::array<double, 5> kWeight = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                             0.4786286704993665, 0.2369268850561891};
  double sum = 0.0;
  for (int p = 0; p < panels; ++p) {
    for (size_t k = 0; k < kNode.size(); ++k) sum += kWeight[k] * f((p + 0.5 + 0.5 * kNode[k]) / panels);
  }
  return 0.5 * sum / panels;
}

TEST(Dome, CurvaturesAtTheApex) {
  const Shape apex = shape_at(dome().derivatives(0.5, 0.5), 1);
  EXPECT_NEAR(principal_curvatures(apex).low, 0.016, 1e-16);
  EXPECT_NEAR(principal_curvatures(apex).high, 0.01875, 1e-16);
  EXPECT_NEAR(gaussian_curvature(apex), 3.0e-4, 1e-18);
  EXPECT_LT((apex.normal - Vec3::UnitZ()).norm(), 1e-15);
}

TEST(Dome, SuCrossSvPointsOutOfTheMaterial) {
  const Derivatives d = dome().derivatives(0.5, 0.5);
  // Theory 1.6 prints Sv x Su at the apex: (0,0,-8000).
  EXPECT_LT((d.Sv.cross(d.Su) - Vec3(0, 0, -8000)).norm(), 1e-11);
  EXPECT_LT((outward_normal(dome(), d) - Vec3::UnitZ()).norm(), 1e-15);
}

TEST(Dome, ShapeAtThreeTenthsSixTenths) {
  const Shape shape = shape_at(dome().derivatives(0.3, 0.6), 1);
  EXPECT_LT((shape.point - Vec3(-20, 8, 31.2)).norm(), 1e-13);
  EXPECT_NEAR(shape.normal.x(), -0.3017123, 5e-8);
  EXPECT_NEAR(shape.normal.y(), 0.14142764, 5e-9);
  EXPECT_NEAR(shape.normal.z(), 0.94285095, 5e-9);
  EXPECT_NEAR(gaussian_curvature(shape), 2.3707918257e-4, 5e-15);
  EXPECT_NEAR(principal_curvatures(shape).low, 0.01358261016, 5e-12);
  EXPECT_NEAR(principal_curvatures(shape).high, 0.01745461143, 5e-12);
}

TEST(Dome, LengthOfTheBoundaryVZero) {
  EXPECT_NEAR(integral([](double u) { return dome().derivatives(u, 0.0).Su.norm(); }, 16), 109.823008377,
              5e-10);
}

TEST(Dome, VolumeUnderIt) {
  const auto strip = [](double u) {
    return integral(
        [u](double v) {
          const Derivatives d = dome().derivatives(u, v);
          return d.S.z() * d.Su.cross(d.Sv).z();
        },
        1);
  };
  EXPECT_NEAR(integral(strip, 1), 186666.6667, 5e-5);
}

TEST(Dome, IsConvexEverywhere) {
  for (int i = 0; i <= 20; ++i) {
    for (int j = 0; j <= 20; ++j) {
      EXPECT_GT(principal_curvatures(shape_at(dome().derivatives(i / 20.0, j / 20.0), 1)).low, 0.0);
    }
  }
}

TEST(Dome, TheOppositeSignTurnsNormalAndCurvatures) {
  const Derivatives d = dome().derivatives(0.2, 0.9);
  const Shape out = shape_at(d, 1);
  const Shape in = shape_at(d, -1);
  EXPECT_LT((out.normal + in.normal).norm(), 1e-15);
  EXPECT_NEAR(principal_curvatures(out).low, -principal_curvatures(in).high, 1e-17);
  EXPECT_NEAR(gaussian_curvature(out), gaussian_curvature(in), 1e-18);
}

}  // namespace
}  // namespace swarf::surface
