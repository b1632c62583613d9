// Random serial chains: any side, any direction, offsets up to a metre. Every branch is found, and no other.
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "kinematics/model_check.h"
#include "test_machines.h"

namespace swarf::kinematics {
namespace {

MachineModel random_chain(Rng& rng) {
  MachineModel machine;
  machine.name = "random";
  const char* names[] = {"X", "Y", "Z", "A", "C"};
  int order[] = {0, 1, 2, 3, 4};
  for (int i = 4; i > 0; --i) std::swap(order[i], order[rng.next() % (i + 1)]);
  for (const int i : order) {
    const Side side = rng.uniform() < 0.5 ? Side::kTable : Side::kHead;
    const Vec3 origin = 1000.0 * rng.uniform() * rng.direction();
    (side == Side::kTable ? machine.table_chain : machine.head_chain)
        .push_back(static_cast<int>(machine.axes.size()));
    machine.axes.push_back(make_axis(names[i], side, rng.direction(), origin, rng.uniform() < 0.5));
  }
  machine.X_MW.linear() = Eigen::AngleAxisd(rng.uniform(0.0, kPi), rng.direction()).toRotationMatrix();
  machine.X_MW.translation() = 100.0 * rng.direction();
  machine.tip_M = 100.0 * rng.direction();
  machine.tool_axis_M = rng.direction();
  return machine;
}

/// Linear axes that ride on rotary ones may become dependent at some poses; tells how far from it q is.
double linear_volume(const MachineModel& machine, const AxisValues& q) {
  Mat3 columns;
  int count = 0;
  for (size_t i = 0; i < machine.axes.size(); ++i) {
    if (machine.axes[i].kind != AxisKind::kLinear) continue;
    AxisValues moved = q;
    moved[i] += 1.0;
    columns.col(count++) = forward_by_poses(machine, moved).tip_W - forward_by_poses(machine, q).tip_W;
  }
  return std::abs(columns.determinant());
}

/// A random chain that is not badly conditioned by its build: that would not be the solver's doing.
MachineModel sound_random_chain(Rng& rng) {
  for (;;) {
    const MachineModel machine = random_chain(rng);
    const std::vector<int> rotary = rotary_order(machine);
    const Vec3 e1 = machine.axes[rotary[0]].direction_M, e2 = machine.axes[rotary[1]].direction_M;
    if (linear_volume(machine, AxisValues::Zero()) >= 0.1 && e1.cross(e2).norm() >= 0.1 &&
        e2.cross(machine.tool_axis_M).norm() >= 0.1) {
      return machine;
    }
  }
}

TEST(RandomChain, ThousandChainsComeBack) {
  Rng rng(42);
  int chains = 0, poses = 0;
  Errors errors;
  while (chains < 1000) {
    const MachineModel machine = sound_random_chain(rng);
    ++chains;
    const InverseKinematics inverse(machine);
    for (int i = 0; i < 50; ++i) {
      const AxisValues q = random_values(machine, rng);
      if (linear_volume(machine, q) < 0.05) continue;
      ++poses;
      const ToolPose pose = forward_by_poses(machine, q);
      const Branch branch = inverse.solve_nearest(pose, q);
      ASSERT_EQ(branch.outcome, InverseOutcome::kOk) << "chain " << chains << " pose " << pose;
      ASSERT_LT((branch.q - q).cwiseAbs().maxCoeff(), 1e-4) << "chain " << chains << " pose " << pose;
      errors.add(forward_by_poses(machine, branch.q), pose);
    }
  }
  EXPECT_GT(poses, 30000);
  EXPECT_LT(errors.tip, 2e-9);  // the proof's 1e-9 plus the rounding of the independent forward
  EXPECT_LT(errors.axis, 2e-12);
  std::printf("%d poses: tip %.3g mm, axis %.3g rad\n", poses, errors.tip, errors.axis);
}

/// The rotary values that give the tool the direction, found by scanning the one next to the tool over a full
/// turn: it sets the angle between the tool and the axis next to the work, and the other follows. Knows
/// forward_by_poses only. Pairs of values in the order of rotary_order(); complete when no two roots lie in
/// one step of the scan.
std::vector<std::pair<double, double>> scanned_branches(const MachineModel& machine, const Vec3& axis_W) {
  const std::vector<int> rotary = rotary_order(machine);
  const Vec3 e1_W = machine.X_MW.linear().transpose() * machine.axes[rotary[0]].direction_M;
  AxisValues q = AxisValues::Zero();
  const auto gap = [&](double inner) {
    q[rotary[1]] = inner;
    return e1_W.dot(forward_by_poses(machine, q).axis_W) - e1_W.dot(axis_W);
  };
  std::vector<std::pair<double, double>> found;
  constexpr int kSteps = 720;
  double low = -kPi, value_low = gap(low);
  for (int i = 1; i <= kSteps; ++i) {
    const double high = -kPi + 2.0 * kPi * i / kSteps, value_high = gap(high);
    if ((value_low < 0.0) != (value_high < 0.0)) {
      double a = low, b = high;
      for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (a + b);
        ((gap(middle) < 0.0) == (value_low < 0.0) ? a : b) = middle;
      }
      gap(a);
      q[rotary[0]] = 0.0;
      const Vec3 from = forward_by_poses(machine, q).axis_W.cross(e1_W), to = axis_W.cross(e1_W);
      // The turn about e1 is the value itself: positive values turn the tool positively in W (ISO 841).
      const double turn = std::atan2(from.cross(to).dot(e1_W), from.dot(to));
      found.emplace_back(machine.axes[rotary[0]].reversed ? -turn : turn, a);
    }
    low = high;
    value_low = value_high;
  }
  return found;
}

double turn_between(double a, double b) {
  return std::abs(std::remainder(a - b, 2.0 * kPi));
}

TEST(RandomChain, EveryBranchOfAThousandChainsIsFoundAndNoOther) {
  Rng rng(4242);
  int branches = 0, none = 0;
  for (int chain = 0; chain < 1000; ++chain) {
    const MachineModel machine = sound_random_chain(rng);
    const InverseKinematics inverse(machine);
    const std::vector<int> rotary = rotary_order(machine);
    for (int i = 0; i < 3; ++i) {
      // A direction that some values give, and one that perhaps none gives.
      const Vec3 axis_W =
          i < 2 ? forward_by_poses(machine, random_values(machine, rng)).axis_W : rng.direction();
      const ToolPose pose{500.0 * rng.direction(), axis_W};
      const auto scanned = scanned_branches(machine, axis_W);
      const InverseSolutions solutions = inverse.solve(pose, AxisValues::Zero());
      // Where both branches meet, the scan may miss them both.
      if (solutions.count == 2 &&
          turn_between(solutions.branch[0].q[rotary[1]], solutions.branch[1].q[rotary[1]]) < 0.02) {
        continue;
      }
      // A pose at which the linear axes become dependent has no values; its neighbours lose digits.
      bool sound = true;
      for (const auto& [outer, inner] : scanned) {
        AxisValues q = AxisValues::Zero();
        q[rotary[0]] = outer;
        q[rotary[1]] = inner;
        sound = sound && linear_volume(machine, q) > 0.05;
      }
      if (!sound) continue;
      ASSERT_EQ(static_cast<size_t>(solutions.count), scanned.size()) << "chain " << chain << ' ' << pose;
      for (const auto& [outer, inner] : scanned) {
        double nearest = 1e9;
        for (int k = 0; k < solutions.count; ++k) {
          nearest = std::min(nearest, turn_between(solutions.branch[k].q[rotary[0]], outer) +
                                          turn_between(solutions.branch[k].q[rotary[1]], inner));
        }
        ASSERT_LT(nearest, 1e-7) << "chain " << chain << " values " << outer << ' ' << inner << ' ' << pose;
        ++branches;
      }
      none += scanned.empty() ? 1 : 0;
    }
  }
  EXPECT_GT(branches, 3000);
  EXPECT_GT(none, 100);
  std::printf("%d branches on 1000 chains, %d poses without one\n", branches, none);
}

}  // namespace
}  // namespace swarf::kinematics
