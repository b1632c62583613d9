// What stands in the control before the first block and is not in the program: the tool in the spindle, the
// unit.
#include "unit/program/nc_support.h"

namespace swarf::program {
namespace {

std::string codes_of_run(const NcRun& run) {
  std::string codes;
  for (const Diagnostic& one : run.diagnostics.list()) codes += (codes.empty() ? "" : " ") + one.code;
  return codes;
}

/// One tool, which the program may leave uncalled.
ControlSetup one_tool_setup() {
  ControlSetup setup = three_axis_setup();
  setup.tools = {{1, "END8", 0.0, 8.0, 0.0}};
  setup.start_tool = 0;
  setup.start_tool_if_needed = true;
  return setup;
}

TEST(StartTool, TheOnlyToolIsInTheSpindleOfAProgramThatCallsNone) {
  const NcRun run = linuxcnc("G21 G90\nG0 X1 Y1 Z1\nG1 X5 F100\nM2\n", one_tool_setup());
  ASSERT_EQ(run.moves().size(), 2u);
  for (const NcMove& move : run.moves()) EXPECT_EQ(move.tool, 0) << "the rapid before the cut too";
  EXPECT_EQ(codes_of_run(run), "start-tool-assumed");
  EXPECT_EQ(
      run.summary.start_tool,
      "T1 is in the spindle from the start (the only tool there is; the program cuts before it calls one)");
}

TEST(StartTool, NoGuessWhereTheProgramCallsATool) {
  for (const char* text : {"G21 G90\nG0 X1 Y1 Z1\nT1 M6\nG1 X5 F100\nM2\n",
                           "o100 sub\nT1 M6\no100 endsub\nG21 G0 X1\no100 call\nG1 X5 F100\nM2\n"}) {
    const NcRun run = linuxcnc(text, one_tool_setup());
    EXPECT_EQ(run.text(), "");
    EXPECT_EQ(run.summary.start_tool, "");
    ASSERT_FALSE(run.moves().empty());
    EXPECT_EQ(run.moves().front().tool, -1) << "the spindle was empty: " << text;
    EXPECT_EQ(run.moves().back().tool, 0);
  }
  // T0 M6 empties the spindle, and what cuts then cuts with nothing.
  EXPECT_EQ(linuxcnc("G21 T1 M6\nT0 M6\nG1 X5 F100\nM2\n", one_tool_setup()).moves().back().tool, -1);
}

/// The radius is asked for before the first feed move.
TEST(StartTool, CompensatesAndMeasuresTheUncalledTool) {
  const NcRun run = linuxcnc("G21 G90 G17\nG0 X0 Y-20\nG41\nG1 X0 Y0 F100\nY50\nG40\nM2\n", one_tool_setup());
  EXPECT_EQ(run.first_error(), "") << run.text();
  expect_tip(run.moves().back(), -4.0, 50.0, 0.0);
  ControlSetup setup = one_tool_setup();
  setup.tools[0].length_mm = 60.0;
  const NcRun fanuc = run_text("%\nO1\nG21 G90\nG43 Z100.\nG01 X5. F100.\nM30\n%\n", Dialect::kFanuc, setup);
  EXPECT_EQ(fanuc.first_error(), "") << fanuc.text();
  EXPECT_NEAR(fanuc.moves().back().q_to[2], 160.0, 1e-12);
}

TEST(StartTool, WhatTheSceneSaysIsThereWithoutAWarning) {
  ControlSetup setup = three_axis_setup();
  setup.start_tool = 2;
  const NcRun run = linuxcnc("G21 G1 X5 F100\nT1 M6\nG1 X6\nM2\n", setup);
  EXPECT_EQ(codes_of_run(run), "length-not-compensated") << run.text();
  EXPECT_EQ(run.moves()[0].tool, 2);
  EXPECT_EQ(run.moves()[1].tool, 0);
  EXPECT_EQ(run.summary.start_tool, "T7 is in the spindle from the start (given as start_tool)");
}

/// Machines without a magazine: MD22550 = 0, T is the change.
TEST(StartTool, OfAnEightFortyDWithoutM6) {
  const ControlSetup setup = three_axis_setup();
  const NcRun run =
      run_text("G710 G90\nT=\"END8\"\nG0 X1 Y1 Z1\nG1 X5 F100\nT=\"DRILL6\" D1\nG1 X6 Z1\nM30\n",
               Dialect::kSiemens, setup);
  EXPECT_EQ(codes_of_run(run), "t-changes-tool") << run.text();
  ASSERT_EQ(run.moves().size(), 3u);
  EXPECT_EQ(run.moves()[0].tool, 0);
  EXPECT_EQ(run.moves()[2].tool, 2);
  EXPECT_NEAR(run.moves()[2].q_to[2], 81.0, 1e-12) << "D1 of the new tool holds";
  const NcRun with_m6 =
      run_text("G710 G90\nT1\nM6\nG0 X1 Y1 Z1\nG1 X5 F100\nM30\n", Dialect::kSiemens, setup);
  EXPECT_EQ(with_m6.text(), "");
}

TEST(StartTool, TChangesWhereTheSetupSaysSo) {
  ControlSetup setup = three_axis_setup();
  setup.t_changes_tool = true;
  for (const Dialect dialect : {Dialect::kLinuxCnc, Dialect::kFanuc}) {
    const NcRun run = run_text("G21 G90 T1\nG1 X5. F100.\nT2 M6\nG1 X6.\nM2\n", dialect, setup);
    EXPECT_EQ(run.first_error(), "") << run.text();
    EXPECT_EQ(run.moves()[0].tool, 0);
    EXPECT_EQ(run.moves()[1].tool, 1);
  }
}

ControlSetup without_unit() {
  ControlSetup setup = three_axis_setup();
  setup.unit_mm.reset();
  return setup;
}

TEST(StartUnit, IsTheMachinesWhereTheProgramIsSilent) {
  ControlSetup inches = three_axis_setup();
  inches.unit_mm = 25.4;
  for (const Dialect dialect : {Dialect::kLinuxCnc, Dialect::kFanuc, Dialect::kSiemens}) {
    const NcRun run = run_text("G90 G94 G0 X1. Y2. Z3.\nG1 X4. F10.\nM30\n", dialect, inches);
    EXPECT_EQ(run.text(), "");
    expect_tip(run.moves()[1], 101.6, 50.8, 76.2);
    EXPECT_NEAR(run.moves()[1].feed_mm_s, 254.0 / 60.0, 1e-12);
    const NcRun metric = run_text("G90 G94 G0 X1. Y2. Z3.\nG1 X4. F10.\nM30\n", dialect, three_axis_setup());
    EXPECT_EQ(metric.text(), "");
    expect_tip(metric.moves()[1], 4.0, 2.0, 3.0);
  }
}

TEST(StartUnit, MillimetresWithAWarningThatNamesTheFactor) {
  for (const Dialect dialect : {Dialect::kLinuxCnc, Dialect::kFanuc, Dialect::kSiemens}) {
    const NcRun run = run_text("G90 G94\nG0 X1. Y2. Z3.\nG1 X4. F10.\nM30\n", dialect, without_unit());
    expect_tip(run.moves()[1], 4.0, 2.0, 3.0);
    ASSERT_EQ(codes_of_run(run), "units-assumed");
    const Diagnostic& told = run.diagnostics.list()[0];
    EXPECT_EQ(told.where.line, 2);
    EXPECT_NE(told.text.find("25.4"), std::string::npos);
    EXPECT_NE(told.fix.find("--units"), std::string::npos);
  }
}

TEST(StartUnit, NoWarningWhereItIsSaidBeforeTheFirstWay) {
  EXPECT_EQ(linuxcnc("G20 G90\nG0 X1\nM2\n", without_unit()).text(), "");
  // G28 goes to a place of the machine, whatever the unit is.
  EXPECT_EQ(run_text("%\nO1\nG91 G28 Z0.\nG90 G21\nG0 X1.\nM30\n%\n", Dialect::kFanuc, without_unit()).text(),
            "");
  EXPECT_EQ(
      run_text("BEGIN PGM A MM\nL X+1 FMAX\nEND PGM A MM\n", Dialect::kHeidenhain, without_unit()).text(),
      "");
  // A state that is kept and brought back says no unit.
  EXPECT_EQ(codes_of_run(linuxcnc("G90 M70\nM72\nG0 X1\nM2\n", without_unit())), "units-assumed");
}

}  // namespace
}  // namespace swarf::program
