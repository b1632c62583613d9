// tests/data/programs/nc/heidenhain/bad: each file states in its first line, "; expect: code line:column",
// the error that stops it. Names that begin with five_ run on the five-axis machine.
#include <algorithm>
#include <cctype>

#include "program/source_text.h"
#include "unit/program/heidenhain_support.h"

namespace swarf::program::heidenhain_bad_programs_test {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> bad_files() {
  std::vector<std::string> files;
  const fs::path folder = fs::path(SWARF_SOURCE_DIR) / "tests/data/programs/nc/heidenhain/bad";
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

/// "G40": a word of letter dialects.
bool speaks_g_code(const std::string& text) {
  for (size_t i = 0; i + 1 < text.size(); ++i) {
    const bool begins = i == 0 || std::isalnum(static_cast<unsigned char>(text[i - 1])) == 0;
    if (begins && text[i] == 'G' && std::isdigit(static_cast<unsigned char>(text[i + 1])) != 0) return true;
  }
  return false;
}

class BadHeidenhainProgram : public testing::TestWithParam<std::string> {};

TEST_P(BadHeidenhainProgram, IsRefusedWhereItStates) {
  const std::string text = read_file(GetParam());
  const std::string head = "; expect: ";
  ASSERT_TRUE(text.starts_with(head)) << "the first line states no expectation";
  const std::string expected = text.substr(head.size(), text.find('\n') - head.size());
  ControlSetup setup =
      fs::path(GetParam()).stem().string().starts_with("five_") ? five_axis_setup() : three_axis_setup();
  setup.moves_max = 1000;
  const NcRun run = run_file(GetParam(), Dialect::kHeidenhain, setup);
  EXPECT_EQ(run.first_error(), expected) << run.text();
  for (const Diagnostic& one : run.diagnostics.list()) {
    EXPECT_FALSE(one.text.empty());
    for (const std::string& said : {one.text, one.fix}) {  // nobody is told to write G-code
      EXPECT_FALSE(speaks_g_code(said)) << said;
    }
    if (one.severity == Severity::kError) {
      EXPECT_FALSE(one.fix.empty()) << format(one);
      EXPECT_EQ(one.where.file, GetParam());
    }
  }
}

std::string name_of_case(const testing::TestParamInfo<std::string>& one) {
  return fs::path(one.param).stem().string();
}

INSTANTIATE_TEST_SUITE_P(Files, BadHeidenhainProgram, testing::ValuesIn(bad_files()), name_of_case);

TEST(BadHeidenhainProgram, ThereAreEnoughOfThem) {
  EXPECT_GE(bad_files().size(), 100u);
}

TEST(BadHeidenhainProgram, WhatIsNoTextIsRefused) {
  const auto first_error = [](const std::string& text) {
    return run_text(text, Dialect::kHeidenhain, three_axis_setup()).first_error();
  };
  EXPECT_EQ(first_error(std::string("BEGIN PGM A MM\nL X1\0 FMAX\n", 26)), "not-text 2:5");
  EXPECT_EQ(first_error(""), "empty-file 0:0");
  EXPECT_EQ(run_file("/nowhere/at/all.h", Dialect::kHeidenhain, three_axis_setup()).first_error(),
            "file-not-found 0:0");
}

TEST(BadHeidenhainProgram, TheNearestWordIsProposed) {
  EXPECT_NE(klartext("PLAIN SPATIAL SPA+1\n").text().find("did you mean PLANE?"), std::string::npos);
  EXPECT_NE(klartext("Q1 = SQRTT 4\n").text().find("did you mean SQRT?"), std::string::npos);
}

}  // namespace
}  // namespace swarf::program::heidenhain_bad_programs_test
