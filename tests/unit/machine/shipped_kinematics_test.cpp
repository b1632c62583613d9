// The inverse on every machine of assets/machines: a million poses, every pole, every end of travel.
#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"
#include "base/units.h"
#include "kinematics/model_check.h"
#include "kinematics/reach.h"
#include "kinematics/round_trip.h"
#include "shipped_machines.h"

namespace swarf::machine::shipped_kinematics_test {
namespace {

using kinematics::Axis;
using kinematics::AxisKind;
using kinematics::AxisValues;
using kinematics::Branch;
using kinematics::InverseKinematics;
using kinematics::InverseOutcome;
using kinematics::InverseSolutions;
using kinematics::MachineModel;

class Shipped : public testing::TestWithParam<std::string> {
 protected:
  /// With the tool that a real machine needs, so that the tip is not the gauge line.
  const MachineModel machine_ = kinematics::with_tool(shipped_machine(GetParam()), 137.0);
  const InverseKinematics inverse_{machine_};
  const std::vector<int> rotary_ = kinematics::rotary_order(machine_);

  /// Anywhere inside the travel; rotary axes at most two turns from zero.
  AxisValues random_values(Rng& rng) const {
    AxisValues q = AxisValues::Zero();
    for (size_t i = 0; i < machine_.axes.size(); ++i) {
      const Axis& axis = machine_.axes[i];
      const double reach = axis.kind == AxisKind::kRotary ? 4.0 * kPi : 1e9;
      q[static_cast<int>(i)] = rng.uniform(std::max(axis.min, -reach), std::min(axis.max, reach));
    }
    return q;
  }

  /// The branch whose values are nearest to q.
  Branch nearest_to(const AxisValues& q) const {
    const InverseSolutions solutions = inverse_.solve(forward(machine_, q), q);
    Branch best;
    double distance = 1e9;
    for (int k = 0; k < solutions.count; ++k) {
      const double away = (solutions.branch[k].q - q).cwiseAbs().maxCoeff();
      if (away >= distance) continue;
      distance = away;
      best = solutions.branch[k];
    }
    return best;
  }

  double to_file_units(int axis) const {
    return machine_.axes[static_cast<size_t>(axis)].kind == AxisKind::kRotary ? deg_from_rad(1.0) : 1.0;
  }
};

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

TEST_P(Shipped, ForwardOfTheInverseGivesAMillionPosesBackInEveryBranch) {
  const kinematics::RoundTrip trip = kinematics::round_trip(machine_, 1000000, 1);
  EXPECT_EQ(trip.unsolved, 0);
  EXPECT_EQ(trip.not_found, 0);
  EXPECT_EQ(trip.branches, rotary_.size() == 2 ? 2 * trip.poses : trip.poses);
  EXPECT_LT(trip.tip_mm, 1e-9);
  EXPECT_LT(trip.axis_rad, 1e-12);
  std::printf("%s: %lld branches of %d poses, tip %.3g mm, axis %.3g rad\n", GetParam().c_str(),
              static_cast<long long>(trip.branches), trip.poses, trip.tip_mm, trip.axis_rad);
}

/// At each pole the axis next to the work is free and keeps the value that it has; beside it, it is not.
TEST_P(Shipped, EachPoleLeavesTheOuterAxisWhereItIs) {
  if (rotary_.size() < 2) {
    EXPECT_TRUE(std::isinf(inverse_.pole_distance(Vec3::UnitZ())));
    return;
  }
  const Axis& outer = machine_.axes[static_cast<size_t>(rotary_[0])];
  const Vec3 e1_W = machine_.X_MW.linear().transpose() * outer.direction_M;
  int poles = 0;
  for (const Vec3& pole : {Vec3(e1_W), Vec3(-e1_W)}) {
    if (inverse_.pole_distance(pole) > 1e-15) continue;
    ++poles;
    for (const double stands : {0.0, 1.0, -2.5}) {
      AxisValues hint = AxisValues::Zero();
      hint[rotary_[0]] = stands;
      const ToolPose at{{10.0, -20.0, 30.0}, pole};
      const InverseSolutions one = inverse_.solve(at, hint);
      ASSERT_EQ(one.count, 1);
      const Branch& branch = one.branch[0];
      EXPECT_EQ(branch.q[rotary_[0]], stands);
      EXPECT_TRUE(branch.outcome == InverseOutcome::kSingular ||
                  branch.outcome == InverseOutcome::kOutOfTravel);
      const ToolPose back = forward(machine_, branch.q);
      EXPECT_LT((back.tip_W - at.tip_W).norm(), 1e-9);
      EXPECT_LT(angle_between(back.axis_W, pole), 1e-12);
      for (const double tilt : {1e-9, 1e-6, 1e-3}) {
        const Vec3 beside = Eigen::AngleAxisd(tilt, pole.unitOrthogonal()) * pole;
        EXPECT_EQ(inverse_.solve({at.tip_W, beside}, hint).count, 2);
        EXPECT_NEAR(inverse_.pole_distance(beside), tilt, 1e-15);
      }
    }
  }
  EXPECT_GE(poles, 1);
}

/// Each end of each axis: a pose just inside has values inside the travel; just outside, the axis is named
/// and by how much it is beyond, or a value one turn away lies inside.
TEST_P(Shipped, EachEndOfTravelNamesItsAxis) {
  Rng rng(99);
  for (size_t i = 0; i < machine_.axes.size(); ++i) {
    const int index = static_cast<int>(i);
    const Axis& axis = machine_.axes[i];
    for (const double end : {axis.min, axis.max}) {
      const double outwards = end == axis.min ? -1.0 : 1.0, step = 1e-6;
      AxisValues q = random_values(rng);
      // Off the pole and its mirror, so that the branches are apart.
      if (!rotary_.empty()) q[rotary_.back()] = 0.3 * machine_.axes[static_cast<size_t>(rotary_.back())].max;
      q[index] = end - outwards * step;
      const std::string where = axis.name + " at " + std::to_string(end * to_file_units(index));
      const Branch inside = nearest_to(q);
      EXPECT_EQ(inside.outcome, InverseOutcome::kOk) << where;
      EXPECT_NEAR(inside.q[index], q[index], 1e-9) << where;

      q[index] = end + outwards * step;
      const double a_turn_back = q[index] - outwards * 2.0 * kPi;
      const bool turns = axis.kind == AxisKind::kRotary && a_turn_back > axis.min && a_turn_back < axis.max;
      AxisValues expected = q;
      if (turns) expected[index] = a_turn_back;
      const Branch outside = [&] {
        Branch best;
        const InverseSolutions all = inverse_.solve(forward(machine_, q), q);
        for (int k = 0; k < all.count; ++k) {
          if ((all.branch[k].q - expected).cwiseAbs().maxCoeff() < 1e-8) best = all.branch[k];
        }
        return best;
      }();
      if (turns) {
        EXPECT_EQ(outside.outcome, InverseOutcome::kOk) << where;
      } else {
        EXPECT_EQ(outside.outcome, InverseOutcome::kOutOfTravel) << where;
        EXPECT_EQ(outside.out_of_travel_axis, index) << where;
        EXPECT_NEAR(travel_excess(axis, outside.q[index]), outwards * step, 1e-9) << where;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Machines, Shipped, testing::ValuesIn(shipped_machines()),
                         [](const auto& instance) { return instance.param; });

}  // namespace
}  // namespace swarf::machine::shipped_kinematics_test
