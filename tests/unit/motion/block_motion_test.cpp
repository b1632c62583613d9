// The motion of CL blocks. The bound of its sweeps is held against dense sampling in tests/unit/sim.
#include "motion/blocks/block_motions.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/units.h"
#include "unit/motion/random_block.h"

namespace swarf::motion::block_motion_test {
namespace {

using kinematics::AxisValues;
using kinematics::MachineModel;
using toolpath::BlockLaw;
using toolpath::BlockMove;

void append(toolpath::ToolPath& path, const BlockMove& block, int line) {
  path.elements.push_back({block, 0, {"test.cl", line, 1}});
}

TEST(BlockMotion, BoundsHoldTheDerivativesOfRandomJointBlocks) {
  Rng rng(47);
  constexpr double kStep = 1e-4;
  for (int trial = 0; trial < 100; ++trial) {
    const RandomBlock c = random_block(rng, BlockLaw::kJoint);
    const MotionBounds bounds = motion_bounds(c.motion());
    for (int k = 1; k < 40; ++k) {
      const double s = k / 40.0;
      const ToolPose low = pose_at(c.motion(), s - kStep), mid = pose_at(c.motion(), s),
                     high = pose_at(c.motion(), s + kStep);
      const Vec3 p1 = (high.tip_W - low.tip_W) / (2 * kStep), a1 = (high.axis_W - low.axis_W) / (2 * kStep);
      const Vec3 p2 = (high.tip_W - 2 * mid.tip_W + low.tip_W) / (kStep * kStep);
      const Vec3 a2 = (high.axis_W - 2 * mid.axis_W + low.axis_W) / (kStep * kStep);
      const double slack = 1e-4 * (1.0 + p2.norm());
      ASSERT_LE(p1.norm(), bounds.speed + slack) << c.text();
      ASSERT_LE(a1.norm(), bounds.turn_rate + 1e-5) << c.text();
      ASSERT_LE(mid.axis_W.cross(a2).norm(), bounds.turn_acceleration + 1e-5) << c.text();
      ASSERT_LE((2.0 * mid.axis_W.cross(a1).cross(p1) - p2).norm(), bounds.bend + slack) << c.text();
    }
  }
}

TEST(BlockMotion, TranslationsNeedOneSweepAndHaveNoError) {
  for (const BlockLaw law : {BlockLaw::kTcp, BlockLaw::kEnds}) {
    RandomBlock c;
    c.machine = paper_machine();
    c.block = {{{0, 0, 0}, Vec3::UnitZ()},
               {{100, 20, -3}, Vec3::UnitZ()},
               {},
               law,
               10.0,
               0.0,
               0.0,
               false,
               0.0,
               {},
               0,
               0};
    EXPECT_EQ(split_error(motion_bounds(c.motion()), 1, 60.0), 0.0);
    EXPECT_EQ(subdivide(c.motion(), 60.0, 1e-9).size(), 2U);
  }
  RandomBlock c;
  c.machine = paper_machine();
  c.block.law = BlockLaw::kJoint;
  c.q_from << 1, 2, 3, 0.4, 0.5;
  c.q_to << 11, -2, 7, 0.4, 0.5;
  c.block.from = kinematics::forward(c.machine, c.q_from);
  c.block.to = kinematics::forward(c.machine, c.q_to);
  EXPECT_EQ(subdivide(c.motion(), 60.0, 1e-9).size(), 2U);
}

TEST(BlockMotion, ArcsAreCutWithTheSagittaOfTheirPieces) {
  // Half a circle of radius 10: pieces of angle phi have sagitta 10 (1 - cos(phi/2)) = 10 phi^2/8.
  RandomBlock c;
  c.machine = paper_machine();
  c.block = {{{10, 0, 0}, Vec3::UnitZ()},
             {{-10, 0, 0}, Vec3::UnitZ()},
             program::Arc{},
             BlockLaw::kTcp,
             10,
             0,
             0,
             false,
             0,
             {},
             0,
             0};
  EXPECT_NEAR(toolpath::arc_angle(c.block), kPi, 1e-12);
  EXPECT_NEAR(toolpath::tip_way(c.block), 10 * kPi, 1e-12);
  const std::vector<ToolPose> poses = subdivide(c.motion(), 60.0, 1e-3);
  const double phi = kPi / static_cast<double>(poses.size() - 1);
  EXPECT_LE(10 * (1 - std::cos(0.5 * phi)), 1e-3);
  EXPECT_GT(10 * (1 - std::cos(0.5 * phi)), 0.9e-3);
  for (const ToolPose& pose : poses) EXPECT_NEAR(pose.tip_W.norm(), 10.0, 1e-12);
  EXPECT_GT(poses[1].tip_W.y(), 0.0) << "counter-clockwise about the normal";
}

TEST(BlockMotion, EndsLawMovesEveryGuidePointOnAStraightLine) {
  Rng rng(5);
  for (int trial = 0; trial < 50; ++trial) {
    const RandomBlock c = random_block(rng, BlockLaw::kEnds);
    const double height = rng.uniform(5, 60), s = rng.uniform();
    // The line between the guide points' linear means is the tool's axis.
    const auto guide = [&](const ToolPose& p) -> Vec3 { return p.tip_W + height * p.axis_W; };
    const Vec3 top = guide(c.block.from) + s * (guide(c.block.to) - guide(c.block.from));
    const ToolPose pose = pose_at(c.motion(), s);
    EXPECT_LT((top - pose.tip_W).normalized().cross(pose.axis_W).norm(), 1e-12) << c.text();
  }
}

TEST(BlockMotions, FollowTheBranchNearestToTheValuesBefore) {
  // A whole turn of the table in blocks of 15 degrees: the rotary axis alone moves, and it moves on.
  const MachineModel machine = paper_machine();
  toolpath::ToolPath path;
  const auto pose = [&](int i) {
    AxisValues q;
    q << 30, 80, 100, 0.35, rad_from_deg(-15.0 * i);
    return kinematics::forward(machine, q);
  };
  for (int i = 0; i < 24; ++i) {
    BlockMove block;
    block.from = pose(i);
    block.to = pose(i + 1);
    block.law = BlockLaw::kJoint;
    block.feed_mm_s = 10;
    append(path, block, i + 1);
  }
  const BlockMotions motions = block_motions(path, machine);
  const AxisValues way = motions.back().q_to - motions.front().q_from;
  EXPECT_NEAR(way[4], -2 * kPi, 1e-9);
  EXPECT_LT(way.head<4>().norm(), 1e-7);
}

TEST(BlockMotions, JointLawRefusesWhatTheMachineCannotReach) {
  MachineModel machine = paper_machine();
  machine.axes.pop_back();  // without the rotary table the tool tilts about X only
  machine.table_chain.pop_back();
  toolpath::ToolPath path;
  BlockMove block;
  block.to = {{10, 0, 0}, Vec3(1, 0, 1).normalized()};
  block.law = BlockLaw::kJoint;
  append(path, block, 7);
  try {
    block_motions(path, machine);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics.list().front().code, "unreachable");
    EXPECT_EQ(error.diagnostics.list().front().where.line, 7);
  }
}

}  // namespace
}  // namespace swarf::motion::block_motion_test
