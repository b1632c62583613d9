#include <gtest/gtest.h>

#include <limits>

#include "stock/rays/ray_height.h"
#include "stock/rays/surface_dexels.h"
#include "stock_test_support.h"

namespace swarf::stock::ray_height_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Lowest point of the ray in the standing cutter of instant t, by the slab and the quadratic alone.
double entry_at(const SweepMap& map, const Vec3& p, const Vec3& n, const CutterSolid& cutter, double t) {
  const Vec3 A = (1.0 - t) * map.start(p) + t * map.end(p);
  const Vec3 B = (1.0 - t) * Vec3(map.R0t * n) + t * Vec3(map.R1t * n);
  double low = -kInfinity, high = kInfinity;
  low = std::max(low, std::min(-A.z() / B.z(), (cutter.height - A.z()) / B.z()));
  high = std::min(high, std::max(-A.z() / B.z(), (cutter.height - A.z()) / B.z()));
  const double a = B.head<2>().squaredNorm(), b = A.head<2>().dot(B.head<2>());
  const double disc = b * b - a * (A.head<2>().squaredNorm() - cutter.radius * cutter.radius);
  if (disc < 0.0) return kInfinity;
  low = std::max(low, (-b - std::sqrt(disc)) / a);
  high = std::min(high, (-b + std::sqrt(disc)) / a);
  return low <= high ? low : kInfinity;
}

/// Minimum over t by a scan that is refined around its best place again and again.
double scanned_height(const SweepMap& map, const Vec3& p, const Vec3& n, const CutterSolid& cutter) {
  double best = kInfinity, low = 0.0, high = 1.0;
  for (int level = 0; level < 12; ++level) {
    constexpr int kSteps = 400;
    double best_t = 0.5 * (low + high);
    const double step = (high - low) / kSteps;
    for (int i = 0; i <= kSteps; ++i) {
      const double t = low + step * i;
      const double s = entry_at(map, p, n, cutter, t);
      if (s <= best) {
        best = s;
        best_t = t;
      }
    }
    if (best == kInfinity) return best;
    low = std::max(0.0, best_t - 2.0 * step);
    high = std::min(1.0, best_t + 2.0 * step);
  }
  return best;
}

void compare_with_scan(uint64_t seed, double travel, double turn_rad, double tolerance_mm) {
  Rng rng(seed);
  const CutterSolid cutter{5.0, 12.0};
  int hits = 0;
  for (int n = 0; n < 3000; ++n) {
    const Sweep sweep = random_sweep(rng, 3.0, travel, turn_rad);
    const Vec3 point = 8.0 * rng.direction() * rng.uniform(), normal = rng.direction();
    const double found = ray_height(point, normal, sweep, cutter);
    const double scanned = scanned_height(sweep_map(sweep), point, normal, cutter);
    // The scan finds no sliver that is touched for less than 1/400 of the motion; the closed form does.
    if (scanned == kInfinity) continue;
    ++hits;
    ASSERT_LE(found, scanned + tolerance_mm) << "seed " << seed << " case " << n << ": " << text(sweep)
                                             << " point " << text(point) << " normal " << text(normal);
    ASSERT_GE(found, scanned - 0.02 * travel - tolerance_mm) << "seed " << seed << " case " << n;
    // What it returns lies on the cutter at some instant: the swept distance there is zero.
    if (found < scanned - tolerance_mm) {
      double nearest = kInfinity;
      for (int i = 0; i <= 4000; ++i) {
        const Vec3 x = point + found * normal;
        const double t = i / 4000.0;
        nearest = std::min(
            nearest,
            cutter_value((1.0 - t) * sweep_map(sweep).start(x) + t * sweep_map(sweep).end(x), cutter));
      }
      ASSERT_LE(std::abs(nearest), 2e-3 * travel) << "seed " << seed << " case " << n << ": " << text(sweep);
    }
  }
  EXPECT_GT(hits, 1000);
}

TEST(RayHeight, TranslationEqualsAScanOfStandingCutters) {
  compare_with_scan(11, 4.0, 0.0, 1e-9);
}
TEST(RayHeight, TickWithRotationEqualsAScan) {
  compare_with_scan(12, 0.05, 0.01, 1e-9);
}
TEST(RayHeight, LongSweepWithRotationEqualsAScan) {
  compare_with_scan(13, 3.0, 0.2, 1e-9);
}
TEST(RayHeight, TurnOnTheSpotEqualsAScan) {
  compare_with_scan(14, 0.0, 0.3, 1e-9);
}

TEST(RayHeight, BottomOfALevelMove) {
  const CutterSolid cutter{5.0, 25.0};
  const Sweep sweep{{{0, 0, 2}, Vec3::UnitZ()}, {{10, 0, 2}, Vec3::UnitZ()}, 0};
  EXPECT_EQ(ray_height({4, 1, 0}, Vec3::UnitZ(), sweep, cutter), 2.0);
  EXPECT_EQ(ray_height({4, 5.1, 0}, Vec3::UnitZ(), sweep, cutter), kInfinity);
  EXPECT_EQ(ray_height({14.9, 0, 0}, Vec3::UnitZ(), sweep, cutter), 2.0);
  EXPECT_EQ(ray_height({15.1, 0, 0}, Vec3::UnitZ(), sweep, cutter), kInfinity);
}

TEST(RayHeight, RampLeavesTheLowestPassageOfTheDisc) {
  // Down from z = 2 to 1 over 10 mm: over x the front of the disc was never lower than its last height there.
  const CutterSolid cutter{5.0, 25.0};
  const Sweep sweep{{{0, 0, 2}, Vec3::UnitZ()}, {{10, 0, 1}, Vec3::UnitZ()}, 0};
  // The disc covers x = 0 until its centre is at x = 5, z = 1.5.
  EXPECT_NEAR(ray_height({0, 0, 0}, Vec3::UnitZ(), sweep, cutter), 1.5, 1e-12);
  // Off the middle line the chord is shorter: sqrt(25 - 9) = 4, z = 2 - 0.4.
  EXPECT_NEAR(ray_height({0, 3, 0}, Vec3::UnitZ(), sweep, cutter), 1.6, 1e-12);
  EXPECT_NEAR(ray_height({8, 0, 0}, Vec3::UnitZ(), sweep, cutter), 1.0, 1e-12);
}

TEST(RayHeight, FlankMeetsARayFromTheSide) {
  // The tool stands along z, the ray runs along x: it meets the flank at x = 20 - 5.
  const CutterSolid cutter{5.0, 25.0};
  const Sweep sweep{{{20, -8, -10}, Vec3::UnitZ()}, {{20, 8, -10}, Vec3::UnitZ()}, 0};
  EXPECT_NEAR(ray_height(Vec3::Zero(), Vec3::UnitX(), sweep, cutter), 15.0, 1e-12);
}

TEST(RayHeight, PlungeAndZeroLength) {
  const CutterSolid cutter{5.0, 25.0};
  const ToolPose high{{0, 0, 9}, Vec3::UnitZ()}, deep{{0, 0, -1}, Vec3::UnitZ()};
  EXPECT_NEAR(ray_height({1, 1, 0}, Vec3::UnitZ(), {high, deep, 0}, cutter), -1.0, 1e-12);
  EXPECT_NEAR(ray_height({1, 1, 0}, Vec3::UnitZ(), {deep, high, 0}, cutter), -1.0, 1e-12);
  EXPECT_NEAR(ray_height({1, 1, 0}, Vec3::UnitZ(), {deep, deep, 0}, cutter), -1.0, 1e-12);
  EXPECT_EQ(ray_height({5.1, 0, 0}, Vec3::UnitZ(), {deep, deep, 0}, cutter), kInfinity);
}

TEST(RayHeight, BackEdgeOfALeaningFlatEnd) {
  // Axis leaning forward by phi about y: the rear rim point is lower than the tip centre by r sin(phi).
  const double phi = 0.2;
  const CutterSolid cutter{5.0, 25.0};
  const Vec3 axis(std::sin(phi), 0, std::cos(phi));
  const Sweep sweep{{{0, 0, 3}, axis}, {{2, 0, 3}, axis}, 0};
  const double x = 2.0 + 5.0 * std::cos(phi) - 1e-6;  // the front rim of the end pose is the lowest
  EXPECT_NEAR(ray_height({x, 0, 0}, Vec3::UnitZ(), sweep, cutter), 3.0 - 5.0 * std::sin(phi), 1e-6);
}

}  // namespace
}  // namespace swarf::stock::ray_height_test
