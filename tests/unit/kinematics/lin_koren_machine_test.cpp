// The paper's machine (theory 1.5): printed oracle, Eq. (10) and (11) as corrected, limits, the pole.
#include <gtest/gtest.h>

#include "test_machines.h"

namespace swarf::kinematics {
namespace {

enum : int { kX, kA, kB, kY, kZ };

struct PaperPose {
  double X, Y, Z, a, b;
};

/// Eq. (10), letters corrected, and Eq. (11): X = Rx(a) { Rz(b) (P + R) + T } + OT.
PaperPose equations_10_11(const Vec3& P, const Vec3& O) {
  const double a = std::atan2(std::hypot(O.x(), O.y()), O.z());
  const double b = std::atan2(O.x(), O.y());
  const Vec3 x = Eigen::AngleAxisd(a, Vec3::UnitX()) *
                 (Eigen::AngleAxisd(b, Vec3::UnitZ()) * (P + Vec3(8.0, 0.0, 0.0)) + Vec3(0.0, 96.0, 120.0));
  return {x.x(), x.y(), x.z(), a, b};
}

TEST(LinKorenMachine, ReproducesTheOracleToThePrintedDigits) {
  const InverseKinematics inverse(lin_koren_machine());
  const Branch tilted =
      inverse.solve_nearest({{10.0, 20.0, 30.0}, Vec3(0.2, 0.3, 0.9).normalized()}, AxisValues::Zero());
  EXPECT_EQ(tilted.outcome, InverseOutcome::kOk);
  EXPECT_NEAR(tilted.q[kX], 3.8829014, 5e-8);
  EXPECT_NEAR(tilted.q[kY], 58.0481602, 5e-8);
  EXPECT_NEAR(tilted.q[kZ], 184.8443972, 5e-8);
  EXPECT_NEAR(deg_from_rad(tilted.q[kA]), 21.83186897, 5e-9);
  EXPECT_NEAR(deg_from_rad(tilted.q[kB]), 33.69006753, 5e-9);

  const Branch upright = inverse.solve_nearest({{0.0, 0.0, 0.0}, Vec3::UnitZ()}, AxisValues::Zero());
  EXPECT_EQ(upright.outcome, InverseOutcome::kSingular);
  EXPECT_DOUBLE_EQ(upright.q[kX], 8.0);
  EXPECT_DOUBLE_EQ(upright.q[kY], 96.0);
  EXPECT_DOUBLE_EQ(upright.q[kZ], 120.0);
  EXPECT_EQ(upright.q[kA], 0.0);
  EXPECT_EQ(upright.q[kB], 0.0);
}

TEST(LinKorenMachine, AgreesWithTheCorrectedEquations) {
  const InverseKinematics inverse(lin_koren_machine());
  Rng rng(1996);
  for (int i = 0; i < 100000; ++i) {
    const ToolPose pose{100.0 * Vec3(rng.uniform(-1.0), rng.uniform(-1.0), rng.uniform()), rng.direction()};
    const PaperPose paper = equations_10_11(pose.tip_W, pose.axis_W);
    AxisValues hint;
    hint << paper.X, paper.a, paper.b, paper.Y, paper.Z;
    const Branch branch = inverse.solve_nearest(pose, hint);
    ASSERT_EQ(branch.outcome, InverseOutcome::kOk) << pose;
    ASSERT_LT((branch.q - hint).cwiseAbs().maxCoeff(), 1e-10) << pose;
  }
}

TEST(LinKorenMachine, OffersTheSecondBranch) {
  const InverseKinematics inverse(lin_koren_machine());
  const InverseSolutions both =
      inverse.solve({{10.0, 20.0, 30.0}, Vec3(0.2, 0.3, 0.9).normalized()}, AxisValues::Zero());
  ASSERT_EQ(both.count, 2);
  EXPECT_NEAR(both.branch[0].q[kA], -both.branch[1].q[kA], 1e-15);
  EXPECT_NEAR(std::abs(both.branch[0].q[kB] - both.branch[1].q[kB]), kPi, 1e-15);
}

TEST(LinKorenMachine, FreeRotaryTakesTheHintAtThePole) {
  const InverseKinematics inverse(lin_koren_machine());
  AxisValues hint = AxisValues::Zero();
  hint[kB] = 7.5;
  const Branch branch = inverse.solve_nearest({{1.0, 2.0, 3.0}, Vec3::UnitZ()}, hint);
  EXPECT_EQ(branch.outcome, InverseOutcome::kSingular);
  EXPECT_EQ(branch.q[kB], 7.5);
  EXPECT_EQ(branch.q[kA], 0.0);
  EXPECT_EQ(inverse.solve({{1.0, 2.0, 3.0}, Vec3::UnitZ()}, hint).count, 1);
}

TEST(LinKorenMachine, NearThePoleAnglesKeepTheirDigits) {
  const InverseKinematics inverse(lin_koren_machine());
  for (double tilt = 1e-3; tilt > 1e-15; tilt *= 0.1) {
    const double azimuth = 0.7;
    const Vec3 axis(std::sin(tilt) * std::sin(azimuth), std::sin(tilt) * std::cos(azimuth), std::cos(tilt));
    const ToolPose pose{{10.0, 20.0, 30.0}, axis};
    const Branch branch = inverse.solve_nearest(pose, AxisValues::Zero());
    const bool free = tilt < kPoleTolerance;
    EXPECT_EQ(branch.outcome, free ? InverseOutcome::kSingular : InverseOutcome::kOk) << tilt;
    if (!free) {
      EXPECT_NEAR(branch.q[kA] / tilt, 1.0, 1e-14) << tilt;
      EXPECT_NEAR(branch.q[kB], azimuth, 1e-15) << tilt;
    }
    const ToolPose back = forward(lin_koren_machine(), branch.q);
    EXPECT_LT((back.tip_W - pose.tip_W).norm(), 1e-9) << tilt;
    EXPECT_LT(angle_between(back.axis_W, pose.axis_W), 1e-12) << tilt;
  }
}

/// Walks along `axis_at(s)`, s in [0, 1], and returns the largest step of A or B between neighbours.
template <class AxisAt>
double largest_rotary_step(const AxisAt& axis_at, AxisValues q, int steps, AxisValues* last = nullptr) {
  const InverseKinematics inverse(lin_koren_machine());
  double largest = 0.0;
  for (int i = 0; i <= steps; ++i) {
    const Branch branch =
        inverse.solve_nearest({Vec3(5.0, 6.0, 7.0), axis_at(i / static_cast<double>(steps))}, q);
    EXPECT_TRUE(branch.outcome == InverseOutcome::kOk || branch.outcome == InverseOutcome::kSingular);
    if (i > 0) {
      largest = std::max({largest, std::abs(branch.q[kA] - q[kA]), std::abs(branch.q[kB] - q[kB])});
    }
    q = branch.q;
  }
  if (last != nullptr) *last = q;
  return largest;
}

TEST(LinKorenMachine, StraightThroughThePoleTheTiltChangesItsSign) {
  const auto through = [](double s) {
    return Vec3(0.0, std::sin(0.4 * (0.5 - s)), std::cos(0.4 * (0.5 - s)));
  };
  AxisValues last;
  EXPECT_LT(largest_rotary_step(through, AxisValues::Zero(), 1000, &last), 4.1e-4);
  EXPECT_NEAR(last[kA], -0.2, 1e-14);
  EXPECT_NEAR(last[kB], 0.0, 1e-14);
}

TEST(LinKorenMachine, PastThePoleTheRotaryTurnsNoFasterThanTheAzimuth) {
  // The path passes the pole at a tilt of 0.01: azimuth rate <= 0.4 / 0.01 per unit of s.
  const auto past = [](double s) { return Vec3(0.01, 0.4 * (0.5 - s), 1.0).normalized(); };
  EXPECT_LT(largest_rotary_step(past, AxisValues::Zero(), 10000), 0.4 / 0.01 / 10000 * 1.01);
}

TEST(LinKorenMachine, RoundAndRoundTheRotaryUnwinds) {
  const auto circle = [](double s) {
    return Vec3(0.5 * std::sin(6.0 * kPi * s), 0.5 * std::cos(6.0 * kPi * s), 0.8).normalized();
  };
  AxisValues last;
  EXPECT_LT(largest_rotary_step(circle, AxisValues::Zero(), 3000, &last), 6.0 * kPi / 3000 * 1.001);
  EXPECT_NEAR(last[kB], 6.0 * kPi, 1e-12);
}

}  // namespace
}  // namespace swarf::kinematics
