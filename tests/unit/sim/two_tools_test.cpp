// Two tools in one job: the machine of each, sweeps of each, and what must not cut.
#include <gtest/gtest.h>

#include <cmath>

#include "contact_run.h"
#include "motion/interpolator.h"
#include "sim/run/bad_cuts.h"
#include "sim/run/job_sweeps.h"
#include "sim/simulation.h"

namespace swarf::sim::two_tools_test {
namespace {

constexpr double kLong = 130.0, kShort = 90.0;  // gauge lengths, mm

cutter::Cutter tool(int number, double diameter, double gauge) {
  cutter::Cutter c;
  c.number = number;
  c.diameter_mm = c.shank_diameter_mm = diameter;
  c.gauge_length_mm = gauge;
  return c;
}

Job job_of(const std::string& text) {
  Job job;
  job.scene.kind = ProgramKind::kCl;
  job.scene.tools = {tool(1, 10.0, kLong), tool(5, 6.0, kShort)};
  job.machine.model = motion::paper_machine();
  job.machine.model.gauge_M = job.machine.model.tip_M + kShort * job.machine.model.tool_axis_M;
  Diagnostics diagnostics;
  job.cl = program::parse_cl(text, "test.cl", diagnostics);
  diagnostics.throw_if_errors();
  return job;
}

MeasuredPath moved(const Job& job) {
  Progress silent;
  return move_tool(job, silent);
}

const char* const kTwoTools =
    "LOADTL/1\nFEDRAT/3000\nGOTO/0,0,5\nGOTO/20,0,5\nLOADTL/5\nGOTO/40,0,5\nGOTO/60,0,5\n";

TEST(TwoTools, TheLongerToolLiftsTheHead) {
  const Job job = job_of(kTwoTools);
  const MeasuredPath path = moved(job);
  const std::vector<kinematics::MachineModel> machines = machines_by_tool(job);
  const motion::Trajectory t = motion::trajectory_of(*path.cycles);
  bool used[2] = {false, false};
  for (size_t k = 0; k < t.samples.size(); ++k) {
    const auto index = static_cast<size_t>(t.samples[k].tool);
    used[index] = true;
    const ToolPose back = kinematics::forward(machines[index], t.axes[k]);
    ASSERT_LT((back.tip_W - t.samples[k].pose.tip_W).norm(), 1e-9) << "sample " << k;
  }
  EXPECT_TRUE(used[0] && used[1]);
  // The tool axis is that of Z: all of the difference of length shows there.
  const auto& axes = job.machine.model.axes;
  for (size_t i = 0; i < axes.size(); ++i) {
    if (axes[i].name != "Z") continue;
    const auto z = static_cast<Eigen::Index>(i);
    EXPECT_NEAR(std::abs(t.axes.front()[z] - t.axes.back()[z]), kLong - kShort, 1e-9);
  }
}

TEST(TwoTools, SweepsKnowTheirToolAndNothingIsMergedAcrossAChange) {
  const Job job = job_of(kTwoTools);
  const MeasuredPath path = moved(job);
  const JobSweeps sweeps = stock_sweeps(job, *path.cycles);
  ASSERT_EQ(sweeps.sweeps.size(), 2U) << "one straight row of each tool";
  EXPECT_EQ(tool_of_blocks(sweeps), (std::vector<int>{0, 1}));
  EXPECT_DOUBLE_EQ(sweeps.sweeps[0].end.tip_W.x(), 20.0);
}

TEST(TwoTools, AProgramsToolThatTheSceneLacksIsNotFound) {
  const Job job = job_of("LOADTL/3\nFEDRAT/3000\nGOTO/0,0,5\nGOTO/20,0,5\n");
  EXPECT_EQ(cl_tools(job), std::vector<int>{-1});
}

/// A box below z = 0 and a path through it.
std::vector<BadCut> bad_cuts_of(const Job& job, const std::vector<toolpath::BlockMove>& blocks) {
  ContactRun run(job.scene.tools, {{-10, -10, -10}, {70, 10, 0}}, 0.5);
  for (const toolpath::BlockMove& block : blocks) {
    run.start(block.from);
    run.turn(block.to) = block;
  }
  run.cut();
  return run.bad_cuts();
}

toolpath::BlockMove move(const Vec3& from, const Vec3& to, double feed, double rpm) {
  toolpath::BlockMove block;
  block.from = {from, Vec3::UnitZ()};
  block.to = {to, Vec3::UnitZ()};
  block.feed_mm_s = feed;
  block.spindle_rpm = rpm;
  return block;
}

TEST(BadCuts, ARapidInMaterialIsFoundAndOneInTheGrooveIsNot) {
  const Job job = job_of(kTwoTools);
  const std::vector<BadCut> found =
      bad_cuts_of(job, {move({0, 0, -2}, {40, 0, -2}, 20, 3000), move({40, 0, -2}, {0, 0, -2}, 0, 3000),
                        move({0, 0, -2}, {0, 0, 20}, 0, 3000), move({0, 0, 20}, {60, 0, 20}, 0, 3000),
                        move({60, 0, 20}, {60, 0, -1.5}, 0, 3000)});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].kind, BadCutKind::kRapid);
  EXPECT_EQ(found[0].event.first.element, 4);
  EXPECT_NEAR(found[0].event.depth_mm, 1.5, 0.5);
}

TEST(BadCuts, TheSpindleMustTurnAndTheRightWayRound) {
  Job job = job_of(kTwoTools);
  const auto blocks = [](double rpm) {
    return std::vector<toolpath::BlockMove>{move({0, 0, -2}, {20, 0, -2}, 20, rpm),
                                            move({20, 0, -2}, {40, 0, -2}, 20, rpm),
                                            move({40, 0, -2}, {60, 0, -2}, 20, 3000)};
  };
  EXPECT_TRUE(bad_cuts_of(job, blocks(3000)).empty());
  const std::vector<BadCut> stands = bad_cuts_of(job, blocks(0));
  ASSERT_EQ(stands.size(), 1U) << "one finding for a row of moves";
  EXPECT_EQ(stands[0].kind, BadCutKind::kSpindleStands);
  const std::vector<BadCut> reversed = bad_cuts_of(job, blocks(-3000));
  ASSERT_EQ(reversed.size(), 1U);
  EXPECT_EQ(reversed[0].kind, BadCutKind::kSpindleReversed);
  job.scene.tools[0].left_hand = true;
  const std::vector<BadCut> left = bad_cuts_of(job, blocks(-3000));
  ASSERT_EQ(left.size(), 1U) << "M3 with a left-hand tool";
  EXPECT_EQ(left[0].event.first.element, 2);
}

TEST(BadCuts, NeighbouringRapidsAreOneEventOverTheWholeWay) {
  // The first rapid touches in its middle alone, the box lies between its ends; the second deepens its slot.
  const Job job = job_of(kTwoTools);
  const std::vector<BadCut> found =
      bad_cuts_of(job, {move({-40, 0, -4}, {100, 0, -4}, 0, 3000), move({100, 0, -4}, {40, 0, -6}, 0, 3000),
                        move({40, 0, -6}, {40, 0, 20}, 0, 3000)});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].event.part, "flutes");
  EXPECT_EQ(found[0].event.first.element, 0);
  EXPECT_EQ(found[0].event.last_element, 1);
  EXPECT_NEAR(found[0].event.depth_mm, 4.0, 0.5);
  EXPECT_NEAR(found[0].event.deepest_W.z(), -4.0, 0.5);
}

TEST(BadCuts, ARapidThatStartsInMaterialIsFound) {
  const Job job = job_of(kTwoTools);
  const std::vector<BadCut> found = bad_cuts_of(job, {move({30, 0, -7}, {30, 0, 20}, 0, 3000)});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].event.depth_mm, 7.0, 0.5);
}

TEST(BadCuts, AStoppedSpindleIsSeenBetweenCollinearBlocks) {
  const Job job = job_of(kTwoTools);
  const std::vector<BadCut> found =
      bad_cuts_of(job, {move({-30, 0, -2}, {10, 0, -2}, 20, 3000), move({10, 0, -2}, {20, 0, -2}, 20, 0),
                        move({20, 0, -2}, {100, 0, -2}, 20, 3000)});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].kind, BadCutKind::kSpindleStands);
  EXPECT_EQ(found[0].event.first.element, 1);
  EXPECT_EQ(found[0].event.last_element, 1);
  EXPECT_NEAR(found[0].event.depth_mm, 2.0, 0.5);
}

TEST(BadCuts, SurviveAStockFile) {
  const ContactEvent event{"flutes", 1, {17, 0.1}, 19, 1.0 / 3, {18, 0.2}, {1, 2, 1.0 / 7}};
  const std::vector<BadCut> cuts{{BadCutKind::kRapid, event}, {BadCutKind::kSpindleReversed, event}};
  std::vector<BadCut> back;
  ASSERT_TRUE(parse_bad_cuts(bad_cuts_text(cuts), back));
  ASSERT_EQ(back.size(), 2U);
  EXPECT_EQ(back[1].kind, cuts[1].kind);
  EXPECT_EQ(bad_cuts_text(back), bad_cuts_text(cuts));
  back.clear();
  EXPECT_TRUE(parse_bad_cuts("", back));
  EXPECT_FALSE(parse_bad_cuts("7 flutes 1 2 3 4 5 6 7 8 9 10 11;", back));
  EXPECT_FALSE(parse_bad_cuts("0 flutes 1 x;", back));
}

}  // namespace
}  // namespace swarf::sim::two_tools_test
