// Oracles of theory 5: surface F1, and brute force.
#include "flank/placement.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"
#include "cutter/profile.h"
#include "flank/envelope.h"
#include "flank/feed.h"
#include "flank/flank_check.h"
#include "flank/flank_path.h"
#include "flank_surfaces.h"
#include "surface/nurbs.h"
#include "surface/polynomial.h"

namespace swarf::flank {
namespace {

using test::f1;
using test::jcde;
using test::random_ruled;

FlankProfile cylinder(double radius = 8.0) {
  FlankProfile profile;
  profile.radius = radius;
  profile.low = 0.0;
  profile.high = 45.0;
  return profile;
}

FlankTask task_of(Placement placement) {
  return {f1(), cylinder(), placement, 3.0};
}

TEST(FlankPlacement, ThePublishedOneCutsAsDeepAsTheTheorySays) {
  const FlankTask task = task_of(Placement::kPublished);
  // Of each axis alone the error on the axis surface is that of the continuous envelope: -.103373.
  EXPECT_NEAR(worst_error(task).mm, -0.103373, 5e-6);
  const AxisError middle = axis_error(task, pose_at(task, 0.5), 0.5);
  EXPECT_NEAR(middle.greatest_mm, 0.0, 1e-9);
}

TEST(FlankPlacement, BalancedHalvesAndMinimaxIsLowest) {
  const double published = std::abs(worst_error(task_of(Placement::kPublished)).mm);
  const double balanced = std::abs(worst_error(task_of(Placement::kBalanced)).mm);
  const double minimax = std::abs(worst_error(task_of(Placement::kMinimax)).mm);
  EXPECT_NEAR(balanced, 0.5 * published, 0.01 * published);
  EXPECT_LT(minimax, 0.2 * balanced);
}

/// Lifts and turn on a grid that closes in on its best place: what no other axis through this ruling beats.
double brute_force(const FlankTask& published, double u) {
  const ToolPose start = pose_at(published, u);
  const surface::Surface& S = *published.surface;
  const surface::Derivatives a = S.derivatives(u, 0.0), b = S.derivatives(u, 1.0);
  const Vec3 N0 = surface::outward_normal(S, a), N1 = surface::outward_normal(S, b);
  const Vec3 across = start.axis_W.cross(N0 + N1).normalized();
  const Vec3 low = start.tip_W + published.tip_below_mm * start.axis_W;
  const double length = (b.S - a.S + 8.0 * (N1 - N0)).norm();
  const Vec3 high = low + length * start.axis_W;
  Vec3 centre(0.05, 0.05, 0.0);
  double best = 1e9;
  for (double step = 2.0; step > 1e-7; step *= 0.7) {
    Vec3 next = centre;
    for (int n = 0; n < 125; ++n) {
      const Vec3 x = centre + step * Vec3(0.04 * (n % 5 - 2), 0.04 * (n / 5 % 5 - 2), n / 25 - 2);
      const Vec3 p0 = low + x[0] * N0 - x[2] * across, p1 = high + x[1] * N1 + x[2] * across;
      double most = 0.0;
      for (int i = 0; i <= 64; ++i) {
        const Foot foot = foot_of(S, p0 + i / 64.0 * (p1 - p0), u, i / 64.0);
        most = std::max(most, std::abs(foot.distance_mm - 8.0));
      }
      if (most < best) best = most, next = x;
    }
    centre = next;
  }
  return best;
}

TEST(FlankPlacement, MinimaxIsTheBestThatBruteForceFinds) {
  const FlankTask minimax = task_of(Placement::kMinimax);
  for (const double u : {0.1, 0.5, 0.83}) {
    const double ours = axis_error(minimax, pose_at(minimax, u), u).most_mm();
    const double brute = brute_force(task_of(Placement::kPublished), u);
    EXPECT_LE(ours, brute * 1.005 + 1e-7) << u;
    EXPECT_GE(ours, brute * 0.98 - 1e-6) << u;
  }
}

TEST(FlankEnvelope, ARayMeetsTheEnvelopeWhereTheErrorSays) {
  const FlankTask task = task_of(Placement::kPublished);
  std::vector<ToolPose> poses;
  for (int i = 0; i <= 400; ++i) poses.push_back(pose_at(task, i / 400.0));
  const PoseTrack track(poses, task.profile);
  double least = 0.0;
  for (int i = 4; i <= 36; ++i) {
    for (int j = 0; j <= 20; ++j) {
      const surface::Derivatives d = task.surface->derivatives(i / 40.0, j / 20.0);
      const auto h = track.height(d.S, surface::outward_normal(*task.surface, d));
      ASSERT_TRUE(h) << i << " " << j;
      least = std::min(least, *h);
    }
  }
  EXPECT_NEAR(least, -0.10337, 2e-4);  // on a grid: not the deepest place itself
}

TEST(FlankEnvelope, TheGrazingConditionHoldsWhereAPointIsNearest) {
  FlankProfile cone = cylinder(5.0);
  cone.taper_rad = 0.1;
  cone.low = 5.0 * std::tan(0.1);
  FlankTask task{f1(), cone, Placement::kBalanced, 3.0};
  std::vector<ToolPose> poses;
  for (int i = 0; i <= 50; ++i) poses.push_back(pose_at(task, i / 50.0));
  const PoseTrack track(poses, cone);
  for (const double v : {0.2, 0.5, 0.9}) {
    const Vec3 x = task.surface->point(0.43, v);
    const PoseTrack::Nearest near = track.nearest(x);
    ASSERT_GT(near.share, 0.0);
    ASSERT_LT(near.share, 1.0);
    const ToolPose &a = poses[near.step], &b = poses[near.step + 1];
    const ToolPose at = between(a, b, near.share);
    const Vec3 adot = [&] {
      const Vec3 raw = (1.0 - near.share) * a.axis_W + near.share * b.axis_W;
      const Vec3 by = b.axis_W - a.axis_W;
      return Vec3((by - at.axis_W * at.axis_W.dot(by)) / raw.norm());
    }();
    const Vec3 speed = b.tip_W - a.tip_W;
    const Vec3 d = x - at.tip_W;
    const double z = d.dot(at.axis_W);
    const double c = nearest_ball(cone, z, (d - z * at.axis_W).norm());
    // Theory 5: N . (v + z_c adot) = 0, N the outward normal of the flank, z_c the centre of its ball.
    EXPECT_NEAR(near.outward.dot(speed + c * adot) / speed.norm(), 0.0, 1e-6) << v;
  }
}

/// Nearest place of a finely divided outline that faces the point.
double outline_distance(const std::vector<Vec2>& corners, const Vec2& point) {
  double least = 1e9;
  for (size_t i = 1; i < corners.size(); ++i) {
    const Vec2 way = corners[i] - corners[i - 1];
    const double t = std::clamp((point - corners[i - 1]).dot(way) / way.squaredNorm(), 0.0, 1.0);
    const Vec2 d = point - corners[i - 1] - t * way;
    const double side = way.x() * d.y() - way.y() * d.x();  // the cutter lies to the left
    if (d.norm() < std::abs(least)) least = side > 0.0 ? -d.norm() : d.norm();
  }
  return least;
}

TEST(FlankProfile, BallsAlongTheAxisAreTheFlank) {
  cutter::Cutter cylinder;
  cylinder.flute_length_mm = 30;
  cutter::Cutter taper = cylinder;
  taper.shape = cutter::Shape::kTaper;
  taper.diameter_mm = 4;
  taper.taper_rad = 0.12;
  cutter::Cutter barrel = cylinder;
  cutter::set_profile(barrel, {{{0, 0}, 0}, {{4, 0}, 0}, {{4, 20}, 60}, {{0, 21}, 0}});
  for (const cutter::Cutter& cutter : {cylinder, taper, barrel}) {
    const auto profile = flank_profile(cutter);
    ASSERT_TRUE(profile) << cutter::describe(cutter);
    const std::vector<Vec2> corners = cutter::sample_outline(cutter::outline(cutter), 1e-7);
    for (const double height : {4.0, 9.0, 16.0}) {
      for (const double out : {-0.3, 0.0, 0.2, 2.0}) {
        const double c = nearest_ball(*profile, height, 4.0);
        const Vec2 point(ball_radius(*profile, c) + out, height);
        EXPECT_NEAR(flank_distance(*profile, point.y(), point.x()), outline_distance(corners, point), 2e-7)
            << cutter::describe(cutter) << " at " << point.transpose();
      }
    }
  }
}

TEST(FlankProfile, ADrillPointAloneIsNoFlank) {
  cutter::Cutter cutter;
  cutter::set_profile(cutter, {{{0, 0}, 0}, {{5, 3}, 0}, {{0, 4}, 0}});
  EXPECT_FALSE(flank_profile(cutter));
}

TEST(FlankProperty, EveryPlacementIsBetterThanTheOneBefore) {
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    Rng rng(seed);
    FlankProfile profile = cylinder(rng.uniform(2.0, 8.0));
    profile.taper_rad = rng.uniform(0.0, 0.1);
    profile.low = profile.radius * std::tan(profile.taper_rad);
    FlankTask task{random_ruled(rng), profile, Placement::kPublished, 2.0};
    Diagnostics told;
    check_task(task, {}, told);
    if (told.has_errors()) continue;
    for (const double u : {0.0, 0.37, 1.0}) {
      double before = 1e9;
      for (const Placement placement : {Placement::kPublished, Placement::kBalanced, Placement::kMinimax}) {
        task.placement = placement;
        const double error = axis_error(task, pose_at(task, u), u).most_mm();
        EXPECT_LE(error, before + 1e-9)
            << "seed " << seed << ", u " << u << ", " << placement_name(placement);
        before = error;
      }
    }
  }
}

/// The least of many poses: what no search may miss.
TEST(FlankProperty, NoPoseOfATrackIsNearerThanTheNearest) {
  for (uint64_t seed = 1; seed <= 30; ++seed) {
    Rng rng(seed);
    const FlankProfile profile = cylinder(rng.uniform(2.0, 6.0));
    std::vector<ToolPose> poses;
    Vec3 tip(0, 0, 0), axis(0, 0, 1);
    for (int i = 0; i < 40; ++i) {  // it turns and comes back over its own way
      tip += Vec3{rng.uniform(-2, 3), rng.uniform(-2, 2), rng.uniform(-1, 1)};
      axis = (axis + Vec3{rng.uniform(-0.2, 0.2), rng.uniform(-0.2, 0.2), 0}).normalized();
      poses.push_back({tip, axis});
    }
    const PoseTrack track(poses, profile);
    for (int k = 0; k < 20; ++k) {
      const Vec3 x{rng.uniform(-20, 40), rng.uniform(-20, 20), rng.uniform(0, 30)};
      double brute = 1e9;
      for (size_t i = 1; i < poses.size(); ++i) {
        for (int s = 0; s <= 200; ++s) {
          const ToolPose at = between(poses[i - 1], poses[i], s / 200.0);
          const Vec3 d = x - at.tip_W;
          const double h = d.dot(at.axis_W);
          brute = std::min(brute, flank_distance(profile, h, (d - h * at.axis_W).norm()));
        }
      }
      const double found = track.nearest(x).distance_mm;
      EXPECT_LE(found, brute + 1e-9) << "seed " << seed << ", x " << x.transpose();
      EXPECT_GE(found, brute - 2e-3) << "seed " << seed << ", x " << x.transpose();
    }
  }
}

TEST(FlankPlacement, NoFeedGoesBelowTheTwist) {
  FlankTask task = task_of(Placement::kPublished);
  EXPECT_NEAR(twist_bound(task, 0.0), 0.093622647, 1e-9);  // theory 5, F1: r (1 - cos(psi / 2))
  EXPECT_NEAR(twist_bound(task, 0.5), 0.103300339, 1e-9);
  task.profile.taper_rad = 0.05;
  for (const double u : {0.1, 0.5, 0.9})
    EXPECT_LE(twist_bound(task, u), -axis_error(task, pose_at(task, u), u).least_mm) << u;
}

TEST(FlankFeed, SagittaOfTheTightestCorner) {
  EXPECT_NEAR(sagitta_feed(4.08572, 1e-3, 1e-3), 180.781, 1e-3);
  EXPECT_NEAR(sagitta_feed(4.08572, 1e-3, 5e-3), 404.140, 1e-3);
}

TEST(FlankFeed, FiguresOfThePublishedPath) {
  const GuideFigures P = guide_figures(*jcde(), 0.0), H = guide_figures(*jcde(), 1.0);
  EXPECT_NEAR(P.length_mm, 98.168133, 1e-6);
  EXPECT_NEAR(H.length_mm, 115.349742, 1e-6);
  EXPECT_NEAR(P.radius_min_mm, 4.08572, 1e-5);
  EXPECT_NEAR(P.radius_min_u, 0.10094, 1e-5);
}

TEST(FlankFeed, TheBisectedFeedMeetsItsLimit) {
  const FlankTask task = task_of(Placement::kMinimax);
  const AxisFamily family(task);
  const double limit = 1.05 * std::abs(worst_error(task).mm);
  const double feed = bisected_feed(task, family, 0.5, 0.05, limit, 2000.0);
  ASSERT_GT(feed, 0.0);
  ASSERT_LT(feed, 2000.0);
  EXPECT_NEAR(chord_error(task, family, 0.5, feed * 0.05).most_mm(), limit, 1e-6);
  EXPECT_EQ(bisected_feed(task, family, 0.5, 0.05, 0.1 * limit, 2000.0), 0.0);
}

TEST(FlankCheck, TellsWhatCannotBeMilled) {
  const auto code = [](const FlankTask& task) {
    Diagnostics found;
    check_task(task, {}, found);
    return found.list().empty() ? std::string() : found.list().front().code;
  };
  EXPECT_EQ(code(task_of(Placement::kMinimax)), "");
  FlankTask shorter = task_of(Placement::kPublished);
  shorter.profile.high = 25.0;
  EXPECT_EQ(code(shorter), "cutter-too-short");
  FlankTask opposed = task_of(Placement::kPublished);
  opposed.surface = std::make_shared<surface::PolynomialSurface>(
      1, 1, std::vector<Vec3>{{0, 0, 0}, {60, 0, 30}, {60, 0, 0}, {-120, 1, 0}}, 1);
  EXPECT_EQ(code(opposed), "guides-opposed");
  FlankTask hollow = task_of(Placement::kPublished);  // y = x^2 / 8 from below: radius 4 at x = 0
  hollow.surface = std::make_shared<surface::PolynomialSurface>(
      2, 1, std::vector<Vec3>{{-10, -12.5, 0}, {0, 0, 30}, {20, 50, 0}, {0, 0, 0}, {0, -50, 0}, {0, 0, 0}},
      -1);
  EXPECT_EQ(code(hollow), "");
  hollow.surface = std::make_shared<surface::PolynomialSurface>(
      2, 1, std::vector<Vec3>{{-10, -12.5, 0}, {0, 0, 30}, {20, 50, 0}, {0, 0, 0}, {0, -50, 0}, {0, 0, 0}},
      1);
  EXPECT_EQ(code(hollow), "cutter-too-large");
}

}  // namespace
}  // namespace swarf::flank
