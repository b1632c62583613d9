// RS274/NGC programs with moves worked out by hand.
#include <cmath>

#include "support/scratch.h"
#include "unit/program/nc_support.h"

namespace swarf::program {
namespace {

TEST(NcLinuxCnc, StraightMovesHaveTimesAndFeeds) {
  const NcRun run = linuxcnc("G21 G90 G0 X10\nG1 X40 Y40 F600\nG91 X-10\nG20 X1\nG93 G90 X0 F4\nG94\nM2\n");
  ASSERT_EQ(run.text(), "");
  ASSERT_EQ(run.moves().size(), 5u);
  EXPECT_TRUE(run.moves()[0].rapid);
  EXPECT_EQ(run.moves()[0].duration_s, 0.0);
  expect_tip(run.moves()[1], 40, 40, 0);
  EXPECT_DOUBLE_EQ(run.moves()[1].duration_s, 5.0);  // 50 mm at 10 mm/s
  EXPECT_DOUBLE_EQ(run.moves()[1].feed_mm_s, 10.0);
  expect_tip(run.moves()[2], 30, 40, 0);
  expect_tip(run.moves()[3], 55.4, 40, 0);
  expect_tip(run.moves()[4], 0, 40, 0);
  EXPECT_EQ(run.moves()[4].duration_s, 15.0);  // G93 F4: a quarter of a minute, exactly
  EXPECT_EQ(run.moves()[4].feed_mm_s, 0.0);
  EXPECT_EQ(run.moves()[2].line, 3);
}

TEST(NcLinuxCnc, ArcsInAllPlanesByCentreAndRadius) {
  const NcRun run = linuxcnc(
      "G21 G17 F600\nG3 X20 Y0 I10 J0\nG2 X0 Y0 Z5 R10\nG18 G2 X10 Z15 I0 K10\nG19 G3 Y-10 Z25 R-10\n"
      "G17 G3 I-5 P3 Z28\nM2\n");
  ASSERT_EQ(run.text(), "");
  ASSERT_EQ(run.moves().size(), 7u);
  const NcMove& half = run.moves()[0];
  ASSERT_TRUE(half.arc);
  EXPECT_NEAR((half.arc->centre_W - Vec3(10, 0, 0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((half.arc->normal_W - Vec3(0, 0, 1)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(half.duration_s, kPi, 1e-12);  // 10 pi mm at 10 mm/s
  const NcMove& back = run.moves()[1];
  EXPECT_NEAR((back.arc->centre_W - Vec3(10, 0, 0)).norm(), 0.0, 1e-7);
  EXPECT_NEAR((back.arc->normal_W - Vec3(0, 0, -1)).norm(), 0.0, 1e-12);
  expect_tip(back, 0, 0, 5);
  EXPECT_NEAR(back.duration_s, std::hypot(10 * kPi, 5.0) / 10.0, 1e-9);
  const NcMove& zx = run.moves()[2];
  EXPECT_NEAR((zx.arc->centre_W - Vec3(0, 0, 15)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((zx.arc->normal_W - Vec3(0, -1, 0)).norm(), 0.0, 1e-12);
  // Counter-clockwise about X from (y 0, z 15) to (-10, 25), the longer way: of the two centres (-10, 15) and
  // (0, 25), the one to the left of the chord would give the shorter arc.
  const NcMove& yz = run.moves()[3];
  EXPECT_NEAR((yz.arc->centre_W - Vec3(10, 0, 25)).norm(), 0.0, 1e-9);
  for (size_t i = 4; i < 7; ++i) expect_tip(run.moves()[i], 10, -10, 25.0 + static_cast<double>(i - 3));
  double time = 0.0;
  for (size_t i = 4; i < 7; ++i) time += run.moves()[i].duration_s;
  EXPECT_NEAR(time, std::hypot(3 * 10 * kPi, 3.0) / 10.0, 1e-9);
}

TEST(NcLinuxCnc, ParametersExpressionsAndLoops) {
  const NcRun run = linuxcnc(
      "#1=3 #<_all>=[10 MOD 4]\n#<depth>=[2**3-#1]\n"
      "o100 sub\n  G0 X[#1*10] Y#<_all> Z[atan[1]/[1]]\no100 endsub\n"
      "o1 while [#1 GT 0]\n  o100 call [#1]\n  #1=[#1-1]\no1 endwhile\n"
      "o2 repeat [2]\n G91 G0 X1\no2 endrepeat\n"
      "G90\no3 if [#<depth> EQ 5]\nG0 Y[-sqrt[16]]\no3 elseif [1]\nG0 Y99\no3 else\nG0 Y98\no3 endif\n"
      "o4 do\n#1=[#1+1]\no5 if [#1 EQ 2]\no4 break\no5 endif\nG0 Z#1\no4 while [1]\nG0 Z50\nM2\n");
  ASSERT_EQ(run.text(), "");
  ASSERT_EQ(run.moves().size(), 8u);
  expect_tip(run.moves()[0], 30, 2, 45);
  expect_tip(run.moves()[1], 20, 2, 45);
  expect_tip(run.moves()[2], 10, 2, 45);
  expect_tip(run.moves()[3], 11, 2, 45);
  expect_tip(run.moves()[4], 12, 2, 45);
  expect_tip(run.moves()[5], 12, -4, 45);
  expect_tip(run.moves()[6], 12, -4, 1);
  expect_tip(run.moves()[7], 12, -4, 50);
}

TEST(NcLinuxCnc, NumberedSubprogramsRepeat) {
  const NcRun run = linuxcnc("G91\nM98 P100 L3\nM2\nO100\nG0 X2\nM99\n");
  ASSERT_EQ(run.text(), "");
  ASSERT_EQ(run.moves().size(), 3u);
  expect_tip(run.moves()[2], 6, 0, 0);
}

TEST(NcLinuxCnc, OffsetsShiftsAndTurns) {
  const NcRun run = linuxcnc(
      "G10 L2 P2 X100 Y50 Z-20\nG55 G0 X1 Y2 Z3\nG92 X0\nG0 X5\nG92.1\nG0 X7\nG54 G52 X10 Y10\nG0 X0 Y0 Z0\n"
      "G52 X0 Y0\nG10 L2 P1 R90\nG0 X10 Y0\nG53 G0 X-3\nG10 L20 P2 X1\nG55 G0 X2\nM2\n");
  ASSERT_EQ(run.text(), "");
  ASSERT_EQ(run.moves().size(), 7u);
  expect_tip(run.moves()[0], 101, 52, -17);
  expect_tip(run.moves()[1], 106, 52, -17);
  expect_tip(run.moves()[2], 107, 52, -17);
  expect_tip(run.moves()[3], 10, 10, 0);
  expect_tip(run.moves()[4], 0, 10, 0);
  expect_tip(run.moves()[5], -3, 10, 0);
  expect_tip(run.moves()[6], -2, 10, 0);
}

/// The machine stands at 30, 40. An offset turned by 90 degrees in which this reads 5, 7 lies at
/// 30 + 7, 40 - 5; where X alone is set, Y reads on as it did.
TEST(NcLinuxCnc, G10L20MakesTurnedOffsetsRead) {
  const NcRun both = linuxcnc(
      "G10 L2 P2 X0 Y0 R90\nG0 X30 Y40 Z0\nG10 L20 P2 X5 Y7\nG55 G0 X5 Y7\nG0 X6 Y7\nG0 X0 Y0\nM2\n");
  ASSERT_EQ(both.text(), "");
  ASSERT_EQ(both.moves().size(), 3u) << "where it stands is no move";
  expect_tip(both.moves()[1], 30, 41, 0);
  expect_tip(both.moves()[2], 37, 35, 0);
  const NcRun one =
      linuxcnc("G10 L2 P2 X0 Y0 R90\nG55 G0 X30 Y40 Z0\nG10 L20 P2 X5\nG0 X5 Y40\nG0 X0 Y0\nM2\n");
  ASSERT_EQ(one.text(), "");
  ASSERT_EQ(one.moves().size(), 2u);
  expect_tip(one.moves()[0], -40, 30, 0);
  expect_tip(one.moves()[1], 0, 25, 0);
  const NcRun shifted =
      linuxcnc("G10 L2 P1 R30\nG0 X30 Y40 Z0\nG92 X0\nG10 L20 P1 X1 Y2 Z3\nG0 X1 Y2 Z3\nM2\n");
  ASSERT_EQ(shifted.text(), "");
  EXPECT_EQ(shifted.moves().size(), 1u) << "it reads 1, 2, 3 where it stands";
}

TEST(NcLinuxCnc, PolarWordsCountFromTheZeroPoint) {
  const NcRun run = linuxcnc(
      "G10 L2 P1 X100\nG0 X0 Y0 Z5\nG1 @10 ^90 F100\n^180\n@20\nG91 ^90\n@5\nG90 G0 @[2*5] ^30 Z1\nG20 G0 @1 "
      "^0\nM2\n");
  EXPECT_EQ(run.first_error(), "words-conflict 9:8") << run.text();
  ASSERT_EQ(run.moves().size(), 7u);
  expect_tip(run.moves()[1], 100, 10, 5);
  expect_tip(run.moves()[2], 90, 0, 5);
  expect_tip(run.moves()[3], 80, 0, 5);
  expect_tip(run.moves()[4], 100, -20, 5);
  expect_tip(run.moves()[5], 100, -25, 5);
  expect_tip(run.moves()[6], 100 + 10 * std::cos(rad_from_deg(30)), 5, 1);
}

TEST(NcLinuxCnc, PolarWordsInInchesAndInArcs) {
  const NcRun run = linuxcnc("G20\nG0 @1 ^0 Z0\nG3 @1 ^90 I-1 J0 F10\nG0 ^180\nM2\n");
  ASSERT_EQ(run.text(), "");
  expect_tip(run.moves().at(1), 0, 25.4, 0);
  expect_tip(run.moves().at(2), -25.4, 0, 0);
}

TEST(NcLinuxCnc, PolarWordsThatSayNothingAreRefused) {
  EXPECT_EQ(linuxcnc("G21 G0 X0 Y0 Z0\nG1 @5 F100\nM2\n").first_error(), "bad-polar 2:4");
  EXPECT_EQ(linuxcnc("G21 G0 X0 Y0 Z0\nG91 G1 @5 ^30 F100\nM2\n").first_error(), "bad-polar 2:8");
  EXPECT_EQ(linuxcnc("G21 G1 @5 ^30 X4 F100\nM2\n").first_error(), "words-conflict 1:8");
  EXPECT_EQ(linuxcnc("G21 G1 @5 @4 F100\nM2\n").first_error(), "word-twice 1:11");
  EXPECT_EQ(run_text("G21 G1 @5 ^4 F100\nM30\n", Dialect::kFanuc, three_axis_setup()).first_error(),
            "unexpected-character 1:8");
}

/// The ends of an arc may differ by 0.02 root 2 mm from one radius, or by a thousandth of it.
TEST(NcLinuxCnc, ArcsEndWhereTheyAreWrittenWithinTheControlsTolerance) {
  for (const char* end : {"X10.028 Y0", "X9.972 Y0"}) {
    const NcRun run = linuxcnc(std::string("G21 G0 X-10 Y0 Z0\nG2 ") + end + " I10 J0 F100\nG1 Y-5\nM2\n");
    ASSERT_EQ(run.text(), "") << end;
    ASSERT_EQ(run.moves().size(), 3u);
    EXPECT_NEAR(run.moves()[1].to.tip_W.x(), std::stod(end + 1), 1e-9);
    EXPECT_NEAR(run.moves()[2].from.tip_W.x(), std::stod(end + 1), 1e-9);
  }
  EXPECT_EQ(linuxcnc("G21 G0 X-10 Y0 Z0\nG2 X10.029 Y0 I10 J0 F100\nM2\n").first_error(), "bad-arc 2:1");
  EXPECT_EQ(linuxcnc("G21 G0 X-100 Y0 Z0\nG2 X100.099 Y0 I100 J0 F100\nM2\n").text(), "");
}

TEST(NcLinuxCnc, ReferencePositionsAreKept) {
  ControlSetup setup = three_axis_setup();
  setup.machine.axes[0].home = 400.0;
  AxisValues change = AxisValues::Zero();
  change[2] = 250.0;
  setup.machine.tool_change = change;
  const NcRun run = linuxcnc(
      "G28 X0\nG30\nG0 X10 Y20 Z30\nG28.1\nG0 X1 Y2 Z3\nG30.1\nG0 X50 Y60 Z70\nG28\nG0 Z80\nG30 Z90\n"
      "G0 X#5161 Y#5182 Z[#5163+#5183]\nM2\n",
      setup);
  ASSERT_EQ(run.text(), "");
  std::vector<Vec3> tips;
  for (const NcMove& move : run.moves()) tips.push_back(move.to.tip_W);
  const std::vector<Vec3> expected = {{400, 0, 0},  {0, 0, 250},  {10, 20, 30}, {1, 2, 3},   {50, 60, 70},
                                      {10, 20, 30}, {10, 20, 80}, {10, 20, 90}, {10, 20, 3}, {10, 2, 33}};
  ASSERT_EQ(tips.size(), expected.size());
  for (size_t i = 0; i < tips.size(); ++i) EXPECT_NEAR((tips[i] - expected[i]).norm(), 0.0, 1e-9) << i;
}

TEST(NcLinuxCnc, ToolLengthsAddUp) {
  const NcRun run = linuxcnc("T2 M6 G43\nG43.2 H7\nG0 Z10\nM2\n");
  ASSERT_EQ(run.text(), "");
  EXPECT_NEAR(run.moves()[0].q_to[2], 10.0 + 50.0 + 80.0, 1e-12);
}

TEST(NcLinuxCnc, PredefinedNamesSayWhatHolds) {
  const NcRun run = linuxcnc(
      "G18 G91.1 G93 G99 S1000 M3\no9 sub\no9 return [17]\no9 endsub\n"
      "o1 if [#<_plane> EQ 180 AND #<_inverse_time> EQ 1 AND #<_units_per_minute> EQ 0]\nG0 X1\no1 endif\n"
      "o2 if [#<_ijk_incremental_mode> EQ 1 AND #<_retract_r_plane> EQ 1 AND #<_ccomp> EQ 400]\nG0 X2\no2 "
      "endif\n"
      "o3 if [EXISTS[#<_plane>] AND EXISTS[#<_x>] AND [EXISTS[#<_nothing>] EQ 0]]\nG0 X3\no3 endif\n"
      "o9 call\no4 if [#<_value> EQ 17 AND #<_value_returned> EQ 1 AND #<_spindle_cw> EQ 1]\nG0 X4\no4 "
      "endif\nM2\n");
  ASSERT_EQ(run.text(), "");
  ASSERT_EQ(run.moves().size(), 4u);
  for (size_t i = 0; i < 4; ++i) expect_tip(run.moves()[i], static_cast<double>(i + 1), 0, 0);
}

TEST(NcLinuxCnc, ToolLengthComesFromTheTable) {
  const NcRun run = linuxcnc("T2 M6\nG43 G0 Z10\nG49 G0 Z10\nT0 M6\nM2\n");
  ASSERT_EQ(run.text(), "");
  ASSERT_EQ(run.moves().size(), 2u);
  expect_tip(run.moves()[0], 0, 0, 10);
  EXPECT_NEAR(run.moves()[0].q_to[2], 60.0, 1e-12);
  expect_tip(run.moves()[1], 0, 0, -40);
  EXPECT_EQ(run.moves()[0].tool, 1);
  EXPECT_NEAR(run.moves()[0].from.tip_W.z(), -50.0, 1e-12);  // the tool hangs below the gauge line
}

TEST(NcLinuxCnc, DrillingCycles) {
  const NcRun run = linuxcnc(
      "G0 Z20\nG99 G83 X10 Y0 Z-10 R2 Q5 F300\nG98 X20\nG80\nG73 X30 Z-10 R2 Q7\nG82 X40 Z-3 R2 P0.5\n"
      "G91 G81 X5 Z-4 R-15 L2\nM2\n");  // from Z20: R is Z5
  ASSERT_EQ(run.text(), "");
  std::vector<double> heights;
  for (const NcMove& move : run.moves()) heights.push_back(move.to.tip_W.z());
  const std::vector<double> expected = {
      20, 20, 2,  -3,     2,      -2.746, -8, 2,      -7.746, -10, 2,  // G83, G99: 12 mm in pecks of 5
      20, 2,  -3, 2,      -2.746, -8,     2,  -7.746, -10,    20,      // second hole, G98: rises on the way
      20, 2,  -5, -4.746, -10,    20,                                  // G73
      20, 2,  -3, 20,                                                  // G82
      20, 5,  1,  20,     20,     5,      1,  20};                     // G91, twice
  ASSERT_EQ(heights.size(), expected.size());
  for (size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(heights[i], expected[i], 1e-9) << i;
  EXPECT_NEAR(run.moves()[30].dwell_s, 0.5, 0.0);  // on the way out of G82
  expect_tip(run.moves().back(), 50, 0, 20);
}

TEST(NcLinuxCnc, DwellExactStopAndCorners) {
  const NcRun run = linuxcnc("G64 P0.05 G1 X1 F100\nG4 P1.5\nG61 X2\nM3 S1000 X3\nG4 P2\nM2\n");
  ASSERT_EQ(run.text(), "");
  ASSERT_EQ(run.moves().size(), 4u);
  EXPECT_EQ(run.moves()[0].corner_tolerance_mm, 0.05);
  EXPECT_EQ(run.moves()[1].dwell_s, 1.5);
  EXPECT_TRUE(run.moves()[1].exact_stop);
  EXPECT_EQ(run.moves()[2].spindle_rpm, 1000.0);
  EXPECT_EQ(run.moves()[3].dwell_s, 2.0);  // a last wait is not lost
  EXPECT_EQ(run.moves()[3].to.tip_W, run.moves()[3].from.tip_W);
}

TEST(NcLinuxCnc, StartIsTheFirstCompletePosition) {
  ControlSetup setup = three_axis_setup();
  setup.start.reset();
  const NcRun run = linuxcnc("G0 Z50\nX10 Y20\nX30\nM2\n", setup);
  ASSERT_EQ(run.text(), "");
  ASSERT_EQ(run.moves().size(), 1u);
  EXPECT_NEAR((run.moves()[0].from.tip_W - Vec3(10, 20, 50)).norm(), 0.0, 1e-12);
  EXPECT_NE(run.summary.start.find("line 2"), std::string::npos) << run.summary.start;
  EXPECT_EQ(linuxcnc("G1 Z50 F100\nM2\n", setup).first_error(), "start-unknown 1:4");
  EXPECT_EQ(linuxcnc("G0 Z50\nM2\n", setup).first_error(), "no-start 1:1");
}

TEST(NcLinuxCnc, TcpKeepsTheTipOnItsLine) {
  ControlSetup setup = five_axis_setup();
  setup.kinematics_switch = {{}, Kinematics::kTcp, Kinematics::kIdentity, {}};
  const NcRun run = linuxcnc(
      "T2 M6 G43\nG0 X10 Y20 Z30 A0 C0\nM428\nG1 X20 Y20 Z30 A30 C40 F600\nG1 A0 C0\nM429\nG1 A10 F600\nM2\n",
      setup);
  ASSERT_EQ(run.text(), "");
  ASSERT_EQ(run.moves().size(), 4u);
  const NcMove& tcp = run.moves()[1];
  EXPECT_EQ(tcp.law, BlockLaw::kTcpAxes);
  expect_tip(tcp, 20, 20, 30);
  EXPECT_NEAR(tcp.feed_mm_s, 10.0, 1e-12);
  EXPECT_NEAR(tcp.duration_s, 1.0, 1e-12);
  expect_tip(run.moves()[2], 20, 20, 30);
  EXPECT_EQ(run.moves()[3].law, BlockLaw::kJoint);
  EXPECT_NEAR(run.moves()[3].duration_s, 1.0, 1e-9);  // 10 degrees at 600 degrees per minute
  for (const NcMove& move : run.moves()) {
    const ToolPose pose = kinematics::forward(kinematics::with_tool(setup.machine, 50.0), move.q_to);
    EXPECT_NEAR((pose.tip_W - move.to.tip_W).norm(), 0.0, 1e-9);
    EXPECT_NEAR((pose.axis_W - move.to.axis_W).norm(), 0.0, 1e-12);
  }
}

TEST(NcLinuxCnc, KinematicsSwitchesAreWhatTheMachineSays) {
  const auto law_after = [](const std::string& code, const KinematicsSwitch& told) {
    ControlSetup setup = five_axis_setup();
    setup.kinematics_switch = told;
    const NcRun run =
        linuxcnc("T2 M6 G43\nG0 X10 Y20 Z30 A0 C0\n" + code + "\nG1 X20 A30 C40 F600\nM2\n", setup);
    EXPECT_FALSE(run.diagnostics.has_errors()) << run.text();
    return run.moves().back().law;
  };
  constexpr auto kTcp = Kinematics::kTcp, kIdentity = Kinematics::kIdentity;
  // LinuxCNC's own machines: the kinematics of the machine, identity, userk (here a copy of identity).
  EXPECT_EQ(law_after("M428", {}), BlockLaw::kTcpAxes);
  EXPECT_EQ(law_after("M428\nM429", {}), BlockLaw::kJoint);
  EXPECT_EQ(law_after("M428\nM430", {{}, {}, {}, kIdentity}), BlockLaw::kJoint);
  EXPECT_EQ(law_after("M430", {{}, {}, {}, kTcp}), BlockLaw::kTcpAxes);
  // The nutating machines count from identity, and a bridge mill starts in its own kinematics.
  EXPECT_EQ(law_after("M429", {{}, kIdentity, kTcp, {}}), BlockLaw::kTcpAxes);
  EXPECT_EQ(law_after("M429\nM428", {{}, kIdentity, kTcp, {}}), BlockLaw::kJoint);
  EXPECT_EQ(law_after("", {kTcp, {}, {}, {}}), BlockLaw::kTcpAxes);
  EXPECT_EQ(law_after("", {}), BlockLaw::kJoint);
}

/// Without TCP the axes run on their circle while A and C turn evenly: chords, each end exactly there.
TEST(NcLinuxCnc, ArcsWithRotaryAxesAreChordsOfTheirCircle) {
  const ControlSetup setup = five_axis_setup();
  const NcRun run = linuxcnc(
      "G21 G90 G94 F600\nG0 X20 Y0 Z0 A10 C0\nG3 X20 I-20 Z8 A70 C-30 P2\nG93 G2 X-20 I-20 C60 F4\nM2\n",
      setup);
  ASSERT_EQ(run.text(), "");
  const auto axis = [&](const AxisValues& q, const char* name) {
    for (size_t i = 0; i < setup.machine.axes.size(); ++i) {
      if (setup.machine.axes[i].name == name) return q[static_cast<long>(i)];
    }
    return std::nan("");
  };
  double seconds = 0.0, timed = 0.0;
  AxisValues before = run.moves()[0].q_to;
  for (size_t i = 1; i < run.moves().size(); ++i) {
    SCOPED_TRACE(i);
    const NcMove& move = run.moves()[i];
    const AxisValues q = move.q_to, middle = 0.5 * (q + before);
    const double x = axis(q, "X"), y = axis(q, "Y");
    (move.line == 3 ? seconds : timed) += move.duration_s;
    EXPECT_EQ(move.law, BlockLaw::kJoint);
    EXPECT_NEAR(std::hypot(x, y), 20.0, 1e-9);
    EXPECT_GE(std::hypot(axis(middle, "X"), axis(middle, "Y")), 20.0 - 1.01e-4);
    if (move.line == 3) {
      const double share = (axis(q, "Z") - axis(run.moves()[0].q_to, "Z")) / 8.0;
      EXPECT_NEAR(std::remainder(4.0 * kPi * share - std::atan2(y, x), 2.0 * kPi), 0.0, 1e-9);
      EXPECT_NEAR(deg_from_rad(axis(q, "A")), 10.0 + 60.0 * share, 1e-9);
      EXPECT_NEAR(deg_from_rad(axis(q, "C")), -30.0 * share, 1e-9);
    }
    before = q;
  }
  EXPECT_NEAR(seconds, std::hypot(80.0 * kPi, 8.0) / 10.0, 1e-3);  // the chords are a little shorter
  EXPECT_NEAR(timed, 15.0, 1e-9);
  EXPECT_NEAR(deg_from_rad(axis(before, "C")), 60.0, 1e-9);
  EXPECT_NEAR(axis(before, "X"), -20.0, 1e-9);
}

TEST(NcLinuxCnc, WhatTheControlLeavesUnsaidIsTold) {
  const auto warning = [](const std::string& text) {
    const NcRun run = linuxcnc(text);
    return run.diagnostics.list().size() == 1 ? run.diagnostics.list()[0].code : run.text();
  };
  EXPECT_EQ(warning("G0 X1\n"), "missing-end");
  EXPECT_EQ(warning("%\nG0 X1\n"), "missing-end");
  EXPECT_EQ(warning("G0 Z5\nG81 X1 Z-1 R2 F100\nM2\n"), "retract-mode");
  EXPECT_EQ(warning("G20 F7\nG1 X1\nM2\n"), "feed-before-units");
  EXPECT_EQ(warning("G21 F7\nG1 X1\nM2\n"), "");
  EXPECT_EQ(warning("G93 G1 X1 F7 G20\nM2\n"), "");
}

TEST(NcLinuxCnc, KinematicsThatNobodyStatesAreToldOnce) {
  const ControlSetup setup = five_axis_setup();
  const NcRun run = linuxcnc("G0 X1 Y2 Z3 A0 C0\nM428\nM429\nM428\nM429\nM2\n", setup);
  ASSERT_EQ(run.diagnostics.list().size(), 2u) << run.text();
  for (const Diagnostic& one : run.diagnostics.list()) {
    EXPECT_EQ(one.severity, Severity::kNote);
    EXPECT_EQ(one.code, "kinematics-assumed");
  }
  EXPECT_NE(run.diagnostics.list()[0].text.find("M428 is taken as TCP"), std::string::npos);
  EXPECT_EQ(run.diagnostics.list()[1].where.line, 3);
}

TEST(NcLinuxCnc, SinkStopsTheProgram) {
  const auto setup = three_axis_setup();
  NcRun run;
  run.sink.stop_after = 2;
  const auto path = test::scratch_folder() / "swarf_nc_stop.ngc";
  std::ofstream(path) << "G0 X1\nX2\nX3\nM2\n";
  run.summary = run_nc(path.string(), Dialect::kLinuxCnc, setup, run.sink, run.diagnostics);
  EXPECT_EQ(run.moves().size(), 2u);
  EXPECT_FALSE(run.diagnostics.has_errors());
}

}  // namespace
}  // namespace swarf::program
