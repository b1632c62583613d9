// Parameters that hold a value before the program starts: a Z that a program takes from one.
#include "unit/program/nc_support.h"

namespace swarf::program {
namespace {

ControlSetup with(const Presets& presets) {
  ControlSetup setup = three_axis_setup();
  setup.presets = presets;
  return setup;
}

NcRun run_with(Dialect dialect, const std::string& text, const std::string& name, double value) {
  return run_text(text, dialect, with({{preset_name(name), {value, {"here"}}}}));
}

std::string text_with(Dialect dialect, const std::string& word) {
  const std::string iso = "G21 G90\nG0 Z" + word + "\nM30\n";
  if (dialect == Dialect::kHeidenhain)
    return "BEGIN PGM T MM\nTOOL CALL 1 Z S100\nL Z+" + word + " FMAX\nEND PGM T MM\n";
  return dialect == Dialect::kSiemens ? "G90\nG0 Z=" + word + "\nM30\n" : iso;
}

TEST(Presets, EachDialectReadsItsOwn) {
  const struct {
    Dialect dialect;
    const char *name, *word;
  } rows[] = {{Dialect::kFanuc, "500", "#500"},
              {Dialect::kFanuc, "#5", "#5"},
              {Dialect::kHaas, "500", "#500"},
              {Dialect::kMazak, "100", "#100"},
              {Dialect::kLinuxCnc, "#31", "#31"},
              {Dialect::kLinuxCnc, "5", "#5"},
              {Dialect::kLinuxCnc, "_dEpth", "#<_Depth>"},
              {Dialect::kLinuxCnc, "#<_depth>", "#<_depth>"},
              {Dialect::kSiemens, "R12", "R12"},
              {Dialect::kSiemens, "r12", "R12"},
              {Dialect::kSiemens, "_DEPTH", "_depth"},
              {Dialect::kSiemens, "DEPTH", "DEPTH"},
              {Dialect::kHeidenhain, "Q5", "Q5"},
              {Dialect::kHeidenhain, "QL5", "QL5"},
              {Dialect::kHeidenhain, "qr5", "QR5"}};
  for (const auto& row : rows) {
    const NcRun run = run_with(row.dialect, text_with(row.dialect, row.word), row.name, 7.25);
    EXPECT_EQ(run.text(), "") << row.name;
    ASSERT_EQ(run.moves().size(), 1u) << row.name;
    EXPECT_NEAR(run.moves()[0].to.tip_W.z(), 7.25, 1e-12) << row.name;
  }
}

TEST(Presets, AProgramMayAssignAnotherValue) {
  const NcRun run = run_with(Dialect::kFanuc, "G21 G90\n#500=#500+1.\nG0 Z#500\nM30\n", "500", 2.0);
  ASSERT_EQ(run.moves().size(), 1u) << run.text();
  EXPECT_NEAR(run.moves()[0].to.tip_W.z(), 3.0, 1e-12);
}

TEST(Presets, AVariableOfTheProgramHidesTheGlobalOne) {
  const NcRun run = run_with(Dialect::kSiemens, "DEF REAL DEPTH=2\nG90\nG0 Z=DEPTH\nM30\n", "DEPTH", 9.0);
  ASSERT_EQ(run.moves().size(), 1u) << run.text();
  EXPECT_NEAR(run.moves()[0].to.tip_W.z(), 2.0, 1e-12);
}

TEST(Presets, GlobalVariablesHoldInCalledProgramsToo) {
  const std::string folder = test::scratch_text() + "presets";
  std::filesystem::create_directories(folder);
  std::ofstream(folder + "/DEEPER.SPF") << "G0 Z=DEPTH\nDEPTH=DEPTH+1\nM17\n";
  ControlSetup setup = with({{"DEPTH", {4.0, {"here"}}}});
  setup.subprogram_folders = {folder};
  const NcRun run = run_text("G90\nDEEPER\nDEEPER\nM30\n", Dialect::kSiemens, setup);
  ASSERT_EQ(run.moves().size(), 2u) << run.text();
  EXPECT_NEAR(run.moves()[0].to.tip_W.z(), 4.0, 1e-12);
  EXPECT_NEAR(run.moves()[1].to.tip_W.z(), 5.0, 1e-12);
}

TEST(Presets, OthersAreRefusedWhereTheyAreSaid) {
  const struct {
    Dialect dialect;
    const char* name;
  } rows[] = {{Dialect::kFanuc, "5001"},     {Dialect::kFanuc, "R1"},       {Dialect::kFanuc, "50"},
              {Dialect::kLinuxCnc, "5221"},  {Dialect::kLinuxCnc, "0"},     {Dialect::kLinuxCnc, "_feed"},
              {Dialect::kLinuxCnc, "depth"}, {Dialect::kSiemens, "R1000"},  {Dialect::kSiemens, "GOTOF"},
              {Dialect::kSiemens, "A[1]"},   {Dialect::kSiemens, "500"},    {Dialect::kHeidenhain, "Q2000"},
              {Dialect::kHeidenhain, "QS1"}, {Dialect::kHeidenhain, "Q1.5"}};
  for (const auto& row : rows) {
    const NcRun run = run_with(row.dialect, text_with(row.dialect, "1"), row.name, 1.0);
    EXPECT_NE(run.text().find("bad-preset"), std::string::npos) << row.name << ": " << run.text();
    EXPECT_NE(run.text().find("here"), std::string::npos) << row.name;
    EXPECT_TRUE(run.moves().empty());
  }
}

}  // namespace
}  // namespace swarf::program
