// Behaviour of whole programs that a list of bad files does not show.
#include <fstream>

#include "program/reporter.h"
#include "support/scratch.h"
#include "unit/program/support.h"

namespace swarf::program {
namespace {

TEST(Interpreter, DefaultsToDegreeThreeAndOutwardSignPlus) {
  const std::string blocks =
      "G10 L70 P1\nG10 L71 P1 I1 J0 X10\nG10 L71 P1 I0 J1 Y10\nG10 L71 P1 I3 J3 Z1\nG10 L79 P1\nG06.4 P1 "
      "V0.5 F60\n";
  const Program program = parse_clean(with_modal_words(blocks));
  ASSERT_EQ(program.surfaces.size(), 1U);
  EXPECT_EQ(program.surfaces[0].surface->outward_sign(), 1);
  EXPECT_LT((program.surfaces[0].surface->point(1.0, 1.0) - Vec3(10, 10, 1)).norm(), 1e-15);
}

TEST(Interpreter, ReadsIsoPasses) {
  const Program program = parse_clean(
      with_modal_words(plane_blocks() + "F1200\nG06.4 P1 V0.25\nG6.4 P1 V1 K0.0005 I-5 J2.5 F600\n"));
  ASSERT_EQ(program.operations.size(), 2U);
  EXPECT_EQ(program.operations[0].kind, OperationKind::kIsoPass);
  EXPECT_EQ(program.operations[0].iso_v, 0.25);
  EXPECT_EQ(program.operations[0].feed_mm_s, 20.0);
  EXPECT_EQ(program.operations[0].chord_tolerance_mm, 1e-3);
  EXPECT_EQ(program.operations[1].feed_mm_s, 10.0);
  EXPECT_EQ(program.operations[1].chord_tolerance_mm, 5e-4);
  EXPECT_NEAR(program.operations[1].lead_rad, -0.0872664625997165, 1e-16);
  EXPECT_NEAR(program.operations[1].tilt_rad, 0.0436332312998582, 1e-16);
}

TEST(Interpreter, ReadsEveryStartBoundaryAndPattern) {
  for (int b = 0; b <= 3; ++b) {
    const std::string op =
        "G06.3 P1 B" + std::to_string(b) + " E0.01 K0.001 F60 L" + std::to_string(b % 2) + "\n";
    const Program program = parse_clean(with_modal_words(plane_blocks() + op));
    ASSERT_EQ(program.operations.size(), 1U);
    EXPECT_EQ(static_cast<int>(program.operations[0].start), b);
    EXPECT_EQ(program.operations[0].zigzag, b % 2 == 1);
  }
}

TEST(Interpreter, LoadsToolAndStartsSpindleInTheOrderOfAControl) {
  // In one block, the tool change comes before the spindle however the words are ordered.
  const Program program = parse_clean("S5000 M3 M6 T12\n" + plane_blocks() + "T3\nG06.4 P1 V0 F60\nM30\n");
  ASSERT_EQ(program.operations.size(), 1U);
  EXPECT_EQ(program.operations[0].tool, 12);
  EXPECT_EQ(program.operations[0].spindle_rpm, 5000.0);
}

TEST(Interpreter, ARefusedBlockChangesNothing) {
  const Parsed parsed = parse("T1 M6\nS12000 M3\nT5 M6 S1 Q9\n" + plane_blocks() + "G06.4 P1 V0 F60\nM30\n");
  EXPECT_EQ(places(parsed.diagnostics), std::vector<std::string>{"unexpected-word 3:10"});
  ASSERT_EQ(parsed.program.operations.size(), 1U);
  EXPECT_EQ(parsed.program.operations[0].tool, 1);
  EXPECT_EQ(parsed.program.operations[0].spindle_rpm, 12000.0);
}

TEST(Interpreter, ReportsACauseAndNotItsConsequences) {
  // Line 2 would have opened the surface: its coefficients, its end and its use are not errors of their own.
  const Parsed parsed =
      parse("T1 M6 S9 M3\nG10 L70 P1 Q0 R1\nG10 L71 P1 I1 J0 X1\nG10 L79 P1\nG06.4 P1 V0 F60\nM30\n");
  EXPECT_EQ(places(parsed.diagnostics), std::vector<std::string>{"out-of-range 2:12"});
  const Parsed no_tool = parse("T1..2 M6\nS9 M3\n" + plane_blocks() + "G06.4 P1 V0 F60\nM30\n");
  EXPECT_EQ(places(no_tool.diagnostics), std::vector<std::string>{"bad-number 1:1"});
}

TEST(Interpreter, StopsAfterAPageOfProblems) {
  std::string text;
  for (int i = 0; i < 500; ++i) text += "A1\n";
  const Parsed parsed = parse(text);
  ASSERT_EQ(parsed.diagnostics.list().size(), static_cast<size_t>(kMaxProblems) + 1);
  EXPECT_EQ(parsed.diagnostics.list().back().code, "too-many-problems");
  EXPECT_EQ(parsed.diagnostics.list().back().where.line, kMaxProblems);
}

TEST(Interpreter, RefusesEmptyTexts) {
  for (const char* text : {"", " ", "\n\r\n\t\n", "\xEF\xBB\xBF"}) {
    EXPECT_EQ(places(parse(text).diagnostics), std::vector<std::string>{"empty-file 0:0"});
  }
}

TEST(Interpreter, RefusesBinaryFiles) {
  const std::string png("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16);
  EXPECT_EQ(places(parse(png).diagnostics), std::vector<std::string>{"not-text 1:1"});
  const std::string utf16(
      "G\0"
      "1\0",
      4);
  EXPECT_EQ(places(parse(utf16).diagnostics), std::vector<std::string>{"not-text 1:2"});
  EXPECT_EQ(places(parse("G17\r(\xC3)\n").diagnostics), std::vector<std::string>{"not-text 2:2"});
}

std::string code_of_loading(const std::string& path) {
  try {
    load_program(path);
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics.list().at(0).where.file, path);
    return error.diagnostics.list().at(0).code;
  }
  return "";
}

TEST(LoadProgram, SaysWhyAFileCannotBeRead) {
  EXPECT_EQ(code_of_loading("no/such/file.nc"), "file-not-found");
  EXPECT_EQ(code_of_loading(project_file("tests")), "file-unreadable");
  EXPECT_EQ(code_of_loading(project_file("tests/data/programs/bad/latin_1.nc")), "not-text");
}

TEST(LoadProgram, HandsOverWarnings) {
  const std::string path = test::scratch_text() + "swarf_no_end.nc";
  std::ofstream(path) << "T1 M6\nS9 M3\n" << plane_blocks() << "G06.4 P1 V0 F60\n";
  Diagnostics warnings;
  EXPECT_EQ(load_program(path, &warnings).operations.size(), 1U);
  EXPECT_EQ(places(warnings), std::vector<std::string>{"no-program-end 7:0"});
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace swarf::program
