// Two tools in one program on the shipped program: volumes, stocks in process, records, refusals.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "support/json_path.h"
#include "support/program_run.h"

namespace two_tools_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using swarf::test::at_path;
using swarf::test::read_text;
using swarf::test::run_swarf;
using swarf::test::write_text;

constexpr double kLength = 60.0;
constexpr double kVoxel = 0.25;

/// A slot of a flat end (4 mm deep, 10 wide) and one of a ball (R 3, 3 deep) along a block.
const char* const kProgram =
    "PARTNO/TWO SLOTS\nUNITS/MM\nLOADTL/1\nSPINDL/3000,CLW\nFROM/-10,-8,5\nRAPID\nGOTO/-10,-8,-4\n"
    "FEDRAT/1200\nGOTO/70,-8,-4\nRAPID\nGOTO/70,-8,5\n"
    "LOADTL/5\nRAPID\nGOTO/-10,10,5\nRAPID\nGOTO/-10,10,-3\nFEDRAT/900\nGOTO/70,10,-3\nRAPID\nGOTO/"
    "70,10,5\nFINI\n";

std::string scene_text(const std::string& tools) {
  return "machine = \"" SWARF_SOURCE_DIR "/assets/machines/mill_3axis/machine.toml\"\ncl = \"path.cl\"\n" +
         tools +
         "[setup]\nwork_origin_mm = [0, 0, 120]\n"
         "[stock]\nbox_mm = [[0, -20, -20], [60, 20, 0]]\nvoxel_mm = 0.25\n[design]\nkind = \"none\"\n";
}

const std::string kTools =
    "[[tool]]\nnumber = 1\ndiameter_mm = 10\nflute_length_mm = 25\nlength_mm = 60\n"
    "[[tool]]\nnumber = 5\nname = \"BALL_6\"\nshape = \"ball\"\ndiameter_mm = 6\ncorner_radius_mm = 3\n"
    "flute_length_mm = 20\nlength_mm = 50\ngauge_length_mm = 90\n";

class TwoTools : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    root_ = swarf::test::fresh_folder("two_tools");
    write("job", scene_text(kTools), kProgram);
    run_ = run("job", "full", "--record --save-stock-after T1,T=BALL_6");
  }
  static void TearDownTestSuite() { fs::remove_all(root_); }

  static void write(const std::string& folder, const std::string& scene, const std::string& program) {
    fs::create_directories(root_ / folder);
    write_text(root_ / folder / "scene.toml", scene);
    write_text(root_ / folder / "path.cl", program);
  }
  static swarf::test::ProgramRun run(const std::string& job, const std::string& out,
                                     const std::string& options = "") {
    return run_swarf("run " + (root_ / job / "scene.toml").string() + " --no-render " + options + " -o " +
                     (root_ / out).string());
  }
  static json metrics(const std::string& out) {
    return json::parse(std::ifstream(root_ / out / "metrics.json"));
  }

  static fs::path root_;
  static swarf::test::ProgramRun run_;
};
fs::path TwoTools::root_;
swarf::test::ProgramRun TwoTools::run_;

TEST_F(TwoTools, CutWhatBothCut) {
  ASSERT_EQ(run_.exit_code, 0) << run_.output;
  const json found = metrics("full");
  const double flat = kLength * 10.0 * 4.0, ball = kLength * 0.5 * 3.14159265358979 * 9.0;
  // An edge of length l is off by up to l voxel^2/12 (Stock::volume_mm3): six of 60 mm. The ball's slot is
  // known by chords over the cells: at most voxel^2/(8 R) inside of its circle.
  const double edges = 6 * kLength * kVoxel * kVoxel / 12;
  const double chords = kLength * 3.14159265358979 * 3.0 * kVoxel * kVoxel / (8 * 3.0);
  EXPECT_NEAR(at_path(found, "stock.volume_removed_mm3").get<double>(), flat + ball, edges + chords);
  ASSERT_EQ(found.at("tools").size(), 2U);
  EXPECT_EQ(at_path(found, "tools.1.name"), "BALL_6");
  EXPECT_DOUBLE_EQ(at_path(found, "tools.0.gauge_length_mm").get<double>(), 110.0);
  EXPECT_DOUBLE_EQ(at_path(found, "tools.1.gauge_length_mm").get<double>(), 90.0);
  EXPECT_GT(at_path(found, "tools.0.time_s").get<double>(), 4.0);
  EXPECT_GT(at_path(found, "tools.1.time_s").get<double>(), 80.0 / 15.0);
  EXPECT_EQ(at_path(found, "bad_cuts.rapids_in_material"), 0);
}

TEST_F(TwoTools, GoOnAfterTheFirstToolWithTheSameEnd) {
  for (const std::string threads : {"1", "2"}) {
    const auto on = run(
        "job", "on", "--threads " + threads + " --from " + (root_ / "full" / "stock_after_T1.vdb").string());
    ASSERT_EQ(on.exit_code, 0) << on.output;
    EXPECT_EQ(at_path(metrics("on"), "stock.hash"), at_path(metrics("full"), "stock.hash"));
    EXPECT_GT(at_path(metrics("on"), "stock.blocks_resumed").get<int>(), 0);
    EXPECT_EQ(metrics("on").at("collisions"), metrics("full").at("collisions"));
  }
  EXPECT_TRUE(fs::exists(root_ / "full" / "stock_after_T_BALL_6.vdb"));
}

TEST_F(TwoTools, TheRecordKnowsTheTools) {
  const std::string record = read_text(root_ / "full" / "run.record");
  EXPECT_NE(record.find("\ntool 1\n"), std::string::npos);
  const auto same = run_swarf("replay " + (root_ / "full" / "run.record").string());
  EXPECT_EQ(same.exit_code, 0) << same.output;
}

TEST_F(TwoTools, AnotherSecondToolIsAnotherCut) {
  std::string tools = kTools;
  tools.replace(tools.find("gauge_length_mm = 90"), 20, "gauge_length_mm = 95");
  write("longer", scene_text(tools), kProgram);
  const auto longer = run("longer", "longer_out");
  ASSERT_EQ(longer.exit_code, 0) << longer.output;
  EXPECT_EQ(at_path(metrics("longer_out"), "stock.hash"), at_path(metrics("full"), "stock.hash"))
      << "the head is higher, the cut is the same";
  const auto z_max = [](const json& m) { return at_path(m, "kinematics.axes.2.max").get<double>(); };
  EXPECT_DOUBLE_EQ(z_max(metrics("longer_out")), z_max(metrics("full")))
      << "the first tool is the longest of both";
  const auto z_min = [](const json& m) { return at_path(m, "kinematics.axes.2.min").get<double>(); };
  EXPECT_NEAR(z_min(metrics("longer_out")) - z_min(metrics("full")), 5.0, 1e-9);
  tools.replace(tools.find("corner_radius_mm = 3"), 20, "corner_radius_mm = 2");
  tools.replace(tools.find("shape = \"ball\""), 14, "shape = \"bull_nose\"");
  write("other", scene_text(tools), kProgram);
  const auto on = run("other", "other_out", "--from " + (root_ / "full" / "stock_after_T1.vdb").string());
  EXPECT_EQ(on.exit_code, 2);
  EXPECT_NE(on.output.find("resume-scene-changed"), std::string::npos) << on.output;
}

TEST_F(TwoTools, WhatTheProgramLoadsMustBeThere) {
  std::string program = kProgram;
  program.replace(program.find("LOADTL/5"), 8, "LOADTL/6");
  write("lacks", scene_text(kTools), program);
  const auto lacks = run("lacks", "lacks_out");
  EXPECT_EQ(lacks.exit_code, 2);
  EXPECT_NE(lacks.output.find("path.cl:12:"), std::string::npos) << lacks.output;
  EXPECT_NE(lacks.output.find("tool 6"), std::string::npos) << lacks.output;
  EXPECT_NE(lacks.output.find("T1, T5 (BALL_6)"), std::string::npos) << lacks.output;
  program = kProgram;
  program.erase(program.find("LOADTL/1\n"), 9);
  write("unloaded", scene_text(kTools), program);
  EXPECT_NE(run("unloaded", "lacks_out").output.find("tool-not-loaded"), std::string::npos);
  EXPECT_NE(run("job", "lacks_out", "--save-stock-after T7").output.find("place-unknown"), std::string::npos);
}

TEST_F(TwoTools, ARapidThroughTheBlockIsAFinding) {
  std::string program = kProgram;
  program.replace(program.find("FEDRAT/900\nGOTO/70,10,-3"), 24, "RAPID\nGOTO/70,10,-3");
  write("rapid", scene_text(kTools), program);
  const auto rapid = run("rapid", "rapid_out");
  EXPECT_EQ(rapid.exit_code, 1) << rapid.output;
  EXPECT_EQ(at_path(metrics("rapid_out"), "bad_cuts.rapids_in_material"), 1);
  const json findings = json::parse(std::ifstream(root_ / "rapid_out" / "findings.json"));
  ASSERT_EQ(findings.size(), 1U) << rapid.output;
  EXPECT_EQ(at_path(findings, "0.code"), "rapid-cut");
  EXPECT_EQ(at_path(findings, "0.line"), 18);
  EXPECT_EQ(at_path(findings, "0.block"), "GOTO/70,10,-3");
}

TEST_F(TwoTools, TheFirstFindingsOfEachCodeArePrinted) {
  std::string program = "UNITS/MM\nLOADTL/1\nSPINDL/3000,CLW\nFROM/-10,-8,5\n";
  for (int i = 0; i < 7; ++i) {  // seven holes stabbed in rapid
    const int x = 4 + 8 * i;
    program += "RAPID\nGOTO/" + std::to_string(x) + ",-8,5\nRAPID\nGOTO/" + std::to_string(x) +
               ",-8,-4\nRAPID\nGOTO/" + std::to_string(x) + ",-8,5\n";
  }
  write("stabs", scene_text(kTools), program + "FINI\n");
  const auto stabs = run("stabs", "stabs_out");
  EXPECT_EQ(stabs.exit_code, 1) << stabs.output;
  EXPECT_NE(stabs.output.find("and 2 more of rapid-cut in findings.json"), std::string::npos) << stabs.output;
  size_t printed = 0;
  for (size_t at = 0; (at = stabs.output.find("finding: ", at)) != std::string::npos; ++at) ++printed;
  EXPECT_EQ(printed, 5U) << stabs.output;
  EXPECT_EQ(json::parse(std::ifstream(root_ / "stabs_out" / "findings.json")).size(), 7U);
}

TEST_F(TwoTools, SurfaceBlocksTakeOneTool) {
  std::string scene = read_text(SWARF_SOURCE_DIR "/scenes/lin_koren_dome/scene.toml");
  const std::string one = "[cutter]\nnumber = 1";
  scene.replace(scene.find(one), one.size(), kTools + "[[tool]]\nnumber = 9");
  fs::create_directories(root_ / "dome");
  write_text(root_ / "dome" / "scene.toml", scene);
  const auto run = run_swarf("check " + (root_ / "dome" / "scene.toml").string());
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.output.find("planner-needs-one-tool"), std::string::npos) << run.output;
}

}  // namespace

}  // namespace two_tools_test
