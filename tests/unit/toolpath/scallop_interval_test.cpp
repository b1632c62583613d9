// The closed forms of theory 1.1 against its oracles, to the printed digits.
#include "toolpath/scallop_interval.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/rng.h"
#include "base/units.h"
#include "exact_cusps.h"
#include "toolpath/nose_strip.h"

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

TEST(BallInterval, MeetsTheExactFormsOfCircleAndPlane) {
  EXPECT_NEAR(ball_scallop(1.0 / 50.0, 1.0, 5.0), .027591995, 5e-10);
  EXPECT_NEAR(ball_scallop(-1.0 / 50.0, 1.0, 5.0), .022541229, 5e-10);
  EXPECT_NEAR(ball_scallop(0.0, 1.0, 5.0), .025062814, 5e-10);
  Rng rng(17);
  for (int i = 0; i < 1000; ++i) {
    const double r = rng.uniform(0.5, 8.0);
    const double k = rng.uniform(-0.8, 2.0) / r;
    const double h = std::pow(10.0, rng.uniform(-4.0, -1.5)) * r;
    if (h * (2.0 + h * k) > 2.0 * r) continue;
    const double P = ball_chord(k, h, r);
    EXPECT_LT(P, ball_reach(k, r));
    EXPECT_NEAR(ball_scallop(k, P, r) / h, 1.0, 1e-9) << "k " << k << " r " << r << " h " << h;
    EXPECT_NEAR(test::ball_on_circle(1.0 / k, r, P) / h, 1.0, 1e-7) << "k " << k << " r " << r;
  }
}

TEST(BallInterval, TheEquatorEndsTheReach) {
  // (R + h)^2 + r^2 = (R + r)^2 at the chord that puts the cusp level with the centre.
  const double R = 40.0, r = 3.0;
  const double h = std::sqrt((R + r) * (R + r) - r * r) - R;
  EXPECT_NEAR(ball_chord(1.0 / R, h, r), ball_reach(1.0 / R, r), 1e-9);
}

TEST(BallInterval, AcrossAPrincipalFeedTheCurvatureIsThatAcross) {
  Mat2 K;
  K << 0.02, 0.0, 0.0, 0.005;
  EXPECT_NEAR(ball_curvature(K, {1.0, 0.0}, 5.0), 0.005, 1e-15);
  EXPECT_NEAR(ball_curvature(K, {0.0, 1.0}, 5.0), 0.02, 1e-15);
}

TEST(NoseInterval, ASmallScallopOnAPlaneFollowsTheEffectiveRadius) {
  Rng rng(23);
  for (int i = 0; i < 200; ++i) {
    const ContactEnd end{rng.uniform(0.5, 6.0), rng.uniform(0.2, 3.0)};
    const Lean lean{rng.uniform(0.05, 0.5), rng.uniform(-0.9, 0.9)};
    const double R = test::effective_radius(end.flat_mm, end.corner_mm, lean.angle, lean.yaw);
    const double h = 1e-7;
    const double P = nose_chord(Mat2::Zero(), {1.0, 0.0}, h, lean, end, RimSides::kBalanced);
    EXPECT_NEAR(P / std::sqrt(8.0 * h * R), 1.0, 1e-3) << i;
    EXPECT_NEAR(nose_scallop(Mat2::Zero(), {1.0, 0.0}, P, lean, end, RimSides::kBalanced) / h, 1.0, 1e-6)
        << i;
  }
}

TEST(NoseInterval, WithASmallCornerItNearsTheLeanedFlatEnd) {
  const double phi = rad_from_deg(10.0);
  // The corner takes its own radius off the rim at most.
  const double h = nose_scallop(Mat2::Zero(), {0.0, 1.0}, 4.0, {phi, 0.0}, {5.0, 1e-4}, RimSides::kBalanced);
  EXPECT_NEAR(h, .0724850, 1e-4);
}

TEST(NoseInterval, WithoutFlatBottomItIsTheBall) {
  const double P = 1.0;
  const double tilted =
      nose_scallop(Mat2::Zero(), {1.0, 0.0}, P, {0.3, 0.0}, {1e-9, 5.0}, RimSides::kBalanced);
  EXPECT_NEAR(tilted, ball_scallop(0.0, P, 5.0), 1e-8);
}

}  // namespace
}  // namespace swarf::toolpath
