// Every machine of assets/machines: that it loads, and that the figures its comments state are true.
#include <gtest/gtest.h>

#include "base/rng.h"
#include "base/units.h"
#include "shipped_machines.h"

namespace swarf::machine::shipped_machines_test {
namespace {

using kinematics::AxisValues;
using kinematics::MachineModel;

/// Axis values in the file's units: mm and degrees.
AxisValues axis_values(const MachineModel& of, const std::vector<double>& written) {
  AxisValues q = AxisValues::Zero();
  for (size_t i = 0; i < of.axes.size(); ++i) {
    const bool rotary = of.axes[i].kind == kinematics::AxisKind::kRotary;
    q[static_cast<int>(i)] = rotary ? rad_from_deg(written[i]) : written[i];
  }
  return q;
}

TEST(ShippedMachines, AreThoseOfTheReferencePage) {
  EXPECT_EQ(shipped_machines(),
            (std::vector<std::string>{"fork_head", "head_table_bc", "lin_koren_xyzab", "maho_600c",
                                      "mikron_ucp710", "mill_3axis", "nutating_head", "spinner_u5_620"}));
}

/// Theory 2: m = Rx(-A)(Rz(-C) p + t) - t with t = (0, 49.93, -120), O = (sin A sin C, -sin A cos C, cos A).
TEST(MikronUcp710, TakesTheProgramsOfSoEtAl) {
  const MachineModel mikron = shipped_machine("mikron_ucp710");
  const Vec3 t(0.0, 49.93, -120.0);
  Rng rng(710);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p = 200.0 * rng.uniform() * rng.direction();
    const double a = rng.uniform(-0.5, 2.0), c = rng.uniform(-30.0, 30.0);
    const Vec3 m = Eigen::AngleAxisd(-a, Vec3::UnitX()) * (Eigen::AngleAxisd(-c, Vec3::UnitZ()) * p + t) - t;
    AxisValues q;
    q << m.x(), m.y(), m.z(), a, c;
    const ToolPose back = forward(mikron, q);
    ASSERT_LT((back.tip_W - p).norm(), 1e-11) << p.transpose() << " A " << a << " C " << c;
    const Vec3 axis(std::sin(a) * std::sin(c), -std::sin(a) * std::cos(c), std::cos(a));
    ASSERT_LT((back.axis_W - axis).norm(), 1e-14);
  }
  EXPECT_GE(mikron.axes[4].max, rad_from_deg(3600.0));
  EXPECT_LE(mikron.axes[4].min, rad_from_deg(-3600.0));
  EXPECT_FALSE(mikron.gauge_M);
}

/// The production programs: SUPA G0 Z610 X-365 Y224 B0 C0 before each tool; G0 B90 C90 goes with
/// AROT X-90, AROT Z90, whose plane has its normal along +Y.
TEST(SpinnerU5620, HasTheHomeAndTheSensesOfItsPrograms) {
  const MachineModel spinner = shipped_machine("spinner_u5_620");
  const AxisValues home = axis_values(spinner, {-365.0, 224.0, 610.0, 0.0, 0.0});
  for (int i = 0; i < 5; ++i) EXPECT_EQ(spinner.axes[static_cast<size_t>(i)].home, home[i]);
  ASSERT_TRUE(spinner.tool_change);
  EXPECT_EQ(*spinner.tool_change, home);
  const struct {
    double b, c;
    Vec3 axis;
  } lines[] = {{90, 0, {1, 0, 0}},
               {90, 90, {0, 1, 0}},
               {90, 180, {-1, 0, 0}},
               {90, 270, {0, -1, 0}},
               {90, -135, Vec3(-1, -1, 0).normalized()}};
  for (const auto& line : lines) {
    const AxisValues q = axis_values(spinner, {0.0, 0.0, 300.0, line.b, line.c});
    EXPECT_LT((forward(spinner, q).axis_W - line.axis).norm(), 1e-15) << "B" << line.b << " C" << line.c;
  }
}

/// The gauge line stands where the axis values say, and the tip is lower by the tool.
TEST(GaugeLine, TheTipIsLowerByTheToolOnEveryMachineThatHasOne) {
  int with_gauge = 0;
  for (const std::string& name : shipped_machines()) {
    const MachineModel bare = shipped_machine(name);
    AxisValues home = AxisValues::Zero();
    for (size_t i = 0; i < bare.axes.size(); ++i) home[static_cast<int>(i)] = bare.axes[i].home;
    const ToolPose at = forward(bare, home), with = forward(kinematics::with_tool(bare, 123.5), home);
    const double lower = bare.gauge_M ? 123.5 : 0.0;
    EXPECT_LT((at.tip_W - lower * at.axis_W - with.tip_W).norm(), 1e-12) << name;
    with_gauge += bare.gauge_M ? 1 : 0;
  }
  EXPECT_EQ(with_gauge, 6);
}

TEST(RapidMoves, AreReadWithTheirSpeeds) {
  const MachineModel maho = shipped_machine("maho_600c");
  EXPECT_EQ(maho.rapid, kinematics::RapidMotion::kDogLeg);
  EXPECT_DOUBLE_EQ(maho.axes[0].rapid_max, 10000.0 / 60.0);
  EXPECT_DOUBLE_EQ(maho.axes[3].rapid_max, rad_from_deg(36.0));
  EXPECT_EQ(maho.axes[4].name, "C");
  ASSERT_TRUE(maho.tool_change);
  EXPECT_EQ(*maho.tool_change, axis_values(maho, {300.0, 250.0, 550.0, 0.0, 0.0}));
  const MachineModel paper = shipped_machine("lin_koren_xyzab");
  EXPECT_EQ(paper.rapid, kinematics::RapidMotion::kLinear);
  EXPECT_EQ(paper.axes[0].rapid_max, 0.0);
  EXPECT_FALSE(paper.tool_change);
}

}  // namespace
}  // namespace swarf::machine::shipped_machines_test
