// swarf check of a program alone gives the time and the travel of the run that cuts with it: to the same
// cycle and the same bits, in every dialect.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "support/program_run.h"

namespace {

namespace fs = std::filesystem;
using swarf::test::read_text;
using swarf::test::write_text;

struct DialectProgram {
  const char* dialect;
  const char* file;
  const char* text;
};

/// Rapids, feeds with corners, an arc, a turn of the table, a dwell.
const DialectProgram kPrograms[] = {
    {"linuxcnc", "part.ngc",
     "G21 G90 G54 G17\nT1 M6\nS5000 M3\nG0 X-12 Y0 Z5 A0 B0\nG1 Z-1 F600\nX-6 Y1 F1500\nX0 Y-1\nG3 X12 Y0 I6 "
     "J0.5\n"
     "G4 P0.5\nG0 Z50\nG0 A20 B90\nG1 A0 B45 F3000\nM2\n"},
    {"fanuc", "part.nc",
     "%\nO0001\nG21 G90 G54 G17\nT1 M6\nS5000 M3\nG0 X-12. Y0. Z5. A0. B0.\nG1 Z-1. F600.\nX-6. Y1. F1500.\n"
     "X0. Y-1.\nG3 X12. Y0. R8.\nG4 X0.5\nG0 Z50.\nG0 A20. B90.\nG1 A0. B45. F3000.\nM30\n%\n"},
    {"siemens", "part.mpf",
     "G71 G90 G54 G17\nT1 D1 M6\nS5000 M3\nG0 X-12 Y0 Z5 A0 B0\nG1 Z-1 F600\nG64\nX-6 Y1 F1500\nX0 Y-1\n"
     "G3 X12 Y0 CR=8\nG4 F0.5\nG0 Z50\nG0 A20 B90\nG1 A0 B45 F3000\nM30\n"},
    {"heidenhain", "part.h",
     "0 BEGIN PGM part MM\n1 TOOL CALL 1 Z S5000\n2 L X-12 Y+0 A+0 B+0 R0 FMAX M3\n3 L Z+5 FMAX\n"
     "4 L Z-1 F600\n5 L X-6 Y+1 F1500\n6 L X+0 Y-1\n7 CR X+12 Y+0 R+8 DR+\n8 CYCL DEF 9.0 DWELL\n"
     "9 CYCL DEF 9.1 DWELL 0.5\n10 L Z+50 FMAX\n11 L A+20 B+90 FMAX\n12 L A+0 B+45 F3000\n13 M30\n"
     "14 END PGM part MM\n"}};

class CheckTime : public testing::TestWithParam<DialectProgram> {};

nlohmann::json checked(const fs::path& folder, const std::string& arguments) {
  const auto run = swarf::test::run_command("cd '" + folder.string() + "' && " + std::string(SWARF_PROGRAM) +
                                            " check --json 2>/dev/null " + arguments);
  const auto json = nlohmann::json::parse(run.output, nullptr, false);
  EXPECT_TRUE(json.is_object()) << run.output;
  return json.at("files").at(0);
}

TEST_P(CheckTime, IsThatOfTheRun) {
  const DialectProgram& program = GetParam();
  const fs::path folder = swarf::test::fresh_folder(std::string("check_time_") + program.dialect);
  const fs::path machines = fs::path(SWARF_SOURCE_DIR) / "tests/data/machines";
  for (const char* file : {"tetrahedron.ply", "tetrahedron.stl", "small.toml"})
    fs::copy_file(machines / file, folder / file);
  write_text(folder / program.file, program.text);
  write_text(folder / "tools.toml",
             "[[tool]]\nnumber = 1\ndiameter_mm = 4\nflute_length_mm = 10\nlength_mm = 40\n");
  write_text(folder / "scene.toml",
             std::string("machine = \"small.toml\"\ntool_table = \"tools.toml\"\nnc = \"") + program.file +
                 "\"\ndialect = \"" + program.dialect +
                 "\"\n[setup]\nstart = { X_mm = 0, Y_mm = 250, Z_mm = 0, A_deg = 0, B_deg = 0 }\n"
                 "[stock]\nbox_mm = [[-8, -4, -3], [8, 4, 0]]\nvoxel_mm = 0.5\n"
                 "[design]\nkind = \"none\"\n[movie]\nseconds = 0\n");
  const auto run = swarf::test::run_command("cd '" + folder.string() + "' && " + std::string(SWARF_PROGRAM) +
                                            " run scene.toml --no-render -o out");
  ASSERT_LE(run.exit_code, 1) << run.output;
  const auto metrics = nlohmann::json::parse(read_text(folder / "out/metrics.json"));
  const nlohmann::json file =
      checked(folder, std::string(program.file) +
                          " --machine small.toml --tools tools.toml --home --dialect " + program.dialect);
  ASSERT_TRUE(file.at("driven").is_object()) << file.dump(2);
  const nlohmann::json& driven = file.at("driven");
  EXPECT_GT(driven.at("cycles").get<int>(), 2000);
  EXPECT_EQ(driven.at("cycles"), metrics.at("motion").at("ticks"));
  EXPECT_EQ(driven.at("time_s").get<double>(), metrics.at("motion").at("time_s").get<double>());
  const nlohmann::json& axes = metrics.at("kinematics").at("axes");
  ASSERT_EQ(driven.at("axes").size(), axes.size());
  for (size_t i = 0; i < axes.size(); ++i) {
    const std::string unit = axes[i].at("unit");
    for (const std::string key : {"min", "max", "travel"})
      EXPECT_EQ(driven.at("axes")[i].at(key + "_" + unit).get<double>(), axes[i].at(key).get<double>())
          << axes[i].at("name") << " " << key;
    EXPECT_EQ(driven.at("axes")[i].at("speed_max_" + unit + "_s"), axes[i].at("speed_max"));
  }
  EXPECT_EQ(checked(folder, "scene.toml").at("time_s"), metrics.at("motion").at("time_s"));
  EXPECT_EQ(driven.at("interpolator").at("period_ms").get<double>(), 1.0) << "what it rests on is said";
  // A scene's own settings are those of its run.
  write_text(folder / "slow.toml", read_text(folder / "scene.toml") +
                                       "[interpolator]\nperiod_ms = 4\npath_acceleration_max_mm_s2 = 500\n");
  ASSERT_LE(swarf::test::run_command("cd '" + folder.string() + "' && " + std::string(SWARF_PROGRAM) +
                                     " run slow.toml --no-render -o slow")
                .exit_code,
            1);
  const auto slow = nlohmann::json::parse(read_text(folder / "slow/metrics.json"));
  EXPECT_GT(slow.at("motion").at("time_s").get<double>(), driven.at("time_s").get<double>());
  EXPECT_EQ(checked(folder, "slow.toml").at("time_s"), slow.at("motion").at("time_s"));
  // Nothing is told that was not driven.
  EXPECT_TRUE(checked(folder, std::string(program.file) + " --machine small.toml --no-drive --dialect " +
                                  program.dialect)
                  .at("driven")
                  .is_null());
  fs::remove_all(folder);
}

INSTANTIATE_TEST_SUITE_P(Dialects, CheckTime, testing::ValuesIn(kPrograms),
                         [](const auto& one) { return std::string(one.param.dialect); });

TEST(CheckHours, AProgramThatARunRefusesForItsTimeIsNotRight) {
  const fs::path folder = swarf::test::fresh_folder("check_hours");
  const auto expect_refused = [&](const char* name, const std::string& text, const std::string& place) {
    write_text(folder / name, text);
    const std::string file = (folder / name).string();
    for (const std::string& words :
         {"check " + file, "run " + file + " --tool 6 -o " + (folder / "o").string()}) {
      const auto run = swarf::test::run_swarf(words);
      EXPECT_EQ(run.exit_code, 2) << run.output;
      EXPECT_NE(run.output.find(name + (":" + place)), std::string::npos) << run.output;
      EXPECT_NE(run.output.find("[too-many-cycles]"), std::string::npos) << run.output;
    }
  };
  // The dwell's own line, not that of the move behind it.
  expect_refused("dwell.ngc", "G21 G90 G94\nG0 X0 Y0 Z5\nF100\nG1 X10\nG4 P1000000000\nG1 X20\nM2\n", "5:");
  expect_refused("feed.ngc", "G21 G90 G94\nG0 X0 Y0 Z5\nF100\nG1 X10\nG1 X20 F0.00001\nX30 F100\nM2\n",
                 "5:4");
  expect_refused("delay.cl",
                 "UNITS/MM\nLOADTL/1\nFEDRAT/100,MMPM\nGOTO/0,0,5\nDELAY/1000000000\nGOTO/10,0,5\nFINI\n",
                 "5:");
}

}  // namespace
