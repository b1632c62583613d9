// The closed forms of theory 1.1 against its oracles, to the printed digits.
#include "toolpath/scallop_interval.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/rng.h"
#include "base/units.h"
#include "exact_cusps.h"

namespace swarf::toolpath {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(ScallopInterval, ChordPlaneDistanceAndArcOfAFlatEndOnACircle) {
  struct Row {
    double R, h, chord, plane, arc;
  };
  for (const Row& row :
       {Row{50, .01, 1.9997001, 2.0001000, 1.9998333}, Row{20, .05, 2.8231365, 2.8301943, 2.8254856},
        Row{10, 1, 8.3319558, 9.1651514, 8.5939930}}) {
    EXPECT_NEAR(chord_for_scallop(row.R, row.h), row.chord, 5e-8);
    EXPECT_NEAR(test::tangent_plane_distance(row.R, row.h), row.plane, 5e-8);
    EXPECT_NEAR(test::arc_between_passes(row.R, row.h), row.arc, 5e-7);  // printed to six decimals
    EXPECT_NEAR(scallop_for_chord(row.R, row.chord), row.h, 1e-7);
  }
}

TEST(ScallopInterval, ChordAndScallopAreInverse) {
  Rng rng(11);
  for (int i = 0; i < 1000; ++i) {
    const double R = std::pow(10.0, rng.uniform(0.0, 6.0));
    const double h = std::pow(10.0, rng.uniform(-5.0, 0.0));
    EXPECT_NEAR(scallop_for_chord(R, chord_for_scallop(R, h)) / h, 1.0, 1e-9) << "R " << R << " h " << h;
  }
}

TEST(ScallopInterval, APlaneHasNoScallopAndNoBound) {
  EXPECT_EQ(chord_for_scallop(kInfinity, 0.01), kInfinity);
  EXPECT_EQ(scallop_for_chord(kInfinity, 3.0), 0.0);
  EXPECT_EQ(reach_limit(10.0, kInfinity, 0.01), 10.0);
  EXPECT_EQ(largest_reachable_scallop(10.0, kInfinity), 0.0);
  EXPECT_EQ(strip_curvature(Mat2::Zero(), {1.0, 0.0}), 0.0);
}

TEST(ScallopInterval, TheLargestReachableScallopMeetsTheReachLimit) {
  for (const double R : {6.0, 50.0, 1e4}) {
    const double h = largest_reachable_scallop(10.0, R);
    EXPECT_NEAR(chord_for_scallop(R, h), reach_limit(10.0, R, h), 1e-9);
  }
  // Erratum E2: P = D does not reach the cusp.
  EXPECT_LT(reach_limit(10.0, 20.0, 0.5), 10.0);
}

TEST(ScallopInterval, TheRadiusThatCountsDependsOnTheFeedDirection) {
  // Disc r = 8 on z = -(x^2/40 + y^2/120)/2 at cross distance w = 2: h = (w^2/2) det K/(t'Kt).
  Mat2 K;
  K << 1.0 / 40.0, 0.0, 0.0, 1.0 / 120.0;
  const double degrees[] = {0, 20, 45, 70, 90};
  const double exact[] = {.016667, .018076, .025000, .040520, .050000};
  const double paper[] = {.016667, .020566, .033333, .046101, .050000};
  const double w = 2.0;
  for (int i = 0; i < 5; ++i) {
    const double angle = rad_from_deg(degrees[i]);
    const Vec2 t(std::cos(angle), std::sin(angle));
    EXPECT_NEAR(0.5 * w * w * strip_curvature(K, t), exact[i], 6e-7) << degrees[i];
    EXPECT_NEAR(0.5 * w * w * cross_curvature(K, t), paper[i], 6e-7) << degrees[i];
    EXPECT_NEAR(1.0 / strip_curvature(K, t), t.dot(K * t) / K.determinant(), 1e-9);
  }
}

TEST(ScallopInterval, AStraightFeedAlongACylinderHasTheCrossCurvature) {
  Mat2 K;
  K << 0.0, 0.0, 0.0, 0.02;
  EXPECT_EQ(strip_curvature(K, {1.0, 0.0}), 0.02);
  EXPECT_NEAR(strip_curvature(K, {0.0, 1.0}), 0.0, 1e-18);
  EXPECT_NEAR(strip_curvature(K, Vec2(0.6, 0.8)), 0.0, 1e-16);
}

Lean lean_deg(double phi, double omega) {
  return {rad_from_deg(phi), rad_from_deg(omega)};
}

TEST(ScallopInterval, EffectiveRadiusOfALeanedFlatEnd) {
  // On a plane P^2/8h tends to R_eff as h tends to 0: (r/sin phi) cos^2(omega).
  const double h = 1e-9;
  for (const RimSides sides : {RimSides::kBalanced, RimSides::kBothLeft, RimSides::kBothRight}) {
    const double P = leaned_chord({}, h, lean_deg(8, 25), 5.0, sides);
    EXPECT_NEAR(P * P / (8.0 * h), 29.5098, sides == RimSides::kBalanced ? 5e-5 : 5e-3);
  }
  EXPECT_NEAR(test::effective_radius(5.0, 0.0, rad_from_deg(8), rad_from_deg(25)), 29.5098, 5e-5);
}

TEST(ScallopInterval, AFlatEndLeanedOnAPlane) {
  struct Row {
    double phi, P, h;
  };
  for (const Row& row : {Row{5, 2, .0088045}, Row{10, 4, .0724850}, Row{20, 2, .0345511}}) {
    const Lean lean = lean_deg(row.phi, 0.0);
    EXPECT_NEAR(leaned_scallop({}, row.P, lean, 5.0, RimSides::kBalanced), row.h, 5e-8);
    EXPECT_NEAR(
        leaned_chord({}, test::leaned_flat_on_plane(5.0, lean.angle, row.P), lean, 5.0, RimSides::kBalanced),
        row.P, 1e-9);
  }
}

TEST(ScallopInterval, LeanedChordAndScallopAreInverseUpToTheRim) {
  Rng rng(3);
  for (int i = 0; i < 500; ++i) {
    const Lean lean{rng.uniform(0.02, 0.6), rng.uniform(-1.0, 1.0)};
    const auto sides = static_cast<RimSides>(i % 3);
    const double rim = std::sin(lean.angle) / 5.0;
    const double across = rng.uniform(-0.7 * rim, 0.05);
    const LeanedCurvature k{across, rng.uniform(-0.3, 0.3) * (rim + across)};
    const double h = rng.uniform(0.001, 0.02);
    const double P = leaned_chord(k, h, lean, 5.0, sides);
    // Near the rim the height is too steep to be inverted, and the corrections converge slowly.
    if (h < 0.1 * (5.0 * std::sin(lean.angle) + 12.5 * std::min(0.0, k.across))) {
      EXPECT_NEAR(leaned_scallop(k, P, lean, 5.0, sides), h, 1e-4 * h)
          << "across " << k.across << " twist " << k.twist << " h " << h << " phi " << lean.angle << " omega "
          << lean.yaw;
    }
    EXPECT_LE(leaned_chord(k, 1e3, lean, 5.0, RimSides::kBalanced), 10.0 * std::cos(lean.yaw) + 1e-12);
  }
}

TEST(ScallopInterval, TheLeanedFlatEndIsTheLimitOfTheMatrixFormula) {
  // h = (P^2/8) det M/(t'Mt), M = T + K with a meridian of radius rc -> 0 towards the lean and sin(phi)/r
  // across.
  Mat2 K;
  K << 0.01, 0.003, 0.003, -0.004;
  const Vec2 feed(1.0, 0.0);
  const Lean lean = lean_deg(12.0, 20.0);
  const Vec2 towards(std::cos(lean.yaw), std::sin(lean.yaw));
  const Vec2 across(-towards.y(), towards.x());
  const double rc = 1e-9;
  const Mat2 T =
      towards * towards.transpose() / rc + across * across.transpose() * std::sin(lean.angle) / 5.0;
  const double h = 1e-9;
  const double P = leaned_chord(leaned_curvature(K, feed, lean), h, lean, 5.0, RimSides::kBalanced);
  EXPECT_NEAR(P * P / 8.0 * strip_curvature(T + K, feed) / h, 1.0, 1e-6);
}

TEST(ScallopInterval, ABallOnACircleFollowsTheGeneralFormula) {
  struct Row {
    double R, h;
  };
  for (const Row& row : {Row{50, .027591995}, Row{-50, .022541229}, Row{kInfinity, .025062814}}) {
    const double exact = test::ball_on_circle(row.R, 5.0, 1.0);
    EXPECT_NEAR(exact, row.h, 5e-10);
    // h = P^2/8 (1/rho + kappa): the fourth order is left out, about (P/2r)^2/4 of it.
    const Mat2 M = Mat2::Identity() * (1.0 / 5.0 + 1.0 / row.R);
    EXPECT_NEAR(0.125 * strip_curvature(M, {1.0, 0.0}) / exact, 1.0, 3.5e-3);
  }
}

TEST(ScallopInterval, TheConjugateDirectionStretchesTheReach) {
  Mat2 K;
  K << 1.0 / 40.0, 0.0, 0.0, 1.0 / 120.0;
  EXPECT_EQ(conjugate_stretch(K, {1.0, 0.0}), 1.0);
  // Feed at 45 degrees: t'Kt = 1/60, t'Kc = -1/120.
  EXPECT_NEAR(conjugate_stretch(K, Vec2(1.0, 1.0).normalized()), std::hypot(1.0, 0.5), 1e-12);
}

}  // namespace
}  // namespace swarf::toolpath
