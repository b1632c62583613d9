// Post and simulation together, by the shipped program: every row of Tables 1 and 2 of Kruth et al. is
// provoked, answered as the paper says, and free in the simulation of the program that was written.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "support/program_run.h"

namespace avoidance_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const fs::path kScenes = SWARF_SOURCE_DIR "/scenes";

/// What CONTROL has to do about a case.
struct Row {
  const char* name;
  int exit_code;       ///< of swarf run
  double least, most;  ///< by how much the tool has to stand out, mm
  bool moves;          ///< the work is clamped elsewhere
  const char* found;   ///< text of the first attempt's failure, or of the error; "": nothing is met
};

void PrintTo(const Row& row, std::ostream* out) {
  *out << row.name;
}

class TableRow : public testing::TestWithParam<Row> {};

TEST_P(TableRow, IsProvokedAnsweredAndFree) {
  const Row& row = GetParam();
  const fs::path folder = swarf::test::fresh_folder(std::string("avoidance_") + row.name);
  const auto run = swarf::test::run_swarf("run " + (kScenes / "kruth_table1" / row.name).string() +
                                          ".toml -o " + (folder / "run").string() + " --no-render");
  ASSERT_EQ(run.exit_code, row.exit_code) << run.output;
  if (row.exit_code == 2) {
    EXPECT_NE(run.output.find("no-free-program"), std::string::npos) << run.output;
    EXPECT_NE(run.output.find(row.found), std::string::npos) << run.output;
    EXPECT_FALSE(fs::exists(folder / "run"));
    return;
  }
  const json metrics = json::parse(std::ifstream(folder / "run" / "metrics.json"));
  const json& avoidance = metrics.at("avoidance");
  EXPECT_EQ(metrics.at("machine_contacts").at("count"), 0) << run.output;
  EXPECT_EQ(metrics.at("collisions").at("count"), 0) << run.output;
  const json& attempts = avoidance.at("attempts");
  if (*row.found != '\0') {
    ASSERT_TRUE(attempts.front().contains("text")) << attempts.front().dump();
    EXPECT_NE(attempts.front().at("text").get<std::string>().find(row.found), std::string::npos)
        << attempts.front().at("text");
  }
  EXPECT_TRUE(attempts.back().at("free").get<bool>());
  const double extended = avoidance.at("extended_mm").front().get<double>();
  EXPECT_GE(extended, row.least);
  EXPECT_LE(extended, row.most);
  const json& origin = avoidance.at("work_origin_mm");
  const auto scene =
      swarf::test::run_swarf("show --json " + (kScenes / "kruth_table1" / row.name).string() + ".toml");
  bool moved = false;
  for (const json& cell : avoidance.at("map")) moved = moved || cell.at("state") != "valid";
  EXPECT_EQ(row.moves, moved || avoidance.at("map").size() > 1) << origin.dump() << scene.exit_code;
  fs::remove_all(folder);
}

// Rows that A answers have their grids laid so that the scene's own position is not free; where a limit is
// met on the way to the bounds, or the position with the least bound is free at once, no attempt failed
// before.
INSTANTIATE_TEST_SUITE_P(
    Kruth, TableRow,
    testing::Values(Row{"row_01_head_workpiece", 0, 11, 20, false, "ram (milling head) touches stock"},
                    Row{"row_02_head_fixture", 0, 12, 20, false, "ram (milling head) touches post"},
                    Row{"row_03_head_table", 0, 0, 0, true, "rotary_table (table) touches ram"},
                    Row{"row_04_holder_workpiece", 0, 5, 5, false, "into the material"},
                    Row{"row_05_holder_fixture", 0, 7, 15, false, "post (clamping tools) touches holder"},
                    Row{"row_06_holder_table", 0, 0, 0, true, "rotary_table (table) touches holder"},
                    Row{"row_07_cutter_finished_part", 1, 0, 0, false, ""},
                    Row{"row_08_cutter_fixture", 2, 0, 0, false, "stop (clamping tools) touches flutes"},
                    Row{"row_09_cutter_table", 0, 0, 0, true, ""},
                    Row{"row_10_workpiece_structure", 0, 0, 0, true, ""},
                    Row{"row_11_linear_limit", 0, 0, 0, true, "axis X would go to"},
                    Row{"row_12_linear_limit_long_tool", 0, -45, -39, true, "axis Z would go to"},
                    Row{"row_13_rotary_limit", 2, 0, 0, false, "axis B would go to 110"},
                    Row{"path_1_holder_wall", 2, 0, 0, false, "wall (clamping tools) touches holder"},
                    Row{"row_14_tool_load", 0, 0, 0, true, "while the tool is changed"},
                    Row{"table2_1_workpiece_arm", 0, 0, 0, true, ""},
                    Row{"table2_2_head_arm", 0, 0, 0, true, ""},
                    Row{"table2_3_holder_arm", 0, 0, 0, true, ""},
                    Row{"table2_4_cutter_arm", 0, 0, 0, true, "arm (rotating arm) touches flutes"}),
    [](const auto& one) { return one.param.name; });

/// Rows that A answers, at their own position: each is provoked there.
TEST(Avoidance, OwnPositionsOfMovedRowsAreNotFree) {
  const fs::path folder = swarf::test::fresh_folder("avoidance_own");
  for (const std::string row :
       {"row_03_head_table", "row_09_cutter_table", "row_10_workpiece_structure", "row_14_tool_load",
        "table2_1_workpiece_arm", "table2_2_head_arm", "table2_3_holder_arm"}) {
    SCOPED_TRACE(row);
    const auto posted =
        swarf::test::run_swarf("-q post " + (kScenes / "kruth_table1" / row).string() + ".toml -o " +
                               (folder / "part.ngc").string() +
                               " --set \"post.clamping.count=[1, 1, 1]\" --set post.tool_reach.most_mm=0");
    EXPECT_EQ(posted.exit_code, 2) << posted.output;
    EXPECT_NE(posted.output.find("no-free-program"), std::string::npos) << posted.output;
    EXPECT_FALSE(fs::exists(folder / "part.ngc"));
  }
}

/// A pass over the pole that is free in no solution alone: the outer axis turns there (Figure 5.b).
TEST(Avoidance, TurnsAtThePoleWhereOnlyThatHelps) {
  const fs::path folder = swarf::test::fresh_folder("avoidance_pole");
  const auto run =
      swarf::test::run_swarf("run " + (kScenes / "kruth_cylinder/obstacle_one_sided.toml").string() + " -o " +
                             (folder / "run").string() + " --no-render");
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const json avoidance = json::parse(std::ifstream(folder / "run" / "metrics.json")).at("avoidance");
  EXPECT_GT(avoidance.at("ways_refused").get<int>(), 0);
  EXPECT_GT(avoidance.at("pole_turns").get<int>(), 0);
  EXPECT_NEAR(avoidance.at("axes").at("B").at("min_deg").get<double>(), 0.0, 1e-4);
  EXPECT_NEAR(std::fmod(avoidance.at("axes").at("C").at("travel_deg").get<double>(), 180.0), 0.0, 1e-3);
}

/// The proof that swarf post prints is a run that passes.
TEST(Avoidance, PostWritesAProgramAndItsProof) {
  const fs::path folder = swarf::test::fresh_folder("avoidance_post");
  const std::string scene = (kScenes / "kruth_table1/row_05_holder_fixture.toml").string();
  const auto posted = swarf::test::run_swarf(
      "post " + scene + " --dialect fanuc --no-tcp --tolerance-um 5 -o " + (folder / "part.nc").string());
  ASSERT_EQ(posted.exit_code, 0) << posted.output;
  const size_t at = posted.output.find("proof: swarf ");
  ASSERT_NE(at, std::string::npos) << posted.output;
  std::string proof = posted.output.substr(at + 13);
  proof = proof.substr(0, proof.find('\n'));
  const auto run = swarf::test::run_swarf(proof + " --no-render -o " + (folder / "run").string());
  EXPECT_EQ(run.exit_code, 0) << proof << "\n" << run.output;
}

/// CL data without a scene: the machine and the tools alone.
TEST(Avoidance, LooksAtCLDataOnAMachineToo) {
  const fs::path folder = swarf::test::fresh_folder("avoidance_cl");
  swarf::test::write_text(folder / "tools.toml",
                          "[[tool]]\nnumber = 1\ndiameter_mm = 10\nflute_length_mm = 60\nlength_mm = 90\n");
  const std::string words = "post " + (kScenes / "kruth_table1/row_05_holder_fixture.cl").string() +
                            " --machine maho_600c --tools " + (folder / "tools.toml").string() + " -o " +
                            (folder / "part.nc").string();
  const auto free = swarf::test::run_swarf(words + " --avoid --work-origin 0 0 20 --json 2>/dev/null");
  ASSERT_EQ(free.exit_code, 0) << free.output;
  EXPECT_TRUE(json::parse(free.output).at("avoidance").at("found").get<bool>());
  const auto inside = swarf::test::run_swarf(words + " --avoid --work-origin 0 0 -60");
  EXPECT_EQ(inside.exit_code, 2) << inside.output;
}

/// Only the path helps: the changed CL data, their program, and the run that proves both.
TEST(Avoidance, FixesThePathWhereNothingElseHelps) {
  const fs::path folder = swarf::test::fresh_folder("avoidance_fix");
  const fs::path cl = kScenes / "kruth_table1/row_13_rotary_limit.cl";
  const std::string scene = (kScenes / "kruth_table1/row_13_rotary_limit.toml").string();
  const std::string out =
      " --fix " + (folder / "freed.cl").string() + " -o " + (folder / "part.ngc").string();
  const auto posted = swarf::test::run_swarf("post " + scene + out);
  ASSERT_EQ(posted.exit_code, 0) << posted.output;
  EXPECT_NE(posted.output.find("CL line 9: tilt +10.00"), std::string::npos) << posted.output;
  const std::string before = swarf::test::read_text(cl), after = swarf::test::read_text(folder / "freed.cl");
  EXPECT_EQ(std::count(before.begin(), before.end(), '\n'), std::count(after.begin(), after.end(), '\n'));
  const size_t at = posted.output.find("proof: swarf ");
  ASSERT_NE(at, std::string::npos) << posted.output;
  std::string proof = posted.output.substr(at + 13);
  proof = proof.substr(0, proof.find('\n'));
  const auto run = swarf::test::run_swarf(proof + " --no-render -o " + (folder / "run").string());
  EXPECT_EQ(run.exit_code, 0) << proof << "\n" << run.output;
}

/// Nothing is written, or left, where no change helps.
TEST(Avoidance, FixLeavesNothingWhereItDoesNotHelp) {
  const fs::path folder = swarf::test::fresh_folder("avoidance_no_fix");
  const std::string scene = (kScenes / "kruth_table1/row_13_rotary_limit.toml").string();
  const auto refused = [&](const std::string& words, const std::string& code) {
    const auto run = swarf::test::run_swarf("post " + words);
    EXPECT_EQ(run.exit_code, 2) << run.output;
    EXPECT_NE(run.output.find(code), std::string::npos) << run.output;
    EXPECT_FALSE(fs::exists(folder / "freed.cl"));
    EXPECT_FALSE(fs::exists(folder / "part.ngc"));
  };
  const std::string out =
      " --fix " + (folder / "freed.cl").string() + " -o " + (folder / "part.ngc").string();
  // Drills stand in cycles: their place is not the post's to change.
  std::string cl = swarf::test::read_text(kScenes / "kruth_table1/row_13_rotary_limit.cl");
  cl.replace(cl.find("FEDRAT/400,MMPM\n"), 16, "CYCLE/DRILL,DEPTH,1,CLEAR,2,MMPM,100\n");
  cl.replace(cl.rfind("RAPID\n"), 6, "CYCLE/OFF\nFEDRAT/400,MMPM\n");
  swarf::test::write_text(folder / "holes.cl", cl);
  refused(scene + out + " --set cl=" + (folder / "holes.cl").string(), "no-fix");
  refused((kScenes / "kruth_table1/row_13_rotary_limit.cl").string() + " --machine maho_600c" + out,
          "needs-scene");
  swarf::test::write_text(folder / "own.cl",
                          swarf::test::read_text(kScenes / "kruth_table1/row_13_rotary_limit.cl"));
  const auto own =
      swarf::test::run_swarf("post " + scene + " --set cl=" + (folder / "own.cl").string() + " --fix " +
                             (folder / "own.cl").string() + " -o " + (folder / "part.ngc").string());
  EXPECT_EQ(own.exit_code, 2) << own.output;
  EXPECT_NE(own.output.find("output-is-input"), std::string::npos) << own.output;
}

TEST(Avoidance, RefusesWhatItCannotMean) {
  const fs::path folder = swarf::test::fresh_folder("avoidance_bad");
  const std::string scene = (kScenes / "kruth_table1/row_03_head_table.toml").string();
  const auto refused = [&](const std::string& words, const std::string& code) {
    const auto run = swarf::test::run_swarf(words);
    EXPECT_EQ(run.exit_code, 2) << run.output;
    EXPECT_NE(run.output.find(code), std::string::npos) << run.output;
  };
  const std::string out = " -o " + (folder / "part.nc").string();
  refused("post " + scene + out + " --set \"post.clamping.count=[0, 1, 1]\"", "empty-grid");
  refused("post " + scene + out + " --machine maho_600c", "flags-and-scene");
  refused("post " + scene + " -o -", "two-outputs");
  refused("post " + scene + out + " --set post.words=nobody", "unknown-post");
  refused("post " + (kScenes / "nc_pocket/scene.toml").string() + out, "post-needs-cl");
  refused("post " + (kScenes / "kruth_table1/row_03_head_table.cl").string() + out, "option-missing");
  std::string cl = swarf::test::read_text(kScenes / "kruth_table1/row_03_head_table.cl");
  cl.erase(cl.find("LOADTL/1\n"), 9);
  swarf::test::write_text(folder / "bare.cl", cl);
  refused("post " + scene + out + " --set cl=" + (folder / "bare.cl").string(), "tool-not-loaded");
}

}  // namespace
}  // namespace avoidance_test
