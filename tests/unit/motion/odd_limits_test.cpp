// Valid programs that strain look-ahead: passing a pole closely, axis limits a thousand times apart, corner
// tolerances of nothing. None stops at an internal check, and no axis exceeds its limits.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "motion/blocks/block_curve.h"
#include "motion/judged/motion_check.h"
#include "unit/kinematics/test_machines.h"
#include "unit/motion/random_program.h"

namespace swarf::motion::odd_limits_test {
namespace {

using kinematics::AxisKind;
using kinematics::AxisValues;
using kinematics::MachineModel;
using toolpath::BlockLaw;
using toolpath::BlockMove;

void append(toolpath::ToolPath& path, const MachineModel& machine, BlockLaw law, const AxisValues& from,
            const AxisValues& to, double feed_mm_s, double tolerance_mm = 0.0) {
  BlockMove block;
  block.law = law;
  block.axes = toolpath::AxisSpan{from, to};
  const size_t before = path.elements.size();
  block.from = before > 0 ? path.elements.block(before - 1).to : kinematics::forward(machine, from);
  block.to = kinematics::forward(machine, to);
  block.feed_mm_s = feed_mm_s;
  block.corner_tolerance_mm = tolerance_mm;
  path.elements.push_back({block, 0, {"odd.cl", static_cast<int>(before) + 1, 1}});
}

size_t blocks_not_followed(const toolpath::ToolPath& path, const MachineModel& machine) {
  const kinematics::InverseKinematics inverse(machine);
  const BlockMotions motions = block_motions(path, machine);
  size_t count = 0;
  for (size_t i = 0; i < motions.size(); ++i)
    count += BlockCurve(motions[i], inverse, 50.0).followed() ? 0 : 1;
  return count;
}

/// Cycles so long that the rounding of axis values beside a pole, 1e-16 over the distance, does not show in
/// third differences.
Interpolated run(const toolpath::ToolPath& path, const MachineModel& machine, double period_s = 0.01) {
  MotionOptions options;
  options.period_s = period_s;
  Progress silent;
  return interpolate(path, machine, cutter::Cutter{}, options, silent);
}

/// Found by chance: the table turns by half a turn within 1e-4 of the first block, and steps of the block's
/// share that were a little off jumped over that. The end of the block lay 230 mm beside its last node, and
/// no corner there was sharp enough.
TEST(OddLimits, ABlockPastAPoleEndsWhereItsProgramSays) {
  MachineModel machine = kinematics::table_table_ac();
  const MachineModel paper = paper_machine();
  for (size_t i = 0; i < machine.axes.size(); ++i) {
    machine.axes[i].speed_max = paper.axes[i].speed_max;
    machine.axes[i].acceleration_max = paper.axes[i].acceleration_max;
    machine.axes[i].jerk_max = paper.axes[i].jerk_max;
  }
  AxisValues a, b, c;
  a << 0.3114830, 0.0, -195.201, 0.860385, -2.30008;
  b << 0.0729810, 3.1413149, -202.339, 0.829082, -2.28615;
  c << -0.5289256, 5.8578724, -209.202, 0.801458, -2.27386;
  toolpath::ToolPath path;
  append(path, machine, BlockLaw::kTcp, a, b, 100.0, 0.79);
  append(path, machine, BlockLaw::kTcpAxes, b, c, 100.0);
  ASSERT_EQ(blocks_not_followed(path, machine), 0U);
  const Interpolated result = run(path, machine);
  EXPECT_LE(axis_excess(result.trajectory, machine).relative, 0.0)
      << axis_excess(result.trajectory, machine).text;
  EXPECT_LT((result.trajectory.axes.back() - c).norm(), 1e-9);
}

/// A great circle that passes the pole at `distance` (rad), the tip 20 mm straight on.
toolpath::ToolPath past_the_pole(const MachineModel& machine, double distance) {
  const double tilt = 0.2;
  AxisValues from, to;
  from << 0.0, 0.0, 0.0, tilt, 0.0;
  to << 0.0, 0.0, 0.0, tilt, 2.0 * std::acos(std::tan(distance) / std::tan(tilt));
  BlockMove block;
  block.from = kinematics::forward(machine, from);
  block.to = kinematics::forward(machine, to);
  block.to.tip_W = block.from.tip_W + Vec3(20, 0, 0);
  to = kinematics::InverseKinematics(machine).continued(block.to, to).q;
  toolpath::ToolPath path;
  append(path, machine, BlockLaw::kTcp, from, to, 50.0);
  return path;
}

/// However close: down to where the tool passes within some nanometres of the pole (speed_clamps.h). The axes
/// turn by half a turn in each case, so that they all take about the same time.
TEST(OddLimits, PolesArePassedCloselyWithinTheLimitsInTheSameTime) {
  const MachineModel machine = paper_machine();
  double shortest = std::numeric_limits<double>::infinity(), longest = 0.0;
  for (double distance = 1e-3; distance > 5e-8; distance /= 3.0) {
    const toolpath::ToolPath path = past_the_pole(machine, distance);
    ASSERT_EQ(blocks_not_followed(path, machine), 0U) << distance << " rad";
    const Interpolated result = run(path, machine);
    EXPECT_LE(axis_excess(result.trajectory, machine).relative, 0.0)
        << distance << " rad: " << axis_excess(result.trajectory, machine).text;
    shortest = std::min(shortest, result.statistics.time_s);
    longest = std::max(longest, result.statistics.time_s);
  }
  EXPECT_LE(longest, 1.2 * shortest);
}

/// The axes turn little, all of it where the block begins or ends: .001 to 3 deg from the pole, while the
/// block goes on to where its tilt is up to 10 000 times as large.
TEST(OddLimits, BlocksThatBeginOrEndBesideAPoleKeepTheLimits) {
  const MachineModel machine = paper_machine();
  const kinematics::InverseKinematics inverse(machine);
  for (uint64_t seed = 0; seed < 96; ++seed) {
    Rng rng(seed);
    AxisValues from = AxisValues::Zero(), to = AxisValues::Zero();
    from[3] = std::pow(10.0, rng.uniform(-4.8, -1.3));
    to[3] = std::pow(10.0, rng.uniform(-1.5, -0.3));
    to[4] = rng.uniform(-0.4, 0.4);
    ToolPose end = kinematics::forward(machine, to);
    end.tip_W = kinematics::forward(machine, from).tip_W + rng.uniform(0.1, 5.0) * rng.direction();
    to = inverse.continued(end, to).q;
    if (seed % 3 == 2) std::swap(from, to);
    toolpath::ToolPath path;
    append(path, machine, BlockLaw::kTcp, from, to, 50.0);
    const Excess excess = axis_excess(run(path, machine, 1e-3).trajectory, machine);
    EXPECT_LE(excess.relative, 0.0) << "Rng rng(" << seed << "); " << excess.text;
  }
}

/// A machine, the indices of the axes that tilt the tool and turn beside the pole, and the tilt at the pole.
struct Named {
  MachineModel machine;
  Eigen::Index tilt, turn;
  double pole;
};

/// Limits that differ by up to a thousand from axis to axis, and from speed to acceleration to jerk.
void make_limits_odd(MachineModel& machine, Rng& rng) {
  const auto odd = [&](double middle) { return middle * std::pow(10.0, rng.uniform(-1.5, 1.5)); };
  for (kinematics::Axis& axis : machine.axes) {
    axis.speed_max = odd(axis.kind == AxisKind::kLinear ? 100.0 : 2.0);
    axis.acceleration_max = odd(10.0 * axis.speed_max);
    axis.jerk_max = odd(20.0 * axis.acceleration_max);
  }
}

/// Blocks of .1 to 20 mm; the axes turn by up to half a turn, a thousandth to half a radian beside the pole.
toolpath::ToolPath odd_program(const Named& on, Rng& rng) {
  const MachineModel& machine = on.machine;
  const kinematics::InverseKinematics inverse(machine);
  const double side = rng.uniform() < 0.5 ? -1.0 : 1.0;
  const auto tilted = [&] { return on.pole + side * std::pow(10.0, rng.uniform(-3.0, -0.3)); };
  AxisValues q = AxisValues::Zero();
  for (size_t i = 0; i < machine.axes.size(); ++i)
    if (machine.axes[i].kind == AxisKind::kLinear) q[static_cast<Eigen::Index>(i)] = rng.uniform(-30, 30);
  q[on.tilt] = tilted();
  q[on.turn] = rng.uniform(-3, 3);
  constexpr BlockLaw kLaws[] = {BlockLaw::kTcp, BlockLaw::kTcp, BlockLaw::kTcp, BlockLaw::kTcpAxes,
                                BlockLaw::kJoint};
  toolpath::ToolPath path;
  path.planner = "cl";
  for (int i = 0; i < 8; ++i) {
    AxisValues next = q;
    if (rng.uniform() < 0.6) {
      const double half_turn =
          std::copysign(kPi - std::pow(10.0, rng.uniform(-4.0, -1.0)), rng.uniform() - 0.5);
      next[on.tilt] = tilted();
      next[on.turn] += rng.uniform() < 0.5 ? rng.uniform(-2.5, 2.5) : half_turn;
    }
    ToolPose to = kinematics::forward(machine, next);
    const double way = std::exp(rng.uniform(std::log(0.1), std::log(20.0)));
    to.tip_W = kinematics::forward(machine, q).tip_W + way * rng.direction();
    const kinematics::Branch end = inverse.continued(to, next);
    if (end.outcome == kinematics::InverseOutcome::kUnreachable) continue;
    const double feed = std::exp(rng.uniform(std::log(5.0), std::log(300.0)));
    append(path, machine, kLaws[static_cast<size_t>(rng.uniform(0, 5)) % 5], q, end.q, feed,
           rng.uniform() < 0.3 ? std::pow(10.0, rng.uniform(-5.0, 0.0)) : 0.0);
    q = end.q;
  }
  return path;
}

/// SWARF_ODD_PROGRAMS=500 runs as many programs on each machine (default 6).
TEST(OddLimits, NoAxisLimitIsExceededOnAnyMachine) {
  const char* asked = std::getenv("SWARF_ODD_PROGRAMS");
  const int programs = asked != nullptr ? std::atoi(asked) : 6;
  double hours = 0.0;
  for (const Named& named :
       {Named{paper_machine(), 3, 4, 0.0}, Named{kinematics::table_table_ac(), 0, 1, 0.0},
        Named{kinematics::table_head_ba(), 4, 1, 0.5 * kPi}, Named{kinematics::head_head_ca(), 4, 3, 0.0},
        Named{kinematics::nutating_head(), 4, 0, 0.0}, Named{kinematics::lin_koren_machine(), 1, 2, 0.0}}) {
    int judged = 0;
    for (int seed = 0; seed < programs; ++seed) {
      Rng rng(static_cast<uint64_t>(seed));
      Named odd = named;
      make_limits_odd(odd.machine, rng);
      const toolpath::ToolPath path = odd_program(odd, rng);
      const Interpolated result = run(path, odd.machine);
      hours += result.statistics.time_s / 3600.0;
      // A great circle may end on another branch than the program's values: a jump that nothing can follow.
      if (blocks_not_followed(path, odd.machine) > 0) continue;
      ++judged;
      const Excess excess = axis_excess(result.trajectory, odd.machine);
      EXPECT_LE(excess.relative, 1e-9) << named.machine.name << ", Rng rng(" << seed << "); " << excess.text;
    }
    EXPECT_GE(3 * judged, programs) << named.machine.name;
  }
  fmt::print("{:.2f} h of motion\n", hours);
}

/// Limits so far apart that the share of a block past the pole changes its rate a hundredfold from step to
/// step: a spline through too few led back, and planning stopped.
TEST(OddLimits, AShareWhoseRateJumpsGoesOn) {
  Rng rng(171);
  Named odd{paper_machine(), 3, 4, 0.0};
  make_limits_odd(odd.machine, rng);
  const toolpath::ToolPath path = odd_program(odd, rng);
  ASSERT_EQ(blocks_not_followed(path, odd.machine), 0U);
  const Excess excess = axis_excess(run(path, odd.machine).trajectory, odd.machine);
  EXPECT_LE(excess.relative, 1e-9) << excess.text;
}

/// Nothing tells such corners from sharp ones: they are passed at rest.
TEST(OddLimits, CornersOfNoToleranceArePassedAtRest) {
  const MachineModel machine = paper_machine();
  AxisValues a, b, c;
  a << 0, 0, 0, 0.3, 0;
  b << 20, 0, 0, 0.3, 0;
  c << 20, 20, 0, 0.3, 0;
  double at_rest = 0.0;
  for (const double tolerance : {1e-300, 1e-14, 1e-9}) {
    toolpath::ToolPath path;
    append(path, machine, BlockLaw::kTcp, a, b, 50.0, tolerance);
    append(path, machine, BlockLaw::kTcp, b, c, 50.0, tolerance);
    const Interpolated result = run(path, machine);
    EXPECT_LE(axis_excess(result.trajectory, machine).relative, 0.0) << tolerance;
    if (at_rest == 0.0) at_rest = result.statistics.time_s;
    EXPECT_NEAR(result.statistics.time_s, at_rest, 0.02) << tolerance;
  }
}

}  // namespace
}  // namespace swarf::motion::odd_limits_test
