// The solver on every arrangement of axes: FK(IK) on random poses, reach, travel, wrong models.
#include <gtest/gtest.h>

#include "base/diagnostics.h"
#include "kinematics/model_check.h"
#include "test_machines.h"

namespace swarf::kinematics {
namespace {

class AnyMachine : public testing::TestWithParam<MachineModel> {};

TEST_P(AnyMachine, ForwardIsTheProductOfTheAxisMotions) {
  Rng rng(11);
  Errors errors;
  for (int i = 0; i < 10000; ++i) {
    const AxisValues q = random_values(GetParam(), rng);
    errors.add(forward(GetParam(), q), forward_by_poses(GetParam(), q));
  }
  EXPECT_LT(errors.tip, 1e-11);
  EXPECT_LT(errors.axis, 1e-14);
}

TEST_P(AnyMachine, BothBranchesComeBackToAMillionRandomPoses) {
  const MachineModel& machine = GetParam();
  const InverseKinematics inverse(machine);
  Rng rng(7);
  Errors errors;
  for (int i = 0; i < 1000000; ++i) {
    const AxisValues q = random_values(machine, rng);
    const ToolPose pose = forward(machine, q);
    const InverseSolutions solutions = inverse.solve(pose, q);
    ASSERT_GE(solutions.count, 1) << machine.name << ' ' << pose;
    double nearest = 1e9;
    for (int k = 0; k < solutions.count; ++k) {
      errors.add(forward(machine, solutions.branch[k].q), pose);
      nearest = std::min(nearest, (solutions.branch[k].q - q).cwiseAbs().maxCoeff());
    }
    // Close to the pole the rotary values themselves are badly conditioned; everywhere else they come back.
    if (inverse.pole_distance(pose.axis_W) > 0.1 && solutions.count == 2) {
      ASSERT_LT(nearest, 1e-5) << machine.name << ' ' << pose;
    }
  }
  EXPECT_LT(errors.tip, 1e-9);
  EXPECT_LT(errors.axis, 1e-12);
  RecordProperty("tip_error_nm", std::to_string(errors.tip * 1e6));
  std::printf("%s: tip %.3g mm, axis %.3g rad\n", machine.name.c_str(), errors.tip, errors.axis);
}

TEST_P(AnyMachine, NearAndAtThePole) {
  const MachineModel& machine = GetParam();
  const InverseKinematics inverse(machine);
  const Vec3 pole_W =
      machine.X_MW.linear().transpose() * machine.axes[rotary_order(machine).front()].direction_M;
  const Vec3 across = pole_W.unitOrthogonal();
  Errors errors;
  for (double tilt = 1e-3; tilt > 1e-17; tilt *= 0.1) {
    for (int k = 0; k < 24; ++k) {
      const Vec3 side = Eigen::AngleAxisd(k * kPi / 12.0, pole_W) * across;
      const ToolPose pose{{10.0, -20.0, 30.0},
                          (std::cos(tilt) * pole_W + std::sin(tilt) * side).normalized()};
      const InverseSolutions solutions = inverse.solve(pose, AxisValues::Constant(0.3));
      ASSERT_GE(solutions.count, 1) << machine.name << " tilt " << tilt << ' ' << pose;
      for (int i = 0; i < solutions.count; ++i) {
        errors.add(forward(machine, solutions.branch[i].q), pose);
        const bool singular = solutions.branch[i].outcome == InverseOutcome::kSingular;
        EXPECT_TRUE(tilt > 2e-13 ? !singular : tilt < 5e-14 ? singular : true) << tilt;
      }
      // The pole's own direction is known no better than double rounding.
      EXPECT_NEAR(inverse.pole_distance(pose.axis_W), tilt, 4e-16);
    }
  }
  EXPECT_LT(errors.tip, 1e-9);
  EXPECT_LT(errors.axis, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Arrangements, AnyMachine,
                         testing::Values(lin_koren_machine(), table_table_ac(), table_head_ba(),
                                         head_head_ca(), nutating_head()),
                         [](const auto& instance) {
                           std::string name = instance.param.name;
                           std::erase_if(name, [](char c) { return std::isalnum(c) == 0; });
                           return name;
                         });

TEST(FewerRotaryAxes, ThreeAxisMachineReachesOnlyItsOwnAxis) {
  const MachineModel machine = make_machine(
      "XYZ", {make_axis("X", Side::kTable, Vec3::UnitX()), make_axis("Y", Side::kTable, Vec3::UnitY()),
              make_axis("Z", Side::kHead, Vec3::UnitZ())});
  const InverseKinematics inverse(machine);
  const Branch branch = inverse.solve_nearest({{1.0, 2.0, 3.0}, Vec3::UnitZ()}, AxisValues::Zero());
  EXPECT_EQ(branch.outcome, InverseOutcome::kOk);
  EXPECT_NEAR((branch.q.head<3>() - Vec3(1.0, 2.0, 3.0)).norm(), 0.0, 1e-15);
  const Vec3 tilted = Vec3(1e-9, 0.0, 1.0).normalized();
  EXPECT_EQ(inverse.solve_nearest({{1.0, 2.0, 3.0}, tilted}, AxisValues::Zero()).outcome,
            InverseOutcome::kUnreachable);
  EXPECT_TRUE(std::isinf(inverse.pole_distance(Vec3::UnitZ())));
}

TEST(FewerRotaryAxes, FourAxisMachineReachesTheDirectionsOfItsCone) {
  const MachineModel machine = make_machine(
      "XYZA", {make_axis("X", Side::kTable, Vec3::UnitX()),
               make_axis("A", Side::kTable, Vec3::UnitX(), Vec3(0.0, 5.0, -7.0)),
               make_axis("Y", Side::kHead, Vec3::UnitY()), make_axis("Z", Side::kHead, Vec3::UnitZ())});
  const InverseKinematics inverse(machine);
  Rng rng(3);
  for (int i = 0; i < 1000; ++i) {
    const AxisValues q = random_values(machine, rng);
    const ToolPose pose = forward_by_poses(machine, q);
    const Branch branch = inverse.solve_nearest(pose, q);
    ASSERT_EQ(branch.outcome, InverseOutcome::kOk) << pose;
    ASSERT_LT((branch.q - q).cwiseAbs().maxCoeff(), 1e-10) << pose;
  }
  const ToolPose off_cone{{0.0, 0.0, 0.0}, Vec3(0.1, 0.0, 1.0).normalized()};
  EXPECT_EQ(inverse.solve_nearest(off_cone, AxisValues::Zero()).outcome, InverseOutcome::kUnreachable);
}

TEST(Reach, NutatingHeadCannotPointDown) {
  const MachineModel machine = nutating_head();
  const InverseKinematics inverse(machine);
  const ToolPose down{{0.0, 0.0, 0.0}, machine.X_MW.linear().transpose() * Vec3(0.1, 0.0, -1.0)};
  EXPECT_EQ(inverse.solve(down, AxisValues::Zero()).count, 0);
}

TEST(Reach, NotANumberHasNoSolution) {
  const InverseKinematics inverse(lin_koren_machine());
  const double nan = std::nan("");
  EXPECT_EQ(inverse.solve({{nan, 0.0, 0.0}, Vec3::UnitZ()}, AxisValues::Zero()).count, 0);
  EXPECT_EQ(inverse.solve({{0.0, 0.0, 0.0}, {nan, 0.0, 1.0}}, AxisValues::Zero()).count, 0);
  EXPECT_EQ(inverse.solve({{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}, AxisValues::Zero()).count, 0);
}

TEST(Travel, NamesTheFirstAxisOutOfTravel) {
  MachineModel machine = lin_koren_machine();
  machine.axes[3].min = -10.0;
  machine.axes[3].max = 90.0;
  const Branch branch =
      InverseKinematics(machine).solve_nearest({{0, 0, 0}, Vec3::UnitZ()}, AxisValues::Zero());
  EXPECT_EQ(branch.outcome, InverseOutcome::kOutOfTravel);
  EXPECT_EQ(branch.out_of_travel_axis, 3);
  EXPECT_DOUBLE_EQ(branch.q[3], 96.0);
}

TEST(Travel, TakesTheOtherBranchWhenTheNearestIsOutside) {
  MachineModel machine = lin_koren_machine();
  machine.axes[1].min = rad_from_deg(-10.0);
  AxisValues hint = AxisValues::Zero();
  hint[1] = -0.1;
  const ToolPose pose{{10.0, 20.0, 30.0}, Vec3(0.0, -0.5, 1.0).normalized()};
  const Branch branch = InverseKinematics(machine).solve_nearest(pose, hint);
  EXPECT_EQ(branch.outcome, InverseOutcome::kOk);
  EXPECT_NEAR(branch.q[1], std::atan2(0.5, 1.0), 1e-14);
  EXPECT_NEAR(std::abs(branch.q[2]), kPi, 1e-14);
}

TEST(Travel, TakesTheValueATurnAwayWhenOnlyThatIsInside) {
  MachineModel machine = lin_koren_machine();
  machine.axes[1].min = machine.axes[1].max = 0.0;  // one branch only
  machine.axes[1].max = 2.0;
  machine.axes[2].min = rad_from_deg(-10.0);
  machine.axes[2].max = rad_from_deg(300.0);
  const double azimuth = rad_from_deg(190.0);
  const ToolPose pose{{0, 0, 0}, {0.5 * std::sin(azimuth), 0.5 * std::cos(azimuth), std::sqrt(0.75)}};
  const Branch branch = InverseKinematics(machine).solve_nearest(pose, AxisValues::Zero());
  EXPECT_EQ(branch.outcome, InverseOutcome::kOk);
  EXPECT_NEAR(branch.q[2], azimuth, 1e-14);
}

/// Codes of the problems that the model has.
std::vector<std::string> codes(const MachineModel& machine) {
  std::vector<std::string> list;
  for (const ModelProblem& problem : check_model(machine)) list.push_back(problem.code);
  return list;
}

TEST(WrongModel, EachHasItsCodeAndTheSolverRefusesIt) {
  using Codes = std::vector<std::string>;
  MachineModel machine = lin_koren_machine();
  machine.axes[4].direction_M = Vec3::UnitY();
  EXPECT_EQ(codes(machine), Codes{"linear-axes-dependent"});
  EXPECT_THROW(InverseKinematics{machine}, InputError);

  machine = lin_koren_machine();
  machine.axes[2].direction_M = -Vec3::UnitX();
  EXPECT_EQ(codes(machine), Codes{"rotary-axes-parallel"});

  machine = lin_koren_machine();
  machine.tool_axis_M = Vec3::UnitX();
  EXPECT_EQ(codes(machine), Codes{"rotary-axis-spins-tool"});

  machine = lin_koren_machine();
  machine.axes[0].direction_M *= 1.001;
  EXPECT_EQ(codes(machine), Codes{"direction-not-unit"});

  machine = lin_koren_machine();
  machine.head_chain.pop_back();
  EXPECT_EQ(codes(machine), Codes{"axis-not-in-chain"});

  machine = lin_koren_machine();
  machine.axes[4].kind = AxisKind::kRotary;
  EXPECT_EQ(codes(machine), (Codes{"wrong-axis-count", "wrong-axis-count"}));
}

}  // namespace
}  // namespace swarf::kinematics
