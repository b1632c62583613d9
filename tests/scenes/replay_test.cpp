// swarf run --record and swarf replay on the shipped program.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sim/run/cut_record.h"
#include "support/json_path.h"
#include "support/program_run.h"

namespace replay_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using swarf::test::at_path;
using swarf::test::read_text;
using swarf::test::run_swarf;
using swarf::test::write_text;

const fs::path kFolder = SWARF_SOURCE_DIR "/scenes/lin_koren_dome";
const std::string kCoarse = std::string(swarf::test::kSoonProven) +
                            " --set stock.voxel_mm=1 --set toolpath.compare=false --set design.pitch_mm=1 "
                            "--set 'interpolator.period_ms=4' ";

/// The surface machined twice, so that one word of the second line can be changed: its scallop height E.
void copy_scene(const fs::path& to, const std::string& second_scallop) {
  fs::create_directories(to);
  std::string program = read_text(kFolder / "dome.nc");
  const size_t at = program.find("N110");
  const size_t end = program.find('\n', at) + 1;
  std::string again = program.substr(at, end - at);
  again.replace(0, 4, "N115");
  again.replace(again.find("E0.010"), 6, second_scallop);
  program.insert(end, again);
  write_text(to / "dome.nc", program);
  std::string scene = read_text(kFolder / "scene.toml");
  const std::string machine = "../../assets";
  scene.replace(scene.find(machine), machine.size(), SWARF_SOURCE_DIR "/assets");
  write_text(to / "scene.toml", scene);
}

/// What --json printed; progress on stderr stands before it.
json json_in(const swarf::test::ProgramRun& run) {
  const size_t begin = run.output.find("{\n");
  return json::parse(begin == std::string::npos ? "" : run.output.substr(begin), nullptr, false);
}

class ReplayRun : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    root_ = swarf::test::fresh_folder("replay");
    copy_scene(root_ / "a", "E0.010");
    run_ = run_swarf("run " + (root_ / "a/scene.toml").string() + kCoarse + "--no-render --record -o " +
                     (root_ / "out").string());
  }
  static void TearDownTestSuite() { fs::remove_all(root_); }
  static std::string record() { return (root_ / "out/run.record").string(); }
  static json replayed(const std::string& options, int exit_code) {
    const auto run = run_swarf("replay " + record() + " --json " + options);
    EXPECT_EQ(run.exit_code, exit_code) << run.output;
    return json_in(run);
  }
  static void expect_refused(const swarf::test::ProgramRun& run, const std::string& code) {
    EXPECT_EQ(run.exit_code, 2) << run.output;
    EXPECT_NE(run.output.find("[" + code + "]"), std::string::npos) << run.output;
    EXPECT_NE(run.output.find("fix: "), std::string::npos) << run.output;
  }
  static fs::path root_;
  static swarf::test::ProgramRun run_;
};
fs::path ReplayRun::root_;
swarf::test::ProgramRun ReplayRun::run_;

TEST_F(ReplayRun, OfTheSameSceneIsEqualForAnyThreads) {
  ASSERT_LE(run_.exit_code, 1) << run_.output;
  for (const char* threads : {"1", "2", "4"}) {
    const json result = replayed(std::string("--threads ") + threads, 0);
    EXPECT_EQ(result.at("equal"), true);
    EXPECT_EQ(result.at("same_motion"), true);
    EXPECT_GT(result.at("states"), 5);
  }
}

TEST_F(ReplayRun, AlteredStateIsFoundInItsInterval) {
  // As if another machine had cut otherwise: the motion is the same, the third hash is not.
  swarf::sim::CutRecord altered = swarf::sim::read_record(record());
  altered.states.at(2) ^= 1;
  const std::string other = (root_ / "altered.record").string();
  swarf::sim::write_record(other, altered);
  const auto run = run_swarf("replay " + other + " --json");
  EXPECT_EQ(run.exit_code, 1) << run.output;
  const json result = json_in(run);
  EXPECT_EQ(result.at("same_motion"), true);
  EXPECT_EQ(at_path(result, "difference.exact"), false);
  EXPECT_EQ(at_path(result, "difference.first_sweep"), 2 * 256 + 1);
  EXPECT_EQ(at_path(result, "difference.last_sweep"), 3 * 256);
}

TEST_F(ReplayRun, ChangedWordIsFoundAtItsBlock) {
  copy_scene(root_ / "b", "E0.007");
  // The oracle: both runs with a hash after every single sweep.
  std::vector<std::vector<uint64_t>> states;
  for (const char* scene : {"a", "b"}) {
    const fs::path out = root_ / (std::string("every_") + scene);
    const auto run = run_swarf("run " + (root_ / scene / "scene.toml").string() + kCoarse +
                               "--no-render --record --record-every 1 -o " + out.string());
    ASSERT_LE(run.exit_code, 1) << run.output;
    states.push_back(swarf::sim::read_record((out / "run.record").string()).states);
  }
  size_t first = 0;
  while (states[0].at(first) == states[1].at(first)) ++first;
  const json result = replayed("--scene " + (root_ / "b/scene.toml").string() + kCoarse, 1);
  EXPECT_EQ(result.at("same_motion"), false);
  EXPECT_EQ(at_path(result, "parts.0.name"), "program");
  EXPECT_EQ(at_path(result, "difference.exact"), true);
  EXPECT_EQ(at_path(result, "difference.first_sweep"), first + 1);
  EXPECT_EQ(at_path(result, "difference.now.line"), 14);  // the line of the changed word
}

TEST_F(ReplayRun, ChangedSweepToleranceIsFoundExactly) {
  const json result = replayed(
      "--scene " + (root_ / "a/scene.toml").string() + kCoarse + "--set stock.sweep_tolerance_um=20", 1);
  EXPECT_EQ(at_path(result, "difference.exact"), true);
  EXPECT_EQ(at_path(result, "parts.0.name"), "stock.sweep_tolerance_um");
}

TEST_F(ReplayRun, ChangedSceneIsRefusedUnlessNamed) {
  std::string scene = read_text(root_ / "a/scene.toml");
  const std::string kept = scene;
  scene.replace(scene.find("diameter_mm = 10"), 16, "diameter_mm = 9");
  write_text(root_ / "a/scene.toml", scene);
  expect_refused(run_swarf("replay " + record()), "record-other-stock");
  write_text(root_ / "a/scene.toml", kept);
  const auto run = run_swarf("replay " + record() + " --scene " + kFolder.string() +
                             "/scene.toml --set stock.voxel_mm=0.4 --set toolpath.compare=false");
  expect_refused(run, "record-other-stock");
}

TEST_F(ReplayRun, BrokenRecordsAreRefused) {
  const fs::path bad = root_ / "bad.record";
  const std::string good = read_text(record());
  expect_refused(run_swarf("replay " + (root_ / "none.record").string()), "record-unreadable");
  expect_refused(run_swarf("replay " + root_.string()), "record-unreadable");
  write_text(bad, "");
  expect_refused(run_swarf("replay " + bad.string()), "record-foreign");
  write_text(bad, "O0001\n");
  expect_refused(run_swarf("replay " + bad.string()), "record-foreign");
  write_text(bad, good.substr(0, good.size() / 2));
  expect_refused(run_swarf("replay " + bad.string()), "record-incomplete");
  write_text(bad, good.substr(0, good.size() - 1));
  expect_refused(run_swarf("replay " + bad.string()), "record-incomplete");
  for (const size_t at : {good.size() / 3, good.size() / 2, good.size() - 30}) {
    std::string damaged = good;
    damaged[at] = damaged[at] == '1' ? '2' : '1';
    write_text(bad, damaged);
    expect_refused(run_swarf("replay " + bad.string()), "record-damaged");
  }
}

}  // namespace

}  // namespace replay_test
