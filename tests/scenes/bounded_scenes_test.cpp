// Every scene with an expected.json of bounds (the dome has a test of its own), on the shipped program: its
// metrics stay within expected.json.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/json_path.h"
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

class BoundedScene : public testing::TestWithParam<std::string> {};

TEST_P(BoundedScene, MeetsExpectedJson) {
  const fs::path folder = swarf::test::fresh_folder(GetParam());
  const auto run = swarf::test::run_swarf("run " + (kScenes / GetParam() / "scene.toml").string() + " -o " +
                                          (folder / "run").string() + " --no-render");
  const json expected = json::parse(std::ifstream(kScenes / GetParam() / "expected.json"));
  ASSERT_EQ(run.exit_code, expected.value("exit_code", 0)) << run.output;
  const json metrics = json::parse(std::ifstream(folder / "run" / "metrics.json"));
  ASSERT_FALSE(expected.at("bounds").empty());
  for (const json& bound : expected.at("bounds")) {
    const std::string name = bound.at("metric");
    const double value = swarf::test::at_path(metrics, name);
    EXPECT_GE(value, bound.at("min").get<double>()) << name << ": " << bound.at("why");
    EXPECT_LE(value, bound.at("max").get<double>()) << name << ": " << bound.at("why");
  }
  fs::remove_all(folder);
}

INSTANTIATE_TEST_SUITE_P(Scenes, BoundedScene, testing::ValuesIn(bounded_scenes()),
                         [](const auto& info) { return info.param; });

}  // namespace

}  // namespace bounded_scenes_test
