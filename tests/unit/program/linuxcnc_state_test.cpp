// Tool data of the program, M61, the modal state that M70 to M73 keep, inputs, parameters and messages.
#include <cmath>

#include "unit/program/nc_support.h"

namespace swarf::program::linuxcnc_state_test {
namespace {

TEST(LinuxCncTools, TheProgramWritesTheToolTable) {
  const NcRun run = linuxcnc(
      "T2 M6 G43\nG0 Z10\nG10 L1 P2 Z60 R6\nG0 Z11\nG43\nG0 Z10\nG20 G10 L1 P2 Z2\nG43 G21 G0 Z10\n"
      "G0 X0 Y-10\nG41 G1 Y20 F600\nG1 Y40\nG40 G1 X50 Y50\nM2\n");
  ASSERT_EQ(run.text(), "");
  EXPECT_NEAR(run.moves()[0].q_to[2], 60.0, 1e-12);  // 50 of the table
  EXPECT_NEAR(run.moves()[1].q_to[2], 61.0, 1e-12);  // written, and not read before G43
  EXPECT_NEAR(run.moves()[2].q_to[2], 70.0, 1e-12);
  EXPECT_NEAR(run.moves()[3].q_to[2], 60.8, 1e-12);  // 2 inches
  EXPECT_NEAR(run.moves()[5].q_to[0], -6.0, 1e-9);   // R6: a cutter of 12 mm, to the left of Y
  EXPECT_EQ(run.moves()[2].tool, 1);                 // the solid in the spindle stays what it is
}

TEST(LinuxCncTools, LengthsMeasuredWhereTheToolStands) {
  // G10 L10 Z4 at Z10 with 50 mm: 56 mm. L11: 60 - 20 - c = 2, whatever G92 says.
  const NcRun run = linuxcnc(
      "G10 L2 P9 Z20\nT2 M6 G43\nG0 Z10\nG10 L10 P2 Z4\nG43\nG0 X#<_z>\n"
      "G43.1 Z50\nG0 Z10\nG92 Z0\nG10 L11 P2 Z2\nG92.1\nG43\nG59.3\nG0 X#<_z>\nM2\n");
  ASSERT_EQ(run.text(), "");
  ASSERT_EQ(run.moves().size(), 3u);
  EXPECT_NEAR(run.moves()[1].q_to[0], 4.0, 1e-12);
  EXPECT_NEAR(run.moves()[2].q_to[0], 2.0, 1e-12);
}

TEST(LinuxCncTools, NumberZeroIsTheToolInTheSpindle) {
  const NcRun run = linuxcnc("T2 M6 G43 H0\nG0 Z10\nG43 H7\nG0 Z10\nG43.2 Z3\nG0 Z10\nG43 H0 G0 Z9\nM2\n");
  ASSERT_EQ(run.text(), "");
  const double expected[] = {60.0, 90.0, 93.0, 59.0};
  ASSERT_EQ(run.moves().size(), 4u);
  for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(run.moves()[i].q_to[2], expected[i], 1e-12) << i;
}

TEST(LinuxCncTools, ANumberForTheToolInTheSpindleMovesNothing) {
  ControlSetup setup = three_axis_setup();
  AxisValues change = AxisValues::Zero();
  change[2] = 250.0;
  setup.machine.tool_change = change;
  const NcRun run = linuxcnc("M61 Q2\nG43\nG0 X#5400 Z10\nM61 Q2\nG0 X9\nM2\n", setup);
  ASSERT_EQ(run.text(), "");
  ASSERT_EQ(run.moves().size(), 2u);
  expect_tip(run.moves()[0], 2, 0, 10);
  EXPECT_NEAR(run.moves()[0].q_to[2], 60.0, 1e-12);
  EXPECT_EQ(run.moves()[0].tool, 1);
}

/// Everything that a move shows of the modal state.
void expect_same(const std::vector<NcMove>& a, const std::vector<NcMove>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].q_to, b[i].q_to) << i;
    EXPECT_EQ(a[i].duration_s, b[i].duration_s) << i;
    EXPECT_EQ(a[i].spindle_rpm, b[i].spindle_rpm) << i;
    EXPECT_EQ(a[i].exact_stop, b[i].exact_stop) << i;
    EXPECT_EQ(a[i].corner_tolerance_mm, b[i].corner_tolerance_mm) << i;
    EXPECT_EQ(a[i].arc.has_value(), b[i].arc.has_value()) << i;
  }
}

const char* const kState =
    "G21 G90 G17 G94 G98 G64 P0.02 G91.1 G55 F200 S2500 M3 M8\nT2 M6 G43\nM3\nG0 Z20\n";
const char* const kChanges = "g20 g91 g18 g95 g99 g61.1 g90.1 g54\nf.2 s300 m4 m9 g49\n";
const char* const kUse =
    "G1 X10 Y0\nG3 X20 I5\nG81 X30 Y0 Z-3 R2\nG80\nG1 X[10*#<_flood>] Z[5*#<_absolute>]\nM2\n";

TEST(LinuxCncState, KeptAndBroughtBack) {
  const NcRun plain = linuxcnc(std::string(kState) + kUse);
  ASSERT_EQ(plain.text(), "");
  ASSERT_GE(plain.moves().size(), 7u);
  const NcRun kept = linuxcnc(std::string(kState) + "M70\n" + kChanges + "M72\n" + kUse);
  ASSERT_EQ(kept.text(), "");
  expect_same(kept.moves(), plain.moves());
  const NcRun in_sub =
      linuxcnc(std::string("o<x> sub\nM73\n") + kChanges + "o<x> endsub\n" + kState + "o<x> call\n" + kUse);
  ASSERT_EQ(in_sub.text(), "");
  expect_same(in_sub.moves(), plain.moves());
  const NcRun by_return =
      linuxcnc(std::string("o<x> sub\nM73\n") + kChanges +
               "o1 if [#1 EQ 0]\no<x> return\no1 endif\no<x> endsub\n" + kState + "o<x> call\n" + kUse);
  ASSERT_EQ(by_return.text(), "");
  expect_same(by_return.moves(), plain.moves());
  const NcRun by_number =
      linuxcnc(std::string(kState) + "M98 P9 L2\n" + kUse + "O9\nM73\n" + kChanges + "M99\n");
  ASSERT_EQ(by_number.text(), "");
  expect_same(by_number.moves(), plain.moves());
  // Without any of them the moves are others: the comparison can fail.
  const NcRun lost = linuxcnc(std::string(kState) + kChanges + "G1 X1\nM2\n");
  ASSERT_GE(lost.moves().size(), 2u) << lost.text();
  EXPECT_NE(lost.moves()[1].spindle_rpm, plain.moves()[1].spindle_rpm);
}

TEST(LinuxCncState, EachCallLevelKeepsItsOwn) {
  const NcRun run = linuxcnc(
      "o<inner> sub\nM70\nF900\nM72\nG1 X[#1+1]\nF900\no<inner> endsub\n"
      "F600\nM70\nF1200\no<inner> call [1]\nM72\nG1 X3\nM2\n");
  ASSERT_EQ(run.text(), "");
  ASSERT_EQ(run.moves().size(), 2u);
  EXPECT_DOUBLE_EQ(run.moves()[0].feed_mm_s, 20.0);  // 1200 came in, and M72 of the inner one brings it back
  EXPECT_DOUBLE_EQ(run.moves()[1].feed_mm_s, 10.0);
  // M71 forgets: the subprogram's F stays.
  const NcRun forgotten = linuxcnc("o1 sub\nM73\nF900\nM71\no1 endsub\nF600\no1 call\nG1 X3\nM2\n");
  ASSERT_EQ(forgotten.text(), "");
  EXPECT_DOUBLE_EQ(forgotten.moves()[0].feed_mm_s, 15.0);
  // No F before is no F after.
  EXPECT_EQ(linuxcnc("M70\nF900\nM72\nG1 X3\nM2\n").first_error(), "missing-feed 4:4");
  // The motion mode is not among what is kept.
  const NcRun mode = linuxcnc("G0 X1\nM70\nG1 F600\nM72\nX2\nM2\n");
  EXPECT_EQ(mode.first_error(), "missing-feed 5:1");
}

TEST(LinuxCncState, InputsAreUnknownAndTheirPathIsNot) {
  const NcRun run = linuxcnc("M66 E0 L0\nM66 P1 L3 Q5\nM62 P1\nM67 E2 Q1.5\nM68 E3 Q1\nG0 X1\nM2\n");
  ASSERT_EQ(run.text(), "");
  EXPECT_EQ(run.moves().size(), 1u);
  EXPECT_GE(run.summary.functions.size(), 5u);
  const NcRun switched = linuxcnc("G0 X1 Y1 Z1 A0 C0\nM68 E3 Q1\nM66 E0 L0\nM2\n", five_axis_setup());
  ASSERT_EQ(switched.diagnostics.list().size(), 1u);
  EXPECT_EQ(switched.diagnostics.list()[0].code, "output-may-switch-kinematics");
}

TEST(LinuxCncFlow, NumberedSubprogramsShareTheirParameters) {
  const NcRun run = linuxcnc(
      "O1\n#1 = 0\nM98 P100 L5\nG0 X#1\nM30\nO100\n#1 = [#1 + 1]\nM98 P200 L5\nM99\nO200\n#1 = [#1 + "
      "0.01]\nM99\n");
  ASSERT_EQ(run.text(), "");
  ASSERT_EQ(run.moves().size(), 1u);
  expect_tip(run.moves()[0], 5.25, 0, 0);  // the example of the reference
}

TEST(LinuxCncFlow, WhatACallLeaves) {
  const NcRun run = linuxcnc(
      "o1 sub\n#1=[#1+#3]\n#5=7\no1 endsub [#1]\no2 sub\nG0 Y[#<_value>+#<_value_returned>]\no2 endsub\n"
      "#1=1 #2=2\no1 call [10] [20]\nG0 X[#1+#2+#<_value>]\no2 call\nG0 Z#<_value_returned>\nM2\n");
  ASSERT_EQ(run.text(), "");
  ASSERT_EQ(run.moves().size(), 1u);  // the values are cleared before the second call
  expect_tip(run.moves()[0], 13, 0, 0);
}

TEST(LinuxCncParameters, EqualMeansWithinAMillionth) {
  const NcRun run = linuxcnc(
      "#1=0\no1 repeat [10]\n#1=[#1+0.1]\no1 endrepeat\n"
      "G0 X[#1 EQ 1] Y[#1 NE 1] Z[[#1 LT 1] + 2*[1 EQ 1.00001] + 4*[1 NE 1.0000001]]\nM2\n");
  ASSERT_EQ(run.text(), "");
  ASSERT_EQ(run.moves().size(), 1u);
  expect_tip(run.moves()[0], 1, 0, 1);  // ten tenths are less than one, and equal to it
}

TEST(LinuxCncParameters, WhatTheControlAnswers) {
  const NcRun run = linuxcnc(
      "G10 L2 P1 X100\nT2 M6 G43 G0 X5 Z1\n#31=#<_abs_x> #32=#<_tool_offset> #33=#<_task> #34=#5210\n"
      "G91 G10 L2 P1 X50\nG90 G0 X0\n#35=#5221 #36=#<_abs_x>\nG92 X3\n#37=#5210 #38=#5211\nG92.1\n"
      "G0 X#31 Y#32\nX#33 Y#34\nX#35 Y#36\nX#37 Y#38\nG41.1 D2\nG0 X#<_ccomp>\nG40 G0 X0\nM2\n");
  ASSERT_EQ(run.text(), "");
  const auto& moves = run.moves();
  ASSERT_GE(moves.size(), 6u);
  expect_tip(moves[2], 50 + 105, 1, 1);
  expect_tip(moves[3], 50 + 1, 0, 1);
  expect_tip(moves[4], 50 + 50, 50, 1);  // G91 does not add to G10 L2
  expect_tip(moves[5], 50 + 1, -3, 1);
  EXPECT_NEAR(moves[6].to.tip_W.x(), 50 + 411, 1e-9);
}

TEST(LinuxCncParameters, BlanksStandWhereTheyMay) {
  const NcRun run = linuxcnc(
      "N10.5 o<a b> SUB\n#<x y> = [ 2 ** 3 ]\nG0 X [ #<xy> ] Y- [ atan [ 1 ] / [ 1 ] ] Z[exists [#<X Y>] + "
      "4]\n"
      "/ o<ab> endsub\nn 20 O<AB> call\nG0 X#[#<_metric>+0]\nM2\n#1=2\n");
  ASSERT_EQ(run.diagnostics.list().size(), 1u) << run.text();
  EXPECT_EQ(run.diagnostics.list()[0].code, "undefined-parameter");
  EXPECT_EQ(run.diagnostics.list()[0].where.line, 6);
  ASSERT_EQ(run.moves().size(), 2u);
  expect_tip(run.moves()[0], 8, -45, 5);
  expect_tip(run.moves()[1], 0, -45, 5);
}

TEST(LinuxCncParameters, MessagesShowValues) {
  const NcRun run = linuxcnc(
      "#31=2.34567 #<depth of cut>=-1.5\n(MSG, as #31)\n(debug,a #31 b %d#31 c%.2f#<depthofcut>)\n"
      "(PRINT, %f #31 is #32 and #<none>)\nM2\n");
  ASSERT_EQ(run.text(), "");
  ASSERT_EQ(run.sink.notes.size(), 3u);
  EXPECT_EQ(run.sink.notes[0].text, " as #31");
  EXPECT_EQ(run.sink.notes[1].text, "a 2.345670 b 2 c-1.50");
  EXPECT_EQ(run.sink.notes[2].text, "  2.3457 is ###### and ######");
}

}  // namespace
}  // namespace swarf::program::linuxcnc_state_test
