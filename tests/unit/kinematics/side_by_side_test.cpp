// What is taken two at a time must not depend on what stands beside it, and must be what one at a time gives.
#include <gtest/gtest.h>

#include <cmath>
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

/// Poses in reach, at the pole, out of reach and not a number, after values up to three turns away.
TEST(SideBySide, ContinuedPosesAreThoseOfOneAtATime) {
  for (const MachineModel& machine : machines_side_by_side()) {
    const InverseKinematics inverse(machine);
    Rng rng(31);
    int differ = 0;
    for (int i = 0; i < 4000; ++i) {
      ToolPose poses[2];
      AxisValues before[2];
      for (int lane = 0; lane < 2; ++lane) {
        poses[lane] = forward(machine, random_values(machine, rng));
        before[lane] = 3.0 * random_values(machine, rng);
        const double kind = rng.uniform();
        if (kind < 0.1) poses[lane].axis_W = rng.direction();
        if (kind > 0.9) poses[lane].axis_W = (Vec3::UnitZ() + 1e-14 * rng.direction()).normalized();
        if (kind > 0.98) poses[lane].axis_W.x() = std::nan("");
      }
      Branch found[2];
      inverse.continued(poses, before, found);
      for (int lane = 0; lane < 2; ++lane) {
        const Branch one = inverse.continued(poses[lane], before[lane]);
        const Branch expected =
            nearest_by_turns(machine, inverse.solve(poses[lane], before[lane]), before[lane]);
        for (const Branch& got : {found[lane], one}) {
          if (got.outcome != expected.outcome || got.out_of_travel_axis != expected.out_of_travel_axis)
            ++differ;
          if (expected.outcome != InverseOutcome::kUnreachable && got.q != expected.q) ++differ;
        }
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
