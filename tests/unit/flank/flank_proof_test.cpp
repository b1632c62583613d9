// Proofs over the whole surface against places that a grid of 257 rulings does not see.
#include "flank/flank_proof.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"
#include "flank/flank_check.h"
#include "flank/rotary_feed.h"
#include "flank_surfaces.h"
#include "surface/curvature.h"
#include "surface/nurbs.h"
#include "surface/polynomial.h"

namespace swarf::flank {
namespace {

FlankTask milled(surface::SurfacePtr surface, double radius) {
  FlankProfile profile;
  profile.radius = radius;
  profile.high = 80.0;
  return {std::move(surface), profile, Placement::kPublished, 2.0};
}

std::string code_of(const FlankTask& task) {
  Diagnostics found;
  check_task(task, {}, found);
  return found.list().empty() ? std::string() : found.list().front().code;
}

/// A wall along X whose guides step by `depth_mm` within `width` of u, between the rulings n/256: cubic
/// splines.
surface::SurfacePtr notched(double width, double depth_mm, double upper_mm) {
  surface::NurbsData data;
  data.degree_u = 3;
  data.degree_v = 1;
  data.knots_v = {0, 0, 1, 1};
  const double middle = 100.5 / 256.0, w = width / 8.0;
  data.knots_u = {0, 0, 0, 0};
  for (int i = -4; i <= 4; ++i) data.knots_u.push_back(middle + i * w);
  data.knots_u.insert(data.knots_u.end(), {1, 1, 1, 1});
  const int poles = static_cast<int>(data.knots_u.size()) - 4;
  for (int i = 0; i < poles; ++i) {
    const double x =
        (data.knots_u[i + 1] + data.knots_u[i + 2] + data.knots_u[i + 3]) / 3.0;  // Greville: x = 100 u
    const double y = i == poles / 2 ? depth_mm : 0.0, y1 = i == poles / 2 ? upper_mm : 0.0;
    data.poles.push_back({100.0 * x, y, 0});
    data.poles.push_back({100.0 * x, y1, 30});
  }
  data.outward_sign = 1;
  return std::make_shared<surface::NurbsSurface>(data);
}

/// Least radius of the hollow by a grid that is fine enough to see it.
double least_hollow(const surface::Surface& S) {
  double most = 0.0;
  // Second derivatives are linear between knots: the crest lies at one of them, or nearly.
  std::vector<double> places;
  for (int i = 0; i <= 40000; ++i) places.push_back(i / 40000.0);
  for (const double knot : static_cast<const surface::NurbsSurface&>(S).grid().breaks_u)
    places.push_back(knot);
  for (const double u : places) {
    const surface::Derivatives d = S.derivatives(u, 0.5);
    const surface::Shape shape = surface::shape_at(d, S.outward_sign());
    const Vec2 across = shape.in_tangent(shape.normal.cross(d.Sv).normalized());
    most = std::max(most, -surface::normal_curvature(shape, across));
  }
  return 1.0 / most;
}

TEST(FlankProof, AHollowBetweenTheRulingsLookedAtIsFound) {
  for (const double sign : {1.0, -1.0}) {
    // The step lies wholly between two of 257 rulings, which are straight there.
    const surface::SurfacePtr wall = notched(0.9 / 256.0, sign * 2e-3, sign * 2e-3);
    const double hollow = least_hollow(*wall);
    ASSERT_LT(hollow, 20.0);
    EXPECT_EQ(code_of(milled(wall, 1.01 * hollow)), "cutter-too-large") << sign;
    EXPECT_EQ(code_of(milled(wall, 0.98 * hollow)), "") << sign;
  }
}

TEST(FlankProof, ATurnBetweenTheRulingsLookedAtIsFound) {
  // Guide 1 runs back inside the step.
  surface::NurbsData data;
  const surface::SurfacePtr straight = notched(0.9 / 256.0, 0.0, 0.0);
  const auto& wall = static_cast<const surface::NurbsSurface&>(*straight);
  surface::BezierGrid grid = wall.grid();
  // The middle poles of the strip in the middle of guide 1, pushed along X.
  const size_t strip = grid.breaks_u.size() / 2 - 1, first = strip * grid.patch_size();
  grid.poles[first + 1 * 2 + 1].x() += 0.5;
  grid.poles[first + 2 * 2 + 1].x() -= 0.5;
  const FlankTask task = milled(std::make_shared<surface::NurbsSurface>(grid, 1), 3.0);
  const std::optional<WeakPlace> weak = turned_ruling(task);
  ASSERT_TRUE(weak);
  EXPECT_GT(weak->u, 100.0 / 256.0);
  EXPECT_LT(weak->u, 101.0 / 256.0);
  EXPECT_FALSE(turned_ruling(milled(straight, 3.0)));
}

TEST(FlankProof, WhatItPassesABruteForceGridPassesToo) {
  int passed = 0;
  for (uint64_t seed = 1; seed <= 40; ++seed) {
    Rng rng(seed);
    const FlankTask task = milled(test::random_ruled(rng), rng.uniform(4.0, 60.0));
    if (turned_ruling(task)) continue;
    const std::optional<WeakPlace> weak = narrow_place(task);
    double room = 1e9;
    for (int i = 0; i <= 300; ++i)
      for (int j = 0; j <= 60; ++j) {
        const surface::Derivatives d = task.surface->derivatives(i / 300.0, j / 60.0);
        const surface::Shape shape = surface::shape_at(d, 1);
        const Vec2 across = shape.in_tangent(shape.normal.cross(d.Sv).normalized());
        const double k = -surface::normal_curvature(shape, across);
        if (k > 0.0) room = std::min(room, 1.0 / k - task.profile.radius);
      }
    if (weak && weak->shown) {
      EXPECT_LT(room, 0.02 * task.profile.radius) << "seed " << seed;
    }
    if (!weak) {
      EXPECT_GE(room, 0.0) << "seed " << seed;
    }
    passed += weak ? 0 : 1;
  }
  EXPECT_GT(passed, 5);
}

TEST(FlankFeed, TheCAxisOfThePublishedPath) {
  const surface::SurfacePtr path = test::jcde();
  // At u = .6 the guides are P' = (50,0,0), R = (0,5,15), R' = (-25,..): C turns at 5 rad per unit of u.
  EXPECT_NEAR(c_limited_feed(*path, 0.6, {0.8, 0.5}).by_speed, 8.0, 1e-9);
  // By differences of atan2 itself.
  for (const double u : {0.05, 0.3, 0.55, 0.93}) {
    const auto C = [&](double x) {
      const Vec3 R = path->derivatives(x, 0.0).Sv;
      return std::atan2(R.x(), -R.y());
    };
    const auto A = [&](double x) { return std::acos(path->derivatives(x, 0.0).Sv.normalized().z()); };
    const double speed = path->derivatives(u, 0.0).Su.norm(), h = 1e-6;
    EXPECT_NEAR(0.8 / c_limited_feed(*path, u, {0.8, 0.5}).by_speed,
                std::abs(std::remainder(C(u + h) - C(u - h), 2 * M_PI)) / (2 * h * speed), 1e-7)
        << u;
    EXPECT_NEAR(0.4 / a_limited_feed(*path, u, {0.4, 0.5}).by_speed,
                std::abs(A(u + h) - A(u - h)) / (2 * h * speed), 1e-7)
        << u;
  }
  const FeedLow least = least_c_feed(*path, {0.8, 0.5});
  for (int i = 0; i <= 1000; ++i)
    EXPECT_GE(c_limited_feed(*path, i / 1000.0, {0.8, 0.5}).by_speed, least.mm_s - 1e-6);
}

}  // namespace
}  // namespace swarf::flank
