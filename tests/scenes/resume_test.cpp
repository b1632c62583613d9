// Stocks in process on the shipped program: saved, stopped with Ctrl-C, resumed, refused.
#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "support/json_path.h"
#include "support/program_run.h"

namespace resume_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using swarf::test::at_path;
using swarf::test::read_text;
using swarf::test::run_swarf;
using swarf::test::write_text;

const std::string kScene = SWARF_SOURCE_DIR "/scenes/lin_koren_dome/scene.toml";
const std::string kQuick = std::string(" --no-render --set toolpath.compare=false --set design.pitch_mm=1 ") +
                           swarf::test::kSoonProven;
const std::string kCoarse = kQuick + "--set stock.voxel_mm=0.5 --set interpolator.period_ms=4 ";

json metrics_of(const fs::path& folder) {
  return json::parse(std::ifstream(folder / "metrics.json"));
}
std::string hash_of(const fs::path& folder) {
  return at_path(metrics_of(folder), "stock.hash");
}

class Resume : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    root_ = swarf::test::fresh_folder("resume");
    run_ =
        run_swarf("run " + kScene + kCoarse + "--save-stock-after 1.5s,60s -o " + (root_ / "full").string());
  }
  static void TearDownTestSuite() { fs::remove_all(root_); }
  static swarf::test::ProgramRun go_on(const fs::path& stock, const std::string& more = kCoarse) {
    fs::remove_all(root_ / "on");
    return run_swarf("run " + kScene + more + "--from " + stock.string() + " -o " + (root_ / "on").string());
  }
  static fs::path saved() { return root_ / "full" / "stock_after_60s.vdb"; }
  static void expect_refused(const swarf::test::ProgramRun& run, const std::string& code) {
    EXPECT_EQ(run.exit_code, 2) << run.output;
    EXPECT_NE(run.output.find("[" + code + "]"), std::string::npos) << run.output;
    EXPECT_NE(run.output.find("fix: "), std::string::npos) << run.output;
    EXPECT_FALSE(fs::exists(root_ / "on"));
  }

  static fs::path root_;
  static swarf::test::ProgramRun run_;
};
fs::path Resume::root_;
swarf::test::ProgramRun Resume::run_;

TEST_F(Resume, EndsWithTheHashAndTheMeasuresOfTheUninterruptedRun) {
  ASSERT_EQ(run_.exit_code, 0) << run_.output;
  const json whole = metrics_of(root_ / "full");
  const std::vector<std::pair<std::string, std::string>> cases{
      {"stock_after_1.5s.vdb", "1"}, {"stock_after_60s.vdb", "2"}, {"stock.vdb", "4"}};
  for (const auto& [file, threads] : cases) {
    const auto run = go_on(root_ / "full" / file, kCoarse + "--threads " + threads + " ");
    ASSERT_EQ(run.exit_code, 0) << run.output;
    const json resumed = metrics_of(root_ / "on");
    EXPECT_EQ(at_path(resumed, "stock.hash"), at_path(whole, "stock.hash")) << file << " " << threads;
    EXPECT_EQ(resumed.at("surface"), whole.at("surface"));
    EXPECT_EQ(resumed.at("collisions"), whole.at("collisions"));
    for (const char* volume : {"stock.volume_removed_mm3", "stock.volume_left_mm3"}) {
      EXPECT_EQ(at_path(resumed, volume), at_path(whole, volume)) << volume;
    }
    EXPECT_GT(at_path(resumed, "stock.blocks_resumed").get<int>(), 0);
  }
}

TEST_F(Resume, SavedStockOpensInOpenVdbAndSaysWhatItIs) {
  openvdb::initialize();
  openvdb::io::File file(saved().string());
  file.open();
  const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("stock"));
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->getGridClass(), openvdb::GRID_LEVEL_SET);
  EXPECT_EQ(grid->metaValue<std::string>("swarf_scene"), "lin_koren_dome");
  EXPECT_EQ(grid->metaValue<std::string>("swarf_program_line"), "13");
  EXPECT_NEAR(std::stod(grid->metaValue<std::string>("swarf_time_s")), 60.0, 0.5);
  EXPECT_NE(grid->metaValue<std::string>("swarf_part_cutter").find("flat, D 10 mm"), std::string::npos);
}

TEST_F(Resume, ProgramLineNamesTheLastMotionOfTheLine) {
  const fs::path out = root_ / "line";
  const auto run = run_swarf("run " + kScene + kCoarse + "--save-stock-after 13 -o " + out.string());
  ASSERT_EQ(run.exit_code, 0) << run.output;
  // Line 13 is the only one that moves: the stock after it is the finished one.
  ASSERT_EQ(go_on(out / "stock_after_line_13.vdb").exit_code, 0);
  EXPECT_EQ(metrics_of(root_ / "on").at("stock").at("blocks"), 0);
  EXPECT_EQ(hash_of(root_ / "on"), hash_of(root_ / "full"));
}

TEST_F(Resume, ChangedSceneIsRefusedAndNamed) {
  struct Change {
    const char *set, *names;
  };
  for (const Change& change : {Change{"stock.voxel_mm=0.6", "another stock.voxel_mm: 0.5; the scene has 0.6"},
                               Change{"'stock.box_mm=[[-50,-40,-20],[50,40,38]]'", "another stock.box_mm"},
                               Change{"stock.sweep_tolerance_um=2", "another stock.sweep_tolerance_um: 1;"},
                               Change{"cutter.diameter_mm=9", "another cutter"},
                               Change{"toolpath.planner=lin_koren", "another toolpath"},
                               Change{"interpolator.period_ms=2", "another interpolator"}}) {
    const auto run = go_on(saved(), kCoarse + "--set " + change.set + " ");
    expect_refused(run, "resume-scene-changed");
    EXPECT_NE(run.output.find(change.names), std::string::npos) << run.output;
  }
}

TEST_F(Resume, ChangedProgramIsRefused) {
  const fs::path copy = root_ / "copy";
  fs::create_directories(copy);
  std::string program = read_text(SWARF_SOURCE_DIR "/scenes/lin_koren_dome/dome.nc");
  program.replace(program.find("F3000"), 5, "F2900");
  write_text(copy / "dome.nc", program);
  const auto run = go_on(saved(), kCoarse + "--set 'program=\"" + (copy / "dome.nc").string() + "\"' ");
  expect_refused(run, "resume-scene-changed");
  EXPECT_NE(run.output.find("another program"), std::string::npos) << run.output;
}

TEST_F(Resume, WhatIsNoStockIsRefused) {
  const fs::path bad = root_ / "bad.vdb";
  expect_refused(go_on(bad), "stock-file-unreadable");
  fs::create_directory(bad);
  expect_refused(go_on(bad), "stock-file-unreadable");
  fs::remove(bad);
  write_text(bad, "");
  expect_refused(go_on(bad), "stock-file-empty");
  write_text(bad, "O0001\nM30\n");
  expect_refused(go_on(bad), "stock-file-foreign");
  const std::string whole = read_text(saved());
  write_text(bad, whole.substr(0, whole.size() / 2));
  expect_refused(go_on(bad), "stock-file-incomplete");
  std::string damaged = whole;
  damaged[whole.size() / 2] ^= 1;
  write_text(bad, damaged);
  expect_refused(go_on(bad), "stock-file-damaged");
  openvdb::initialize();
  const auto fog = openvdb::FloatGrid::create(0.0F);
  fog->setGridClass(openvdb::GRID_FOG_VOLUME);
  openvdb::io::File(bad.string()).write(openvdb::GridPtrVec{fog});
  expect_refused(go_on(bad), "stock-not-level-set");
}

TEST_F(Resume, PlacesThatDoNotExistAreRefused) {
  const auto with = [](const std::string& options) {
    fs::remove_all(root_ / "on");
    return run_swarf("run " + kScene + kCoarse + options + " -o " + (root_ / "on").string());
  };
  const auto line = with("--save-stock-after 12");
  expect_refused(line, "place-unknown");
  EXPECT_NE(line.output.find("nearest line with motion is 13"), std::string::npos) << line.output;
  expect_refused(with("--save-stock-after 5000s"), "place-unknown");
  expect_refused(with("--save-stock-after N13"), "bad-place");
  expect_refused(with("--save-stock-after 13,"), "bad-place");
  expect_refused(with("--from " + saved().string() + " --save-stock-after 1.5s"), "place-before-resume");
}

TEST_F(Resume, ExpensiveChecksHold) {
  const fs::path out = root_ / "checked";
  const auto run = run_swarf("run " + kScene + kCoarse + "--check -o " + out.string());
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_GE(at_path(metrics_of(out), "self_checks.stock_voxels").get<int>(), 8);
  EXPECT_EQ(at_path(metrics_of(out), "self_checks.stock_broken"), "");
  EXPECT_EQ(hash_of(out), hash_of(root_ / "full"));
}

TEST_F(Resume, CtrlCSavesTheStockOfThatMoment) {
  // One sweep per cycle makes the cut last some seconds.
  const std::string slow = kQuick + "--set stock.voxel_mm=0.25 --set stock.sweep_tolerance_um=0.001 ";
  const fs::path out = root_ / "stopped", log = root_ / "stopped.log";
  // One Ctrl-C may come twice, to the process and to its group.
  // The shell reports the program's own exit code; the program is told once it has begun to cut.
  const std::string script =
      std::string(SWARF_PROGRAM) + " run " + kScene + slow + "-o " + out.string() + " > " + log.string() +
      " 2>&1 & pid=$!; for i in $(seq 600); do grep -q 'memory: stock' " + log.string() +
      " && break; sleep 0.1; done; sleep 0.5; kill -INT $pid; sleep 0.05; kill -INT $pid; wait $pid";
  const int status = std::system(script.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 130) << read_text(log);
  const std::string said = read_text(log);
  ASSERT_NE(said.find("go on with: swarf run "), std::string::npos) << said;
  EXPECT_NE(said.find("--from " + (out / "stock.vdb").string()), std::string::npos) << said;
  const size_t at = said.find("stopped: ");
  size_t cut = 0, all = 0;
  ASSERT_EQ(std::sscanf(said.c_str() + at, "stopped: %zu of %zu", &cut, &all), 2) << said;
  EXPECT_GT(cut, 0U);
  EXPECT_LT(cut, all);
  for (const std::string& later :
       {"export " + out.string() + " --vdb " + (root_ / "again.vdb").string(),
        "compare " + (out / "stock.vdb").string() + " " + (root_ / "none.stl").string()})
    EXPECT_NE(run_swarf(later).output.find("[run-stopped]"), std::string::npos) << later;
  const auto on = go_on(out / "stock.vdb", slow);
  ASSERT_EQ(on.exit_code, 0) << on.output;
  const auto whole = run_swarf("run " + kScene + slow + "-o " + out.string());
  ASSERT_EQ(whole.exit_code, 0) << whole.output;
  EXPECT_EQ(hash_of(root_ / "on"), hash_of(out));
}

}  // namespace

}  // namespace resume_test
