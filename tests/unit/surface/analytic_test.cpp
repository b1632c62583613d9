#include "surface/analytic.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"
#include "base/units.h"
#include "surface/curvature.h"

namespace swarf::surface {
namespace {

const double kSkew = rad_from_deg(20.0);

Turn random_turn(Rng& rng) {
  Turn turn;
  turn.base_W = 30.0 * rng.direction();
  turn.axis_W = rng.direction();
  turn.from_rad = rng.uniform(-3, 0);
  turn.to_rad = turn.from_rad + rng.uniform(0.5, 6);
  return turn;
}

struct Named {
  std::string name;
  SurfacePtr surface;
};

std::vector<Named> all_kinds(Rng& rng) {
  const Turn turn = random_turn(rng);
  const MaterialSide side = rng.uniform() < 0.5 ? MaterialSide::kConvex : MaterialSide::kConcave;
  return {{"plane",
           std::make_shared<PlaneSurface>(10 * rng.direction(), 20 * rng.direction(), 30 * rng.direction())},
          {"cylinder", cylinder_surface(turn, rng.uniform(2, 40), rng.uniform(5, 50), side)},
          {"cone", cone_surface(turn, 30.0, rng.uniform(-0.5, 0.5), 40.0, side)},
          {"sphere", sphere_surface(turn, rng.uniform(2, 40), 0.2, 2.5, side)},
          {"hyperboloid", hyperboloid_surface(turn, {30.0, rng.uniform(-0.8, 0.8), 5.0}, -20.0, 25.0)}};
}

TEST(AnalyticSurface, DerivativesAgreeWithFiniteDifferences) {
  Rng rng(71);
  constexpr double h = 1e-4;
  for (int trial = 0; trial < 40; ++trial) {
    for (const Named& one : all_kinds(rng)) {
      const Surface& S = *one.surface;
      const double u = rng.uniform(0.01, 0.99), v = rng.uniform(0.01, 0.99);
      const Derivatives d = S.derivatives(u, v);
      const auto near = [&](const Vec3& exact, const Vec3& difference, const char* what) {
        EXPECT_LT((exact - difference).norm(), 3e-6 * (1.0 + exact.norm()) + 2e-5)
            << one.name << " " << what << fmt::format(" at u = {}, v = {}, trial {}", u, v, trial);
      };
      EXPECT_LT((d.S - S.point(u, v)).norm(), 1e-12) << one.name;
      near(d.Su, (S.point(u + h, v) - S.point(u - h, v)) / (2 * h), "Su");
      near(d.Sv, (S.point(u, v + h) - S.point(u, v - h)) / (2 * h), "Sv");
      const Derivatives right = S.derivatives(u + h, v), left = S.derivatives(u - h, v);
      const Derivatives above = S.derivatives(u, v + h), below = S.derivatives(u, v - h);
      near(d.Suu, (right.Su - left.Su) / (2 * h), "Suu");
      near(d.Suv, (right.Sv - left.Sv) / (2 * h), "Suv");
      near(d.Svv, (above.Sv - below.Sv) / (2 * h), "Svv");
    }
  }
}

TEST(AnalyticSurface, CurvaturesAreThoseOfTheClosedForms) {
  Rng rng(72);
  for (int trial = 0; trial < 50; ++trial) {
    const double u = rng.uniform(), v = rng.uniform(), R = rng.uniform(2, 40);
    const bool convex = rng.uniform() < 0.5;
    const MaterialSide side = convex ? MaterialSide::kConvex : MaterialSide::kConcave;
    const double sign = convex ? 1.0 : -1.0;
    const auto curvatures = [&](const SurfacePtr& s) {
      return principal_curvatures(shape_at(s->derivatives(u, v), s->outward_sign()));
    };
    const PrincipalCurvatures cylinder = curvatures(cylinder_surface(random_turn(rng), R, 20, side));
    EXPECT_NEAR(convex ? cylinder.high : cylinder.low, sign / R, 1e-12);
    EXPECT_NEAR(convex ? cylinder.low : cylinder.high, 0.0, 1e-12);
    const PrincipalCurvatures sphere = curvatures(sphere_surface(random_turn(rng), R, 0.3, 2.8, side));
    EXPECT_NEAR(sphere.low, sign / R, 1e-12);
    EXPECT_NEAR(sphere.high, sign / R, 1e-12);
    // A cone is curved round its axis by cos(alpha)/r.
    const double alpha = rng.uniform(-0.6, 0.6), r = 50.0 - v * 30.0 * std::tan(alpha);
    const PrincipalCurvatures cone = curvatures(cone_surface(random_turn(rng), 50, alpha, 30, side));
    EXPECT_NEAR(convex ? cone.high : cone.low, sign * std::cos(alpha) / r, 1e-12);
  }
}

TEST(AnalyticSurface, NormalsPointOutOfTheMaterial) {
  Rng rng(73);
  for (int trial = 0; trial < 50; ++trial) {
    const Turn turn = random_turn(rng);
    for (const MaterialSide side : {MaterialSide::kConvex, MaterialSide::kConcave}) {
      for (const SurfacePtr& s :
           {cylinder_surface(turn, 8, 20, side), sphere_surface(turn, 8, 0.3, 2.8, side)}) {
        const Derivatives d = s->derivatives(rng.uniform(), rng.uniform());
        const Vec3 arm = d.S - turn.base_W;
        const Vec3 radial = arm - arm.dot(turn.axis_W) * turn.axis_W;
        const double outwards = outward_normal(*s, d).dot(radial);
        EXPECT_GT(side == MaterialSide::kConvex ? outwards : -outwards, 0.0);
      }
    }
  }
  const PlaneSurface plane({0, 0, 5}, {10, 0, 0}, {0, 10, 0});
  EXPECT_LT((outward_normal(plane, plane.derivatives(0.5, 0.5)) - Vec3::UnitZ()).norm(), 1e-15);
}

TEST(Hyperboloid, MeetsTheOraclePointsOfTheory6) {
  const Hyperboloid shape{30.0, kSkew, 5.0};
  const double oracle[3][3] = {{0, 25, 0}, {10, 25.198577496, 9.602891161}, {40, 28.028236159, 38.334330944}};
  for (const auto& [s, rho, z] : oracle) {
    const Meridian m = hyperboloid_meridian(shape, s);
    EXPECT_NEAR(m.r, rho, 1e-9) << "s " << s;
    EXPECT_NEAR(m.z, z, 1e-9) << "s " << s;
  }
}

TEST(Hyperboloid, LiesOneRadiusFromTheTurningCylindersAxis) {
  // Independent of the formula: over all table angles the least distance of a surface point to the skew axis
  // is the cutter's radius.
  Turn turn;
  turn.base_W = {-8, 3, 1};
  const SurfacePtr s = hyperboloid_surface(turn, {30.0, kSkew, 5.0}, -18.0, 14.0);
  for (const double v : {0.0, 0.2, 0.5, 0.77, 1.0}) {
    const Vec3 point = s->point(0.3, v) - turn.base_W;
    const auto distance = [&](double angle) {
      const Mat3 R = Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix();
      const Vec3 on_axis = R * Vec3(30, 0, 0), along = R * Vec3(0, std::sin(kSkew), std::cos(kSkew));
      return (point - on_axis).cross(along).norm();
    };
    double best = 0.0, least = 1e9;
    for (int i = 0; i < 3600; ++i) {
      const double angle = rad_from_deg(0.1 * i);
      if (distance(angle) < least) least = distance(best = angle);
    }
    double low = best - 0.002, high = best + 0.002;
    for (int i = 0; i < 200; ++i) {
      const double a = low + (high - low) / 3, b = high - (high - low) / 3;
      (distance(a) < distance(b) ? high : low) = distance(a) < distance(b) ? b : a;
    }
    EXPECT_NEAR(distance(low), 5.0, 1e-9) << "v " << v;
  }
  EXPECT_NEAR(s->point(0.1, 0.0).z() - turn.base_W.z(), -18.0, 1e-9);
  EXPECT_NEAR(s->point(0.1, 1.0).z() - turn.base_W.z(), 14.0, 1e-9);
}

}  // namespace
}  // namespace swarf::surface
