// CL programs whose result is known in closed form, on the shipped program.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "support/json_path.h"
#include "support/program_run.h"

namespace exact_cases_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using swarf::test::at_path;
using swarf::test::run_swarf;

const std::string kFolder = SWARF_SOURCE_DIR "/scenes/exact_hyperboloid/";

json read_json(const fs::path& path) {
  return json::parse(std::ifstream(path));
}

class HyperboloidRun : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = swarf::test::fresh_folder("hyperboloid") / "run";
    run_ = run_swarf("run " + kFolder + "scene.toml -o " + folder_.string() +
                     " --set movie.seconds=0.2 --set 'movie.size=[320,180]' --set 'stills.size=[320,180]' "
                     "--set stills.samples=2 --set stock.voxel_mm=0.5 --set 'design.z_mm=[-6,2]'");
  }
  static void TearDownTestSuite() { fs::remove_all(folder_.parent_path()); }

  static fs::path folder_;
  static swarf::test::ProgramRun run_;
};
fs::path HyperboloidRun::folder_;
swarf::test::ProgramRun HyperboloidRun::run_;

TEST_F(HyperboloidRun, PassesAndSaysWhereItStartedAndWhatTookTheTime) {
  EXPECT_EQ(run_.exit_code, 0) << run_.output;
  EXPECT_NE(run_.output.find("line 7: the first complete position"), std::string::npos) << run_.output;
  EXPECT_NE(run_.output.find("rapid 0.37 s, dwell 0.00 s"), std::string::npos) << run_.output;
}

TEST_F(HyperboloidRun, RendersExportsAndComparesFromItsFolder) {
  const std::string png = (folder_ / "again.png").string(), stl = (folder_ / "part.stl").string();
  const auto render =
      run_swarf("render " + folder_.string() + " --kind deviation --camera iso --labels --still " + png);
  EXPECT_EQ(render.exit_code, 0) << render.output;
  EXPECT_EQ(swarf::test::read_text(png), swarf::test::read_text(folder_ / "still_deviation.png"));
  const auto exported = run_swarf("export " + folder_.string() + " --stl " + stl);
  EXPECT_EQ(exported.exit_code, 0) << exported.output;
  const auto compare = run_swarf("compare " + (folder_ / "stock.vdb").string() + " " + kFolder +
                                 "scene.toml --json --scallop-um 25 --gouge-um 25");
  const json result = json::parse(compare.output);
  EXPECT_GT(at_path(result, "surface.excess_bound_um"), at_path(result, "surface.excess_max_um"));
  EXPECT_LT(at_path(result, "surface.mean_abs_um"), 10.0);
}

TEST(ExactCases, AGougeNamesTheBlockOfTheClFile) {
  // The design set 10 um outwards (a greater distance of the tool's axis): the tool cuts 10 um into it.
  const fs::path folder = swarf::test::fresh_folder("hyperboloid_gouge") / "run";
  const auto run =
      run_swarf("run " + kFolder + "scene.toml --no-render -o " + folder.string() +
                " --set design.distance_mm=30.01 --set stock.voxel_mm=1 --set design.pitch_mm=2"
                " --set accept.gouge_max_um=9 --set 'design.z_mm=[-0.25,0.25]'"
                // What stands above the design is of no interest: its proof would be most of the run.
                " --set accept.scallop_max_um=1000 --set accept.excess_max_um=1000");
  EXPECT_EQ(run.exit_code, 1) << run.output;
  bool named = false;
  for (const json& finding : read_json(folder / "findings.json")) {
    if (finding.at("code") != "gouge") continue;
    named = true;
    EXPECT_NE(finding.at("file").get<std::string>().find("path.cl"), std::string::npos);
    EXPECT_GE(finding.at("line").get<int>(), 42);
    EXPECT_LE(finding.at("line").get<int>(), 65);
    EXPECT_GT(finding.at("t_s").get<double>(), 0.0);
  }
  EXPECT_TRUE(named) << run.output;
  EXPECT_NEAR(at_path(read_json(folder / "metrics.json"), "surface.gouge_max_um").get<double>(), 10.0, 0.1);
  fs::remove_all(folder.parent_path());
}

TEST(ExactCases, WithoutADesignNothingIsMeasuredAndTheReportSaysSo) {
  const fs::path folder = swarf::test::fresh_folder("hyperboloid_none");
  fs::create_directories(folder);
  const std::string scene = swarf::test::read_text(kFolder + "scene.toml");
  std::string text =
      scene.substr(0, scene.find("[design]")) + "[design]\nkind = \"none\"\n" +
      scene.substr(scene.find("[interpolator]"), scene.find("[accept]") - scene.find("[interpolator]"));
  text.replace(text.find("../.."), 5, SWARF_SOURCE_DIR);
  text.replace(text.find("voxel_mm = 0.25"), 15, "voxel_mm = 1.0");
  std::ofstream(folder / "scene.toml") << text;
  fs::copy_file(kFolder + "path.cl", folder / "path.cl");
  const auto run =
      run_swarf("run " + (folder / "scene.toml").string() + " --no-render -o " + (folder / "run").string());
  EXPECT_EQ(run.exit_code, 0) << run.output;
  EXPECT_NE(run.output.find("none: the finished part is not measured"), std::string::npos) << run.output;
  const auto metrics = read_json(folder / "run/metrics.json");
  EXPECT_EQ(at_path(metrics, "surface.samples"), 0);
  for (const char* measured : {"gouge_max_um", "excess_max_um", "within_tolerance_pct"})
    EXPECT_TRUE(metrics.at("surface").at(measured).is_null()) << measured;
  EXPECT_TRUE(metrics.at("cross_check").at("holds").is_null());
  fs::remove_all(folder);
}

TEST(ExactCases, ContradictionsOfSceneAndClFileAreErrors) {
  const auto exit_code_with = [](const std::string& change) {
    return run_swarf("run " + kFolder + "scene.toml --no-render -o /nowhere/run --set " + change);
  };
  const auto cutter = exit_code_with("cutter.diameter_mm=12");
  EXPECT_EQ(cutter.exit_code, 2);
  EXPECT_NE(cutter.output.find("path.cl:4:1"), std::string::npos) << cutter.output;
  EXPECT_NE(cutter.output.find("cutter-contradiction"), std::string::npos) << cutter.output;
  EXPECT_NE(exit_code_with("cutter.number=2").output.find("unknown-tool"), std::string::npos);
  EXPECT_NE(exit_code_with("program=path.cl").output.find("two-programs"), std::string::npos);
  EXPECT_NE(exit_code_with("interpolator.mode=offline").output.find("unknown-choice"), std::string::npos);
  EXPECT_NE(exit_code_with("toolpath.compare=false").output.find("unknown-key"), std::string::npos);
}

}  // namespace

}  // namespace exact_cases_test
