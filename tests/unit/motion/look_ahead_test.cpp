// Stops, dwells, corners, dog-legs, branches and cycle times along blocks.
#include <gtest/gtest.h>

#include <functional>

#include <cmath>

#include "base/units.h"
#include "motion/blocks/block_run.h"
#include "motion/blocks/dog_leg.h"
#include "motion/judged/motion_check.h"
#include "motion/speed/jerk_profile.h"
#include "unit/motion/random_program.h"

namespace swarf::motion::look_ahead_test {
namespace {

using kinematics::AxisValues;
using kinematics::MachineModel;
using toolpath::BlockLaw;
using toolpath::BlockMove;

AxisValues values(double x, double y, double z, double a, double b) {
  AxisValues q;
  q << x, y, z, a, b;
  return q;
}

/// Blocks between stations of axis values, all alike.
toolpath::ToolPath path_through(const MachineModel& machine, const std::vector<AxisValues>& stations,
                                BlockLaw law, double feed_mm_s) {
  toolpath::ToolPath path;
  path.planner = "cl";
  for (size_t i = 0; i + 1 < stations.size(); ++i) {
    BlockMove block;
    block.law = law;
    block.feed_mm_s = feed_mm_s;
    block.axes = toolpath::AxisSpan{stations[i], stations[i + 1]};
    block.from = kinematics::forward(machine, stations[i]);
    block.to = kinematics::forward(machine, stations[i + 1]);
    path.elements.push_back({block, 0, {"test.nc", static_cast<int>(i) + 1, 1}});
  }
  return path;
}

/// Changes one block of a path.
void edit(toolpath::ToolPath& path, size_t i, const std::function<void(BlockMove&)>& change) {
  std::vector<toolpath::Element> elements(path.elements.begin(), path.elements.end());
  change(std::get<BlockMove>(elements[i].what));
  path.elements = toolpath::Elements(elements);
}

Interpolated run(const toolpath::ToolPath& path, const MachineModel& machine,
                 const MotionOptions& options = {}) {
  Progress silent;
  return interpolate(path, machine, cutter::Cutter{}, options, silent);
}

/// Speed of the tip in the middle of the corner after an element, mm/s.
double speed_at_corner(const Interpolated& result, int element) {
  const auto& samples = result.trajectory.samples;
  for (size_t k = 1; k < samples.size(); ++k) {
    if (samples[k].element > element)
      return (samples[k].pose.tip_W - samples[k - 1].pose.tip_W).norm() / result.trajectory.period_s;
  }
  return -1.0;
}

const std::vector<AxisValues> kCorner{values(0, 0, 0, 0.3, 0), values(20, 0, 0, 0.3, 0),
                                      values(20, 20, 0, 0.3, 0)};

TEST(LookAhead, ExactStopComesToRestAndALargerToleranceIsFaster) {
  const MachineModel machine = paper_machine();
  toolpath::ToolPath path = path_through(machine, kCorner, BlockLaw::kTcp, 50.0);
  const double by_default = speed_at_corner(run(path, machine), 0);
  edit(path, 0, [](BlockMove& block) { block.corner_tolerance_mm = 0.2; });
  const Interpolated wide = run(path, machine);
  EXPECT_GT(by_default, 2.0);
  EXPECT_GT(speed_at_corner(wide, 0), 2.0 * by_default);
  EXPECT_GT(wide.statistics.corner_deviation_max_mm, 0.15);
  EXPECT_LE(wide.statistics.corner_deviation_max_mm, 0.2);
  EXPECT_GE(wide.statistics.corner_element, 0);
  edit(path, 0, [](BlockMove& block) { block.exact_stop = true; });
  const Interpolated stopped = run(path, machine);
  EXPECT_LT(speed_at_corner(stopped, 0), 0.1);
  EXPECT_EQ(stopped.statistics.corner_deviation_max_mm, 0.0);
}

TEST(LookAhead, ReversalInPlaceIsRounded) {
  const MachineModel machine = paper_machine();
  const toolpath::ToolPath path =
      path_through(machine, {values(0, 0, 0, 0.3, 0), values(20, 0, 0, 0.3, 0), values(0, 0, 0, 0.3, 0)},
                   BlockLaw::kTcp, 50.0);
  const Interpolated result = run(path, machine);
  EXPECT_LE(axis_excess(result.trajectory, machine).relative, 1e-9);
  EXPECT_LE(result.statistics.corner_deviation_max_mm, 0.01);
}

TEST(LookAhead, DwellsAndTimesByKindAndTool) {
  const MachineModel machine = paper_machine();
  toolpath::ToolPath path = path_through(machine, kCorner, BlockLaw::kJoint, 50.0);
  edit(path, 1, [](BlockMove& block) { block.dwell_s = 0.25; });
  edit(path, 1, [](BlockMove& block) { block.tool = 2; });
  edit(path, 0, [](BlockMove& block) { block.feed_mm_s = 0.0; });
  const Interpolated result = run(path, machine);
  const CycleTime& cycle = result.statistics.cycle;
  EXPECT_NEAR(cycle.dwell_s, 0.25, 1e-9);
  // The cycle in which the tool changes is of no kind.
  EXPECT_NEAR(cycle.feed_s + cycle.rapid_s + cycle.dwell_s,
              result.statistics.time_s - result.trajectory.period_s, 1e-9);
  ASSERT_EQ(cycle.by_tool_s.size(), 3U);
  EXPECT_NEAR(cycle.by_tool_s[0], cycle.rapid_s, 1e-9);
  EXPECT_EQ(cycle.by_tool_s[1], 0.0);
  EXPECT_NEAR(cycle.by_tool_s[2], cycle.feed_s + cycle.dwell_s, 1e-9);
  const MotionOptions options;
  EXPECT_NEAR(cycle.feed_s,
              RestToRest(20, 50, options.path_acceleration_max, options.path_jerk_max).duration(), 2e-3);
  EXPECT_NEAR(cycle.rapid_s, RestToRest(20, 500, 5000, 1e5).duration(), 2e-3);
}

TEST(LookAhead, DurationOfABlockReplacesItsFeed) {
  const MachineModel machine = paper_machine();
  toolpath::ToolPath path =
      path_through(machine, {values(0, 0, 0, 0.3, 0), values(100, 0, 0, 0.3, 0)}, BlockLaw::kTcp, 500.0);
  edit(path, 0, [](BlockMove& block) { block.duration_s = 5.0; });
  const Interpolated result = run(path, machine);
  EXPECT_NEAR(result.statistics.time_s, RestToRest(100, 20, 2000, 5e4).duration(), 2e-3);
}

TEST(LookAhead, TurnsOfTheProgramAreFollowed) {
  // Two whole turns of the table and a bit, in one block of each law that can say so.
  const MachineModel machine = paper_machine();
  for (const BlockLaw law : {BlockLaw::kJoint, BlockLaw::kTcpAxes}) {
    const AxisValues from = values(10, 20, 30, 0.4, 0.1), to = values(12, 20, 30, 0.5, 0.1 + 5.0 * kPi);
    const Interpolated result = run(path_through(machine, {from, to}, law, 20.0), machine);
    EXPECT_EQ(check_motion(result.trajectory, machine), "") << law_name(law);
    EXPECT_LT((result.trajectory.axes.front() - from).norm(), 1e-12);
    EXPECT_LT((result.trajectory.axes.back() - to).norm(), 1e-9);
    EXPECT_NEAR(result.statistics.axes[4].travel, 5.0 * kPi, 1e-9);
    EXPECT_LE(axis_excess(result.trajectory, machine).relative, 1e-9) << law_name(law);
    ASSERT_FALSE(result.findings.empty());
    EXPECT_EQ(result.findings.back().code, "swing");
    EXPECT_NE(result.findings.back().text.find("+900"), std::string::npos);
  }
}

TEST(LookAhead, WarningsHaveTheTimeOfTheirBlock) {
  const MachineModel machine = paper_machine();
  const AxisValues from = values(0, 0, 0, 0.4, 0.1), there = values(100, 0, 0, 0.4, 0.1);
  const Interpolated result = run(
      path_through(machine, {from, there, values(100, 0, 0, 0.4, 0.1 + 1.5 * kPi)}, BlockLaw::kJoint, 20.0),
      machine);
  ASSERT_FALSE(result.findings.empty());
  const MotionFinding& swing = result.findings.back();
  EXPECT_EQ(swing.code, "swing");
  EXPECT_EQ(swing.element, 1);
  EXPECT_NEAR(swing.t_s, RestToRest(100, 20, 2000, 5e4).duration(), 2e-3);  // after the first block
}

TEST(LookAhead, TheBranchIsThatOfTheProgramEvenOutOfTravel) {
  MachineModel machine = paper_machine();
  machine.axes[3].max = 0.2;  // the program tilts further; the other branch would be within travel
  const Interpolated result =
      run(path_through(machine, {values(10, 20, 30, 0.4, 0.1), values(12, 20, 30, 0.5, 0.2)}, BlockLaw::kTcp,
                       20.0),
          machine);
  EXPECT_NEAR(result.statistics.axes[3].min, 0.4, 1e-9);
  EXPECT_NEAR(result.statistics.axes[3].max, 0.5, 1e-9);
  ASSERT_FALSE(result.findings.empty());
  EXPECT_EQ(result.findings[0].code, "travel");
}

TEST(LookAhead, WholeCircleHoldsItsFeedAndReturns) {
  const MachineModel machine = paper_machine();
  toolpath::ToolPath path =
      path_through(machine, {values(0, 0, 0, 0.3, 0), values(0, 0, 0, 0.3, 0)}, BlockLaw::kTcp, 40.0);
  edit(path, 0, [](BlockMove& block) {
    block.arc = program::Arc{block.from.tip_W + Vec3(25, 0, 0), Vec3::UnitZ()};
  });
  const Interpolated result = run(path, machine);
  EXPECT_EQ(check_motion(result.trajectory, machine), "");
  EXPECT_NEAR(result.statistics.path_length_mm, 50 * kPi, 1e-4);
  EXPECT_NEAR(result.statistics.time_s, RestToRest(50 * kPi, 40, 2000, 5e4).duration(), 0.02);
  EXPECT_LE(axis_excess(result.trajectory, machine).relative, 1e-9);
}

TEST(DogLeg, EachAxisArrivesByItself) {
  MachineModel machine = paper_machine();
  machine.rapid = kinematics::RapidMotion::kDogLeg;
  machine.axes[0].rapid_max = 300;
  machine.axes[1].rapid_max = 100;
  toolpath::ToolPath path =
      path_through(machine, {values(0, 0, 0, 0.3, 0), values(30, 40, 0, 0.3, 0)}, BlockLaw::kJoint, 0.0);
  edit(path, 0, [](BlockMove& block) { block.dwell_s = 0.1; });
  const toolpath::ToolPath legs = with_dog_legs(path, std::span(&machine, 1));
  ASSERT_EQ(legs.elements.size(), 2U);
  const BlockMove first = legs.elements.block(0);
  const BlockMove second = legs.elements.block(1);
  EXPECT_LT((first.axes->to - values(30, 10, 0, 0.3, 0)).norm(), 1e-9) << "X arrives after 0.1 s";
  EXPECT_EQ(second.axes->from, first.axes->to);
  EXPECT_EQ(second.to.tip_W, path.elements.block(0).to.tip_W);
  EXPECT_EQ(first.dwell_s, 0.1);
  EXPECT_EQ(second.dwell_s, 0.0);
  EXPECT_TRUE(second.exact_stop);
  const Interpolated result = run(legs, machine);
  EXPECT_LE(axis_excess(result.trajectory, machine).relative, 1e-9);
  EXPECT_GT(result.statistics.cycle.rapid_s, 0.4) << "40 mm of Y at 100 mm/s";
  EXPECT_LT(result.statistics.cycle.rapid_s, 0.6);
  machine.rapid = kinematics::RapidMotion::kLinear;
  EXPECT_EQ(with_dog_legs(path, std::span(&machine, 1)).elements.size(), 1U);
}

/// The run is refused for its time, and names the block of this line.
void expect_too_long(const toolpath::ToolPath& path, const MachineModel& machine, int line) {
  try {
    run(path, machine);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics.list().front().code, "too-many-cycles");
    EXPECT_EQ(error.diagnostics.list().front().where.line, line);
  }
}

TEST(LookAhead, TooLongAProgramIsRefusedBeforeItTakesTime) {
  const MachineModel machine = paper_machine();
  toolpath::ToolPath path = path_through(machine, kCorner, BlockLaw::kJoint, 50.0);
  edit(path, 1, [](BlockMove& block) { block.dwell_s = 1e9; });
  expect_too_long(path, machine, 2);
  // A corner of 1e-9 mm/s in the middle of a run.
  path = path_through(machine, kCorner, BlockLaw::kJoint, 50.0);
  edit(path, 1, [](BlockMove& block) { block.feed_mm_s = 1e-9; });
  expect_too_long(path, machine, 2);
  // 1200 mm at .2 um/s: 1667 hours.
  const toolpath::ToolPath slow =
      path_through(machine, {values(0, 0, 0, 0.3, 0), values(400, 0, 0, 0.3, 0), values(-400, 0, 0, 0.3, 0)},
                   BlockLaw::kJoint, 2e-4);
  EXPECT_THROW(run(slow, machine), InputError);
}

TEST(LookAhead, TcpAxesBoundsHoldTheDerivatives) {
  Rng rng(71);
  constexpr double kStep = 1e-4;
  const MachineModel machine = paper_machine();
  for (int trial = 0; trial < 100; ++trial) {
    const AxisValues from =
        values(rng.uniform(-50, 50), rng.uniform(-50, 50), 30, rng.uniform(-1, 1), rng.uniform(-3, 3));
    AxisValues to = from;
    for (int i = 0; i < 5; ++i) to[i] += i < 3 ? rng.uniform(-20, 20) : rng.uniform(-1.5, 1.5);
    toolpath::ToolPath path = path_through(machine, {from, to}, BlockLaw::kTcpAxes, 10.0);
    if (trial % 2 == 1) {
      edit(path, 0, [](BlockMove& block) {
        const Vec3 chord = block.to.tip_W - block.from.tip_W;
        const Vec3 normal = chord.unitOrthogonal();
        block.arc = program::Arc{block.from.tip_W + 0.5 * chord + normal.cross(chord), normal};
      });
    }
    const BlockMotions motions = block_motions(path, machine);
    const MotionBounds bounds = motion_bounds(motions[0]);
    for (int k = 1; k < 40; ++k) {
      const double s = k / 40.0;
      const ToolPose low = pose_at(motions[0], s - kStep), mid = pose_at(motions[0], s),
                     high = pose_at(motions[0], s + kStep);
      const Vec3 p1 = (high.tip_W - low.tip_W) / (2 * kStep), a1 = (high.axis_W - low.axis_W) / (2 * kStep);
      const Vec3 p2 = (high.tip_W - 2 * mid.tip_W + low.tip_W) / (kStep * kStep);
      const Vec3 a2 = (high.axis_W - 2 * mid.axis_W + low.axis_W) / (kStep * kStep);
      ASSERT_LE(p1.norm(), bounds.speed * (1 + 1e-6)) << trial;
      ASSERT_LE(a1.norm(), bounds.turn_rate + 1e-5) << trial;
      ASSERT_LE(mid.axis_W.cross(a2).norm(), bounds.turn_acceleration + 1e-4) << trial;
      ASSERT_LE((2.0 * mid.axis_W.cross(a1).cross(p1) - p2).norm(), bounds.bend * (1 + 1e-5) + 1e-3) << trial;
      // The rotary axes move evenly, the tip as under tcp.
      const AxisValues q = from + s * (to - from);
      ASSERT_LT((kinematics::forward(machine, q).axis_W - mid.axis_W).norm(), 1e-12);
    }
    // Not looser than it need be: the sum of both turns bounds the rate, the true rate is often far below.
    EXPECT_LE(bounds.turn_rate, (to - from).tail<2>().cwiseAbs().sum() * 1.05);
  }
}

}  // namespace
}  // namespace swarf::motion::look_ahead_test
