// How near look-ahead comes to the fastest there is: against a direct transcription (time_optimum.h) on the
// same rounded path, under the same limits of axes, tip and feed, none of them split into shares. That
// searches from a first law; what it finds is held between a time that is proven not to be beaten and the
// best of all laws by dynamic programming (least_time.h).
#include <gtest/gtest.h>

#include "motion/judged/motion_check.h"
#include "motion/speed/jerk_profile.h"
#include "unit/motion/least_time.h"
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

/// Feed blocks through the stations.
toolpath::ToolPath path_of(const Case& one, const kinematics::MachineModel& machine) {
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
  return path;
}

MotionOptions options_of_the_cases() {
  MotionOptions options;
  options.path_acceleration_max = 1000.0;
  options.path_jerk_max = 20000.0;
  options.corner_tolerance_mm = 0.05;
  return options;
}

struct Times {
  double planned = 0.0, optimum = 0.0;      ///< s
  double not_beaten = 0.0, best_law = 0.0;  ///< of LeastTime, where they are asked for
};
enum class Oracles { kOne, kAll };
Times times_of(const Case& one, Oracles oracles = Oracles::kOne) {
  const kinematics::MachineModel machine = paper_machine();
  const kinematics::InverseKinematics inverse(machine);
  const MotionOptions options = options_of_the_cases();
  const toolpath::ToolPath path = path_of(one, machine);
  const BlockMotions motions = block_motions(path, machine);
  RunPlace start;
  start.end = motions.size();
  RunPlanner planner(motions, start, inverse, options);
  const PlannedRun& run = planner.next();
  Times times{duration(run.phases), TimeOptimum(run, machine, options).time()};
  if (oracles == Oracles::kAll) {
    LeastTime least(run, machine, options);
    times.not_beaten = least.without_jerk();
    times.best_law = least.with_jerk();
  }
  fmt::print("{}: {:.4f} s, optimum {:.4f} s, {:+.2f} %, not beaten {:.4f} s, best law {:.4f} s\n", one.name,
             times.planned, times.optimum, 100.0 * (times.planned / times.optimum - 1.0), times.not_beaten,
             times.best_law);
  EXPECT_GE(times.planned, 0.99 * times.optimum) << one.name << ": the optimum is not one";
  EXPECT_GE(times.planned, times.not_beaten) << one.name;
  return times;
}

/// The optimum lies above what nothing beats, and no law is better. The grid of dynamic programming costs up
/// to 6 %, and it may gain a little where it interpolates.
void expect_confirmed(const Times& times, const char* name) {
  EXPECT_GE(times.optimum, 0.995 * times.not_beaten) << name;
  EXPECT_GE(times.best_law, 0.99 * times.optimum) << name << ": a better law";
  EXPECT_LE(times.best_law, 1.06 * times.optimum) << name;
}

/// No axis exceeds its limits, by differences of the sampled values.
void expect_axis_limits(const Case& one) {
  const kinematics::MachineModel machine = paper_machine();
  Progress silent;
  const Interpolated result =
      interpolate(path_of(one, machine), machine, cutter::Cutter{}, options_of_the_cases(), silent);
  const Excess excess = axis_excess(result.trajectory, machine);
  EXPECT_LE(excess.relative, 1e-9) << one.name << ": " << excess.text;
}

TEST(LeastTime, IsThatOfClosedFormsOnAStraightWay) {
  const kinematics::MachineModel machine = paper_machine();
  const kinematics::InverseKinematics inverse(machine);
  const MotionOptions options = options_of_the_cases();
  const double way = 20.0, feed = 30.0, a = options.path_acceleration_max;
  const Case one{"straight", {values(0, 0, 0, 0.3, 0), values(way, 0, 0, 0.3, 0)}, {feed}};
  const toolpath::ToolPath path = path_of(one, machine);
  const BlockMotions motions = block_motions(path, machine);
  RunPlace start;
  start.end = motions.size();
  RunPlanner planner(motions, start, inverse, options);
  LeastTime least(planner.next(), machine, options);
  const double closed = RestToRest(way, feed, a, options.path_jerk_max).duration();
  const double trapezoid = way / feed + feed / a;
  EXPECT_GE(least.without_jerk(), 0.998 * trapezoid);
  EXPECT_LE(least.without_jerk(), closed);
  EXPECT_GE(least.with_jerk(), 0.99 * closed);
  EXPECT_LE(least.with_jerk(), 1.02 * closed);
}

TEST(LookAhead, TimeIsWithinThreePercentOfTheOptimum) {
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
    const Times times = times_of(one);
    EXPECT_LE(times.planned, 1.03 * times.optimum) << one.name;
    if (one.stations.size() > 2 || one.stations[0].tail<2>() != one.stations[1].tail<2>()) continue;
    const double way = (one.stations[1] - one.stations[0]).norm();
    const MotionOptions options = options_of_the_cases();
    const double closed =
        RestToRest(way, 30.0, options.path_acceleration_max, options.path_jerk_max).duration();
    EXPECT_NEAR(times.optimum, closed, 0.003 * closed) << one.name << ": the optimum misses its closed form";
  }
}

/// Short blocks whose rotary axes turn far beside the pole, so that a few cells leave a hundredth of the
/// acceleration that those beside them leave.
TEST(LookAhead, PastAPoleTimeIsWithinTenPercentOfTheOptimum) {
  for (const Case& one : {
           Case{"two blocks past the pole",
                {values(0, 0, 0, 0.02, 0), values(2, 1, 0, 0.03, 1.9), values(4, 1, 0, 0.05, 2.2)},
                {200, 200},
                BlockLaw::kTcp},
           Case{"towards and past the pole",
                {values(0, 0, 0, 0.06, 0), values(2, 0.5, 0, 0.02, 0.1), values(3, 1, 0, 0.03, 1.9)},
                {200, 200},
                BlockLaw::kTcp},
           Case{"a corner at the pole",
                {values(0, 0, 0, 0.05, 0), values(1, 0, 0, 0.01, 0.8), values(1, 1.5, 0, 0.04, 1.6)},
                {60, 60},
                BlockLaw::kTcp},
           Case{"a way that turns back",
                {values(8, 96, 120, 0.02, 0), values(9, 96, 120, 0.025, 1.0), values(9, 97, 120, 0.03, 0.4)},
                {60, 60},
                BlockLaw::kTcp},
           Case{"a straight way after the pole",
                {values(0, 0, 0, 0.02, 0), values(2, 1, 0, 0.03, 1.9), values(6, 3, 0, 0.03, 1.9)},
                {200, 200},
                BlockLaw::kTcp},
       }) {
    const Times times = times_of(one, Oracles::kAll);
    expect_confirmed(times, one.name);
    EXPECT_LE(times.planned, 1.1 * times.optimum) << one.name;
    expect_axis_limits(one);
  }
}

/// Two blocks of .5 to 4 mm whose second rotary axis turns by up to two radians .3 to 3.4 deg from the pole.
Case pair_beside_the_pole(uint64_t seed) {
  Rng rng(seed);
  AxisValues q = AxisValues::Zero();
  for (const int i : {0, 1}) q[i] = rng.uniform(-5, 5);
  q[3] = rng.uniform(0.005, 0.06);
  Case pair{"random pair", {q}, {}, BlockLaw::kTcp};
  for (int block = 0; block < 2; ++block) {
    const Vec3 direction = rng.direction();
    const double length = rng.uniform(0.5, 4);
    q[0] += length * direction[0];
    q[1] += length * direction[1];
    q[3] = rng.uniform(0.005, 0.06);
    q[4] += 2.0 * rng.uniform(-1, 1);
    pair.stations.push_back(q);
  }
  pair.feeds.assign(2, rng.uniform(30, 200));
  return pair;
}

/// A part has one acceleration and one jerk, and blocks that turn evenly are not parted: 3 of the first 40
/// pairs are above 10 %, the worst by 21 %; of the first 140 15 are, the worst by 39 %, where a corner longer
/// than half of its blocks is passed evenly.
TEST(LookAhead, RandomPairsPastAPoleAreMostlyWithinTenPercentOfTheOptimum) {
  int above = 0;
  for (uint64_t seed = 0; seed < 8; ++seed) {
    const Times times = times_of(pair_beside_the_pole(seed), Oracles::kAll);
    expect_confirmed(times, "random pair");
    above += times.planned > 1.1 * times.optimum ? 1 : 0;
    EXPECT_LE(times.planned, 1.25 * times.optimum) << "seed " << seed;
  }
  EXPECT_LE(above, 1);
  for (uint64_t seed = 0; seed < 40; ++seed) expect_axis_limits(pair_beside_the_pole(seed));
}

}  // namespace
}  // namespace swarf::motion::look_ahead_optimum_test
