// tests/data/programs/nc/<dialect>/bad: each file states in its first line the error that stops it,
// (expect: code line:column). Names that begin with five_ run on the five-axis machine.
#include <algorithm>

#include "base/rng.h"
#include "program/source_text.h"
#include "unit/program/nc_support.h"

namespace swarf::program {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> bad_files() {
  std::vector<std::string> files;
  for (const char* dialect : {"linuxcnc", "fanuc"}) {
    const fs::path folder = fs::path(SWARF_SOURCE_DIR) / "tests/data/programs/nc" / dialect / "bad";
    for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

Dialect dialect_of(const std::string& file) {
  return file.find("/fanuc/") == std::string::npos ? Dialect::kLinuxCnc : Dialect::kFanuc;
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
  const NcRun run = run_file(GetParam(), dialect_of(GetParam()), setup_for(GetParam()));
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
  return (dialect_of(one.param) == Dialect::kFanuc ? "fanuc_" : "linuxcnc_") +
         fs::path(one.param).stem().string();
}

INSTANTIATE_TEST_SUITE_P(Files, NcBadProgram, testing::ValuesIn(bad_files()), name_of_case);

TEST(NcBadInput, BinaryEmptyAndMissingFiles) {
  EXPECT_EQ(linuxcnc(std::string("G0 X1\nG0 \0 X2\n", 14)).first_error(), "not-text 2:4");
  EXPECT_EQ(linuxcnc("").first_error(), "empty-file 0:0");
  EXPECT_EQ(run_file("/nowhere/at/all.ngc", Dialect::kLinuxCnc, three_axis_setup()).first_error(),
            "file-not-found 0:0");
}

TEST(NcBadInput, DialectsAreRecognisedOrAskedFor) {
  const ControlSetup setup = three_axis_setup();
  const auto recognised = [&](const std::string& name, const std::string& text) {
    const auto path = fs::temp_directory_path() / ("swarf_nc_dialect" + name);
    std::ofstream(path) << text;
    return run_file(path.string(), std::nullopt, setup);
  };
  EXPECT_EQ(recognised(".nc", "G0 X1\nM2\n").first_error(), "unknown-dialect 0:0");
  const NcRun linux_run = recognised(".nc", "o1 repeat [2]\nG0 X1\no1 endrepeat\nM2\n");
  EXPECT_EQ(linux_run.text(), "");
  EXPECT_EQ(linux_run.summary.dialect, Dialect::kLinuxCnc);
  EXPECT_EQ(linux_run.summary.dialect_reason, "recognised by an O word in line 1");
  const NcRun fanuc_run = recognised(".nc", "%\nO0123\nG05.1 Q1\nG0 X1\nM30\n%\n");
  EXPECT_EQ(fanuc_run.text(), "");
  EXPECT_EQ(fanuc_run.summary.dialect, Dialect::kFanuc);
  const NcRun siemens_run = recognised(".nc", "DEF REAL _X=5\nG0 X=_X\nCYCLE832()\nM30\n");
  EXPECT_EQ(siemens_run.text(), "");
  EXPECT_EQ(siemens_run.summary.dialect, Dialect::kSiemens);
  EXPECT_EQ(siemens_run.summary.dialect_reason, "recognised by 'DEF REAL _X=5' in line 1");
  EXPECT_EQ(recognised(".mpf", "G0 X1\nM30\n").summary.dialect_reason, "recognised by the ending .mpf");
}

// Cut off anywhere, or with bytes changed: a diagnostic or a run, never a crash, never a place outside the
// file.
TEST(NcBadInput, TruncatedAndMutatedProgramsNeverCrash) {
  const std::vector<std::string> files = bad_files();
  Rng rng(20261121);
  std::vector<std::string> seeds;
  for (const std::string& file : files) seeds.push_back(read_file(file));
  seeds.push_back(
      "%\nO1\nG21 G90 G54\nT1 M6 G43 H1\nS1000 M3\nG0 X0 Y0 Z5\nG41 D1 G1 X20 F100\nG2 X30 Y10 R10\nG40 G1 "
      "X50\nG81 X1 Z-2 R1\nG80\n#101=[1+2*3]\no1 while [#101 GT 3]\n#101=[#101-1]\no1 endwhile\nM2\n");
  const std::string alphabet = "0123456789.-+#[]()<>=GMXYZABCIJKRFSTDHLPQON \n%;/owhileifcall*&\x01\xC3\xA4";
  const auto path = fs::temp_directory_path() / "swarf_nc_fuzz.ngc";
  for (int round = 0; round < 3000; ++round) {
    std::string text = seeds[rng.next() % seeds.size()];
    const size_t changes = rng.next() % 6;
    for (size_t i = 0; i < changes && !text.empty(); ++i) {
      const size_t at = rng.next() % text.size();
      const char c = alphabet[rng.next() % alphabet.size()];
      switch (rng.next() % 3) {
        case 0:
          text[at] = c;
          break;
        case 1:
          text.insert(at, 1, c);
          break;
        default:
          text.erase(at, 1 + rng.next() % 4);
      }
    }
    if (rng.next() % 3 == 0 && !text.empty()) text.resize(rng.next() % text.size());
    std::ofstream(path, std::ios::binary) << text;
    ControlSetup setup = rng.next() % 2 == 0 ? three_axis_setup() : five_axis_setup();
    setup.moves_max = 300;
    const Dialect dialect = rng.next() % 2 == 0 ? Dialect::kLinuxCnc : Dialect::kFanuc;
    const NcRun run = run_file(path.string(), dialect, setup);
    const long lines =
        std::count(text.begin(), text.end(), '\n') + std::count(text.begin(), text.end(), '\r') + 1;
    for (const Diagnostic& one : run.diagnostics.list())
      ASSERT_LE(one.where.line, lines) << "program:\n" << text;
    for (const NcMove& move : run.moves())
      ASSERT_TRUE(move.q_to.allFinite() && move.to.tip_W.allFinite()) << "program:\n" << text;
  }
}

}  // namespace
}  // namespace swarf::program
