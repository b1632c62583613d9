// Custom macro B: arguments, modal macros, subprograms of other files, jumps and loops, modal variables.
#include <fmt/format.h>

#include "base/rng.h"
#include "support/scratch.h"
#include "unit/program/nc_support.h"

namespace swarf::program::nc_fanuc_macros_test {
namespace {

namespace fs = std::filesystem;

NcRun fanuc(const std::string& text, const ControlSetup& setup = three_axis_setup()) {
  return run_text(text, Dialect::kFanuc, setup);
}

std::vector<double> xs(const NcRun& run) {
  std::vector<double> all;
  for (const NcMove& move : run.moves()) all.push_back(move.to.tip_W.x());
  return all;
}
using Values = std::vector<double>;

TEST(NcFanucMacros, ArgumentsOfTheFirstKind) {
  // Every letter but G L N O P, in any order but I J K.
  const std::string letters = "ABCDEFHIJKMQRSTUVWXYZ";
  const int variables[] = {1, 2, 3, 7, 8, 9, 11, 4, 5, 6, 13, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26};
  std::string call = "G65 P10 L1", macro = "O0010\n";
  for (size_t i = 0; i < letters.size(); ++i) {
    call += fmt::format(" {}{}", letters[i], i + 3);
    macro += fmt::format("G00 X#{}\n", variables[i]);
  }
  const NcRun run = fanuc(call + "\nM30\n" + macro + "M99\n");
  ASSERT_EQ(run.text(), "");
  Values expected;
  for (size_t i = 0; i < letters.size(); ++i) expected.push_back(static_cast<double>(i + 3));
  EXPECT_EQ(xs(run), expected);
}

TEST(NcFanucMacros, ArgumentsOfTheSecondKind) {
  std::string call = "G65 P10 A1 B2 C3", macro = "O0010\n";
  Values expected;
  for (int i = 4; i <= 33; ++i) call += fmt::format(" {}{}", "IJK"[(i - 4) % 3], i);
  for (int i = 1; i <= 33; ++i) {
    macro += fmt::format("G00 X#{}\n", i);
    expected.push_back(i);
  }
  const NcRun run = fanuc(call + "\nM30\n" + macro + "M99\n");
  ASSERT_EQ(run.text(), "");
  EXPECT_EQ(xs(run), expected);
}

TEST(NcFanucMacros, MixedArgumentsTheLaterHolds) {
  // The manual's example: the second I and D both mean #7, and D comes later.
  const NcRun run = fanuc("G65 A1.0 P1000\nM30\nO1000\nM99\n");
  EXPECT_EQ(run.first_error(), "");
  const NcRun mixed = fanuc(
      "G65 P1000 A1.0 B2.0 I-3.0 I4.0 D5.0\nM30\nO1000\nG00 X#1\nX#2\nX#4\nX#7\n"
      "IF [#3 NE #0] GOTO 9\nIF [#5 EQ #0] GOTO 10\nN9 X99\nN10 M99\n");
  ASSERT_EQ(mixed.text(), "");
  EXPECT_EQ(xs(mixed), (Values{1, 2, -3, 5}));
  // J before I: I is that of the second set.
  const NcRun backwards = fanuc("G65 P1 J5 I7\nM30\nO1\nG00 X#5\nX#7\nM99\n");
  ASSERT_EQ(backwards.text(), "");
  EXPECT_EQ(xs(backwards), (Values{5, 7}));
}

TEST(NcFanucMacros, LocalLevels) {
  // Each G65 has #1 of its own, M98 shares that of its caller, and what a level left comes back.
  const NcRun run = fanuc(
      "#1=1\nG65 P10 A2\nG00 X#1\nM98 P20\nG00 X#1\nM30\n"
      "O0010\nG00 X#1\nG65 P11 A3\nG00 X#1\n#1=40\nM98 P21\nM99\nO0011\nG00 X#1\n#1=50\nM99\n"
      "O0020\n#1=60\nM99\nO0021\nG00 X#1\nM99\n");
  ASSERT_EQ(run.text(), "");
  EXPECT_EQ(xs(run), (Values{2, 3, 2, 40, 1, 60}));
}

TEST(NcFanucMacros, FiveLevelsOfMacros) {
  std::string text = "G65 P11 A1\nM30\n";
  for (int level = 1; level < 5; ++level)
    text += fmt::format("O{:04}\nG65 P{} A{}\nM99\n", 10 + level, 11 + level, level + 1);
  EXPECT_EQ(fanuc(text + "O0015\nG00 X#1\nM99\n").text(), "");
  EXPECT_EQ(fanuc(text + "O0015\nG65 P16 A6\nM99\nO0016\nG00 X#1\nM99\n").first_error(),
            "recursion-limit 16:1");
}

TEST(NcFanucMacros, ModalMacroAfterEachMove) {
  // Only blocks with a move call it; not the G66 block, nor F S M alone.
  const NcRun run = fanuc(
      "G90 G00 X0 Y0 Z10\nG66 P30 Z-4 R2\nX10\nS500\nM08\nY5\nG04 P100\nG67\nX30\nM30\n"
      "O0030\nG00 Z#18\nG01 Z#26 F100\nG00 Z10\nM99\n");
  ASSERT_EQ(run.text(), "");
  std::vector<std::array<double, 3>> tips;
  for (const NcMove& move : run.moves())
    tips.push_back({move.to.tip_W.x(), move.to.tip_W.y(), move.to.tip_W.z()});
  const std::vector<std::array<double, 3>> expected{{0, 0, 10},  {10, 0, 10}, {10, 0, 2}, {10, 0, -4},
                                                    {10, 0, 10}, {10, 5, 10}, {10, 5, 2}, {10, 5, -4},
                                                    {10, 5, 10}, {30, 5, 10}};
  EXPECT_EQ(tips, expected);
}

TEST(NcFanucMacros, ModalMacrosNest) {
  // The last G66 is called after the moves, the one before it after the moves of that macro.
  const NcRun run =
      fanuc("G91 G00\nG66 P1\nG66 P2\nX1\nG67\nX1\nG67\nX1\nM30\nO0001\nY1\nM99\nO0002\nZ1\nM99\n");
  ASSERT_EQ(run.text(), "");
  std::string order;
  for (const NcMove& move : run.moves()) {
    const Vec3 way = move.to.tip_W - move.from.tip_W;
    order += way.x() > 0.5 ? 'X' : way.y() > 0.5 ? 'Y' : 'Z';
  }
  EXPECT_EQ(order, "XZYXYX");
}

TEST(NcFanucMacros, ModalArgumentsAreSetOnce) {
  // #1 is set in the G66 block alone: the macro counts in it. L repeats it, and M98 carries the mode along.
  const NcRun run =
      fanuc("G91\nG66 P1 A1 L2\nG00 Y1\nM98 P2\nG67\nM30\nO0001\nG00 X#1\n#1=#1+1\nM99\nO0002\nY1\nM99\n");
  ASSERT_EQ(run.text(), "");
  EXPECT_EQ(xs(run), (Values{0, 1, 3, 3, 6, 10}));
}

TEST(NcFanucMacros, ExternalSubprogramsComeFromFiles) {
  const fs::path folder = test::scratch_folder() / "swarf_nc_fanuc_external";
  fs::create_directories(folder);
  std::ofstream(folder / "O0040.nc") << "%\nO0040 (ON THE CARD)\nG91 G00 X5\nG90 M99\n%\n";
  ControlSetup setup = three_axis_setup();
  setup.subprogram_folders = {folder.string()};
  // O0040 of the program's own file is another one.
  const std::string text = "M98 P40\nM198 P40\nM198 P20040\nM30\nO0040\nG91 G00 X1\nG90 M99\n";
  const NcRun run = fanuc(text, setup);
  ASSERT_EQ(run.text(), "");
  EXPECT_EQ(xs(run), (Values{1, 6, 11, 16}));
  EXPECT_EQ(fanuc(text).first_error(), "unknown-subprogram 2:1");
  fs::remove_all(folder);
}

TEST(NcFanucMacros, JumpsWithinAndOutOfLoops) {
  const NcRun run = fanuc(
      "#1=0\nWHILE [#1 LT 4] DO1\n#1=#1+1\nIF [#1 EQ 2] GOTO 7\n#2=0\nN3 WHILE [#2 LT 2] DO2\n#2=#2+1\n"
      "G00 X[#1*10+#2]\nIF [#1 EQ 3] GOTO 7\nN4 END2\nN7 G00 Y#1\nN8 END1\nM30\n");
  ASSERT_EQ(run.text(), "");
  EXPECT_EQ(xs(run), (Values{11, 12, 12, 12, 31, 31, 41, 42, 42}));
  // Into a loop from outside is an error of the program.
  EXPECT_EQ(fanuc("#1=0\nGOTO 5\nWHILE [#1 LT 1] DO1\nN5 #1=1\nEND1\nM30\n").first_error(),
            "bad-statement 5:1");
}

TEST(NcFanucMacros, ModalVariables) {
  const struct {
    const char* block;
    const char* variable;
    double value;
  } cases[] = {{"G00", "#4001", 0},           {"G01 F10", "#4001", 1},
               {"G03", "#4001", 3},           {"G18", "#4002", 18},
               {"G91", "#4003", 91},          {"G95", "#4005", 95},
               {"G93", "#4005", 93},          {"G20", "#4006", 20},
               {"G42 D1", "#4007", 42},       {"G43 H2", "#4008", 43},
               {"G43.4 H2", "#4008", 43.4},   {"G49", "#4008", 49},
               {"G80", "#4009", 80},          {"G99", "#4010", 99},
               {"G66 P1", "#4012", 66},       {"G67", "#4012", 67},
               {"G97", "#4013", 97},          {"G57", "#4014", 57},
               {"G54.1 P7", "#4014", 54.1},   {"G54.1 P7", "#4130", 7},
               {"G68 X0 Y0 R5", "#4016", 68}, {"G42 D2", "#4107", 2},
               {"F250", "#4109", 250},        {"G43 H7", "#4111", 7},
               {"S800", "#4119", 800},        {"T2", "#4120", 2},
               {"G10 L2 P3 Y4", "#5262", 4},  {"G10 L20 P2 Z5", "#7023", 5},
               {"G10 L20 P2 Z5", "#14023", 5}};
  for (const auto& one : cases) {
    const std::string text = fmt::format("{}\n#100={}\nIF [#100 EQ {}] GOTO 9\n#3000=1\nN9 M30\nO1\nM99\n",
                                         one.block, one.variable, one.value);
    EXPECT_EQ(fanuc(text).first_error(), "") << text;
  }
}

TEST(NcFanucMacros, AlarmsStopsAndSwitches) {
  EXPECT_EQ(fanuc("#3000=25 (NO TOOL)\nM30\n").first_error(), "program-alarm 1:1");
  const NcRun run = fanuc("#3003=1\n#3004=3\n#3006=1 (TURN THE PART)\n/N5 #1=4\nG00 X#1\nM30\n");
  ASSERT_EQ(run.text(), "");
  EXPECT_EQ(xs(run), Values{4});
  EXPECT_EQ(run.summary.functions.size(), 3u);
  EXPECT_EQ(run.sink.notes.size(), 1u);
}

/// The manual's table: a vacant variable leaves its word out, counts as zero in arithmetic and in GT GE LT
/// LE, equals only a vacant one, and hands its vacancy on.
TEST(NcFanucMacros, VacantVariables) {
  const NcRun words = fanuc("G00 Y3\nG00 X#1 Y5\nG00 X-#100 Y7\nM30\n");
  ASSERT_EQ(words.diagnostics.list().size(), 1u);
  EXPECT_EQ(words.diagnostics.list()[0].code, "vacant-word");
  ASSERT_EQ(words.moves().size(), 3u);
  expect_tip(words.moves()[2], 0, 7, 0);
  const NcRun sums = fanuc("#2=#1+4\n#3=#1*5\nG00 X#2 Y#3\nM30\n");
  ASSERT_EQ(sums.diagnostics.list().size(), 1u);
  EXPECT_EQ(sums.diagnostics.list()[0].code, "vacant-value");
  expect_tip(sums.moves()[0], 4, 0, 0);
  const struct {
    const char* condition;
    bool holds;
  } cases[] = {{"#1 EQ #0", true},
               {"#1 NE #0", false},
               {"#1 EQ 0", false},
               {"#1 NE 0", true},
               {"#1 GE #0", true},
               {"#1 GT 0", false},
               {"#1 LE 0", true},
               {"#2 EQ #0", false},
               {"#2 NE #0", true},
               {"#2 EQ 0", true},
               {"#1 EQ #3", true},
               {"#1 EQ #2", false},
               {"[#1 EQ #0] AND [#2 EQ 0]", true}};
  for (const auto& one : cases) {
    const NcRun run = fanuc(fmt::format("#2=0\nIF [{}] GOTO 5\n#3000=1\nN5 M30\n", one.condition));
    EXPECT_EQ(run.first_error(), one.holds ? "" : "program-alarm 3:1") << one.condition;
  }
  EXPECT_EQ(fanuc("#1=3\n#1=#0\n#2=#1\nIF [#2 EQ #0] GOTO 5\n#3000=1\nN5 M30\n").text(), "");
}

/// A macro that adds two arguments, called with random ones: the sums come back in #100.
TEST(NcFanucMacros, RandomCalls) {
  Rng rng(65);
  for (int round = 0; round < 40; ++round) {
    std::string text = "#100=0\n";
    double sum = 0.0;
    for (int i = 0; i < 10; ++i) {
      const double a = std::floor(2000 * rng.uniform()) / 8 - 125, b = std::floor(2000 * rng.uniform()) / 8;
      const long times = static_cast<long>(rng.next() % 4);
      text += fmt::format("G65 P77 A{} I1 J2 K3 I{} L{}\n", a, b, times);
      sum += static_cast<double>(times) * (a + b);
    }
    text += "G00 X#100\nM30\nO0077\n#100=#100+#1+#7\nM99\n";
    const NcRun run = fanuc(text);
    ASSERT_EQ(run.text(), "") << text;
    if (sum == 0.0) continue;
    ASSERT_EQ(run.moves().size(), 1u) << text;
    ASSERT_EQ(run.moves()[0].to.tip_W.x(), sum) << text;
  }
}

}  // namespace
}  // namespace swarf::program::nc_fanuc_macros_test
