// The singularity of random machines with two rotary axes against dense sampling, and degenerate blocks.
#include <gtest/gtest.h>

#include <algorithm>

#include "base/diagnostics.h"
#include "kinematics/singularity.h"
#include "kinematics/singularity_model.h"
#include "unit/kinematics/singular_blocks.h"

namespace swarf::kinematics::singularity_property_test {
namespace {

constexpr int kSamples = 400;

double line_distance(const Vec3& from, const Vec3& to, const Vec3& p) {
  const Vec3 d = (to - from).normalized(), g = p - from;
  return (g - g.dot(d) * d).norm();
}

double segment_distance(const Vec3& from, const Vec3& to, const Vec3& p) {
  const Vec3 way = to - from;
  const double t = std::clamp((p - from).dot(way) / way.squaredNorm(), 0.0, 1.0);
  return (p - from - t * way).norm();
}

/// Samples cannot exceed the maxima, and fall short of them by at most the sagitta of a sampling step.
TEST(SingularityProperty, MaximaHoldAgainstDenseSampling) {
  Rng rng(2009);
  for (int trial = 0; trial < 400; ++trial) {
    const MachineModel machine = random_two_rotary_machine(rng);
    const BlockEnds ends = random_ends(rng, machine, rng.uniform() < 0.3 ? 3.0 : 0.3, 20.0);
    const TrajectoryError error = trajectory_error(machine, ends);
    double line = 0.0, segment = 0.0, beyond = 0.0, length = 0.0, turned = 0.0;
    const Vec3 d = (ends.to.tip_W - ends.from.tip_W).normalized();
    const Vec3 normal = ends.from.axis_W.cross(ends.to.axis_W).normalized();
    Vec3 before = ends.from.tip_W;
    for (int k = 1; k <= kSamples; ++k) {
      const double u = static_cast<double>(k) / kSamples;
      const ToolPose pose = forward(machine, ends.q_from + u * (ends.q_to - ends.q_from));
      line = std::max(line, line_distance(ends.from.tip_W, ends.to.tip_W, pose.tip_W));
      segment = std::max(segment, segment_distance(ends.from.tip_W, ends.to.tip_W, pose.tip_W));
      const double along = (pose.tip_W - ends.from.tip_W).dot(d);
      beyond = std::max({beyond, along - error.chord_mm, -along});
      turned = std::max(turned, std::asin(std::min(1.0, std::abs(pose.axis_W.dot(normal)))));
      length += (pose.tip_W - before).norm();
      before = pose.tip_W;
    }
    const double slack = error.bound_mm / (kSamples * kSamples) + 2e-9;
    const std::string block = text_of(machine, ends);
    ASSERT_LE(line, error.line.value + 2e-9) << block;
    ASSERT_GE(line, error.line.value - slack) << block;
    ASSERT_LE(segment, error.segment.value + 2e-9) << block;
    ASSERT_GE(segment, error.segment.value - slack) << block;
    ASSERT_LE(beyond, error.beyond.value + 2e-9) << block;
    ASSERT_GE(beyond, error.beyond.value - slack) << block;
    ASSERT_NEAR(length, error.length_mm, 1e-3 * error.length_mm + 8.0 * slack) << block;
    ASSERT_LE(length, error.length_mm + 1e-7) << block;
    ASSERT_NEAR(turned, error.orientation_rad, 1e-3) << block;
    ASSERT_LE(std::max(error.line.value, error.segment.value), error.bound_mm + 1e-9) << block;
  }
}

/// The model's only approximation is that M is linear: it errs by at most 1/8 max|M''|.
TEST(SingularityProperty, AnalyticTrajectoryHoldsWithinTheBendOfM) {
  Rng rng(1208);
  for (int trial = 0; trial < 400; ++trial) {
    const MachineModel machine = random_two_rotary_machine(rng);
    const BlockEnds ends = random_ends(rng, machine, 0.5, 20.0);
    const SingularityModel model(machine, ends);
    // M moves as the tip does while the outer axis stands: its bend is that of the block without U's swing.
    const Poles poles = find_poles(machine);
    AxisValues still = ends.q_to;
    still[poles.outer] = ends.q_from[poles.outer];
    const double bound = 0.125 * tip_acceleration_bound(JointPath(machine, ends.q_from, still));
    double most = 0.0, true_line = 0.0;
    for (int k = 0; k <= kSamples; ++k) {
      const double u = static_cast<double>(k) / kSamples;
      const Vec3 exact = forward(machine, ends.q_from + u * (ends.q_to - ends.q_from)).tip_W;
      most = std::max(most, (model.tip_W(u) - exact).norm());
      true_line = std::max(true_line, line_distance(ends.from.tip_W, ends.to.tip_W, exact));
    }
    ASSERT_LE(most, bound + 1e-9) << text_of(machine, ends);
    // Its maximum is sought in the projection across U: the height along U may be missed, nothing else.
    const double analytic = model.greatest_deviation().value;
    ASSERT_LE(analytic,
              true_line + bound + trajectory_error(machine, ends).bound_mm / (kSamples * kSamples) + 1e-9)
        << text_of(machine, ends);
  }
}

/// V alone moves nothing that the model approximates: with V at rest it is the trajectory itself.
TEST(SingularityProperty, AnalyticTrajectoryIsExactWhileTheInnerAxisRests) {
  Rng rng(7);
  for (int trial = 0; trial < 200; ++trial) {
    const MachineModel machine = random_two_rotary_machine(rng);
    BlockEnds ends = random_ends(rng, machine, 2.0, 20.0);
    const Poles poles = find_poles(machine);
    ends.q_to[poles.inner] = ends.q_from[poles.inner];
    ends.to = forward(machine, ends.q_to);
    const SingularityModel model(machine, ends);
    for (const double u : {0.2, 0.5, 0.9}) {
      const Vec3 exact = forward(machine, ends.q_from + u * (ends.q_to - ends.q_from)).tip_W;
      ASSERT_LT((model.tip_W(u) - exact).norm(), 1e-9) << text_of(machine, ends);
    }
  }
}

TEST(SingularityProperty, PoleDistancesHoldAgainstSampling) {
  Rng rng(31);
  const MachineModel machines[] = {table_table_ac(), table_head_ba(), head_head_ca(), nutating_head()};
  for (int trial = 0; trial < 400; ++trial) {
    const MachineModel& machine = machines[trial % 4];
    const Poles poles = find_poles(machine);
    ASSERT_FALSE(poles.at.empty()) << machine.name;
    const InverseKinematics inverse(machine);
    const BlockEnds ends = random_ends(rng, machine, 2.0, 20.0);
    double joint = 10.0, arc = 10.0;
    constexpr int kFine = 4000;
    for (int k = 0; k <= kFine; ++k) {
      const double u = static_cast<double>(k) / kFine;
      joint = std::min(
          joint, inverse.pole_distance(forward(machine, ends.q_from + u * (ends.q_to - ends.q_from)).axis_W));
      const double angle = angle_between(ends.from.axis_W, ends.to.axis_W);
      const Vec3 on_arc = std::sin((1 - u) * angle) * ends.from.axis_W + std::sin(u * angle) * ends.to.axis_W;
      arc = std::min(arc, inverse.pole_distance(on_arc.normalized()));
    }
    ASSERT_NEAR(pole_distance_of_axes(machine, poles, ends), joint, 4.0 / kFine) << text_of(machine, ends);
    ASSERT_LE(pole_distance_of_axes(machine, poles, ends), joint + 1e-9) << text_of(machine, ends);
    ASSERT_NEAR(pole_distance_on_arc(poles, ends.from.axis_W, ends.to.axis_W), arc, 4.0 / kFine)
        << text_of(machine, ends);
    ASSERT_LE(pole_distance_on_arc(poles, ends.from.axis_W, ends.to.axis_W), arc + 1e-9)
        << text_of(machine, ends);
  }
}

TEST(SingularityProperty, EveryBranchChoiceStandsOnThePoses) {
  Rng rng(5);
  const MachineModel machines[] = {table_table_ac(), table_head_ba(), head_head_ca(), nutating_head()};
  for (int trial = 0; trial < 200; ++trial) {
    const MachineModel& machine = machines[trial % 4];
    const InverseKinematics inverse(machine);
    const BlockEnds ends = random_ends(rng, machine, 0.3, 5.0);
    for (const BranchChoice& choice : branch_choices(machine, inverse, ends)) {
      ASSERT_LT((forward(machine, choice.q_from).tip_W - ends.from.tip_W).norm(), 2e-9);
      ASSERT_LT((forward(machine, choice.q_to).tip_W - ends.to.tip_W).norm(), 2e-9);
      ASSERT_LT((forward(machine, choice.q_to).axis_W - ends.to.axis_W).norm(), 1e-11);
    }
  }
}

BlockEnds block_of(const MachineModel& machine, const AxisValues& from, const AxisValues& to) {
  return {forward(machine, from), forward(machine, to), from, to};
}

TEST(SingularityDegenerate, ThroughTheVeryPole) {
  const MachineModel machine = table_table_ac();
  const BlockEnds ends =
      block_of(machine, axis_values(10, 20, 30, 2.0, 40.0), axis_values(11, 20, 30, -3.0, 40.0));
  EXPECT_EQ(pole_distance_of_axes(machine, find_poles(machine), ends), 0.0);
  const TrajectoryError error = trajectory_error(machine, ends);
  EXPECT_TRUE(std::isfinite(error.segment.value));
  EXPECT_NEAR(error.orientation_rad, 0.0, 1e-9);  // one rotary axis turns the tool along a great circle
  EXPECT_NEAR(pole_distance_on_arc(find_poles(machine), ends.from.axis_W, ends.to.axis_W), 0.0, 1e-12);
}

TEST(SingularityDegenerate, StartingAtThePole) {
  const MachineModel machine = table_table_ac();
  const BlockEnds ends =
      block_of(machine, axis_values(10, 20, 30, 0.0, 40.0), axis_values(12, 20, 30, 1.0, 70.0));
  EXPECT_EQ(pole_distance_of_axes(machine, find_poles(machine), ends), 0.0);
  EXPECT_TRUE(std::isfinite(trajectory_error(machine, ends).segment.value));
  for (const BranchChoice& choice : branch_choices(machine, InverseKinematics(machine), ends)) {
    EXPECT_TRUE(choice.q_from.allFinite() && choice.q_to.allFinite());
  }
}

TEST(SingularityDegenerate, NoRotationIsAStraightLine) {
  const MachineModel machine = table_table_ac();
  const BlockEnds ends =
      block_of(machine, axis_values(10, 20, 30, 5.0, 40.0), axis_values(-30, 25, 10, 5.0, 40.0));
  const TrajectoryError error = trajectory_error(machine, ends);
  EXPECT_NEAR(error.line.value, 0.0, 1e-12);
  EXPECT_NEAR(error.segment.value, 0.0, 1e-12);
  EXPECT_NEAR(error.beyond.value, 0.0, 1e-12);
  EXPECT_NEAR(error.length_mm, error.chord_mm, 1e-12);
  EXPECT_NEAR(error.orientation_rad, 0.0, 1e-15);
  EXPECT_EQ(error.bound_mm, 0.0);
  EXPECT_NEAR(SingularityModel(machine, ends).greatest_deviation().value, 0.0, 1e-12);
}

TEST(SingularityDegenerate, ZeroLengthIsMeasuredFromItsPoint) {
  const MachineModel machine = table_table_ac();
  const InverseKinematics inverse(machine);
  const ToolPose from{{50, 0, 0}, Vec3(0.02, 0.0, 1.0).normalized()},
      to{{50, 0, 0}, Vec3(0.0, 0.02, 1.0).normalized()};
  BlockEnds ends{from, to, inverse.solve_nearest(from, AxisValues::Zero()).q, {}};
  ends.q_to = inverse.solve_nearest(to, ends.q_from).q;
  const TrajectoryError error = trajectory_error(machine, ends);
  EXPECT_EQ(error.chord_mm, 0.0);
  EXPECT_EQ(error.beyond.value, 0.0);
  EXPECT_GT(error.segment.value, 1.0);  // the table swings by a quarter under an arm of 50 mm
  EXPECT_NEAR(error.segment.value, error.line.value, 1e-9);
  EXPECT_TRUE(std::isfinite(SingularityModel(machine, ends).greatest_deviation().value));
}

TEST(SingularityDegenerate, AxisReversal) {
  const MachineModel machine = table_table_ac();
  const BlockEnds ends =
      block_of(machine, axis_values(10, 20, 30, 90.0, 0.0), axis_values(10, 20, 30, 90.0, 180.0));
  EXPECT_TRUE(std::isnan(trajectory_error(machine, ends).orientation_rad));
  EXPECT_GT(trajectory_error(machine, ends).segment.value, 1.0);
}

TEST(SingularityDegenerate, WholeTurnBackToTheSamePose) {
  const MachineModel machine = table_table_ac();
  const BlockEnds ends =
      block_of(machine, axis_values(50, 0, 0, 10.0, 0.0), axis_values(50, 0, 0, 10.0, 360.0));
  const TrajectoryError error = trajectory_error(machine, ends);
  const Vec3 tip = ends.from.tip_W;
  const double radius = std::hypot(tip.x(), tip.y());
  EXPECT_NEAR(error.segment.value, 2.0 * radius, 1e-6);
  EXPECT_NEAR(error.length_mm, 2.0 * kPi * radius, 1e-6);
  EXPECT_NEAR(error.orientation_rad, rad_from_deg(20.0), 1e-8);
}

TEST(SingularityDegenerate, NotANumberIsRefused) {
  const MachineModel machine = table_table_ac();
  const double nan = std::nan("");
  for (int place = 0; place < 4; ++place) {
    BlockEnds ends = block_of(machine, axis_values(1, 2, 3, 4, 5), axis_values(2, 3, 4, 5, 6));
    if (place == 0) ends.from.tip_W.x() = nan;
    if (place == 1) ends.to.axis_W.z() = nan;
    if (place == 2) ends.q_from[1] = nan;
    if (place == 3) ends.q_to[0] = std::numeric_limits<double>::infinity();
    try {
      trajectory_error(machine, ends);
      FAIL() << "place " << place;
    } catch (const InputError& error) {
      EXPECT_EQ(error.diagnostics.list().front().code, "not-finite");
    }
    EXPECT_THROW(SingularityModel(machine, ends), InputError);
    EXPECT_THROW(branch_choices(machine, InverseKinematics(machine), ends), InputError);
  }
}

TEST(SingularityDegenerate, AMachineWithOneRotaryAxisHasNoPole) {
  const MachineModel machine = make_machine(
      "4 axes", {make_axis("A", Side::kTable, Vec3::UnitX()), make_axis("X", Side::kHead, Vec3::UnitX()),
                 make_axis("Y", Side::kHead, Vec3::UnitY()), make_axis("Z", Side::kHead, Vec3::UnitZ())});
  const Poles poles = find_poles(machine);
  EXPECT_EQ(poles.outer, 0);
  EXPECT_EQ(poles.inner, -1);
  EXPECT_TRUE(poles.at.empty());
  EXPECT_TRUE(std::isinf(pole_distance_on_arc(poles, Vec3::UnitZ(), Vec3::UnitY())));
}

TEST(SingularityDegenerate, ConeOfTheSpeedLimit) {
  EXPECT_NEAR(singular_cone(0.01, 0.1, 1.0), std::asin(0.1), 1e-15);
  EXPECT_EQ(singular_cone(0.01, 0.01, 0.5), 0.5 * kPi);
  EXPECT_EQ(singular_cone(0.0, 0.01, 0.5), 0.0);
}

}  // namespace
}  // namespace swarf::kinematics::singularity_property_test
