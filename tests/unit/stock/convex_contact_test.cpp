// The signed distance to the sweep of any cutter, against dense scans and exact answers.
#include "stock/contact/convex_contact.h"

#include <gtest/gtest.h>

#include "cutter_shapes.h"
#include "stock_test_support.h"

namespace swarf::stock::convex_contact_test {
namespace {

/// F of the standing cutter for a point in the tool's frame, mm: the least over its pieces; 1-Lipschitz.
double standing_distance(const Vec3& point_T, const CutterSolid& cutter) {
  const double rho = point_T.head<2>().norm();
  double least = std::numeric_limits<double>::infinity();
  for (const cutter::ConvexPiece& piece : cutter.pieces) {
    least = std::min(least, cutter::signed_distance(piece, rho, point_T.z()));
  }
  return least;
}

/// Least F over instants: a scan, then golden sections about its best place (F is convex along the motion).
double scanned(const SweepMap& map, const Vec3& x, const CutterSolid& cutter) {
  const auto at = [&](double t) {
    return standing_distance((1.0 - t) * map.start(x) + t * map.end(x), cutter);
  };
  double least = 1e300;
  for (const cutter::ConvexPiece& piece : cutter.pieces) {
    const CutterSolid alone = solid_of({piece});
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 130; ++i) {
      const double a = low + 0.382 * (high - low), b = low + 0.618 * (high - low);
      const auto value = [&](double t) {
        return standing_distance((1.0 - t) * map.start(x) + t * map.end(x), alone);
      };
      (value(a) <= value(b) ? high : low) = value(a) <= value(b) ? b : a;
      least = std::min({least, value(a), value(b)});
    }
    least = std::min({least, at(0.0), at(1.0)});
  }
  for (int i = 0; i <= 200; ++i) least = std::min(least, at(i / 200.0));
  return least;
}

void compare(const CutterSolid& cutter, const Sweep& sweep, const Vec3& x, const std::string& where) {
  const SweepMap map = sweep_map(sweep);
  const SweepContact contact = swept_contact(x, map, cutter);
  ASSERT_NEAR(contact.distance_mm, scanned(map, x, cutter), 1e-9)
      << where << ": " << text(sweep) << " point " << text(x) << " of " << text(cutter.pieces[0]);
  const Vec3 X = (1.0 - contact.t) * map.start(x) + contact.t * map.end(x);
  ASSERT_NEAR(standing_distance(X, cutter), contact.distance_mm, 1e-12) << where;
}

Vec3 near_tool(Rng& rng, const Sweep& sweep, double reach) {
  return sweep.start.tip_W + reach * rng.uniform() * rng.direction();
}

TEST(SweptContact, EqualsAScanForRandomPiecesAndMotions) {
  constexpr uint64_t kSeed = 61;
  Rng rng(kSeed);
  for (int n = 0; n < 1500; ++n) {
    const CutterSolid cutter = solid_of({random_piece(rng)});
    const double travel = std::vector{0.0, 0.05, 4.0, 80.0}[n % 4];
    const Sweep sweep = random_sweep(rng, 3.0, travel, n % 3 == 0 ? 0.0 : 0.3);
    compare(cutter, sweep, near_tool(rng, sweep, 15.0), fmt::format("seed {} case {}", kSeed, n));
  }
}

TEST(SweptContact, EqualsAScanWhereTheMotionIsDegenerate) {
  constexpr uint64_t kSeed = 62;
  Rng rng(kSeed);
  for (int n = 0; n < 600; ++n) {
    const CutterSolid cutter = solid_of({random_piece(rng)});
    const ToolPose pose{Vec3::Zero(), rng.direction()};
    const ToolPose plunged{rng.uniform(-6, 6) * pose.axis_W, pose.axis_W};
    const ToolPose turned{pose.tip_W, Vec3(pose.axis_W + 0.3 * rng.direction()).normalized()};
    const Vec3 on_axis = rng.uniform(-5, 15) * pose.axis_W;
    const std::string where = fmt::format("seed {} case {}", kSeed, n);
    compare(cutter, {pose, pose, 0}, near_tool(rng, {pose, pose, 0}, 12), where + " zero length");
    compare(cutter, {pose, plunged, 0}, near_tool(rng, {pose, pose, 0}, 12), where + " plunge");
    compare(cutter, {pose, plunged, 0}, on_axis, where + " plunge, on the axis");
    compare(cutter, {pose, turned, 0}, near_tool(rng, {pose, pose, 0}, 12), where + " turn");
    const Vec3 across = rng.direction();
    compare(cutter, {{-5.0 * across, pose.axis_W}, {4.0 * across, pose.axis_W}, 0}, on_axis,
            where + " through the axis");
  }
}

TEST(SweptContact, NormalIsTheGradient) {
  constexpr uint64_t kSeed = 63;
  Rng rng(kSeed);
  int smooth = 0;
  for (int n = 0; n < 600; ++n) {
    const CutterSolid cutter = solid_of({random_piece(rng)});
    const Sweep sweep = random_sweep(rng, 3.0, 4.0, n % 2 == 0 ? 0.0 : 0.2);
    const SweepMap map = sweep_map(sweep);
    const Vec3 x = near_tool(rng, sweep, 12.0);
    const auto gradient = [&](double h) {
      Vec3 g;
      for (int c = 0; c < 3; ++c) {
        const Vec3 step = h * Vec3::Unit(c);
        g[c] = (swept_contact(x + step, map, cutter).distance_mm -
                swept_contact(x - step, map, cutter).distance_mm) /
               (2.0 * h);
      }
      return g;
    };
    const Vec3 coarse = gradient(2e-4), fine = gradient(1e-4);
    const SweepContact contact = swept_contact(x, map, cutter);
    // Where the differences do not settle x lies within a step of a crease; deep inside the sweep the
    // gradient shrinks to a ridge.
    if ((coarse - fine).norm() > 1e-6 || fine.norm() < 0.2) continue;
    ++smooth;
    ASSERT_LT((contact.normal_W - fine.normalized()).norm(), 1e-4)
        << "seed " << kSeed << " case " << n << ": " << text(sweep) << " point " << text(x);
  }
  EXPECT_GT(smooth, 400);
}

TEST(SweptContact, BallIsTheDistanceToASegment) {
  const CutterSolid cutter = ball_nose(3.0, 20.0);
  const SweepMap map = sweep_map({{{0, 0, 0}, Vec3::UnitZ()}, {{10, 0, 0}, Vec3::UnitZ()}, 0});
  // The centre runs along z = 3.
  const SweepContact below = swept_contact({4, 3, -1}, map, cutter);
  EXPECT_NEAR(below.distance_mm, 5.0 - 3.0, 1e-12);
  EXPECT_NEAR(below.t, 0.4, 1e-9);
  EXPECT_NEAR((below.normal_W - Vec3(0, 0.6, -0.8)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(swept_contact({-2, 0, 1}, map, cutter).distance_mm, std::sqrt(8.0) - 3.0, 1e-12);
}

TEST(SweptContact, RimOfARampSweepsANormalAcrossItsMotion) {
  // A flat end ramping down: its rear edge (x = -5) makes a wall parallel to the motion.
  const CutterSolid cutter(5.0, 20.0);
  const SweepMap map = sweep_map({{{0, 0, 0}, Vec3::UnitZ()}, {{8, 0, -6}, Vec3::UnitZ()}, 0});
  const SweepContact contact =
      swept_contact(Vec3(-5, 0, 0) + Vec3(4, 0, -3) + 0.01 * Vec3(-3, 0, -4), map, cutter);
  EXPECT_NEAR((contact.normal_W - Vec3(-0.6, 0, -0.8)).norm(), 0.0, 1e-9);
  EXPECT_GT(contact.distance_mm, 0.0);
}

TEST(SweptContact, UnionKnowsItsPiece) {
  const CutterSolid cutter = t_slot(8.0, 4.0, 3.0, 20.0);
  const SweepMap map = sweep_map({{{0, 0, 0}, Vec3::UnitZ()}, {{10, 0, 0}, Vec3::UnitZ()}, 0});
  EXPECT_EQ(swept_contact({5, 7, 2}, map, cutter).piece, 0u);
  EXPECT_NEAR(swept_contact({5, 7, 2}, map, cutter).distance_mm, -1.0, 1e-12);
  EXPECT_EQ(swept_contact({5, 3.5, 10}, map, cutter).piece, 1u);
  EXPECT_NEAR(swept_contact({5, 3.5, 10}, map, cutter).distance_mm, 0.5, 1e-12);
}

}  // namespace
}  // namespace swarf::stock::convex_contact_test
