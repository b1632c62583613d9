// Q parameters, formulas, labels, repeats, jumps and called programs of Heidenhain programs.
#include "support/scratch.h"
#include "unit/program/heidenhain_support.h"

namespace swarf::program::heidenhain_flow_test {
namespace {

/// The value of a formula: it becomes a coordinate.
double value_of(const std::string& formula, const std::string& before = "") {
  const NcRun run = klartext_clean(before + "Q9 = " + formula + "\nL X+Q9 FMAX\n");
  return run.moves().empty() ? 0.0 : run.moves()[0].to.tip_W.x();
}

TEST(HeidenhainFlow, FormulasInTheOrderOfTheControl) {
  const std::vector<std::pair<std::string, double>> cases{
      {"1 + 2 * 3", 7},
      {"(1 + 2) * 3", 9},
      {"2 ^ 3 ^ 2", 64},
      {"-3 ^ 2", 9},
      {"8 / 4 / 2", 1},
      {"10 - 2 - 3", 5},
      {"400 % 360", 40},
      {"SIN 30", 0.5},
      {"SIN(30) ^ 2", 0.25},
      {"COS(60) + TAN 45", 1.5},
      {"ASIN 0.5", 30},
      {"ACOS 0.5", 60},
      {"ATAN 1", 45},
      {"SQRT 16 + SQ 3", 13},
      {"LN EXP 2", 2},
      {"LOG 1000", 3},
      {"ABS -7", 7},
      {"NEG 7", -7},
      {"INT -2.7", -2},
      {"FRAC 2.75", 0.75},
      {"SGN -5", -1},
      {"PI", kPi},
      {"Q1 + QL2 * QR3", 1 + 2 * 3},
  };
  for (const auto& [formula, expected] : cases)
    EXPECT_NEAR(value_of(formula, "Q1 = 1\nQL2 = 2\nQR3 = 3\n"), expected, 1e-12) << formula;
}

TEST(HeidenhainFlow, NumberedFunctions) {
  const std::vector<std::pair<std::string, double>> cases{
      {"FN 0: Q9 = +5", 5},          {"FN 1: Q9 = +Q1 + +5", 15},    {"FN 2: Q9 = +Q1 - +4", 6},
      {"FN 3: Q9 = +Q1 * -2", -20},  {"FN 4: Q9 = +Q1 DIV +4", 2.5}, {"FN 5: Q9 = SQRT +25", 5},
      {"FN 6: Q9 = SIN +30", 0.5},   {"FN 7: Q9 = COS +180", -1},    {"FN 8: Q9 = +3 LEN +4", 5},
      {"FN 13: Q9 = +1 ANG -1", 135}};
  for (const auto& [text, expected] : cases) {
    const NcRun run = klartext_clean("Q1 = 10\n" + text + "\nL X+Q9 FMAX\n");
    ASSERT_EQ(run.moves().size(), 1u) << text;
    EXPECT_NEAR(run.moves()[0].to.tip_W.x(), expected, 1e-12) << text;
  }
}

TEST(HeidenhainFlow, LoopsByJumps) {
  // Sum of 1 to 10 by FN 12, and each comparison taken once or not.
  const NcRun run = klartext_clean(
      "FN 0: Q1 = +0\nFN 0: Q2 = +0\nLBL 1\nFN 1: Q1 = +Q1 + +1\nFN 1: Q2 = +Q2 + +Q1\n"
      "FN 12: IF +Q1 LT +10 GOTO LBL 1\nL X+Q2 FMAX\nFN 9: IF +Q2 EQU +55 GOTO LBL \"NEXT\"\nL X+1 FMAX\n"
      "LBL \"NEXT\"\nFN 10: IF +Q2 NE +55 GOTO LBL 2\nL X+3 FMAX\nFN 11: IF +Q2 GT +1 GOTO LBL 2\n"
      "L X+4 FMAX\nLBL 2\n");
  ASSERT_EQ(run.moves().size(), 2u);
  expect_tip(run.moves()[0], 55, 0, 0);
  expect_tip(run.moves()[1], 3, 0, 0);
}

TEST(HeidenhainFlow, SubprogramsAndRepeats) {
  const NcRun run = klartext_clean(
      "CALL LBL 5\nLBL 1\nL IX+1 FMAX\nLBL 2\nL IY+1 FMAX\nCALL LBL 2 REP 2\nCALL LBL 1 REP 1/1\nL Z+9 FMAX "
      "M2\n"
      "LBL 5\nL X+10 FMAX\nCALL LBL 6\nLBL 0\nLBL 6\nL Z+1 FMAX\nLBL 0\n");
  // 5 and 6 once; then twice one step in X and three in Y; Z+9 at last.
  ASSERT_EQ(run.moves().size(), 2u + 2u * 4u + 1u);
  expect_tip(run.moves()[1], 10, 0, 1);
  expect_tip(run.moves().back(), 12, 6, 9);
}

TEST(HeidenhainFlow, CalledProgramsHaveTheirOwnLabelsAndLocalParameters) {
  namespace fs = std::filesystem;
  const fs::path folder = test::scratch_folder() / "swarf_heidenhain_calls";
  fs::create_directories(folder);
  std::ofstream(folder / "SUB.H") << "BEGIN PGM SUB MM\nQL1 = 5\nLBL 1\nL IX+QL1 FMAX\nCALL LBL 1 REP 1\n"
                                     "Q1 = Q1 + 1\nEND PGM SUB MM\n";
  std::ofstream(folder / "main.h") << "0 BEGIN PGM MAIN MM\n1 Q1 = 1\n2 QL1 = 7\n3 LBL 1\n4 CALL PGM SUB\n"
                                      "5 L Y+QL1 Z+Q1 FMAX\n6 END PGM MAIN MM\n";
  const NcRun run = run_file((folder / "main.h").string(), std::nullopt, three_axis_setup());
  ASSERT_EQ(run.text(), "");
  EXPECT_EQ(run.summary.dialect, Dialect::kHeidenhain);
  EXPECT_EQ(run.summary.dialect_reason, "recognised by 'BEGIN PGM' in line 1");
  ASSERT_EQ(run.summary.files.size(), 2u);
  ASSERT_EQ(run.moves().size(), 3u);
  expect_tip(run.moves()[1], 10, 0, 0);
  EXPECT_EQ(run.moves()[1].file, 1);
  expect_tip(run.moves()[2], 10, 7, 2);
  fs::remove_all(folder);
}

TEST(HeidenhainFlow, TextParametersNameToolsAndLabels) {
  const NcRun run = klartext_clean(
      "QS1 = \"DRILL\" || \"6\"\nTOOL CALL QS1 Z S100\nQS2 = \"END\"\nFN 9: IF +1 EQU +1 GOTO LBL QS2\n"
      "L X+1 FMAX\nLBL \"END\"\nL X+2 FMAX\n");
  ASSERT_EQ(run.moves().size(), 1u);
  EXPECT_EQ(run.moves()[0].tool, 2);
}

TEST(HeidenhainFlow, EndlessLoopsAndRecursionEnd) {
  EXPECT_EQ(klartext("LBL 1\nFN 9: IF +0 EQU +0 GOTO LBL 1\n").first_error(), "endless-loop 3:29");
  EXPECT_EQ(klartext("LBL 1\nCALL LBL 1\nLBL 0\n").first_error(), "recursion-limit 3:10");
}

}  // namespace
}  // namespace swarf::program::heidenhain_flow_test
