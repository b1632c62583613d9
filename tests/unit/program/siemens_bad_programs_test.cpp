// tests/data/programs/nc/siemens/bad: each file states in its first line, "; expect: code line:column", the
// error that it must give and no other.
#include <algorithm>

#include "support/scratch.h"
#include "unit/program/siemens_support.h"

namespace swarf::program::nc::siemens::siemens_bad_programs_test {
namespace {

namespace fs = std::filesystem;

const char* const kFolder = "tests/data/programs/nc/siemens/bad";

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const auto& entry : fs::directory_iterator(project_file(kFolder))) {
    if (entry.path().extension() == ".mpf") all.push_back(entry.path().stem().string());
  }
  std::sort(all.begin(), all.end());
  return all;
}

class BadSiemensProgram : public testing::TestWithParam<std::string> {};

TEST_P(BadSiemensProgram, GivesExactlyTheErrorItStates) {
  const std::string path = project_file(std::string(kFolder) + "/" + GetParam() + ".mpf");
  const std::string text = read_file(path);
  const std::string head = "; expect: ";
  ASSERT_TRUE(text.starts_with(head)) << "the first line states no expectation";
  const std::string expected = text.substr(head.size(), text.find('\n') - head.size());
  Ran ran;
  run_file(path, setup_of(spinner()), ran);
  EXPECT_EQ(errors_of(ran.diagnostics), std::vector<std::string>{expected}) << all_text(ran.diagnostics);
  for (const Diagnostic& diagnostic : ran.diagnostics.list()) {
    EXPECT_FALSE(diagnostic.text.empty());
    EXPECT_FALSE(diagnostic.fix.empty()) << format(diagnostic);
    EXPECT_EQ(diagnostic.where.file, path);
  }
}

std::string name_of_case(const testing::TestParamInfo<std::string>& info) {
  return info.param;
}
INSTANTIATE_TEST_SUITE_P(Files, BadSiemensProgram, testing::ValuesIn(names()), name_of_case);

TEST(BadSiemensProgram, ThereAreEnoughOfThem) {
  EXPECT_GE(names().size(), 90U);
}

TEST(BadSiemensProgram, WhatIsNoTextIsRefused) {
  EXPECT_EQ(errors_of(run_text(std::string("G0 X1\0Y2\n", 9)).diagnostics),
            std::vector<std::string>{"not-text 1:6"});
  EXPECT_EQ(errors_of(run_text("").diagnostics), std::vector<std::string>{"empty-file 0:0"});
  Ran ran;
  run_file("/nowhere/at/all.mpf", setup_of(spinner()), ran);
  EXPECT_EQ(errors_of(ran.diagnostics), std::vector<std::string>{"file-not-found 0:0"});
}

TEST(BadSiemensProgram, TheNearestNameIsProposed) {
  const Ran ran = run_text("DEF REAL _CUTTING\n_CUTING=5\n");
  EXPECT_NE(all_text(ran.diagnostics).find("did you mean _CUTTING?"), std::string::npos)
      << all_text(ran.diagnostics);
  EXPECT_NE(all_text(run_text("TRAORY\n").diagnostics).find("did you mean TRAORI?"), std::string::npos);
}

TEST(BadSiemensProgram, RecursionEndsAtTheLevelsOfTheControl) {
  const std::string sub = test::scratch_text() + "/SIEMENS_SELF.spf";
  std::ofstream(sub) << "SIEMENS_SELF\nM17\n";
  const Ran ran = run_text("SIEMENS_SELF\nM30\n");
  std::remove(sub.c_str());
  EXPECT_EQ(errors_of(ran.diagnostics), std::vector<std::string>{"recursion-limit 1:1"});
}

}  // namespace
}  // namespace swarf::program::nc::siemens::siemens_bad_programs_test
