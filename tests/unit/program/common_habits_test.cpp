// Habits of posts and shops that one control or another allows: read as the control does, or said.
#include "unit/program/nc_support.h"

namespace swarf::program {
namespace {

NcRun fanuc_run(const std::string& text, const ControlSetup& setup = three_axis_setup()) {
  return run_text(text, Dialect::kFanuc, setup);
}

/// The head line of many posts. LinuxCNC itself refuses it; the warning says so.
TEST(CommonHabits, TheEndOfACycleBesideAMotion) {
  for (const char* line : {"G0 G17 G21 G40 G49 G80 G90 X1 Y2", "G80 G0 G17 G21 G40 G49 G90 X1 Y2"}) {
    const NcRun run = linuxcnc(std::string(line) + "\nX3\nM2\n");
    ASSERT_EQ(run.diagnostics.list().size(), 1u) << run.text();
    EXPECT_EQ(run.diagnostics.list()[0].code, "cycle-end-beside-motion");
    EXPECT_EQ(run.diagnostics.list()[0].severity, Severity::kWarning);
    ASSERT_EQ(run.moves().size(), 2u);
    EXPECT_TRUE(run.moves()[1].rapid);
    expect_tip(run.moves()[1], 3.0, 2.0, 0.0);
    EXPECT_EQ(fanuc_run("%\nO1\n" + std::string(line) + "\nX3.\nM30\n%\n").first_error(), "");
  }
  EXPECT_EQ(linuxcnc("G81 G80 X1 Z-1 R1\nM2\n").first_error(), "two-motion-words 1:5");
}

/// D and H are modal: T4 D04 M06 names the offset, a later G41 takes it.
TEST(CommonHabits, OffsetNumbersBesideTheToolChange) {
  const NcRun run = fanuc_run(
      "%\nO1\nG21 G90 G17\nT2 D02 M06\nG00 X0 Y-30.\nG41 G01 X0 Y0 F100.\nY50.\nG40 X-30.\nM30\n%\n");
  EXPECT_EQ(run.first_error(), "") << run.text();
  expect_tip(run.moves()[2], -5.0, 50.0, -50.0);  // T2: radius 5; its length is not compensated
  // Another tool's offset: that of D, not that of the tool in the spindle.
  const NcRun other = fanuc_run(
      "%\nO1\nG21 G90 G17\nT2 D07 M06\nG00 X0 Y-30.\nG41 G01 X0 Y0 F100.\nY50.\nG40 X-30.\nM30\n%\n");
  expect_tip(other.moves()[2], -3.0, 50.0, -50.0);
  const NcRun length = fanuc_run("%\nO1\nG21 G90\nT2 H02 M06\nG43 Z10.\nM30\n%\n");
  EXPECT_EQ(length.first_error(), "") << length.text();
  EXPECT_NEAR(length.moves().back().q_to[2], 60.0, 1e-12);
}

TEST(CommonHabits, AnotherOffsetWhileCompensatedIsRefused) {
  EXPECT_EQ(fanuc_run("%\nO1\nG21 G90 G17 T2 M06\nG00 X0 Y-30.\nG41 D2 G01 Y0 F100.\nY50. D7\nM30\n%\n")
                .first_error(),
            "unexpected-word 6:6");
  EXPECT_EQ(fanuc_run("%\nO1\nG21 G90 T2 M06\nG43 H2 Z10.\nX5. H7\nM30\n%\n").first_error(),
            "unexpected-word 5:5");
}

/// LinuxCNC looks for a subprogram behind its call too, and passes over comments between arguments.
TEST(CommonHabits, LinuxCncCallsBeforeTheDefinition) {
  const NcRun run = linuxcnc(
      "G21 G90\no<drill> call [3] (depth) [4]\nG0 X9\no<drill> sub\nG0 Z#1\nG0 X#2\no<drill> endsub\n"
      "o<drill> call [7] [8]\nM2\n");
  EXPECT_EQ(run.text(), "");
  ASSERT_EQ(run.moves().size(), 5u);
  expect_tip(run.moves()[0], 0.0, 0.0, 3.0);
  expect_tip(run.moves()[1], 4.0, 0.0, 3.0);
  expect_tip(run.moves()[2], 9.0, 0.0, 3.0);
  expect_tip(run.moves()[4], 8.0, 0.0, 7.0);
}

TEST(CommonHabits, LinuxCncCommentsBetweenArguments) {
  const NcRun run = linuxcnc(
      "G21 G90 G0 Z0\no<a> sub\nG0 X#1 Y#2 Z#3\no<a> endsub\no<a> call [1] (width) [2](height) [3] "
      "; end\nM2\n");
  EXPECT_EQ(run.text(), "");
  EXPECT_LT((run.moves().back().to.tip_W - Vec3(1, 2, 3)).norm(), 1e-12);
}

TEST(CommonHabits, LinuxCncParametersThatNobodyAssigned) {
  const NcRun run = linuxcnc("G21 G90 G0 X1\n#5599=0\n#101=3 G0 X#101\nG0 X[#5599+5]\nM2\n");
  ASSERT_EQ(run.diagnostics.list().size(), 1u) << run.text();
  EXPECT_EQ(run.diagnostics.list()[0].code, "undefined-parameter");
  EXPECT_EQ(run.diagnostics.list()[0].severity, Severity::kWarning);
  EXPECT_EQ(run.diagnostics.list()[0].where.line, 3);
  ASSERT_EQ(run.moves().size(), 3u);
  expect_tip(run.moves()[1], 0.0, 0.0, 0.0);  // assigned when the block has been read
  expect_tip(run.moves()[2], 5.0, 0.0, 0.0);
}

/// A program alone, to be checked: its path is that of the contour, and the warning says so.
TEST(CommonHabits, WithoutAToolTableEveryCutterHasRadiusZero) {
  ControlSetup setup = three_axis_setup();
  setup.tools.clear();
  const std::pair<Dialect, std::string> programs[] = {
      {Dialect::kLinuxCnc, "G21 G90 G17 T1 M6\nG0 X0 Y-20\nG41 G1 X0 Y0 F100\nY50\nG40 X-20\nM2\n"},
      {Dialect::kLinuxCnc, "G21 G90 G17\nG0 X0 Y-20\nG41 D3 G1 X0 Y0 F100\nY50\nG40 X-20\nM2\n"},
      {Dialect::kFanuc, "G21 G90 G17 T1 M6\nG0 X0 Y-20.\nG41 D1 G1 X0 Y0 F100.\nY50.\nG40 X-20.\nM30\n"},
      {Dialect::kSiemens, "G710 G90 G17 G94 T1\nM6\nG0 X0 Y-20\nG41 G1 X0 Y0 F100\nY50\nG40 X-20\nM30\n"},
      {Dialect::kHeidenhain,
       "BEGIN PGM A MM\nTOOL CALL 1 Z S100\nL X+0 Y-20 R0 FMAX\nL X+0 Y+0 RL F100\nL Y+50\nL X-20 R0\n"
       "END PGM A MM\n"}};
  for (const auto& [dialect, text] : programs) {
    const NcRun run = run_text(text, dialect, setup);
    EXPECT_EQ(run.first_error(), "") << run.text();
    ASSERT_FALSE(run.diagnostics.list().empty()) << text;
    EXPECT_EQ(run.diagnostics.list()[0].code, "no-tool-table");
    EXPECT_NE(run.diagnostics.list()[0].fix.find("--tools"), std::string::npos);
    ASSERT_EQ(run.moves().size(), 4u) << text;
    expect_tip(run.moves()[1], 0.0, 0.0, 0.0);
    expect_tip(run.moves()[2], 0.0, 50.0, 0.0);
  }
}

/// A table has more tools than a program calls: what its line lacks is told where it is called.
TEST(CommonHabits, AToolWhoseLineLacksSomethingIsRefusedAtItsCall) {
  ControlSetup setup = three_axis_setup();
  setup.incomplete_tools[5] = "tools.tbl:3: the tool has no word D";
  EXPECT_EQ(linuxcnc("G21 T1 M6\nG0 X1\nM2\n", setup).first_error(), "");
  const NcRun run = linuxcnc("G21 T5 M6\nM2\n", setup);
  EXPECT_EQ(run.first_error(), "unknown-tool 1:5");
  EXPECT_NE(run.diagnostics.list()[0].text.find("tools.tbl:3"), std::string::npos);
}

/// Tables of hundreds of tools are not listed.
TEST(CommonHabits, AtMostEightToolsAreNamed) {
  ControlSetup setup = three_axis_setup();
  setup.tools.clear();
  for (int number = 1; number <= 20; ++number) setup.tools.push_back({number, "", 50.0, 8.0, 0.0});
  const NcRun run = linuxcnc("G21 T77 M6\nM2\n", setup);
  ASSERT_EQ(run.first_error(), "unknown-tool 1:5");
  const std::string& text = run.diagnostics.list()[0].text;
  EXPECT_NE(text.find("T1, T2, T3, T4, T5, T6, T7, T8 and 12 more"), std::string::npos) << text;
}

/// 10 mm at 1 mm/min and back: a thousand hours after 6000 moves, where the next fifty million would fill the
/// memory before they are counted.
TEST(CommonHabits, ALoopWithoutAnEndIsToldBeforeItsMovesFillTheMemory) {
  const NcRun run = linuxcnc("G21 G90 G94\nG0 X0 Y0 Z5\nF1\no1 while [1]\nG1 X10\nX0\no1 endwhile\nM2\n",
                             three_axis_setup());
  EXPECT_EQ(run.first_error().substr(0, 15), "too-many-moves ") << run.text();
  EXPECT_NE(run.text().find("more than 1000 h of feeds and dwells in 100001 moves"), std::string::npos)
      << run.text();
  EXPECT_LT(run.moves().size(), 200'000U);
}

}  // namespace
}  // namespace swarf::program
