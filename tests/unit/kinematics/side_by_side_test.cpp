// What is taken two at a time must not depend on what stands beside it, and must be what one at a time gives.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "kinematics/forward_chain.h"
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

TEST(SideBySide, ContinuedPosesAreThoseOfOneAtATime) {
  for (const MachineModel& machine : machines_side_by_side()) {
    const InverseKinematics inverse(machine);
    Rng rng(31);
    int differ = 0;
    for (int i = 0; i < 1000; ++i) {
      const std::vector<ToolPose> poses = mixed_poses(machine, rng, 1 + i % 17);
      std::vector<AxisValues> before;
      for (size_t k = 0; k < poses.size(); ++k)
        before.push_back((rng.uniform() < 0.01 ? 1e10 : 3.0) * random_values(machine, rng));
      std::vector<Branch> found(poses.size());
      inverse.continued(poses, before, found);
      for (size_t k = 0; k < poses.size(); ++k) {
        const Branch one = inverse.continued(poses[k], before[k]);
        differ += differences(found[k], one);
        if (before[k].norm() > 1e9) continue;
        const Branch nearest = nearest_by_turns(machine, inverse.solve(poses[k], before[k]), before[k]);
        differ += differences(one, nearest);
      }
    }
    EXPECT_EQ(differ, 0) << machine.name;
  }
}

TEST(SideBySide, PosesAlongAWayAreThoseOfOneAfterTheOther) {
  for (const MachineModel& machine : machines_side_by_side()) {
    const InverseKinematics inverse(machine);
    Rng rng(33);
    int differ = 0;
    for (int i = 0; i < 1000; ++i) {
      const std::vector<ToolPose> poses = mixed_poses(machine, rng, 1 + i % 17);
      AxisValues before = 3.0 * random_values(machine, rng);
      std::vector<Branch> found(poses.size());
      inverse.continued(poses, before, found);
      for (size_t k = 0; k < poses.size(); ++k) {
        const Branch one = inverse.continued(poses[k], before);
        differ += differences(found[k], one);
        if (one.outcome != InverseOutcome::kUnreachable) before = one.q;
      }
    }
    EXPECT_EQ(differ, 0) << machine.name;
  }
}

TEST(SideBySide, ForwardChainIsForwardToTheLastBits) {
  for (const MachineModel& machine : machines_side_by_side()) {
    const ForwardChain chain(machine);
    Rng rng(32);
    Errors errors;
    for (int i = 0; i < 4000; ++i) {
      const AxisValues q[2] = {random_values(machine, rng), random_values(machine, rng)};
      ToolPose poses[2];
      chain.at(q, poses);
      for (int lane = 0; lane < 2; ++lane) errors.add(poses[lane], forward(machine, q[lane]));
    }
    EXPECT_LT(errors.tip, 1e-12) << machine.name;
    EXPECT_LT(errors.axis, 1e-15) << machine.name;
  }
}

}  // namespace
}  // namespace swarf::kinematics
