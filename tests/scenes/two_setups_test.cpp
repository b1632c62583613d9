// Several set-ups of one part, on the shipped program: what a later one begins with is what the earlier ones
// have left, to the bit where the frames are one.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/json_path.h"
#include "support/program_run.h"

namespace two_setups_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using swarf::test::at_path;
using swarf::test::run_swarf;
using swarf::test::write_text;

/// A slot 6 wide, along X or Y, out of any stock of 40 mm.
std::string slot(const std::string& axis, int depth) {
  const std::string other = axis == "X" ? "Y" : "X";
  return "G21 G17 G90 G94 G54\nT1 M6\nS8000 M3\nG0 " + axis + "-30 " + other + "0\nZ5\nG1 Z-" +
         std::to_string(depth) + " F2000\n" + axis + "30\nG0 Z20\nM5\nM2\n";
}

const char* const kHead =
    "nc = \"first.ngc\"\ndialect = \"linuxcnc\"\ntools = \"T1=6\"\nmachine = \"mill_3axis\"\n"
    "[movie]\nseconds = 0\n";
const char* const kBlock = "[stock]\nvoxel_mm = 0.4\nbox_mm = [[-20, -20, -15], [20, 20, 0]]\n";
const char* const kClamped = "work_origin_mm = \"on_table\"\nwithout_length = \"tip\"\n";
const char* const kTurned = "part_pose = { position_mm = [0, 0, -15], rotation_deg = [180, 0, 0] }\n";

std::string setups(const std::string& first, const std::string& second) {
  return std::string(kHead) + kBlock + "[[setup]]\n" + kClamped + first + "[[setup]]\nnc = \"second.ngc\"\n" +
         kClamped + second;
}

fs::path folder_with(const std::string& name, const std::string& scene) {
  const fs::path folder = swarf::test::fresh_folder("setups_" + name);
  write_text(folder / "first.ngc", slot("X", 5));
  write_text(folder / "second.ngc", slot("Y", 7));
  write_text(folder / "scene.toml", scene);
  return folder;
}

swarf::test::ProgramRun run_in(const fs::path& folder, const std::string& more = "",
                               const std::string& scene = "scene.toml", const std::string& out = "out") {
  return run_swarf("run " + (folder / scene).string() + " --no-render -q -o " + (folder / out).string() +
                   " " + more);
}

json read(const fs::path& file) {
  return json::parse(std::ifstream(file));
}
double number(const json& metrics, const char* path) {
  return at_path(metrics, path).get<double>();
}
std::string text(const json& metrics, const char* path) {
  return at_path(metrics, path).get<std::string>();
}

TEST(TwoSetups, SlotsFromOppositeSidesHaveTheirVolumeInClosedForm) {
  const fs::path folder = folder_with("opposite", setups("name = \"First side\"\n", kTurned));
  const auto run = run_in(folder);
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const json list = read(folder / "out/setups.json");
  EXPECT_TRUE(list.at("passes").get<bool>());
  const json first = read(folder / "out/1_first_side/metrics.json"),
             second = read(folder / "out/2_setup/metrics.json");
  const double block = 40.0 * 40.0 * 15.0, along_x = 40.0 * 6.0 * 5.0, along_y = 40.0 * 6.0 * 7.0;
  const auto near = [](const json& metrics, const char* path, double value) {
    EXPECT_LE(std::abs(number(metrics, path) - value), number(metrics, "stock.volume_error_bound_mm3"))
        << path;
    EXPECT_NEAR(number(metrics, path), value, 3e-3 * value) << path;
  };
  near(first, "stock.volume_removed_mm3", along_x);
  near(second, "stock.volume_removed_mm3", along_y);
  near(second, "stock.volume_left_mm3", block - along_x - along_y);
  EXPECT_EQ(list.at("finished")[1].at("stock_start_hash"), at_path(second, "stock.start_hash"));
  EXPECT_EQ(list.at("finished")[0].at("stock_hash"), at_path(first, "stock.hash"));
  // Each folder stands for itself, with the inputs of what was cut before it.
  fs::remove(folder / "first.ngc");
  const auto still = run_swarf("render " + (folder / "out/2_setup").string() +
                               " --kind machine --size 64 64 --still " + (folder / "machine.png").string());
  EXPECT_EQ(still.exit_code, 0) << still.output;
  fs::remove_all(folder);
}

TEST(TwoSetups, ThatDoNotTurnThePartHandItOnToTheBit) {
  const fs::path folder = folder_with("same", setups("", ""));
  const auto run = run_in(folder, "--threads 1");
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const json first = read(folder / "out/1_setup/metrics.json"),
             second = read(folder / "out/2_setup/metrics.json");
  EXPECT_EQ(text(second, "stock.start_hash"), text(first, "stock.hash"));
  EXPECT_NE(text(second, "stock.hash"), text(first, "stock.hash"));
  // It is an assumption, and said.
  const auto loud = run_swarf("run " + (folder / "scene.toml").string() + " --no-render -o " +
                              (folder / "loud").string() + " --threads 2");
  EXPECT_NE(loud.output.find("not turned"), std::string::npos) << loud.output;
  EXPECT_EQ(text(read(folder / "loud/2_setup/metrics.json"), "stock.hash"), text(second, "stock.hash"));
  // One program that does both leaves the same bits.
  write_text(folder / "both.ngc",
             slot("X", 5).substr(0, slot("X", 5).find("M5")) + slot("Y", 7).substr(slot("Y", 7).find("G0")));
  write_text(folder / "one.toml",
             "nc = \"both.ngc\"\n" + std::string(kHead).substr(17) + kBlock + "[setup]\n" + kClamped);
  const auto one = run_in(folder, "", "one.toml", "one");
  ASSERT_EQ(one.exit_code, 0) << one.output;
  EXPECT_EQ(text(read(folder / "one/metrics.json"), "stock.hash"), text(second, "stock.hash"));
  fs::remove_all(folder);
}

TEST(TwoSetups, AreTheSameAsASceneThatBeginsWithARun) {
  const fs::path folder = folder_with("from_run", setups("", kTurned));
  ASSERT_EQ(run_in(folder).exit_code, 0);
  const std::string whole = text(read(folder / "out/2_setup/metrics.json"), "stock.hash");
  write_text(folder / "first.toml", std::string(kHead) + kBlock + "[setup]\n" + kClamped);
  ASSERT_EQ(run_in(folder, "", "first.toml", "one").exit_code, 0);
  const std::string pose = "_pose = { position_mm = [0, 0, -15], rotation_deg = [180, 0, 0] }\n";
  const auto from = [&](const char* name, const std::string& run) {
    write_text(folder / name, "nc = \"second.ngc\"\n" + std::string(kHead).substr(17) +
                                  "[stock]\nvoxel_mm = 0.4\nfrom_run = \"" + run + "\"\nfrom_run" + pose +
                                  "[setup]\n" + kClamped);
  };
  from("second.toml", "one");
  const auto second = run_in(folder, "", "second.toml", "two");
  ASSERT_EQ(second.exit_code, 0) << second.output;
  EXPECT_EQ(text(read(folder / "two/metrics.json"), "stock.hash"), whole);
  // A third begins with both; each folder holds what it is made of.
  from("third.toml", "two/stock.vdb");
  fs::remove_all(folder / "one");
  const auto third = run_in(folder, "", "third.toml", "three");
  ASSERT_EQ(third.exit_code, 0) << third.output;
  EXPECT_EQ(at_path(read(folder / "three/metrics.json"), "stock.earlier.cut").size(), 2U);
  // Inputs that are no longer those of the run are found, for its stock says what has cut it.
  write_text(folder / "two/input/program/second.ngc", slot("Y", 6));
  const auto changed = run_in(folder, "", "third.toml", "three");
  EXPECT_EQ(changed.exit_code, 2);
  EXPECT_NE(changed.output.find("from-run-differs"), std::string::npos) << changed.output;
  fs::remove_all(folder);
}

const char* const kLedge = SWARF_SOURCE_DIR "/scenes/two_setups/scene.toml";

TEST(TwoSetups, AWrongPoseIsFoundBelowAndAboveTheDesign) {
  const fs::path folder = swarf::test::fresh_folder("setups_pose");
  // So much higher the ledge of the first set-up lies than it shall: it looks down.
  for (const auto& [z, code] : {std::pair{-24.99, "gouge"}, std::pair{-25.01, "excess"}}) {
    const auto run =
        run_swarf(std::string("run ") + kLedge + " --no-render -q -o " + (folder / "out").string() +
                  " --set setup[1].part_pose.position_mm=[0,0," + std::to_string(z) + "]");
    EXPECT_EQ(run.exit_code, 1) << run.output;
    const json metrics = read(folder / "out/2_turned_over/metrics.json");
    const std::string value = std::string("surface.") + code + "_max_um";
    EXPECT_NEAR(number(metrics, value.c_str()), 10.0, 1e-3) << z;
    const std::string findings = swarf::test::read_text(folder / "out/2_turned_over/findings.json");
    EXPECT_NE(findings.find("it was cut in set-up 1, first side"), std::string::npos) << findings;
  }
  fs::remove_all(folder);
}

TEST(TwoSetups, AFirstOneThatFailsDoesNotStopTheSecond) {
  const fs::path folder = folder_with("fails", setups("", kTurned));
  write_text(folder / "first.ngc",
             "G21 G17 G90 G94 G54\nT1 M6\nS8000 M3\nG0 X-30 Y0\nZ-5\nX0\nG1 X30 F2000\nG0 Z20\nM5\nM2\n");
  const auto run = run_in(folder);
  EXPECT_EQ(run.exit_code, 1) << run.output;
  const json list = read(folder / "out/setups.json");
  EXPECT_FALSE(list.at("passes").get<bool>());
  EXPECT_FALSE(list.at("finished")[0].at("passes").get<bool>());
  EXPECT_TRUE(list.at("finished")[1].at("passes").get<bool>()) << list;
  EXPECT_NE(run.output.find("1 of 2 set-ups pass"), std::string::npos) << run.output;
  fs::remove_all(folder);
}

TEST(TwoSetups, UpToOneOfThem) {
  const fs::path folder = folder_with("up_to", setups("", kTurned));
  const auto run = run_in(folder, "--setup 1");
  EXPECT_EQ(run.exit_code, 1) << run.output;
  EXPECT_NE(run.output.find("NOT JUDGED: 1 of 2 set-ups pass; 1 not run"), std::string::npos) << run.output;
  EXPECT_EQ(run.output.find("PASS: 1 of 2"), std::string::npos) << run.output;
  EXPECT_TRUE(read(folder / "out/setups.json").at("passes").is_null()) << "nobody knows of the second";
  EXPECT_FALSE(fs::exists(folder / "out/2_setup"));
  // All of them replace it whole, and are one JSON.
  const auto all =
      run_swarf("run " + (folder / "scene.toml").string() + " --no-render -q --json --no-progress -o " +
                (folder / "out").string() + " 2>/dev/null");
  EXPECT_EQ(json::parse(all.output).at("finished").size(), 2U) << all.output;
  const auto picture =
      run_swarf("show " + (folder / "scene.toml").string() + " --setup 2 -o " + (folder / "a.png").string());
  EXPECT_EQ(picture.exit_code, 0) << picture.output;
  const auto checked = run_swarf("check " + (folder / "scene.toml").string());
  EXPECT_EQ(checked.exit_code, 0) << checked.output;
  EXPECT_NE(checked.output.find("set-up 2: scene is right"), std::string::npos) << checked.output;
  fs::remove_all(folder);
}

TEST(TwoSetups, FixturesStandWhereTheFirstOneHasCut) {
  // Along the slot of the first set-up, which now opens downwards: its middle is free up to Z -10.
  const auto fixture = [](double top) {
    return "[[setup.fixture]]\nkind = \"box\"\non = \"part\"\nbox_mm = [[-15, -2, -115], [15, 2, " +
           std::to_string(top) + "]]\n";
  };
  const fs::path folder = folder_with("fixture", setups("", kTurned + fixture(-10.5)));
  const auto free = run_in(folder);
  EXPECT_EQ(free.exit_code, 0) << free.output;
  write_text(folder / "scene.toml", setups("", kTurned + fixture(-9.0)));
  const auto inside = run_in(folder);
  EXPECT_EQ(inside.exit_code, 2) << inside.output;
  EXPECT_NE(inside.output.find("fixture-in-part"), std::string::npos) << inside.output;
  EXPECT_NE(inside.output.find("1.000 mm inside the stock"), std::string::npos) << inside.output;
  EXPECT_TRUE(fs::exists(folder / "out.incomplete/1_setup/metrics.json")) << "what was finished is kept";
  fs::remove_all(folder);
}

struct BadSetups {
  const char *name, *first, *second, *code, *words;
};

TEST(TwoSetups, WhatIsNoListOfThemIsRefusedWithItsPlace) {
  const std::vector<BadSetups> cases{
      {"two_stocks", "", "[setup.stock]\nmesh = \"a.stl\"\n", "two-stocks", "scene.toml:"},
      {"pose_of_first", "part_pose = { position_mm = [0, 0, 1] }\n", "", "part-pose-of-first",
       "scene.toml:1"},
      {"pose_of_two", "", "part_pose = { position_mm = [0, 0] }\n", "wrong-type", "position_mm"},
      {"not_rigid", "", "part_pose = { scale = 2 }\n", "unknown-key", "setup.part_pose.scale"},
      {"not_finite", "", "part_pose = { rotation_deg = [inf, 0, 0] }\n", "wrong-type", "rotation_deg"},
      {"two_programs", "", "cl = \"a.cls\"\n", "two-programs", "scene.toml:"},
      {"unknown", "", "part_pos = 1\n", "unknown-key", "part_pos"},
      {"itself", "", "setup = 1\n", "unknown-key", "setup.setup"},
      {"no_file", "", "machine = \"no_such_machine\"\n", "unknown-machine", "scene.toml:"},
      {"cut_away", "", "part_pose = { position_mm = [0, 0, 500] }\n", "path-misses-stock",
       "setup.part_pose"}};
  for (const BadSetups& bad : cases) {
    const fs::path folder = folder_with(bad.name, setups(bad.first, bad.second));
    const auto run = run_in(folder);
    EXPECT_EQ(run.exit_code, 2) << bad.name << ": " << run.output;
    EXPECT_NE(run.output.find(bad.code), std::string::npos) << bad.name << ": " << run.output;
    EXPECT_NE(run.output.find(bad.words), std::string::npos) << bad.name << ": " << run.output;
    EXPECT_FALSE(fs::exists(folder / "out")) << bad.name;
    fs::remove_all(folder);
  }
}

TEST(TwoSetups, WhatTakesOneOfThemSaysSo) {
  const fs::path folder = folder_with("one_of_them", setups("", kTurned));
  const std::string scene = (folder / "scene.toml").string();
  for (const std::string& words :
       {"run " + scene + " --from stock.vdb", "run " + scene + " --record",
        "run " + scene + " --save-stock-after 7", "show " + scene + " -o " + (folder / "a.png").string()}) {
    const auto run = run_swarf(words);
    EXPECT_EQ(run.exit_code, 2) << words << run.output;
    EXPECT_NE(run.output.find("several-set-ups"), std::string::npos) << words << run.output;
  }
  write_text(folder / "empty.toml",
             std::string(kHead).substr(0, std::string(kHead).find('[')) + "setup = []\n" + kBlock);
  const auto empty = run_in(folder, "", "empty.toml");
  EXPECT_EQ(empty.exit_code, 2);
  EXPECT_NE(empty.output.find("no-set-ups"), std::string::npos) << empty.output;
  write_text(folder / "design.toml", "design = { kind = \"none\" }\n" + setups("", kTurned));
  EXPECT_NE(run_in(folder, "", "design.toml").output.find("whose-frame"), std::string::npos);
  for (const auto& [number, file] : {std::pair{"3", "scene.toml"}, std::pair{"1", "one.toml"}}) {
    write_text(folder / "one.toml", std::string(kHead) + kBlock + "[setup]\n" + kClamped);
    const auto run = run_in(folder, std::string("--setup ") + number, file);
    EXPECT_EQ(run.exit_code, 2) << run.output;
    EXPECT_NE(run.output.find("no-such-set-up"), std::string::npos) << run.output;
  }
  fs::remove_all(folder);
}

}  // namespace
}  // namespace two_setups_test
