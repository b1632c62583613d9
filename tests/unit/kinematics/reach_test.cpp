// What lies out of reach, and by how much: closed form against the solver and against scanning both angles.
#include "kinematics/reach.h"

#include <gtest/gtest.h>

#include "kinematics/model_check.h"
#include "test_machines.h"

namespace swarf::kinematics {
namespace {

MachineModel xyz_machine() {
  return make_machine(
      "XYZ", {make_axis("X", Side::kTable, Vec3::UnitX()), make_axis("Y", Side::kHead, Vec3::UnitY()),
              make_axis("Z", Side::kHead, Vec3::UnitZ())});
}

TEST(AxisReach, HasTheAnglesOfTheArrangements) {
  const AxisReach orthogonal = axis_reach(table_table_ac());
  EXPECT_EQ(orthogonal.about, "C");
  EXPECT_NEAR(orthogonal.angle_min, 0.0, 1e-15);
  EXPECT_NEAR(orthogonal.angle_max, kPi, 1e-15);
  const AxisReach nutating = axis_reach(nutating_head());
  EXPECT_NEAR(nutating.angle_min, 0.0, 1e-15);
  EXPECT_NEAR(nutating.angle_max, 0.5 * kPi, 1e-15);
  const AxisReach none = axis_reach(xyz_machine());
  EXPECT_EQ(none.about, "");
  EXPECT_EQ(none.angle_max, 0.0);
}

TEST(AxisReach, NamesTheMissingAngleAndItsSide) {
  MachineModel machine = nutating_head();
  machine.X_MW.linear() = Mat3::Identity();
  const AxisReach reach = axis_reach(machine);
  const auto at = [](double deg) {
    return Vec3(std::sin(rad_from_deg(deg)), 0.0, std::cos(rad_from_deg(deg)));
  };
  EXPECT_EQ(missing_angle(reach, at(0.0)), 0.0);
  EXPECT_EQ(missing_angle(reach, at(90.0)), 0.0);
  EXPECT_NEAR(missing_angle(reach, at(102.5)), rad_from_deg(12.5), 1e-14);
  EXPECT_NEAR(missing_angle(reach, at(180.0)), rad_from_deg(90.0), 1e-14);
  EXPECT_LT((nearest_in_reach(reach, 3.0 * at(102.5)) - at(90.0)).norm(), 1e-15);

  // A head that cannot come closer than 30 deg to the C axis nor further than 80: too close is negative.
  machine.axes[4].direction_M = at(55.0);
  machine.tool_axis_M = at(30.0);
  const AxisReach ring = axis_reach(machine);
  EXPECT_NEAR(deg_from_rad(ring.angle_min), 30.0, 1e-13);
  EXPECT_NEAR(deg_from_rad(ring.angle_max), 80.0, 1e-13);
  EXPECT_NEAR(deg_from_rad(missing_angle(ring, at(12.0))), -18.0, 1e-12);
  EXPECT_NEAR(deg_from_rad(missing_angle(ring, at(-100.0))), 20.0, 1e-12);
  EXPECT_NEAR(deg_from_rad(angle_between(nearest_in_reach(ring, at(0.0)), at(0.0))), 30.0, 1e-12);
}

TEST(AxisReach, TheSumOfBothAnglesTurnsBackBehindTheAxis) {
  // a + b > 180 deg: the far end is 360 deg - (a + b).
  MachineModel machine = table_table_ac();
  const auto at = [](double deg) {
    return Vec3(std::sin(rad_from_deg(deg)), 0.0, std::cos(rad_from_deg(deg)));
  };
  machine.axes[0].direction_M = at(120.0);
  machine.tool_axis_M = at(-140.0);
  const AxisReach reach = axis_reach(machine);
  EXPECT_NEAR(deg_from_rad(reach.angle_min), 20.0, 1e-12);
  EXPECT_NEAR(deg_from_rad(reach.angle_max), 140.0, 1e-12);
}

/// Whatever the solver refuses misses an angle, whatever it solves misses none, and the nearest direction in
/// reach is solved.
TEST(AxisReach, AgreesWithTheSolverOnRandomHeads) {
  Rng rng(2026);
  int outside = 0, inside = 0;
  for (int i = 0; i < 2000; ++i) {
    MachineModel machine = head_head_ca();
    machine.axes[3].direction_M = rng.direction();
    machine.axes[4].direction_M = rng.direction();
    machine.tool_axis_M = rng.direction();
    if (!check_model(machine).empty()) continue;
    const InverseKinematics inverse(machine);
    const AxisReach reach = axis_reach(machine);
    for (int k = 0; k < 20; ++k) {
      const ToolPose pose{100.0 * rng.direction(), rng.direction()};
      const double missing = missing_angle(reach, pose.axis_W);
      const int count = inverse.solve(pose, AxisValues::Zero()).count;
      if (std::abs(missing) < 1e-9 && missing != 0.0) continue;  // the border itself
      ASSERT_EQ(count > 0, missing == 0.0) << "missing " << missing << ' ' << pose;
      const Vec3 nearest = nearest_in_reach(reach, pose.axis_W);
      ASSERT_NEAR(angle_between(nearest, pose.axis_W), std::abs(missing), 1e-9) << pose;
      (count > 0 ? inside : outside) += 1;
      if (count > 0) continue;
      if (reach.angle_max - reach.angle_min < 0.02) continue;
      const Vec3 inward =
          Eigen::AngleAxisd(missing > 0.0 ? -0.01 : 0.01, reach.about_W.cross(nearest).normalized()) *
          nearest;
      ASSERT_GT(inverse.solve({pose.tip_W, inward}, AxisValues::Zero()).count, 0) << pose;
    }
  }
  EXPECT_GT(outside, 1000);
  EXPECT_GT(inside, 1000);
}

TEST(UnreachableText, SaysTheAngleTheReachAndTheNearestAxis) {
  MachineModel machine = nutating_head();
  machine.X_MW.linear() = Mat3::Identity();
  const double angle = rad_from_deg(102.5);
  const UnreachableText text =
      unreachable_text(machine, {{1.0, 2.0, 3.0}, {std::sin(angle), 0.0, std::cos(angle)}});
  EXPECT_EQ(
      text.text,
      "the machine has no axis values for tip (1.000, 2.000, 3.000) mm, axis (0.9763, 0.0000, -0.2164): "
      "the tool would stand at 102.5 deg to the C axis, the machine reaches 0 .. 90 deg; 12.5 deg are "
      "missing");
  EXPECT_EQ(text.fix, "the nearest tool axis that it reaches is (1.0000, 0.0000, 0.0000)");

  const UnreachableText fixed = unreachable_text(xyz_machine(), {{0, 0, 0}, Vec3(0.6, 0.0, 0.8)});
  EXPECT_NE(fixed.text.find("at 36.87 deg to the spindle, the machine reaches exactly 0 deg; 36.87 deg are "
                            "missing"),
            std::string::npos)
      << fixed.text;
}

/// X rides on the A axis: where A has turned it into the direction of Y, the linear axes lie in one plane.
TEST(UnreachableText, SaysWhenTheLinearAxesLieInOnePlane) {
  MachineModel machine = make_machine(
      "Y under A", {make_axis("A", Side::kTable, Vec3::UnitX()), make_axis("Y", Side::kTable, Vec3::UnitY()),
                    make_axis("X", Side::kHead, Vec3::UnitX()), make_axis("Z", Side::kHead, Vec3::UnitZ())});
  const ToolPose pose{{1.0, 2.0, 3.0}, Vec3::UnitY()};
  EXPECT_EQ(InverseKinematics(machine).solve(pose, AxisValues::Zero()).count, 0);
  EXPECT_NE(unreachable_text(machine, pose).text.find("do not span space"), std::string::npos);
}

TEST(TravelExcess, IsSigned) {
  Axis axis = make_axis("X", Side::kTable, Vec3::UnitX());
  axis.min = -10.0;
  axis.max = 20.0;
  EXPECT_EQ(travel_excess(axis, -10.5), -0.5);
  EXPECT_EQ(travel_excess(axis, -10.0), 0.0);
  EXPECT_EQ(travel_excess(axis, 20.0), 0.0);
  EXPECT_EQ(travel_excess(axis, 23.0), 3.0);
}

}  // namespace
}  // namespace swarf::kinematics
