// Rays against the sweeps of any cutter: dense scans, exact answers, degenerate positions.
#include <gtest/gtest.h>

#include <limits>

#include "cutter_shapes.h"
#include "stock/contact/convex_contact.h"
#include "stock/rays/ray_height.h"
#include "stock/rays/surface_dexels.h"
#include "stock_test_support.h"

namespace swarf::stock::convex_ray_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Lowest point of a line A + s B in the standing piece: F is convex along it, so its least place is found by
/// golden sections and the root below that by bisection.
double entry_at(const Vec3& A, const Vec3& B, const cutter::ConvexPiece& piece) {
  const auto f = [&](double s) {
    const Vec3 X = A + s * B;
    return cutter::signed_distance(piece, X.head<2>().norm(), X.z());
  };
  double low = -60.0, high = 60.0;
  for (int i = 0; i < 80; ++i) {
    const double a = low + 0.382 * (high - low), b = low + 0.618 * (high - low);
    (f(a) <= f(b) ? high : low) = f(a) <= f(b) ? b : a;
  }
  double inside = 0.5 * (low + high), outside = -60.0;
  if (f(inside) > 0.0) return kInfinity;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (inside + outside);
    (f(middle) <= 0.0 ? inside : outside) = middle;
  }
  return inside;
}

/// Least entry over the instants by a scan that closes in on its best place.
double scanned_height(const SweepMap& map, const Vec3& p, const Vec3& n, const cutter::ConvexPiece& piece) {
  double best = kInfinity, low = 0.0, high = 1.0;
  for (int level = 0; level < 7; ++level) {
    constexpr int kSteps = 40;
    double best_t = 0.5 * (low + high);
    const double step = (high - low) / kSteps;
    for (int i = 0; i <= kSteps; ++i) {
      const double t = low + step * i;
      const double s = entry_at((1.0 - t) * map.start(p) + t * map.end(p),
                                (1.0 - t) * Vec3(map.R0t * n) + t * Vec3(map.R1t * n), piece);
      if (s <= best) {
        best = s;
        best_t = t;
      }
    }
    if (best == kInfinity) return best;
    low = std::max(0.0, best_t - 1.5 * step);
    high = std::min(1.0, best_t + 1.5 * step);
  }
  return best;
}

void compare_with_scan(uint64_t seed, double travel, double turn_rad) {
  Rng rng(seed);
  int hits = 0;
  for (int n = 0; n < 120; ++n) {
    const cutter::ConvexPiece piece = random_piece(rng);
    const Sweep sweep = random_sweep(rng, 3.0, travel, turn_rad);
    const SweepMap map = sweep_map(sweep);
    const Vec3 point = 6.0 * rng.direction() * rng.uniform(), normal = rng.direction();
    const std::string where = fmt::format("seed {} case {}: {} point {} normal {} {}", seed, n, text(sweep),
                                          text(point), text(normal), text(piece));
    const RayInterval found = ray_interval(point, normal, map, piece);
    const double scanned = scanned_height(map, point, normal, piece);
    // The search is certified from below, the scan may miss a sliver: never above, and if below, on the
    // sweep.
    ASSERT_LE(found.low, scanned + 1e-7) << where;
    if (!found.hit()) continue;
    ++hits;
    const CutterSolid cutter = solid_of({piece});
    ASSERT_NEAR(swept_contact(point + found.low * normal, map, cutter).distance_mm, 0.0, 1e-10) << where;
    ASSERT_NEAR(swept_contact(point + found.high * normal, map, cutter).distance_mm, 0.0, 1e-10) << where;
    ASSERT_GT(swept_contact(point + (found.low - 1e-4) * normal, map, cutter).distance_mm, 0.0) << where;
    ASSERT_EQ(ray_height(point, normal, map, cutter), found.low) << where;
    if (scanned < kInfinity) {
      ASSERT_NEAR(found.low, scanned, 1e-7) << where;
      ASSERT_NEAR(found.high, -scanned_height(map, point, -normal, piece), 1e-7) << where;
    }
  }
  EXPECT_GT(hits, 40);
}

TEST(ConvexRay, TranslationEqualsAScan) {
  compare_with_scan(71, 4.0, 0.0);
}
TEST(ConvexRay, LongTranslationEqualsAScan) {
  compare_with_scan(72, 30.0, 0.0);
}
TEST(ConvexRay, TickWithRotationEqualsAScan) {
  compare_with_scan(73, 0.05, 0.01);
}
TEST(ConvexRay, LongSweepWithRotationEqualsAScan) {
  compare_with_scan(74, 3.0, 0.3);
}
TEST(ConvexRay, TurnOnTheSpotEqualsAScan) {
  compare_with_scan(75, 0.0, 0.5);
}

TEST(ConvexRay, CylinderAgreesWithItsClosedForm) {
  // The same solid with its flank given twice is no longer recognised as a plain cylinder.
  constexpr uint64_t kSeed = 76;
  Rng rng(kSeed);
  const CutterSolid plain(5.0, 12.0);
  const CutterSolid general = solid_of({ProfileWalk({0, 0}, -90).line(5.0).turn_to(1e-9).line(12.0).close()});
  ASSERT_TRUE(plain.is_cylinder());
  ASSERT_FALSE(general.is_cylinder());
  int hits = 0;
  for (int n = 0; n < 3000; ++n) {
    const Sweep sweep = random_sweep(rng, 3.0, 2.0, n % 2 == 0 ? 0.0 : 0.1);
    const Vec3 point = 8.0 * rng.direction() * rng.uniform(), normal = rng.direction();
    const double closed = ray_height(point, normal, sweep, plain);
    const double searched = ray_height(point, normal, sweep, general);
    if (closed == kInfinity || searched == kInfinity)
      continue;  // a ray may touch one and just miss the other
    ++hits;
    ASSERT_NEAR(closed, searched, 1e-6) << "seed " << kSeed << " case " << n << ": " << text(sweep)
                                        << " point " << text(point) << " normal " << text(normal);
  }
  EXPECT_GT(hits, 1000);
}

TEST(ConvexRay, CylinderHasBothEnds) {
  const auto piece = cutter::ConvexPiece::cylinder(5.0, 12.0);
  const SweepMap map = sweep_map({{{0, 0, 2}, Vec3::UnitZ()}, {{10, 0, 2}, Vec3::UnitZ()}, 0});
  const RayInterval up = ray_interval({4, 1, 0}, Vec3::UnitZ(), map, piece);
  EXPECT_EQ(up.low, 2.0);
  EXPECT_NEAR(up.high, 14.0, 1e-12);
  const RayInterval along = ray_interval({-20, 3, 5}, Vec3::UnitX(), map, piece);
  EXPECT_NEAR(along.low, 20.0 - 4.0, 1e-12);
  EXPECT_NEAR(along.high, 20.0 + 14.0, 1e-12);
  EXPECT_FALSE(ray_interval({4, 5.1, 0}, Vec3::UnitZ(), map, piece).hit());
}

TEST(ConvexRay, BallMeetsItsStadium) {
  const CutterSolid cutter = ball_nose(5.0, 20.0);
  const Sweep sweep{{{0, 0, 0}, Vec3::UnitZ()}, {{10, 0, 0}, Vec3::UnitZ()}, 0};
  EXPECT_NEAR(ray_height({4, 3, 0}, Vec3::UnitZ(), sweep, cutter), 5.0 - 4.0, 1e-11);
  EXPECT_NEAR(ray_height({12, 0, -3}, Vec3::UnitZ(), sweep, cutter), 8.0 - std::sqrt(21.0), 1e-11);
  EXPECT_EQ(ray_height({4, 5.001, 0}, Vec3::UnitZ(), sweep, cutter), kInfinity);
}

TEST(ConvexRay, BullNoseRampIsTheTorusCornersEnvelope) {
  // Plane y = 0 is a plane of symmetry of the motion (1, 0, -1/2): there the corner sweeps the offset of its
  // centre's line, which runs through (R - rc, rc) at the front; exact below the ramp's end.
  const double R = 5.0, rc = 1.5, slope = 0.5;
  const CutterSolid cutter = bull_nose(R, rc, 20.0);
  const Sweep sweep{{{0, 0, 0}, Vec3::UnitZ()}, {{20, 0, -20 * slope}, Vec3::UnitZ()}, 0};
  const double x = 4.0;
  // The rear of the corner (x - (R - rc)) touches last and lowest: centre line z = rc - slope (x + R - rc).
  const double expected = rc - slope * (x + R - rc) - rc * std::sqrt(1.0 + slope * slope);
  EXPECT_NEAR(ray_height({x, 0, 0}, Vec3::UnitZ(), sweep, cutter), expected, 1e-11);
  // Off the plane of symmetry: grazing condition of the torus (theory 5), n . v = 0 with
  // n = (cos p cos a, cos p sin a, -sin p): cos p cos a = -slope sin p.
  for (const double angle_deg : {100.0, 130.0, 170.0}) {
    const double a = rad_from_deg(angle_deg);
    const double p = std::atan(-std::cos(a) / slope);
    const double rho = R - rc + rc * std::cos(p), t = 0.5;
    const Vec3 touch = Vec3(20 * t, 0, -20 * slope * t) +
                       Vec3(rho * std::cos(a), rho * std::sin(a), rc * (1.0 - std::sin(p)));
    EXPECT_NEAR(ray_height({touch.x(), touch.y(), 0}, Vec3::UnitZ(), sweep, cutter), touch.z(), 1e-11)
        << angle_deg;
  }
}

TEST(ConvexRay, DrillPointOnItsAxisAndOffIt) {
  const CutterSolid cutter = drill(4.0, 90.0, 20.0);
  const Sweep plunge{{{0, 0, 5}, Vec3::UnitZ()}, {{0, 0, -3}, Vec3::UnitZ()}, 0};
  EXPECT_NEAR(ray_height({0, 0, 0}, Vec3::UnitZ(), plunge, cutter), -3.0, 1e-11);
  EXPECT_NEAR(ray_height({2, 0, 0}, Vec3::UnitZ(), plunge, cutter), -1.0, 1e-11);
  // Across the tip: the cone's apex sweeps a groove with its own flanks.
  const Sweep groove{{{-5, 0, -1}, Vec3::UnitZ()}, {{5, 0, -1}, Vec3::UnitZ()}, 0};
  EXPECT_NEAR(ray_height({0.3, 0, 0}, Vec3::UnitZ(), groove, cutter), -1.0, 1e-11);
  EXPECT_NEAR(ray_height({0.3, 1.25, 0}, Vec3::UnitZ(), groove, cutter), 0.25, 1e-11);
}

TEST(ConvexRay, UndercutOfATSlotLeavesTheLowestEnd) {
  const CutterSolid cutter = t_slot(8.0, 4.0, 3.0, 20.0);
  const SweepMap map = sweep_map({{{0, 0, 1}, Vec3::UnitZ()}, {{10, 0, 1}, Vec3::UnitZ()}, 0});
  EXPECT_EQ(ray_height({5, 7, 0}, Vec3::UnitZ(), map, cutter), 1.0);
  const RayInterval disc = ray_interval({5, 7, 0}, Vec3::UnitZ(), map, cutter.pieces[0]);
  EXPECT_NEAR(disc.high, 5.0, 1e-12);
  EXPECT_FALSE(ray_interval({5, 7, 0}, Vec3::UnitZ(), map, cutter.pieces[1]).hit());
  EXPECT_NEAR(ray_interval({5, 2, 0}, Vec3::UnitZ(), map, cutter.pieces[1]).high, 21.0, 1e-11);
}

}  // namespace
}  // namespace swarf::stock::convex_ray_test
