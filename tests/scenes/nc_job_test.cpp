// NC programs as jobs of the shipped program: what they are told, what they tell, what they refuse.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "support/json_path.h"
#include "support/program_run.h"

namespace nc_job_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using swarf::test::at_path;
using swarf::test::read_text;
using swarf::test::run_swarf;
using swarf::test::write_text;

/// A slot 60 long, 10 wide, 4 deep along a block, by the tool that the control knows as T2.
const char* const kSlot =
    "%\nG21 G17 G90 G94\nT2 M6\nG43 H2\nS3000 M3 M8\nG0 X-10 Y0 Z20\nZ-4\nG1 X70 F1200\nG0 Z20\nM5\nM2\n";
constexpr double kSlotVolume = 60.0 * 10.0 * 4.0;

const std::string kTools =
    "[[tool]]\nnumber = 2\ndiameter_mm = 10\nflute_length_mm = 25\nlength_mm = 60\ngauge_length_mm = 120\n"
    "[[tool]]\nname = \"BALL\"\ndiameter_mm = 6\ncorner_radius_mm = 3\nflute_length_mm = 20\nlength_mm = "
    "50\n";

const std::string kStart = "start = { X_mm = 0, Y_mm = 0, Z_mm = 600 }\n";

class NcJob : public testing::Test {
 protected:
  void SetUp() override { root_ = swarf::test::fresh_folder("nc_job"); }
  void TearDown() override { fs::remove_all(root_); }

  void write(const std::string& program, const std::string& setup, const std::string& keys = "") {
    write_text(root_ / "job.ngc", program);
    write_text(
        root_ / "scene.toml",
        "machine = \"" SWARF_SOURCE_DIR "/assets/machines/mill_3axis/machine.toml\"\nnc = \"job.ngc\"\n" +
            keys + kTools + "[setup]\nwork_origin_mm = [0, 0, 100]\n" + setup +
            "[stock]\nbox_mm = [[0, -20, -20], [60, 20, 0]]\nvoxel_mm = 0.5\n[design]\nkind = \"none\"\n");
  }
  swarf::test::ProgramRun run() {
    return run_swarf("run " + (root_ / "scene.toml").string() + " --no-render --report -o " +
                     (root_ / "out").string());
  }
  json metrics() const { return json::parse(std::ifstream(root_ / "out" / "metrics.json")); }

  void expect_refused(const std::string& code, const std::string& place = "") {
    const auto refused = run();
    EXPECT_EQ(refused.exit_code, 2) << refused.output;
    EXPECT_NE(refused.output.find(code), std::string::npos) << refused.output;
    EXPECT_NE(refused.output.find(place), std::string::npos) << refused.output;
  }

  fs::path root_;
};

TEST_F(NcJob, SaysHowItWasReadAndWhatItDidNotSimulate) {
  write(kSlot, kStart);
  const auto done = run();
  ASSERT_EQ(done.exit_code, 0) << done.output;
  // The legs of a rapid's dog-leg are no feed moves.
  EXPECT_NE(done.output.find("1 feed moves of 80 mm, 3 rapids"), std::string::npos) << done.output;
  const json found = metrics();
  EXPECT_NEAR(at_path(found, "stock.volume_removed_mm3").get<double>(), kSlotVolume, 1e-3 * kSlotVolume);
  EXPECT_EQ(at_path(found, "program.dialect"), "linuxcnc");
  EXPECT_FALSE(at_path(found, "program.dialect_reason").get<std::string>().empty());
  EXPECT_EQ(at_path(found, "program.not_simulated.0"), "M8 (flood)");
  EXPECT_GT(at_path(found, "tools.0.time_s").get<double>(), 4.0);
  EXPECT_EQ(at_path(found, "tools.1.time_s"), 0.0);
  const std::string report = read_text(root_ / "out" / "report.html");
  EXPECT_NE(report.find("read, not simulated: M8"), std::string::npos);
  EXPECT_NE(report.find("given by the scene"), std::string::npos);
}

TEST_F(NcJob, OfRapidsAloneInTheAirItSaysThatNothingCuts) {
  write("%\nG21 G17 G90 G94\nT2 M6\nG43 H2\nG0 X-10 Y0 Z20\nG0 X70\nM2\n", kStart);
  expect_refused("path-misses-stock", "fix: name the program that cuts");
}

TEST_F(NcJob, TheFirstCompletePositionStartsItWhereTheSceneDoesNot) {
  write(kSlot, "");
  const auto done = run();
  ASSERT_EQ(done.exit_code, 0) << done.output;
  EXPECT_NE(at_path(metrics(), "program.start").get<std::string>().find("6"), std::string::npos);
  EXPECT_NEAR(at_path(metrics(), "stock.volume_removed_mm3").get<double>(), kSlotVolume, 1e-3 * kSlotVolume);
}

TEST_F(NcJob, WorkOffsetsShiftTheProgram) {
  std::string program = kSlot;
  program.replace(program.find("G94"), 3, "G94 G55");
  write(program, kStart + "offsets = { G55 = { Y_mm = 5, Z_mm = 1.5 } }\n");
  const auto done = run();
  ASSERT_EQ(done.exit_code, 0) << done.output;
  const double depth = 4.0 - 1.5;
  EXPECT_NEAR(at_path(metrics(), "stock.volume_removed_mm3").get<double>(), 60.0 * 10.0 * depth, 2.0);
}

TEST_F(NcJob, TheWorkTurnsOnTheTableAndTheProgramDoesNot) {
  // The slot runs along the machine's X: along -Y of a block that is turned by 90 degrees, through its 40 mm.
  std::string program = kSlot;
  program.replace(program.find("X-10 Y0"), 7, "X-40 Y30");
  write(program, kStart + "work_rotation_deg = 90\n");
  const auto done = run();
  ASSERT_EQ(done.exit_code, 0) << done.output;
  EXPECT_NEAR(at_path(metrics(), "stock.volume_removed_mm3").get<double>(), 40.0 * 10.0 * 4.0, 2.0);
  const std::string cl =
      "UNITS/MM\nLOADTL/2\nSPINDL/3000,CLW\nFROM/-10,0,-4\nFEDRAT/1200\nGOTO/70,0,-4\nFINI\n";
  write_text(root_ / "job.cl", cl);
  std::string scene = read_text(root_ / "scene.toml");
  scene.replace(scene.find("nc = \"job.ngc\""), 14, "cl = \"job.cl\"");
  scene.erase(scene.find(kStart), kStart.size());
  write_text(root_ / "scene.toml", scene);
  const auto turned = run();
  ASSERT_EQ(turned.exit_code, 0) << turned.output;
  EXPECT_NEAR(at_path(metrics(), "stock.volume_removed_mm3").get<double>(), kSlotVolume, 2.0);
  EXPECT_NEAR(at_path(metrics(), "kinematics.axes.0.travel").get<double>(), 0.0, 1e-9);
  EXPECT_NEAR(at_path(metrics(), "kinematics.axes.1.travel").get<double>(), 80.0, 1e-9);
}

TEST_F(NcJob, ChecksAsScene) {
  write(kSlot, kStart);
  const auto checked = run_swarf("check " + (root_ / "scene.toml").string());
  EXPECT_EQ(checked.exit_code, 0) << checked.output;
  EXPECT_NE(checked.output.find("80 mm of feed moves"), std::string::npos) << checked.output;
}

TEST_F(NcJob, RefusesAToolThatTheSceneLacks) {
  std::string program = kSlot;
  program.replace(program.find("T2"), 2, "T7");
  write(program, kStart);
  expect_refused("7", "job.ngc:3:");
}

TEST_F(NcJob, RefusesFeedMovesWithAnEmptySpindle) {
  std::string program = kSlot;
  program.erase(program.find("T2 M6\nG43 H2\n"), 13);
  write(program, kStart);
  expect_refused("no-tool-in-spindle", "job.ngc:6:");
}

TEST_F(NcJob, RefusesASetupThatTheMachineLacks) {
  write(kSlot, "start = { X_mm = 0, Y_mm = 0 }\n");
  expect_refused("missing-axis", "scene.toml");
  write(kSlot, "start = { X_mm = 0, Y_mm = 0, Z_mm = 600, C_deg = 0 }\n");
  expect_refused("unknown-axis", "scene.toml");
  write(kSlot, "start = { X_deg = 0, Y_mm = 0, Z_mm = 600 }\n");
  expect_refused("wrong-unit", "scene.toml");
  write(kSlot, kStart + "offsets = { G40 = { X_mm = 1 } }\n");
  expect_refused("unknown-offset", "scene.toml");
  write(kSlot, kStart + "offsets = { G54 = { Xmm = 1 } }\n");
  expect_refused("unknown-key", "scene.toml");
}

TEST_F(NcJob, RefusesKeysOfOtherPrograms) {
  write(kSlot, kStart, "dialect = \"linux\"\n");
  expect_refused("linuxcnc", "scene.toml");
  write(kSlot, kStart, "cl = \"job.ngc\"\n");
  expect_refused("two-programs", "scene.toml");
  write(kSlot, kStart + "[interpolator]\nmode = \"tcp\"\n");
  expect_refused("mode", "scene.toml");
}

TEST_F(NcJob, WithTheSpindleOffItCutsNothingUnnoticed) {
  std::string program = kSlot;
  program.replace(program.find("S3000 M3"), 8, "S3000 M4");
  write(program, kStart);
  const auto reversed = run();
  EXPECT_EQ(reversed.exit_code, 1) << reversed.output;
  EXPECT_NE(reversed.output.find("job.ngc:8:"), std::string::npos) << reversed.output;
  EXPECT_NE(reversed.output.find("the spindle turning the wrong way"), std::string::npos) << reversed.output;
}

}  // namespace

}  // namespace nc_job_test
