// Time along CL blocks: feed, start and stop, rapids, and what is measured of it.
#include "motion/blocks/block_run.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/units.h"
#include "motion/judged/motion_check.h"
#include "motion/speed/jerk_profile.h"
#include "toolpath/cl_path.h"
#include "unit/motion/dome.h"
#include "unit/motion/interpolated.h"

namespace swarf::motion::block_run_test {
namespace {

using toolpath::BlockLaw;

Interpolated run(const std::string& text, BlockLaw law) {
  Diagnostics diagnostics;
  const program::ClProgram program = program::parse_cl(text, "test.cl", diagnostics);
  const toolpath::ToolPath path = toolpath::cl_path(program, law, diagnostics);
  diagnostics.throw_if_errors();
  Progress silent;
  return interpolate(path, paper_machine(), cutter::Cutter{}, MotionOptions{}, silent);
}

double longest_tick(const Interpolated& result, SampleKind kind) {
  double longest = 0.0;
  for (size_t k = 1; k < result.trajectory.samples.size(); ++k) {
    const ToolSample& sample = result.trajectory.samples[k];
    if (sample.kind != kind) continue;
    longest = std::max(longest, (sample.pose.tip_W - result.trajectory.samples[k - 1].pose.tip_W).norm());
  }
  return longest;
}

TEST(BlockRun, KeepsItsFeedAlongItsBlocksAndItsToleranceAtCorners) {
  const Interpolated result =
      run("FEDRAT/3000\nGOTO/0,0,30\nGOTO/30,0,30\nGOTO/30,20,30\nGOTO/30,40,30\nGOTO/30,40,25\n",
          BlockLaw::kTcp);
  const Trajectory& trajectory = result.trajectory;
  EXPECT_EQ(check_motion(trajectory, paper_machine()), "");
  const MotionOptions options;
  EXPECT_LE(longest_tick(result, SampleKind::kCutting), 0.05 * (1 + 1e-9));
  EXPECT_EQ(trajectory.samples.front().pose.tip_W, Vec3(0, 0, 30));
  EXPECT_EQ(trajectory.samples.back().pose.tip_W, Vec3(30, 40, 25));
  EXPECT_EQ(trajectory.samples.back().element, 3);
  EXPECT_LE(result.statistics.corner_deviation_max_mm, options.corner_tolerance_mm);
  EXPECT_GE(result.statistics.corner_deviation_max_mm, 0.8 * options.corner_tolerance_mm);
  // Through the node between two blocks of one line the feed holds and the tip stays on the line.
  int through = 0;
  for (const ToolSample& s : trajectory.samples) {
    if (std::abs(s.pose.tip_W.y() - 20.0) > 5.0 || s.pose.tip_W.x() < 29.0) continue;
    ++through;
    EXPECT_NEAR(s.feed_mm_s, 50.0, 1e-4);
    EXPECT_NEAR(s.pose.tip_W.x(), 30.0, 1e-12);
  }
  EXPECT_GT(through, 190);
  // Two corners stop more or less; nothing else does.
  const RestToRest whole(75.0, 50.0, options.path_acceleration_max, options.path_jerk_max);
  EXPECT_GT(result.statistics.time_s, whole.duration());
  EXPECT_LT(result.statistics.time_s, whole.duration() + 2 * 0.08);
  EXPECT_LT(result.statistics.feed_error_max_rel, 1e-9);
  EXPECT_LT(result.statistics.chord_error_max_mm, 1e-12) << "straight blocks";
}

TEST(BlockRun, StartsFromRestAfterARapidAndRapidsObeyTheMachine) {
  for (const BlockLaw law : {BlockLaw::kTcp, BlockLaw::kJoint}) {
    const Interpolated result =
        run("MULTAX/ON\nFROM/0,0,60,0,0,1\nRAPID\nGOTO/40,10,30,0,0.173648178,0.984807753\nFEDRAT/600\n"
            "GOTO/45,10,30\nFEDRAT/1200\nGOTO/50,10,30,0,0.190808995,0.981627183\n",
            law);
    EXPECT_EQ(check_motion(result.trajectory, paper_machine()), "") << law_name(law);
    EXPECT_TRUE(result.findings.empty()) << result.findings.front().text;
    double slowest = 1e9;
    for (const ToolSample& s : result.trajectory.samples) {
      if (s.element == 1 && s.u < 0.01) slowest = std::min(slowest, s.feed_mm_s);
    }
    EXPECT_LT(slowest, 2.0) << law_name(law) << ": the feed starts from rest";
  }
}

TEST(BlockRun, JointBlocksMoveEveryAxisEvenly) {
  const Interpolated result =
      run("MULTAX/ON\nFEDRAT/1200\nGOTO/20,0,0,0,0.342020143,0.939692621\n"
          "GOTO/10,17,0,-0.296198133,0.171010072,0.939692621\n",
          BlockLaw::kJoint);
  const Trajectory& trajectory = result.trajectory;
  ASSERT_GT(trajectory.samples.size(), 100U);
  const kinematics::AxisValues from = trajectory.axes.front(), way = trajectory.axes.back() - from;
  for (size_t k = 0; k < trajectory.samples.size(); ++k) {
    EXPECT_LT((trajectory.axes[k] - from - trajectory.samples[k].u * way).norm(), 1e-9) << "sample " << k;
  }
}

TEST(BlockRun, ABlockThatOnlyTurnsTakesTheTimeOfItsAxis) {
  // 30 degrees of the tilt axis at 120 deg/s, whatever the feed says.
  const Interpolated result =
      run("MULTAX/ON\nFEDRAT/60000\nGOTO/0,0,0,0,0.5,0.866025404\nGOTO/0,0,0,0,0.866025404,0.5\n",
          BlockLaw::kTcp);
  EXPECT_GT(result.statistics.time_s, 0.25);
}

}  // namespace
}  // namespace swarf::motion::block_run_test
