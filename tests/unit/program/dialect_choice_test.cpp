// Which dialect a file is in: what its text says, what is assumed where it says nothing, and what no longer
// counts.
#include <fmt/format.h>

#include <array>

#include "program/evidence.h"
#include "unit/program/nc_support.h"

namespace swarf::program {
namespace {

namespace fs = std::filesystem;

/// Runs a file whose name ends like this, without naming its dialect.
NcRun unnamed(const std::string& ending, const std::string& text,
              const ControlSetup& setup = three_axis_setup()) {
  const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
  const fs::path path = test::scratch_folder() / ("swarf_choice_" + name + ending);
  fs::remove(path);
  std::ofstream(path, std::ios::binary) << text;
  return run_file(path.string(), std::nullopt, setup);
}

/// The codes of all diagnostics, in order.
std::string codes_of(const NcRun& run) {
  std::string codes;
  for (const Diagnostic& one : run.diagnostics.list()) codes += (codes.empty() ? "" : " ") + one.code;
  return codes;
}

void expect_same_moves(const NcRun& run, const NcRun& other, const std::string& what) {
  ASSERT_EQ(run.moves().size(), other.moves().size()) << what << "\n" << run.text();
  for (size_t i = 0; i < run.moves().size(); ++i) {
    EXPECT_EQ(run.moves()[i].q_to, other.moves()[i].q_to) << what << ", move " << i;
    EXPECT_EQ(run.moves()[i].rapid, other.moves()[i].rapid) << what << ", move " << i;
  }
}

TEST(DialectChoice, ByWordsThatOnlyOneHas) {
  const NcRun linux_run = unnamed(".nc", "o1 repeat [2]\nG0 X1\no1 endrepeat\nM2\n");
  EXPECT_EQ(linux_run.text(), "");
  EXPECT_EQ(linux_run.summary.dialect, Dialect::kLinuxCnc);
  EXPECT_EQ(linux_run.summary.dialect_reason, "recognised by an O word in line 1");
  const NcRun fanuc_run = unnamed(".nc", "%\nO0123\nG05.1 Q1\nG0 X1\nM30\n%\n");
  EXPECT_EQ(fanuc_run.text(), "");
  EXPECT_EQ(fanuc_run.summary.dialect, Dialect::kFanuc);
  const NcRun siemens_run = unnamed(".nc", "DEF REAL _X=5\nG0 X=_X\nCYCLE832()\nM30\n");
  EXPECT_EQ(siemens_run.text(), "");
  EXPECT_EQ(siemens_run.summary.dialect, Dialect::kSiemens);
  EXPECT_EQ(siemens_run.summary.dialect_reason, "recognised by 'DEF REAL _X=5' in line 1");
  EXPECT_EQ(unnamed(".mpf", "G0 X1\nM30\n").summary.dialect_reason, "recognised by the ending .mpf");
}

TEST(DialectChoice, FilesThatAreNoProgramSayWhere) {
  EXPECT_EQ(unnamed(".nc", std::string("G0 X1\nG0 \0 X2\n", 14)).first_error(), "not-text 2:4");
  EXPECT_EQ(unnamed(".nc", "G0 X1\n" + std::string(100'000, 'X')).first_error(), "line-too-long 2:1");
  EXPECT_EQ(unnamed(".nc", "").first_error(), "empty-file 0:0");
  EXPECT_EQ(run_file(test::scratch_folder().string(), std::nullopt, three_axis_setup()).first_error(),
            "file-unreadable 0:0");
}

/// Most files of hobby shops: no number, no macro, nothing but G, M and axis words.
TEST(DialectChoice, PlainIsoWordsAreTheCommonCoreAndTheNoteNamesTheFlag) {
  const std::string plain = "G90 G21 G17\nG0 Z5\nG0 X10 Y10\nG1 Z-1 F200\nG2 X20 Y10 I5 J0\nG0 Z5\nM30\n";
  for (const char* ending : {".nc", ".tap", ".gcode", ".gc", ".cnc", ".eia", ".txt", ""}) {
    const NcRun run = unnamed(ending, plain);
    EXPECT_EQ(run.summary.dialect, Dialect::kLinuxCnc) << ending;
    EXPECT_EQ(run.first_error(), "") << run.text();
    ASSERT_EQ(codes_of(run), "dialect-assumed") << ending;
    EXPECT_EQ(run.diagnostics.list()[0].severity, Severity::kNote);
    EXPECT_NE(run.diagnostics.list()[0].text.find("--dialect"), std::string::npos);
    EXPECT_NE(run.summary.dialect_reason.find("assumed"), std::string::npos);
    expect_same_moves(run, linuxcnc(plain), ending);
  }
}

/// A Fusion post for GRBL writes the tool into a comment, with words that only an 840D has.
TEST(DialectChoice, CommentsAreNoEvidence) {
  const std::string fusion =
      "(1014)\n(Machine)\n(  vendor: Autodesk)\n(T1  D=6 CR=0 - ZMIN=-5 - flat end mill)\nG90 G94\nG17\n"
      "G21\n(2D CONTOUR - GOTOF O1 CALL)\nS5000 M3\nG54\nG0 X30 Y8.5\nZ15\nG1 Z-1 F300\nX40\nG0 "
      "Z15\nM5\nM30\n";
  const NcRun run = unnamed(".nc", fusion);
  EXPECT_EQ(run.summary.dialect, Dialect::kLinuxCnc);
  EXPECT_EQ(codes_of(run), "dialect-assumed") << run.text();
  EXPECT_EQ(run.moves().size(), 5u);
}

TEST(DialectChoice, WhatIsAComment) {
  EXPECT_EQ(code_of_line("(T1 D=6 CR=0)"), "");
  EXPECT_EQ(code_of_line("n10 g0 x1 (CR=5) y2 ; CR=7"), "N10 G0 X1  Y2");
  EXPECT_EQ(code_of_line("CYCLE832(0.01,112003)"), "CYCLE832(0.01,112003)");
  EXPECT_EQ(code_of_line("CYCLE81 (5,0,2)"), "CYCLE81 (5,0,2)");
  EXPECT_EQ(code_of_line("X=AC(3) Y=2*(1+2) (note)"), "X=AC(3) Y=2*(1+2)");
  EXPECT_EQ(code_of_line("MSG(\"a ; b (c\") ;d"), "MSG(\"a ; b (c\")");
  EXPECT_EQ(code_of_line("(open"), "");
  EXPECT_TRUE(has_word("N1 G65 P1", "G65"));
  EXPECT_FALSE(has_word("N1 G650", "G65"));
  EXPECT_FALSE(has_word("G65.1", "G65"));
}

TEST(DialectChoice, ProgramNumbersHaveOneToEightDigits) {
  for (const std::string number : {"O1", "O12", "O100", "O1001", "O123456", "O1234567", "O12345678", ":1234",
                                   "O7 (BRACKET, OP 10)", "o0100(lower)", "  O100", "O01001"}) {
    const NcRun run = unnamed(".nc", "%\n" + number + "\nG21\nG0 X1. Y0 Z5.\nG1 X2. F100.\nM30\n%\n");
    // Five digits are those of Haas.
    EXPECT_EQ(run.summary.dialect, number == "O01001" ? Dialect::kHaas : Dialect::kFanuc) << number;
    EXPECT_EQ(run.first_error(), "") << number << run.text();
    EXPECT_EQ(run.moves().size(), 2u) << number;
  }
  EXPECT_NE(unnamed(".nc", "O1 IF [1 EQ 1]\nG0 X1\nO1 ENDIF\nM2\n").summary.dialect, Dialect::kFanuc);
}

/// What transfers, editors and old disks leave in a file changes no move.
TEST(DialectChoice, MarksOfATransferChangeNothing) {
  const std::array<std::pair<Dialect, std::string>, 4> programs{
      {{Dialect::kLinuxCnc, "%\nG21 G90 G0 X1 Y2 Z3\nG1 X5 F100\nM2\n%\n"},
       {Dialect::kFanuc, "%\nO1001\nG21 G90 G0 X1. Y2. Z3.\nG1 X5. F100.\nM30\n%\n"},
       {Dialect::kSiemens, "G710 G90 G0 X1 Y2 Z3\nG1 X5 F100\nM30\n"},
       {Dialect::kHeidenhain, "BEGIN PGM A MM\nL X+1 Y+2 Z+3 FMAX\nL X+5 F100\nEND PGM A MM\n"}}};
  for (const auto& [dialect, text] : programs) {
    const NcRun plain = run_text(text, dialect, three_axis_setup());
    ASSERT_EQ(plain.text(), "") << text;
    std::string crlf, lower = text, blanks, tabs;
    for (const char c : text) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
    for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    blanks = "  ";
    for (const char c : text) blanks += c == '\n' ? std::string("  \n\t ") : std::string(1, c);
    const std::array<std::pair<const char*, std::string>, 9> variants{
        {{"byte order mark", "\xEF\xBB\xBF" + text},
         {"CR LF", crlf},
         {"ETX", text + "\x03"},
         {"ETX on a line", text + "\x03\n"},
         {"XON, XOFF", "\x11" + text + "\x13\n"},
         {"end of file of DOS", text + "\x1A"},
         {"NUL behind the last line", text + std::string(512, '\0')},
         {"NUL before the first line", std::string(64, '\0') + text},
         {"leading blanks", blanks}}};
    for (const auto& [what, changed] : variants) {
      const NcRun run = run_text(changed, dialect, three_axis_setup());
      EXPECT_EQ(run.text(), "") << what << ", " << dialect_name(dialect);
      expect_same_moves(run, plain, what);
    }
    const NcRun small = run_text(lower, dialect, three_axis_setup());
    EXPECT_EQ(small.text(), "") << dialect_name(dialect);
    expect_same_moves(small, plain, "small letters");
  }
}

/// NUL behind a block is what a disk fault leaves: digits may be lost.
TEST(DialectChoice, NulWithinAProgramIsRefused) {
  EXPECT_EQ(linuxcnc(std::string("G0 X1\nG1 X10.\0\0\nG0 X3\nM2\n", 26)).first_error(), "not-text 2:8");
  EXPECT_EQ(linuxcnc(std::string("G0 X1\n\0\0G0 X3\nM2\n", 17)).first_error(), "not-text 2:1");
}

TEST(DialectChoice, PercentAtTheEndAloneEndsTheProgram) {
  const NcRun run = unnamed(".nc", "G21 G90\nG0 X1 Y1 Z1\n%\n");
  EXPECT_EQ(run.first_error(), "");
  EXPECT_EQ(codes_of(run), "dialect-assumed percent-alone") << run.text();
  EXPECT_EQ(run.moves().size(), 1u);
}

/// The ending speaks for an 840D, the comments of the first lines for nobody's 840D.
TEST(DialectChoice, TheNextBestIsTriedWhereTheFirstLinesCannotBeRead) {
  const NcRun run = unnamed(".mpf", "(OP 10)\nG21 G90\nG0 X1 Y1 Z1 (GO)\nM30\n");
  EXPECT_EQ(run.summary.dialect, Dialect::kLinuxCnc);
  EXPECT_EQ(run.first_error(), "");
  ASSERT_EQ(codes_of(run), "dialect-changed") << run.text();
  EXPECT_EQ(run.diagnostics.list()[0].where.line, 1);
  EXPECT_NE(run.diagnostics.list()[0].text.find("siemens (recognised by the ending .mpf)"),
            std::string::npos);
  EXPECT_NE(run.summary.dialect_reason.find("as siemens"), std::string::npos);
  // Modal G0 from the start is Fanuc's: LinuxCNC has no motion before the first G0.
  const NcRun modal = unnamed(".nc", "G21 G90\nX1 Y1 Z1\nG1 X5 F100\nM30\n");
  EXPECT_EQ(modal.summary.dialect, Dialect::kFanuc) << modal.text();
  EXPECT_EQ(modal.first_error(), "");
}

/// No dialect reads it: the fault is told with the dialect that was taken and the flag that names another.
TEST(DialectChoice, RefusalsSayWhichDialectWasTaken) {
  const NcRun run = unnamed(".nc", "G0 X1 Y1 Z1\nthis is no program\n");
  EXPECT_EQ(run.first_error(), "bad-number 2:2") << run.text();
  EXPECT_EQ(run.diagnostics.list().back().code, "dialect-taken");
  EXPECT_NE(run.diagnostics.list().back().text.find("linuxcnc (assumed"), std::string::npos);
  EXPECT_NE(run.diagnostics.list().back().text.find("--dialect"), std::string::npos);
}

/// A word of each, so far from one another that the first moves settle nothing.
TEST(DialectChoice, EqualEvidenceIsAWarning) {
  std::string text = "G21 G90 G64 P0.1\nG0 X1 Y1 Z1\n";
  for (int i = 0; i < 600; ++i) text += fmt::format("G1 X{} F100\n", i + 2);
  const NcRun run = unnamed(".nc", text + "G05.1 Q1\nM30\n");
  EXPECT_EQ(run.summary.dialect, Dialect::kLinuxCnc);
  EXPECT_TRUE(codes_of(run).starts_with("dialect-assumed")) << run.text();
  EXPECT_EQ(run.diagnostics.list()[0].severity, Severity::kWarning);
  EXPECT_NE(run.diagnostics.list()[0].text.find("fanuc (G05.1 in line 603)"), std::string::npos)
      << run.text();
}

}  // namespace
}  // namespace swarf::program
