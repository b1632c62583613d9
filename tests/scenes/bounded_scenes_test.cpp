// Every scene with an expected.json of bounds (the dome has a test of its own), on the shipped program: its
// metrics stay within expected.json.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/json_path.h"
#include "support/page_opens.h"
#include "support/program_run.h"

namespace bounded_scenes_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const fs::path kScenes = SWARF_SOURCE_DIR "/scenes";

std::vector<std::string> bounded_scenes() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(kScenes)) {
    const std::string name = entry.path().filename();
    if (name != "lin_koren_dome" && fs::exists(entry.path() / "expected.json")) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// Whose page and glTF files are looked at too, with the folder of the set-up: flank, surface driven, two
/// set-ups. The others are the pocket (ExportedMeshes), the dome (DomeRun), gouges (GougedPage) and contacts
/// of the machine (MachineContacts).
const std::vector<std::string> kPaged{"chu_barrel", "kato_five_axis", "two_setups"};
const std::vector<std::string> kPagedSetup{"", "", "2_turned_over"};

/// Minutes each: run where SWARF_LONG_SCENES is set. A part of each surface is held always.
const std::vector<std::string> kLong{"scallop_ball_whole", "scallop_bull_whole"};

/// Their bounds are those of the planner and the interpolator that they name; comparisons with all the
/// others, most of the time, are held on the dome (DomeRun).
bool has_comparisons(const std::string& name) {
  return name == "scallop_ball_dome" || name == "scallop_bull_dome";
}

class BoundedScene : public testing::TestWithParam<std::string> {};

TEST_P(BoundedScene, MeetsExpectedJson) {
  const bool is_long = std::find(kLong.begin(), kLong.end(), GetParam()) != kLong.end();
  if (is_long && std::getenv("SWARF_LONG_SCENES") == nullptr)
    GTEST_SKIP() << "takes minutes: SWARF_LONG_SCENES=1 runs it";
  const fs::path folder = swarf::test::fresh_folder(GetParam());
  const auto paged = std::find(kPaged.begin(), kPaged.end(), GetParam());
  const auto run = swarf::test::run_swarf(
      "run " + (kScenes / GetParam() / "scene.toml").string() + " -o " + (folder / "run").string() +
      " --no-render" + (paged == kPaged.end() ? "" : " --report") +
      (has_comparisons(GetParam()) ? " --set toolpath.compare=false" : ""));
  const json expected = json::parse(std::ifstream(kScenes / GetParam() / "expected.json"));
  ASSERT_EQ(run.exit_code, expected.value("exit_code", 0)) << run.output;
  ASSERT_FALSE(expected.at("bounds").empty());
  for (const json& bound : expected.at("bounds")) {
    // Of several set-ups the one whose folder is named.
    const fs::path results = folder / "run" / bound.value("setup", "");
    const json metrics = json::parse(std::ifstream(results / "metrics.json"));
    const std::string name = bound.at("metric");
    const double value = swarf::test::at_path(metrics, name);
    EXPECT_GE(value, bound.at("min").get<double>()) << name << ": " << bound.at("why");
    EXPECT_LE(value, bound.at("max").get<double>()) << name << ": " << bound.at("why");
  }
  if (paged != kPaged.end())
    swarf::test::expect_review(folder / "run" / kPagedSetup.at(paged - kPaged.begin()));
  fs::remove_all(folder);
}

/// The volumes that two scenes expect, from the coordinates of their CL files alone. Wider rows than those of
/// the figures, which take minutes.
TEST(ScanLines, GiveTheVolumesThatScenesExpect) {
  const auto volume = [](const std::string& words) {
    const auto run = swarf::test::run_command("/usr/bin/python3 '" + (kScenes / "scan_lines.py").string() +
                                              "' " SWARF_SOURCE_DIR "/assets/programs/stepnode/" + words);
    EXPECT_EQ(run.exit_code, 0) << run.output;
    return std::strtod(run.output.c_str(), nullptr);
  };
  EXPECT_NEAR(volume("coremill.cls 30 0,0,0,300,200,150 1"), 6522418.0, 2e-4 * 6522418.0);
  EXPECT_NEAR(volume("Plane_1.cldata 10 0,-10,10,60,35,29 0.1"), 2591.1, 2e-4 * 2591.1);
}

INSTANTIATE_TEST_SUITE_P(Scenes, BoundedScene, testing::ValuesIn(bounded_scenes()),
                         [](const auto& one) { return one.param; });

}  // namespace

}  // namespace bounded_scenes_test
