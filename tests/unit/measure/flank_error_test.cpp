// Flank error against closed forms, standing poses by the thousand, and the oracle F1 of theory 5.
#include "measure/flank_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "base/rng.h"
#include "base/units.h"
#include "measure/axis_patch.h"
#include "surface/analytic.h"
#include "surface/polynomial.h"

namespace swarf::measure::flank_error_test {
namespace {

using surface::PolynomialSurface;

constexpr double kRadius = 8.0;

/// C0 = (60u, 0, 0), C1 = (60u, 20(u-1/2), 30).
PolynomialSurface f1(int outward_sign = 1) {
  return {1, 1, {{0, 0, 0}, {0, -10, 30}, {60, 0, 0}, {0, 20, 0}}, outward_sign};
}

double to_line(const Vec3& x, const Vec3& a, const Vec3& b) {
  return (b - a).cross(x - a).norm() / (b - a).norm();
}

/// Normal of F1 by hand: Su x Sv = (60, 20v, 0) x (0, 20(u-1/2), 30).
Vec3 f1_normal(double u, double v) {
  return Vec3(600.0 * v, -1800.0, 1200.0 * (u - 0.5)).normalized();
}
Vec3 f1_guide(double u, double v) {
  return {60.0 * u, 20.0 * (u - 0.5) * v, 30.0 * v};
}

/// The least of distance - r at one surface point over poses that stand 1/`poses` of a block apart, each an
/// infinite line.
double brute_force(double u, double v, int blocks, int poses) {
  const Vec3 x = f1_guide(u, v);
  double least = std::numeric_limits<double>::infinity();
  for (int b = 0; b < blocks; ++b) {
    const double ua = static_cast<double>(b) / blocks, ub = static_cast<double>(b + 1) / blocks;
    const Vec3 P0 = f1_guide(ua, 0) + kRadius * f1_normal(ua, 0),
               P1 = f1_guide(ub, 0) + kRadius * f1_normal(ub, 0);
    const Vec3 Q0 = f1_guide(ua, 1) + kRadius * f1_normal(ua, 1),
               Q1 = f1_guide(ub, 1) + kRadius * f1_normal(ub, 1);
    for (int i = 0; i <= poses; ++i) {
      const double s = static_cast<double>(i) / poses;
      least = std::min(least, to_line(x, P0 + s * (P1 - P0), Q0 + s * (Q1 - Q0)));
    }
  }
  return least - kRadius;
}

TEST(FlankError, OracleF1Standing) {
  EXPECT_NEAR(deg_from_rad(ruling_twist(f1(), 0.0)), 17.548400614, 1e-9);
  EXPECT_NEAR(deg_from_rad(ruling_twist(f1(), 0.5)), 18.434948823, 1e-9);
  EXPECT_NEAR(standing_error(f1(), kRadius, 0.0), -0.093622647, 1e-9);
  EXPECT_NEAR(standing_error(f1(), kRadius, 0.5), -0.103300339, 1e-9);
}

TEST(FlankError, OracleF1Envelopes) {
  const FlankError error = flank_error(f1(), kRadius);
  EXPECT_NEAR(error.psi_max_rad, std::atan(1.0 / 3.0), 1e-12);
  EXPECT_NEAR(error.psi_max_u, 0.5, 1e-6);
  EXPECT_NEAR(error.standing_error_mm, -0.103300339, 1e-9);
  EXPECT_NEAR(error.continuous.error_mm, -0.103373, 1e-6);
  // E18: half way along a symmetric ruling the twist bound is the standing error itself.
  EXPECT_NEAR(error.twist_bound_mm, -error.standing_error_mm, 1e-12);
  ASSERT_EQ(error.rows.size(), 6u);
  // Twice computed: here and by a program that shares no line with this one (dense poses and a pattern
  // search).
  const double expected[] = {-0.490665781, -0.198292338, -0.128324439,
                             -0.109693529, -0.104958394, -0.103769674};
  for (size_t i = 0; i < error.rows.size(); ++i) {
    EXPECT_EQ(error.rows[i].blocks, 1 << i);
    EXPECT_NEAR(error.rows[i].envelope.error_mm, expected[i], 2e-9) << "blocks " << error.rows[i].blocks;
  }
}

TEST(FlankError, BruteForceOverStandingPosesFindsNothingDeeperAndReachesTheSamePlace) {
  for (const int blocks : {1, 2, 4, 8}) {
    const FlankDepth found = block_envelope_error(f1(), kRadius, blocks);
    // At the place that was found a thousand poses a block come within the sagitta between two of them.
    EXPECT_NEAR(brute_force(found.u, found.v, blocks, 20000 / blocks), found.error_mm, 1e-6);
    Rng rng(7);
    for (int i = 0; i < 200; ++i) {
      const double u = rng.uniform(), v = rng.uniform();
      EXPECT_GE(brute_force(u, v, blocks, 512), found.error_mm) << "u = " << u << ", v = " << v;
    }
  }
}

TEST(FlankError, BothSidesAreMirrorImages) {
  // F1 turned by 180 degrees about the line x = 30, y = 0 is F1 with the other side out.
  const FlankDepth one = block_envelope_error(f1(1), kRadius, 4),
                   other = block_envelope_error(f1(-1), kRadius, 4);
  EXPECT_NEAR(one.error_mm, other.error_mm, 1e-9);
  EXPECT_NEAR(one.u, 1.0 - other.u, 1e-4);
}

TEST(FlankError, ConeHasNoTwistAndItsBlocksLeaveTheSagittaOfTheirChords) {
  // Half way the axis must stay outside of the cone: 47.7 cos(20 deg) > 40.
  // Both guide points of the axis run on circles about the cone's axis; a block of angle phi draws them onto
  // parallel chords, so its axis patch is flat. By symmetry the ruling half way is the deepest, and nearest
  // to the axis half way, whose guide points have their radius times cos(phi/2): two segments in one plane.
  const double alpha = rad_from_deg(15.0), base = 40.0, height = 20.0, span = rad_from_deg(40.0);
  surface::Turn turn;
  turn.to_rad = span;
  const surface::SurfacePtr cone =
      surface::cone_surface(turn, base, alpha, height, surface::MaterialSide::kConvex);
  ASSERT_TRUE(is_ruled(*cone));
  const FlankError error = flank_error(*cone, kRadius);
  EXPECT_NEAR(error.psi_max_rad, 0.0, 1e-12);
  EXPECT_NEAR(error.standing_error_mm, 0.0, 1e-12);
  EXPECT_NEAR(error.continuous.error_mm, 0.0, 1e-10);
  for (const FlankRow& row : error.rows) {
    const double squeeze = std::cos(0.5 * span / row.blocks);
    const double top = base - height * std::tan(alpha);
    const Vec3 n(std::cos(alpha), 0.0, std::sin(alpha));
    Vec3 a = Vec3(base, 0, 0) + kRadius * n, b = Vec3(top, 0, height) + kRadius * n;
    a.x() *= squeeze;
    b.x() *= squeeze;
    const double expected = segment_distance({base, 0, 0}, {top, 0, height}, a, b) - kRadius;
    EXPECT_NEAR(row.envelope.error_mm, expected, 1e-9) << "blocks " << row.blocks;
  }
}

TEST(FlankError, PlaneIsCutExactly) {
  const PolynomialSurface plane(1, 1, {{0, 0, 0}, {3, 2, 25}, {50, 0, 0}, {0, 0, 0}}, 1);
  const FlankError error = flank_error(plane, 5.0);
  EXPECT_NEAR(error.continuous.error_mm, 0.0, 1e-12);
  for (const FlankRow& row : error.rows) EXPECT_NEAR(row.envelope.error_mm, 0.0, 1e-12);
}

TEST(FlankError, OnlyRuledSurfacesPass) {
  EXPECT_TRUE(is_ruled(f1()));
  const PolynomialSurface bent(1, 2, {{0, 0, 0}, {0, 0, 20}, {0, 1, 0}, {60, 0, 0}, {0, 0, 0}, {0, 0, 0}}, 1);
  EXPECT_FALSE(is_ruled(bent));
}

TEST(FlankError, SameBitsForAnyNumberOfThreads) {
  const FlankDepth all = block_envelope_error(f1(), kRadius, 8);
  set_thread_count(1);
  const FlankDepth one = block_envelope_error(f1(), kRadius, 8);
  set_thread_count(0);
  EXPECT_EQ(all.error_mm, one.error_mm);
  EXPECT_EQ(all.u, one.u);
  EXPECT_EQ(all.v, one.v);
}

TEST(AxisPatch, DistanceIsTheLeastOverADenseGrid) {
  for (uint64_t seed = 0; seed < 300; ++seed) {
    Rng rng(seed);
    const auto point = [&] { return Vec3(rng.uniform(-10, 10), rng.uniform(-10, 10), rng.uniform(-10, 10)); };
    const Vec3 P0 = point(), P1 = point(), Q0 = point(), Q1 = point(), x = point();
    const AxisPatch patch(P0, P1, Q0, Q1);
    double least = std::numeric_limits<double>::infinity();
    constexpr int kSteps = 2000;
    for (int i = 0; i <= kSteps; ++i) {
      const double t = static_cast<double>(i) / kSteps;
      least = std::min(least, segment_distance(x, P0 + t * (P1 - P0), Q0 + t * (Q1 - Q0)));
    }
    const double found = patch.distance(x);
    EXPECT_LE(found, least + 1e-12) << "seed " << seed;
    // Half a step of at most 35 mm aside.
    EXPECT_GE(found, least - 0.5 * 35.0 / kSteps) << "seed " << seed;
    EXPECT_LE(patch.distance_bound(x), found) << "seed " << seed;
  }
}

TEST(AxisPatch, PointsAndEdgesOfNoLength) {
  const Vec3 o(0, 0, 0), z(0, 0, 10);
  // A standing axis: the patch is a segment.
  EXPECT_NEAR(AxisPatch(o, o, z, z).distance({3, 4, 5}), 5.0, 1e-14);
  EXPECT_NEAR(AxisPatch(o, o, z, z).distance({0, 0, 12}), 2.0, 1e-14);
  // A fan about its tip.
  EXPECT_NEAR(AxisPatch(o, o, {-5, 0, 10}, {5, 0, 10}).distance({1, 2, 8}), 2.0, 1e-14);
  // On the patch itself.
  EXPECT_NEAR(AxisPatch(o, {10, 0, 0}, z, {10, 5, 10}).distance({5, 1.25, 5}), 0.0, 1e-12);
  EXPECT_NEAR(segment_distance(o, z, {1, 0, 0}, {4, 0, 0}), 1.0, 1e-15);
  EXPECT_NEAR(segment_distance(o, z, {1, -1, 5}, {1, 1, 5}), 1.0, 1e-15);
  EXPECT_NEAR(segment_distance(o, z, {2, 0, 3}, {2, 0, 8}), 2.0, 1e-15);
}

}  // namespace
}  // namespace swarf::measure::flank_error_test
