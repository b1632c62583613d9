// Circles given as lines, and how far linear axes lead from them (theory 2, the tilted cone).
#include "motion/judged/circle_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "base/rng.h"
#include "unit/kinematics/singular_blocks.h"

namespace swarf::motion::circle_error_test {
namespace {

using toolpath::BlockLaw;
using toolpath::BlockMove;

/// The points of a circle of radius 30 about (20, 10, 300), the axis constant or leaning outwards.
std::vector<ToolPose> ring(int blocks, double turn, double lean, double height = 0.0) {
  std::vector<ToolPose> poses;
  for (int i = 0; i <= blocks; ++i) {
    const double phi = turn * i / blocks;
    const Vec3 out(std::cos(phi), std::sin(phi), 0.0);
    poses.push_back({Vec3(20.0, 10.0, 300.0 + height * i / blocks) + 30.0 * out,
                     std::cos(lean) * Vec3::UnitZ() + std::sin(lean) * out});
  }
  return poses;
}

toolpath::ToolPath path_of(const std::vector<ToolPose>& poses) {
  toolpath::ToolPath path;
  for (size_t i = 1; i < poses.size(); ++i) {
    BlockMove block;
    block.from = poses[i - 1];
    block.to = poses[i];
    block.law = BlockLaw::kJoint;
    block.feed_mm_s = 10.0;
    path.elements.push_back({block, 0, {}});
  }
  return path;
}

std::optional<CircleError> error_of(const std::vector<ToolPose>& poses) {
  static const kinematics::MachineModel machine = kinematics::table_table_ac();
  const toolpath::ToolPath path = path_of(poses);
  const BlockMotions motions = block_motions(path, machine);
  std::vector<int> elements(motions.size());
  std::iota(elements.begin(), elements.end(), 0);
  return circle_error(motions, elements);
}

TEST(CircleError, WithoutATurnOfTheAxesItIsTheSagitta) {
  const auto error = error_of(ring(24, 2.0 * kPi, 0.0));
  ASSERT_TRUE(error);
  EXPECT_EQ(error->blocks(), 24);
  EXPECT_NEAR(error->radius_mm, 30.0, 1e-9);
  const double sagitta = 30.0 * (1.0 - std::cos(kPi / 24.0));
  EXPECT_NEAR(error->chord_mm, sagitta, 1e-9);
  EXPECT_NEAR(error->value_mm, sagitta, 1e-9);
  EXPECT_NEAR(error->u, 0.5, 1e-3);
}

TEST(CircleError, TurningAxesAddToIt) {
  const auto error = error_of(ring(24, 2.0 * kPi, 0.2));
  ASSERT_TRUE(error);
  EXPECT_GT(std::abs(error->value_mm - error->chord_mm), 1e-3);
  // Against samples that know nothing of the search.
  const kinematics::MachineModel machine = kinematics::table_table_ac();
  const toolpath::ToolPath path = path_of(ring(24, 2.0 * kPi, 0.2));
  double worst = 0.0;
  for (const BlockMotion& motion : block_motions(path, machine)) {
    for (int k = 0; k <= 1000; ++k) {
      const kinematics::AxisValues q = motion.q_from + k / 1000.0 * (motion.q_to - motion.q_from);
      const Vec3 gap = forward(machine, q).tip_W - Vec3(20.0, 10.0, 300.0);
      worst = std::max(worst, std::hypot(gap.z(), std::hypot(gap.x(), gap.y()) - 30.0));
    }
  }
  EXPECT_NEAR(error->value_mm, worst, 1e-6);
  EXPECT_GE(error->value_mm, worst - 1e-12);
}

TEST(CircleError, OnlyRunsOfEightBlocksAndAQuarter) {
  EXPECT_FALSE(error_of(ring(7, 2.0 * kPi, 0.0)));
  EXPECT_TRUE(error_of(ring(8, 2.0 * kPi, 0.0)));
  EXPECT_FALSE(error_of(ring(8, 0.45 * kPi, 0.0)));
  EXPECT_TRUE(error_of(ring(8, 0.55 * kPi, 0.0)));
  EXPECT_FALSE(error_of(ring(24, 2.0 * kPi, 0.0, 5.0)));  // a helix is no circle
}

TEST(CircleError, StraightRowsWithRoundedPointsAreNoCircle) {
  Rng rng(5);
  std::vector<ToolPose> poses;
  for (int i = 0; i <= 200; ++i) {
    poses.push_back({{0.5 * i + rng.uniform(-5e-5, 5e-5), rng.uniform(-5e-5, 5e-5), 300.0}, Vec3::UnitZ()});
  }
  EXPECT_FALSE(error_of(poses));
}

TEST(CircleError, TheLongestOfSeveral) {
  std::vector<ToolPose> poses = ring(12, 2.0 * kPi, 0.0);
  for (ToolPose pose : ring(36, 1.5 * kPi, 0.0)) {
    pose.tip_W.z() += 20.0;
    poses.push_back(pose);
  }
  const auto error = error_of(poses);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->blocks(), 36);
  EXPECT_EQ(error->first, 13);
  EXPECT_EQ(error->last, 48);
}

}  // namespace
}  // namespace swarf::motion::circle_error_test
