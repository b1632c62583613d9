// The block of So et al., Table 2, under tcp: near the pole the time is that of the rotary table (theory 2).
#include <gtest/gtest.h>

#include <cmath>

#include "motion/blocks/block_run.h"
#include "motion/blocks/block_turns.h"
#include "motion/judged/motion_check.h"
#include "unit/motion/random_program.h"

namespace swarf::motion::so_limits_test {
namespace {

using toolpath::BlockLaw;
using toolpath::BlockMove;

/// m = Rx(-A)(Rz(-C) p + t) - t with t = (0, 49.93, -120); limits of assets/machines/mikron_ucp710.
kinematics::MachineModel mikron() {
  using kinematics::Axis;
  using kinematics::AxisKind;
  using kinematics::Side;
  const double deg = rad_from_deg(1.0);
  kinematics::MachineModel machine;
  machine.name = "MIKRON UCP 710";
  for (int i = 0; i < 3; ++i) {
    machine.axes.push_back({std::string(1, "XYZ"[i]), AxisKind::kLinear, Side::kHead, Vec3::Unit(i),
                            Vec3::Zero(), false, -500, 500, 20000.0 / 60.0, 5000, 80000});
  }
  machine.axes.push_back({"A", AxisKind::kRotary, Side::kTable, Vec3::UnitX(), Vec3(0, -49.93, 120), false,
                          -30 * deg, 120 * deg, 90 * deg, 500 * deg, 10000 * deg});
  machine.axes.push_back({"C", AxisKind::kRotary, Side::kTable, Vec3::UnitZ(), Vec3::Zero(), false,
                          -36000 * deg, 36000 * deg, 120 * deg, 800 * deg, 16000 * deg});
  // The branch of Table 2: the other one has an error of its own.
  machine.axes[3].home = 1 * deg;
  machine.axes[4].home = 149 * deg;
  machine.table_chain = {3, 4};
  machine.head_chain = {0, 1, 2};
  return machine;
}

toolpath::ToolPath table_2(BlockLaw law, double feed_mm_s) {
  BlockMove block;
  block.from = {{75.211, -51.4295, 228.6808},
                Vec3(0.009594399914, 0.015947899856, 0.999826790990).normalized()};
  block.to = {{74.513, -50.551, 228.6857}, Vec3(0.017539299772, 0.010768199860, 0.999788186985).normalized()};
  block.law = law;
  block.feed_mm_s = feed_mm_s;
  toolpath::ToolPath path;
  path.planner = "cl";
  path.elements.push_back({block, 0, {"so.cl", 1, 1}});
  return path;
}

/// Integral of |dC| over the block, rad, from the azimuth of the tool axis alone.
double swing() {
  const toolpath::ToolPath path = table_2(BlockLaw::kTcp, 1.0);
  const BlockMove block = path.elements.block(0);
  const Vec3 &a = block.from.axis_W, &b = block.to.axis_W;
  return std::abs(std::atan2(a.x() * b.y() - a.y() * b.x(), a.x() * b.x() + a.y() * b.y()));
}

TEST(SoLimits, TimeAtTheLimitOfCIsTheIntegralOfItsTurn) {
  // Acceleration and jerk that do not count leave the speed limits alone: the bound of theory 2 is met.
  kinematics::MachineModel machine = mikron();
  for (kinematics::Axis& axis : machine.axes) {
    axis.acceleration_max *= 1e4;
    axis.jerk_max *= 1e8;
  }
  MotionOptions options;
  options.period_s = 1e-4;
  options.path_acceleration_max = 1e8;
  options.path_jerk_max = 1e13;
  Progress silent;
  const Interpolated result =
      interpolate(table_2(BlockLaw::kTcp, 1000.0), machine, cutter::Cutter{}, options, silent);
  const double bound = swing() / machine.axes[4].speed_max;
  const double at_limit = result.statistics.axes[4].time_at_speed_limit_s;
  fmt::print(
      "swing {:.4f} deg, integral |dC| / limit {:.5f} s, at the limit {:.5f} s ({:+.2f} %), in all {:.5f} "
      "s\n",
      deg_from_rad(swing()), bound, at_limit, 100 * (at_limit / bound - 1), result.statistics.time_s);
  EXPECT_NEAR(at_limit, bound, 0.01 * bound);
  EXPECT_NEAR(result.statistics.time_s, bound, 0.01 * bound);
  EXPECT_GE(result.statistics.time_s, bound);
  EXPECT_EQ(check_motion(result.trajectory, machine), "");
  EXPECT_LE(axis_excess(result.trajectory, machine).relative, 1e-9);
}

TEST(SoLimits, WithItsRampsTheTimeIsThatOfCAlone) {
  // Rest to rest the table needs swing/V + V/A + A/J at least.
  const kinematics::MachineModel machine = mikron();
  const kinematics::Axis& c = machine.axes[4];
  MotionOptions options;
  options.period_s = 1e-4;
  options.path_acceleration_max = 1e8;
  options.path_jerk_max = 1e13;
  Progress silent;
  const Interpolated result =
      interpolate(table_2(BlockLaw::kTcp, 1000.0), machine, cutter::Cutter{}, options, silent);
  const double bound =
      swing() / c.speed_max + c.speed_max / c.acceleration_max + c.acceleration_max / c.jerk_max;
  fmt::print("rest to rest {:.4f} s, bound of C alone {:.4f} s ({:+.2f} %)\n", result.statistics.time_s,
             bound, 100 * (result.statistics.time_s / bound - 1));
  EXPECT_GE(result.statistics.time_s, bound * (1 - 1e-6));
  EXPECT_LE(result.statistics.time_s, 1.03 * bound);
  EXPECT_LE(axis_excess(result.trajectory, machine).relative, 1e-9);
}

TEST(SoLimits, TipErrorOfTheOtherModeIsThatOfTheory2) {
  const kinematics::MachineModel machine = mikron();
  for (const BlockLaw law : {BlockLaw::kTcp, BlockLaw::kJoint}) {
    const toolpath::ToolPath path = table_2(law, 5.0);
    const OtherMode other = other_mode(block_motions(path, machine));
    EXPECT_NEAR(other.tip_error_max_mm, 2.126416, 1e-6);
    EXPECT_NEAR(other.share, 0.5454, 1e-4);
    EXPECT_EQ(other.element, 0);
  }
}

TEST(SoLimits, FastRotaryMovesAndSwingsAreNamedWithTheirBlocks) {
  const kinematics::MachineModel machine = mikron();
  const toolpath::ToolPath path = table_2(BlockLaw::kTcp, 5.0);
  const BlockMotions motions = block_motions(path, machine);
  MotionOptions options;
  std::vector<MotionFinding> findings = find_fast_turns(path.elements, motions, options);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].code, "fast-rotary");
  EXPECT_EQ(findings[0].severity, Severity::kWarning);
  EXPECT_NE(findings[0].text.find("24.4 deg/mm"), std::string::npos) << findings[0].text;
  EXPECT_EQ(findings[0].where.line, 1);
  options.swing_rad = rad_from_deg(20.0);
  findings = find_fast_turns(path.elements, motions, options);
  ASSERT_EQ(findings.size(), 2U);
  EXPECT_EQ(findings[1].code, "swing");
  EXPECT_NE(findings[1].text.find("-27."), std::string::npos) << findings[1].text;
}

}  // namespace
}  // namespace swarf::motion::so_limits_test
