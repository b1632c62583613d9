// Linearisation of the block of So et al. and the scan of a path (theory 2).
#include "motion/judged/singularity_scan.h"

#include <gtest/gtest.h>

#include <cmath>

#include "motion/blocks/linearise.h"
#include "unit/kinematics/singular_blocks.h"

namespace swarf::motion::singularity_scan_test {
namespace {

using kinematics::BlockEnds;
using kinematics::InverseKinematics;
using kinematics::MachineModel;
using toolpath::BlockLaw;
using toolpath::BlockMove;

MachineModel so_machine() {
  MachineModel machine = kinematics::table_table_ac();
  for (kinematics::Axis& axis : machine.axes) axis.speed_max = 2.0;
  machine.axes[1].home = rad_from_deg(149.0);
  machine.axes[0].home = rad_from_deg(1.0);
  return machine;
}

BlockMove move(const ToolPose& from, const ToolPose& to, BlockLaw law, double feed_mm_s) {
  BlockMove block;
  block.from = from;
  block.to = to;
  block.law = law;
  block.feed_mm_s = feed_mm_s;
  return block;
}

void append(toolpath::ToolPath& path, const BlockMove& block) {
  path.elements.push_back({block, 0, {"test.cl", static_cast<int>(path.elements.size()) + 1, 1}});
}

ToolPose above(ToolPose pose, double way) {
  pose.tip_W += way * pose.axis_W;
  return pose;
}

/// Rapid to P0, P0 to P1, away along the axis.
toolpath::ToolPath so_path(BlockLaw law) {
  const ToolPose p0 = kinematics::so_p0(), p1 = kinematics::so_p1();
  toolpath::ToolPath path;
  append(path, move(above(p0, 50), p0, law, 0.0));
  append(path, move(p0, p1, law, 10.0));
  append(path, move(p1, above(p1, 50), law, 10.0));
  return path;
}

TEST(Linearise, EqualPiecesOfTheBlockOfTable2) {
  const MachineModel machine = so_machine();
  const InverseKinematics inverse(machine);
  const BlockEnds block = kinematics::so_block(machine);
  const auto error = [&](int pieces) { return equal_pieces_error(machine, inverse, block, pieces); };
  // Theory 2 gives the distance to the line; from eight pieces on nothing passes the ends of the pieces.
  EXPECT_NEAR(error(1).segment_mm, 2.126416, 0.5e-6);
  EXPECT_NEAR(error(2).line_mm, 0.250862, 1e-6);
  EXPECT_NEAR(error(2).segment_mm, 0.493457, 0.5e-6);
  EXPECT_NEAR(error(4).line_mm, 0.063519, 0.5e-6);
  EXPECT_NEAR(error(4).segment_mm, 0.083597, 0.5e-6);
  for (const auto& [pieces, mm] :
       {std::pair(8, 0.015896), std::pair(16, 0.003973), std::pair(32, 0.000993)}) {
    EXPECT_NEAR(error(pieces).line_mm, mm, 0.5e-6) << pieces;
    EXPECT_NEAR(error(pieces).segment_mm, mm, 0.5e-6) << pieces;
  }
}

TEST(Linearise, BlocksForATolerance) {
  const MachineModel machine = so_machine();
  const InverseKinematics inverse(machine);
  const BlockEnds block = kinematics::so_block(machine);
  struct Row {
    double tolerance_mm;
    int equal, greedy;
  };
  for (const Row& row : {Row{0.1, 4, 4}, Row{0.05, 5, 5}, Row{0.02, 8, 7}, Row{0.01, 11, 10},
                         Row{0.005, 15, 14}, Row{0.001, 32, 31}}) {
    EXPECT_EQ(equal_pieces(machine, inverse, block, row.tolerance_mm), row.equal) << row.tolerance_mm;
    const auto cuts = greedy_cuts(machine, inverse, block, row.tolerance_mm);
    ASSERT_TRUE(cuts) << row.tolerance_mm;
    EXPECT_EQ(static_cast<int>(cuts->size()) - 1, row.greedy) << row.tolerance_mm;
    kinematics::AxisValues q = block.q_from;
    for (size_t i = 1; i < cuts->size(); ++i) {
      const auto piece = piece_of(inverse, block, (*cuts)[i - 1], (*cuts)[i], q);
      ASSERT_TRUE(piece);
      EXPECT_LE(kinematics::trajectory_error(machine, *piece).segment.value, row.tolerance_mm);
      q = piece->q_to;
    }
  }
}

/// Random blocks near the pole: within the tolerance, and greedy never needs more than equal pieces.
TEST(Linearise, RandomBlocksStayWithinTheTolerance) {
  Rng rng(42);
  const MachineModel machine = so_machine();
  const InverseKinematics inverse(machine);
  for (int trial = 0; trial < 60; ++trial) {
    const double beta = rng.uniform(0.002, 0.05), sigma = rng.uniform(-kPi, kPi);
    const auto pose = [&](double azimuth, double tilt) -> ToolPose {
      return {kinematics::so_p0().tip_W + Vec3(rng.uniform(-2, 2), rng.uniform(-2, 2), rng.uniform(-1, 1)),
              Vec3(std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt))};
    };
    BlockEnds block{
        pose(sigma, beta), pose(sigma + rng.uniform(-1.5, 1.5), beta * rng.uniform(0.5, 2.0)), {}, {}};
    block.q_from = inverse.solve_nearest(block.from, kinematics::axis_values(0, 0, 0, 1, 0)).q;
    block.q_to = inverse.solve_nearest(block.to, block.q_from).q;
    const std::optional<int> equal = equal_pieces(machine, inverse, block, 0.01);
    const auto cuts = greedy_cuts(machine, inverse, block, 0.01);
    ASSERT_TRUE(equal && cuts) << kinematics::text_of(machine, block);
    EXPECT_LE(equal_pieces_error(machine, inverse, block, *equal).segment_mm, 0.01 + 1e-9)
        << kinematics::text_of(machine, block);
    EXPECT_LE(static_cast<int>(cuts->size()) - 1, *equal) << kinematics::text_of(machine, block);
  }
}

TEST(SingularityScan, FindsTheBlockOfTable2) {
  const MachineModel machine = so_machine();
  const toolpath::ToolPath path = so_path(BlockLaw::kJoint);
  const auto scan = scan_singularity(path, machine, 0.01);
  ASSERT_TRUE(scan);
  EXPECT_EQ(scan->blocks, 2);
  EXPECT_EQ(scan->rapids, 1);
  EXPECT_EQ(scan->outer_axis, "C");
  ASSERT_EQ(scan->worst.size(), 2u);
  const BlockSingularity& worst = scan->worst.front();
  EXPECT_EQ(worst.pole.element, 1);
  EXPECT_NEAR(worst.error.line.value, 0.938333, 0.5e-6);
  EXPECT_NEAR(worst.error.segment.value, 2.126416, 0.5e-6);
  EXPECT_NEAR(worst.analytic.value, 0.938350, 0.5e-6);
  EXPECT_EQ(worst.greedy, 10);
  EXPECT_EQ(worst.equal, 11);
  EXPECT_NEAR(deg_from_rad(worst.pole.pole_distance_rad), 1.066422, 0.5e-6);
  EXPECT_TRUE(worst.pole.in_cone());
  EXPECT_EQ(scan->in_cone, 1);
  EXPECT_NEAR(scan->worst.back().error.segment.value, 0.0, 1e-9);
  EXPECT_EQ(scan->worst.back().greedy, 1);
}

/// Under TCP the same block is what it would be without; its distance to the pole is that of the great
/// circle.
TEST(SingularityScan, UnderTcpItTellsWhatJointWouldDo) {
  const MachineModel machine = so_machine();
  for (const BlockLaw law : {BlockLaw::kTcp, BlockLaw::kTcpAxes}) {
    const auto scan = scan_singularity(so_path(law), machine, 0.01);
    ASSERT_TRUE(scan);
    EXPECT_NEAR(scan->worst.front().error.segment.value, 2.126416, 0.5e-6);
    if (law == BlockLaw::kTcp) {
      EXPECT_LT(deg_from_rad(scan->nearest.pole_distance_rad), 1.066422);
    } else {
      EXPECT_NEAR(deg_from_rad(scan->nearest.pole_distance_rad), 1.066422, 0.5e-6);
    }
  }
}

TEST(SingularityScan, NoneWithoutAPoleOrAFeedBlock) {
  MachineModel machine = so_machine();
  toolpath::ToolPath rapids;
  append(rapids, move(kinematics::so_p0(), kinematics::so_p1(), BlockLaw::kJoint, 0.0));
  EXPECT_FALSE(scan_singularity(rapids, machine, 0.01));
  machine.axes[0].direction_M = Vec3(1.0, 0.0, 0.3).normalized();
  machine.tool_axis_M = Vec3::UnitY();  // on its cone about A the tool never stands along C
  EXPECT_FALSE(scan_singularity(so_path(BlockLaw::kTcp), machine, 0.01));
}

/// The ten worst of many, against measuring every one of them.
TEST(SingularityScan, TheWorstAreTheWorstOfAll) {
  Rng rng(11);
  const MachineModel machine = so_machine();
  toolpath::ToolPath path;
  ToolPose at = kinematics::so_p0();
  for (int i = 0; i < 400; ++i) {
    const ToolPose next{at.tip_W + Vec3(rng.uniform(-2, 2), rng.uniform(-2, 2), 0),
                        (at.axis_W + 0.05 * rng.direction()).normalized()};
    append(path, move(at, next, BlockLaw::kJoint, 10.0));
    at = next;
  }
  const auto scan = scan_singularity(path, machine, 0.05);
  ASSERT_TRUE(scan);
  std::vector<double> every;
  for (const BlockMotion& motion : block_motions(path, machine)) {
    every.push_back(kinematics::segment_deviation(
                        machine, {motion.block.from, motion.block.to, motion.q_from, motion.q_to})
                        .value);
  }
  std::sort(every.rbegin(), every.rend());
  ASSERT_EQ(scan->worst.size(), static_cast<size_t>(kWorstBlocks));
  for (size_t i = 0; i < scan->worst.size(); ++i) {
    EXPECT_EQ(scan->worst[i].error.segment.value, every[i]) << i;
  }
}

}  // namespace
}  // namespace swarf::motion::singularity_scan_test
