// How near look-ahead comes to the fastest there is: against a direct transcription (time_optimum.h) on the
// same rounded path, under the same limits of axes, tip and feed, none of them split into shares.
#include <gtest/gtest.h>

#include "motion/speed/jerk_profile.h"
#include "unit/motion/random_program.h"
#include "unit/motion/time_optimum.h"

namespace swarf::motion::look_ahead_optimum_test {
namespace {

using kinematics::AxisValues;
using toolpath::BlockLaw;
using toolpath::BlockMove;

struct Case {
  const char* name;
  std::vector<AxisValues> stations;
  std::vector<double> feeds;
  BlockLaw law = BlockLaw::kJoint;
};

AxisValues values(double x, double y, double z, double a, double b) {
  AxisValues q;
  q << x, y, z, a, b;
  return q;
}

TEST(LookAhead, TimeIsWithinThreePercentOfTheOptimum) {
  const kinematics::MachineModel machine = paper_machine();
  const kinematics::InverseKinematics inverse(machine);
  MotionOptions options;
  options.path_acceleration_max = 1000.0;
  options.path_jerk_max = 20000.0;
  options.corner_tolerance_mm = 0.05;
  const std::vector<Case> cases{
      {"straight", {values(0, 0, 0, 0.3, 0), values(20, 0, 0, 0.3, 0)}, {30}},
      {"short straight", {values(0, 0, 0, 0.3, 0), values(2, 0, 0, 0.3, 0)}, {30}},
      {"right angle",
       {values(0, 0, 0, 0.3, 0), values(10, 0, 0, 0.3, 0), values(10, 10, 0, 0.3, 0)},
       {30, 30}},
      {"gentle corners",
       {values(0, 0, 0, 0.3, 0), values(3, 0, 0, 0.3, 0), values(6, 0.2, 0, 0.3, 0),
        values(12, 1.2, 0, 0.3, 0)},
       {30, 30, 30}},
      {"feed step", {values(0, 0, 0, 0.3, 0), values(8, 0, 0, 0.3, 0), values(16, 0, 0, 0.3, 0)}, {10, 30}},
      {"zigzag",
       {values(0, 0, 0, 0.3, 0), values(5, 0, 0, 0.3, 0), values(8, 4, 0, 0.3, 0), values(12, 1, 0, 0.3, 0)},
       {30, 25, 30}},
      {"turning", {values(0, 0, 0, 0.3, 0), values(6, 0, 0, 0.4, 0.2)}, {30}},
      {"turning corner",
       {values(0, 0, 0, 0.3, 0), values(6, 2, 1, 0.35, 0.1), values(10, 8, 1, 0.5, 0.15)},
       {30, 20}},
      {"tip straight while turning",
       {values(0, 0, 0, 0.3, 0), values(6, 2, 1, 0.45, 0.3), values(10, 8, 1, 0.5, 0.15)},
       {60, 60},
       BlockLaw::kTcp},
      {"past the pole", {values(0, 0, 0, 0.02, 0), values(2, 1, 0, 0.03, 1.9)}, {200}, BlockLaw::kTcp},
      {"near the pole", {values(8, 96, 120, 0.02, 0), values(9, 96, 120, 0.025, 1.0)}, {60}, BlockLaw::kTcp},
  };
  for (const Case& one : cases) {
    toolpath::ToolPath path;
    for (size_t i = 0; i + 1 < one.stations.size(); ++i) {
      BlockMove block;
      block.law = one.law;
      block.axes = toolpath::AxisSpan{one.stations[i], one.stations[i + 1]};
      block.from = kinematics::forward(machine, one.stations[i]);
      block.to = kinematics::forward(machine, one.stations[i + 1]);
      block.feed_mm_s = one.feeds[i];
      path.elements.push_back({block, 0, {}});
    }
    const BlockMotions motions = block_motions(path, machine);
    RunPlace start;
    start.end = motions.size();
    RunPlanner planner(motions, start, inverse, options);
    const PlannedRun& run = planner.next();
    const double seconds = duration(run.phases);
    const double optimum = TimeOptimum(run, machine, options).time();
    fmt::print("{}: {:.4f} s, optimum {:.4f} s, {:+.2f} %\n", one.name, seconds, optimum,
               100.0 * (seconds / optimum - 1.0));
    EXPECT_LE(seconds, 1.03 * optimum) << one.name;
    EXPECT_GE(seconds, 0.99 * optimum) << one.name << ": the optimum is not one";
    if (one.stations.size() > 2 || one.stations[0].tail<2>() != one.stations[1].tail<2>()) continue;
    const double way = (one.stations[1] - one.stations[0]).norm();
    const double closed =
        RestToRest(way, 30.0, options.path_acceleration_max, options.path_jerk_max).duration();
    EXPECT_NEAR(optimum, closed, 0.003 * closed) << one.name << ": the optimum misses its closed form";
  }
}

}  // namespace
}  // namespace swarf::motion::look_ahead_optimum_test
