#include "collision/closest_approach.h"

#include <gtest/gtest.h>

#include "unit/collision/brute_distance.h"
#include "unit/collision/toy_machine.h"

namespace swarf::collision {
namespace {

Body work_box(const Vec3& low, const Vec3& high) {
  return mesh_body("work", BodyKind::kFixture, kTable, box_mesh(low, high));
}

Body head_box(const Vec3& low, const Vec3& high) {
  return mesh_body("head", BodyKind::kLink, kZSlide, box_mesh(low, high));
}

TEST(RelativeMotion, PoseIsThatOfTheLinks) {
  const machine::MachineScene scene = toy_machine();
  Rng rng(3);
  for (int i = 0; i < 200; ++i) {
    AxisValues q;
    for (int k = 0; k < 5; ++k) q[k] = rng.uniform(-3.0, 3.0);
    const std::vector<Pose> poses = machine::link_poses(scene, q);
    const auto a = static_cast<int>(rng.uniform(0.0, 6.0)), b = static_cast<int>(rng.uniform(0.0, 6.0));
    const Pose expected = poses[static_cast<size_t>(a)].inverse() * poses[static_cast<size_t>(b)];
    EXPECT_LT((RelativeMotion(scene, a, b).pose(q).matrix() - expected.matrix()).norm(), 1e-12);
    EXPECT_LT((link_pose(scene, b, q).matrix() - poses[static_cast<size_t>(b)].matrix()).norm(), 1e-12);
  }
}

/// Speed, sagitta and stray hold for points of the ball, and not by a factor that would make them useless.
TEST(RelativeMotion, BoundsHoldForEveryPoint) {
  const machine::MachineScene scene = toy_machine();
  Rng rng(4);
  double tightest = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const RelativeMotion motion(scene, static_cast<int>(rng.uniform(0.0, 6.0)),
                                static_cast<int>(rng.uniform(0.0, 6.0)));
    AxisSegment segment;
    const double size = std::pow(10.0, rng.uniform(-3.0, 0.3));
    for (int k = 0; k < 5; ++k) {
      segment.q0[k] = rng.uniform(-3.0, 3.0);
      segment.q1[k] = segment.q0[k] + size * rng.uniform(-1.0, 1.0);
      segment.stray[k] = i % 3 == 0 ? 0.1 * size * rng.uniform() : 0.0;
    }
    const Vec3 centre = 100.0 * rng.uniform() * rng.direction();
    const MotionBounds bounds = motion.bounds(segment, centre, 5.0);
    const Vec3 point = centre + 5.0 * rng.direction();
    const double t = rng.uniform(), h = 1e-4;
    const auto at = [&](double s) -> Vec3 { return motion.pose(segment.at(s)) * point; };
    EXPECT_LE((at(t + h) - at(t)).norm() / h, bounds.speed * (1 + 1e-3) + 1e-9) << i;
    const double sagitta = ((1.0 - t) * at(0.0) + t * at(1.0) - at(t)).norm();
    EXPECT_LE(sagitta, bounds.slack(0.125) - bounds.slack(0.0) + 1e-12) << i;
    const double most = bounds.slack(0.125) - bounds.slack(0.0);
    if (most > 0.0) tightest = std::max(tightest, sagitta / most);
    AxisValues off = segment.at(t);
    for (int k = 0; k < 5; ++k) off[k] += segment.stray[k] * rng.uniform(-1.0, 1.0);
    EXPECT_LE((motion.pose(off) * point - at(t)).norm(), bounds.slack(0.0) * (1 + 1e-9) + 1e-9) << i;
    // Both together, along any direction.
    Vec3 n = rng.direction();
    if (i % 3 == 1) n = Vec3::Unit(i / 3 % 3);
    // Where only the wobble of that axis is left.
    if (i % 3 == 2 && !bounds.steps.empty())
      n = bounds.steps[static_cast<size_t>(i) / 3 % bounds.steps.size()].axis;
    const Vec3 whole = motion.pose(off) * point - ((1.0 - t) * at(0.0) + t * at(1.0));
    EXPECT_LE(std::abs(n.dot(whole)), bounds.slack(n, 0.125) * (1 + 1e-9) + 1e-9) << i;
  }
  EXPECT_GT(tightest, 0.8);
}

/// A short span at either end of a way on which the table turns often while its axis tilts: what the tilt
/// lets come of the turns along the axis counts.
TEST(RelativeMotion, BoundsHoldOnSpansOfWaysWithManyTurns) {
  const machine::MachineScene scene = toy_machine();
  const RelativeMotion motion(scene, kColumn, kTable);
  Rng rng(6);
  for (int i = 0; i < 2000; ++i) {
    const double tilt = rng.uniform(-1, 1), tilted = tilt + rng.uniform(-0.1, 0.1);
    const AxisSegment segment = way(axes(0, 0, 0, tilt), axes(0, 0, 0, tilted, rng.uniform(-80, 80)));
    const Vec3 centre = 50.0 * rng.direction();
    const MotionBounds bounds = motion.bounds(segment, centre, 1.0);
    const double length = std::pow(10.0, rng.uniform(-4.0, -1.0)), from = i % 2 == 0 ? 0.0 : 1.0 - length;
    const auto at = [&](double s) -> Vec3 { return motion.pose(segment.at(from + s * length)) * centre; };
    const Vec3 off = at(0.5) - 0.5 * (at(0.0) + at(1.0));
    for (const StepBound& step : bounds.steps) {
      EXPECT_LE(std::abs(step.axis.dot(off)), bounds.slack(step.axis, length * length / 8.0) + 1e-12) << i;
    }
  }
}

/// Between the bounds lies the least of many poses, and at t both witness points are that far apart.
void expect_least_of_poses(const Encounter& pair, const AxisSegment& segment, int poses, const char* label,
                           int number) {
  const Approach found = closest_approach(pair, segment, {});
  double least = INFINITY;
  for (int k = 0; k <= poses; ++k) {
    least =
        std::min(least, brute_distance(*pair.a, *pair.b, pair.b_from_a.pose(segment.at(k / double(poses)))));
  }
  EXPECT_LE(found.lower, least + 1e-9) << label << number;
  EXPECT_LE(found.upper, least + 1e-3) << label << number;
  EXPECT_LE(found.upper - found.lower, 1e-3 + 1e-9) << label << number;
  EXPECT_NEAR((found.point_a - found.point_b).norm(), found.upper, 1e-9) << label << number;
  const double at_t = brute_distance(*pair.a, *pair.b, pair.b_from_a.pose(segment.at(found.t)));
  EXPECT_NEAR(at_t, found.upper, 1e-3 + 1e-6) << label << number;
}

TEST(ClosestApproach, AgreesWithManyPoses) {
  const machine::MachineScene scene = toy_machine();
  Rng rng(7);
  for (int i = 0; i < 40; ++i) {
    const Body a =
        mesh_body("a", BodyKind::kPart, kTable, bumpy_ball(20.0 * rng.direction(), 15.0, 5, 7, rng));
    const Body b =
        mesh_body("b", BodyKind::kLink, kZSlide, bumpy_ball(50.0 * rng.direction(), 12.0, 4, 6, rng));
    AxisSegment segment;
    for (int k = 0; k < 5; ++k) {
      const double size = k < 3 ? 20.0 : 1.0;
      segment.q0[k] = size * rng.uniform(-1.0, 1.0);
      segment.q1[k] = size * rng.uniform(-1.0, 1.0);
    }
    expect_least_of_poses(encounter(scene, a, b), segment, 20, "forth ", i);
    expect_least_of_poses(encounter(scene, b, a), way(segment.q1, segment.q0), 20, "back ", i);
  }
}

TEST(ClosestApproach, FastMovePastAThinWall) {
  const machine::MachineScene scene = toy_machine();
  const Body wall = work_box({0, -50, 0}, {0.05, 50, 100});
  const Body needle = head_box({-100, 0, 50}, {-99.9, 0.1, 150});
  const Encounter pair = encounter(scene, wall, needle);
  // Through the wall within one segment; no end is near it.
  EXPECT_LT(closest_approach(pair, way(axes(0), axes(300))).upper, 1e-9);
  // Over it by 3 microns.
  const Approach over = closest_approach(pair, way(axes(0, 0, 50.003), axes(300, 0, 50.003)));
  EXPECT_NEAR(over.upper, 0.003, 1e-5);
  EXPECT_NEAR(over.lower, 0.003, 1e-3);
  EXPECT_NEAR(over.t * 300.0, 100.0, 0.2);
}

TEST(ClosestApproach, RotationSweepsWhatItsEndsDoNot) {
  const machine::MachineScene scene = toy_machine();
  const Body arm = work_box({50, -1, 0}, {100, 1, 2});  // turns about Z by half a turn and is back outside
  const Body post = mesh_body("post", BodyKind::kLink, kColumn, box_mesh({-1, 90, -5}, {1, 95, 5}));
  const Body far_post = mesh_body("far", BodyKind::kLink, kColumn, box_mesh({-1, 100.105, -5}, {1, 110, 5}));
  // A positive C turns the table from X to -Y.
  const AxisSegment towards = way(axes(0), axes(0, 0, 0, 0, -kPi)),
                    away = way(axes(0), axes(0, 0, 0, 0, kPi));
  EXPECT_LT(closest_approach(encounter(scene, arm, post), towards).upper, 1e-9);
  EXPECT_GT(closest_approach(encounter(scene, arm, post), away).lower, 50.0);
  // The corner at (100, +-1) passes the post on a circle.
  const double gap = 100.105F - std::hypot(100.0, 1.0);
  const Approach past = closest_approach(encounter(scene, arm, far_post), towards);
  EXPECT_LE(past.lower, gap + 1e-9);
  EXPECT_NEAR(past.lower, gap, 1.1e-3);
  EXPECT_NEAR(past.upper, gap, 1.1e-3);
}

TEST(ClosestApproach, StrayIsTakenOffTheBound) {
  const machine::MachineScene scene = toy_machine();
  const Body work = work_box({-10, -10, -10}, {10, 10, 0}), head = head_box({-5, -5, 3}, {5, 5, 9});
  AxisSegment segment = way(axes(-2), axes(2));
  segment.stray = axes(0, 0, 0.5, 0, 0.1);
  // Z strays by 0.5; C turns in the plane of the gap, which does not change it.
  ApproachQuery query;
  query.limit = 2.5;
  EXPECT_FALSE(closest_approach(encounter(scene, work, head), segment, query).within);
  EXPECT_GE(closest_approach(encounter(scene, work, head), segment, query).lower, 2.499);
  query.limit = 2.502;
  EXPECT_TRUE(closest_approach(encounter(scene, work, head), segment, query).within);
  EXPECT_LE(closest_approach(encounter(scene, work, head), segment, query).lower, 2.501);
}

TEST(ClosestApproach, LimitAndNothing) {
  const machine::MachineScene scene = toy_machine();
  const Body work = work_box({-10, -10, -10}, {10, 10, 0}), head = head_box({-5, -5, 30}, {5, 5, 40});
  ApproachQuery query;
  query.limit = 10.0;
  const Approach far = closest_approach(encounter(scene, work, head), way(axes(0), axes(9)), query);
  EXPECT_FALSE(far.within);
  EXPECT_GE(far.lower, 10.0 - query.tolerance);
  const Body none = mesh_body("none", BodyKind::kLink, kZSlide, {});
  EXPECT_FALSE(closest_approach(encounter(scene, work, none), way(axes(0), axes(9))).within);
  EXPECT_FALSE(first_contact(encounter(scene, work, none), way(axes(0), axes(9))).touches);
}

TEST(ClosestApproach, ToolsOfRevolution) {
  const machine::MachineScene scene = toy_machine();
  const Body work = work_box({-10, -10, -10}, {10, 10, 0});
  kinematics::MachineModel with = scene.model;
  with.tip_M = Vec3(0, 0, 20);
  const std::vector<ToolFrustum> parts{{0, 30, 4, 4}, {30, 60, 4, 25}};
  const Body tool = tool_body(scene, with, "tool", parts);
  const Encounter pair = encounter(scene, tool, work);
  EXPECT_NEAR(closest_approach(pair, way(axes(0), axes(0, 0, -15))).upper, 5.0, 1e-3);
  // The wide upper end stands over the block and comes down towards it; the thin part stays nearer.
  const Approach wide = closest_approach(pair, way(axes(20, 0, -40), axes(20, 0, -45)));
  EXPECT_NEAR(wide.upper, 6.0, 1e-3);
  // Beside the block, on a straight way along Y: 3 mm.
  const Approach beside = closest_approach(pair, way(axes(17, -100, -30), axes(17, 100, -30)));
  EXPECT_NEAR(beside.upper, 3.0, 1e-3);
  EXPECT_NEAR(beside.lower, 3.0, 1e-3);
}

}  // namespace
}  // namespace swarf::collision
