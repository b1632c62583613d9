// tests/data/programs/nc/<dialect>/bad: each file states in its first line the error that stops it,
// (expect: code line:column). Names that begin with five_ run on the five-axis machine.
#include <algorithm>

#include "program/dialects.h"
#include "program/source_text.h"
#include "support/scratch.h"
#include "unit/program/nc_support.h"

namespace swarf::program::nc_bad_programs_test {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> bad_files() {
  std::vector<std::string> files;
  for (const char* dialect : {"linuxcnc", "fanuc", "haas", "mazak"}) {
    const fs::path folder = fs::path(SWARF_SOURCE_DIR) / "tests/data/programs/nc" / dialect / "bad";
    for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// The folder names the dialect.
std::string folder_of(const std::string& file) {
  return fs::path(file).parent_path().parent_path().filename().string();
}

Dialect dialect_of_folder(const std::string& file) {
  const auto found = dialect_of(folder_of(file));
  EXPECT_TRUE(found.has_value()) << file;
  return found.value_or(Dialect::kLinuxCnc);
}

ControlSetup setup_for(const std::string& file) {
  ControlSetup setup =
      fs::path(file).stem().string().starts_with("five_") ? five_axis_setup() : three_axis_setup();
  setup.moves_max = 1000;
  return setup;
}

class NcBadProgram : public testing::TestWithParam<std::string> {};

TEST_P(NcBadProgram, IsRefusedWhereItStates) {
  const std::string text = read_file(GetParam());
  const std::string head = "(expect: ";
  ASSERT_TRUE(text.starts_with(head));
  const std::string expected = text.substr(head.size(), text.find(')') - head.size());
  const NcRun run = run_file(GetParam(), dialect_of_folder(GetParam()), setup_for(GetParam()));
  EXPECT_EQ(run.first_error(), expected) << run.text();
  for (const Diagnostic& one : run.diagnostics.list()) {
    EXPECT_FALSE(one.text.empty());
    if (one.severity == Severity::kError) {
      EXPECT_FALSE(one.fix.empty()) << format(one);
      EXPECT_EQ(one.where.file, GetParam());
    }
  }
}

std::string name_of_case(const testing::TestParamInfo<std::string>& one) {
  return folder_of(one.param) + "_" + fs::path(one.param).stem().string();
}

INSTANTIATE_TEST_SUITE_P(Files, NcBadProgram, testing::ValuesIn(bad_files()), name_of_case);

TEST(NcBadInput, BinaryEmptyAndMissingFiles) {
  EXPECT_EQ(linuxcnc(std::string("G0 X1\nG0 \0 X2\n", 14)).first_error(), "not-text 2:4");
  EXPECT_EQ(linuxcnc("").first_error(), "empty-file 0:0");
  EXPECT_EQ(run_file("/nowhere/at/all.ngc", Dialect::kLinuxCnc, three_axis_setup()).first_error(),
            "file-not-found 0:0");
}

}  // namespace
}  // namespace swarf::program::nc_bad_programs_test
