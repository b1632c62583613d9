// What is taken two at a time must not depend on what stands beside it, and must be what one at a time gives.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "base/instruction_sets.h"
#include "kinematics/forward_chain.h"
#include "kinematics/inverse_lanes.h"
#include "test_machines.h"

namespace swarf::kinematics {
namespace {

std::vector<MachineModel> machines_side_by_side() {
  return {lin_koren_machine(), table_table_ac(), table_head_ba(), head_head_ca(), nutating_head()};
}

/// The solution nearest by the turns of the rotary axes, each turned by whole turns to the value before.
Branch nearest_by_turns(const MachineModel& machine, const InverseSolutions& all, const AxisValues& before) {
  Branch nearest;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < all.count; ++k) {
    Branch one = all.branch[k];
    double turn = 0.0;
    for (size_t i = 0; i < machine.axes.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      if (machine.axes[i].kind != AxisKind::kRotary) continue;
      one.q[row] += 2.0 * kPi * std::nearbyint((before[row] - one.q[row]) / (2.0 * kPi));
      turn += std::abs(one.q[row] - before[row]);
    }
    if (turn >= least) continue;
    least = turn;
    nearest = one;
  }
  return nearest;
}

/// Poses in reach, at the pole, out of reach and not a number, after values up to three turns away or more
/// than can be counted.
std::vector<ToolPose> mixed_poses(const MachineModel& machine, Rng& rng, size_t count) {
  std::vector<ToolPose> poses;
  for (size_t i = 0; i < count; ++i) {
    poses.push_back(forward(machine, random_values(machine, rng)));
    Vec3& axis = poses.back().axis_W;
    const double kind = rng.uniform();
    if (kind < 0.03) axis = rng.direction();
    if (kind > 0.97) axis = (Vec3::UnitZ() + 1e-14 * rng.direction()).normalized();
    if (kind > 0.99) axis.x() = std::nan("");
    if (kind > 0.5 && kind < 0.6) axis *= 1.5;
  }
  return poses;
}

int differences(const Branch& got, const Branch& expected) {
  const bool same_kind =
      got.outcome == expected.outcome && got.out_of_travel_axis == expected.out_of_travel_axis;
  const bool same_bits = std::memcmp(got.q.data(), expected.q.data(), sizeof(AxisValues)) == 0;
  return same_kind && (same_bits || expected.outcome == InverseOutcome::kUnreachable) ? 0 : 1;
}

/// Of every variant of the kernel that this processor runs.
TEST(SideBySide, ContinuedPosesAreThoseOfOneAtATime) {
  for (const MachineModel& machine : machines_side_by_side()) {
    const InverseKinematics inverse(machine);
    Rng rng(31);
    int differ = 0;
    for (int i = 0; i < 1000; ++i) {
      const std::vector<ToolPose> poses = mixed_poses(machine, rng, 1 + i % 17);
      std::vector<AxisValues> before;
      std::vector<Branch> one, found(poses.size());
      for (const ToolPose& pose : poses) {
        before.push_back((rng.uniform() < 0.01 ? 1e10 : 3.0) * random_values(machine, rng));
        one.push_back(inverse.continued(pose, before.back()));
        if (before.back().norm() > 1e9) continue;
        const Branch nearest = nearest_by_turns(machine, inverse.solve(pose, before.back()), before.back());
        differ += differences(one.back(), nearest);
      }
      for (const InverseLanes& lanes : inverse_lane_variants()) {
        continue_apart(lanes, inverse, poses, before, found);
        for (size_t k = 0; k < poses.size(); ++k) differ += differences(found[k], one[k]);
      }
    }
    EXPECT_EQ(differ, 0) << machine.name;
  }
}

/// Travel that ends at a value of the pose itself, or at 0 where the value is 0 or -0.
TEST(SideBySide, ValuesOnABoundOfTheTravelAreInside) {
  for (const MachineModel& machine : machines_side_by_side()) {
    Rng rng(34);
    for (int i = 0; i < 100; ++i) {
      AxisValues q = random_values(machine, rng);
      for (Eigen::Index row = 0; row < kMaxAxes; ++row)
        if (rng.uniform() < 0.3) q[row] = rng.uniform() < 0.5 ? 0.0 : -0.0;
      const std::vector<ToolPose> poses(3, forward(machine, q));
      const Branch found = InverseKinematics(machine).continued(poses[0], q);
      MachineModel bounded = machine;
      for (size_t row = 0; row < machine.axes.size(); ++row) {
        const double value = found.q[static_cast<Eigen::Index>(row)];
        (rng.uniform() < 0.5 ? bounded.axes[row].min : bounded.axes[row].max) = value == 0.0 ? 0.0 : value;
      }
      const InverseKinematics inverse(bounded);
      const Branch expected = inverse.continued(poses[0], q);
      std::vector<Branch> side_by_side(poses.size());
      for (const InverseLanes& lanes : inverse_lane_variants()) {
        continue_apart(lanes, inverse, poses, std::vector<AxisValues>(poses.size(), q), side_by_side);
        for (const Branch& one : side_by_side)
          EXPECT_EQ(differences(one, expected), 0) << machine.name << " " << i;
      }
    }
  }
}

TEST(SideBySide, PosesAlongAWayAreThoseOfOneAfterTheOther) {
  for (const MachineModel& machine : machines_side_by_side()) {
    const InverseKinematics inverse(machine);
    Rng rng(33);
    int differ = 0;
    for (int i = 0; i < 1000; ++i) {
      const std::vector<ToolPose> poses = mixed_poses(machine, rng, 1 + i % 17);
      const AxisValues before = 3.0 * random_values(machine, rng);
      AxisValues last = before;
      std::vector<Branch> one, found(poses.size());
      for (const ToolPose& pose : poses) {
        one.push_back(inverse.continued(pose, last));
        if (one.back().outcome != InverseOutcome::kUnreachable) last = one.back().q;
      }
      for (const InverseLanes& lanes : inverse_lane_variants()) {
        continue_along(lanes, inverse, poses, before, found);
        for (size_t k = 0; k < poses.size(); ++k) differ += differences(found[k], one[k]);
      }
    }
    EXPECT_EQ(differ, 0) << machine.name;
  }
}

/// So that the two above have seen what they are to see.
TEST(SideBySide, EightFourAndTwoPosesWhereTheProcessorHasThem) {
  std::vector<int> poses;
  for (const InverseLanes& lanes : inverse_lane_variants()) poses.push_back(lanes.poses);
  std::vector<int> expected{2};
  if (runs_x86_64_v3()) expected.insert(expected.begin(), 4);
  if (runs_x86_64_v4()) expected.insert(expected.begin(), 8);
  EXPECT_EQ(poses, expected);
  EXPECT_EQ(forward_kernel_variants().size(), expected.size());
}

TEST(SideBySide, ForwardChainIsForwardToTheLastBits) {
  for (const MachineModel& machine : machines_side_by_side()) {
    const ForwardChain chain(machine);
    Rng rng(32);
    Errors errors;
    int differ = 0;
    for (int i = 0; i < 800; ++i) {
      std::vector<AxisValues> q(static_cast<size_t>(1 + i % 17));
      for (AxisValues& one : q) one = (rng.uniform() < 0.01 ? 1e6 : 1.0) * random_values(machine, rng);
      std::vector<ToolPose> poses(q.size());
      chain.at(q, poses);
      for (size_t k = 0; k < q.size(); ++k)
        if (q[k].norm() < 1e4) errors.add(poses[k], forward(machine, q[k]));
      for (const ForwardKernel kernel : forward_kernel_variants()) {
        std::vector<ToolPose> others(q.size()), alone(1);
        kernel(chain, q, others);
        kernel(chain, std::span(q).last(1), alone);
        differ += std::memcmp(others.data(), poses.data(), poses.size() * sizeof(ToolPose)) != 0;
        differ += std::memcmp(alone.data(), &poses.back(), sizeof(ToolPose)) != 0;
      }
    }
    EXPECT_EQ(differ, 0) << machine.name;
    EXPECT_LT(errors.tip, 1e-12) << machine.name;
    EXPECT_LT(errors.axis, 1e-15) << machine.name;
  }
}

}  // namespace
}  // namespace swarf::kinematics
