// The main job on the shipped program: run, then compare, render and export from its folder.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mesh/mesh_io.h"
#include "support/json_path.h"
#include "support/page_opens.h"
#include "support/program_run.h"

namespace dome_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using swarf::test::at_path;
using swarf::test::run_swarf;

const std::string kScene = SWARF_SOURCE_DIR "/scenes/lin_koren_dome/scene.toml";

json read_json(const fs::path& path) {
  return json::parse(std::ifstream(path));
}

class DomeRun : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = swarf::test::fresh_folder("dome") / "run";
    run_ = run_swarf("run " + kScene + " -o " + folder_.string() +
                     " --set movie.seconds=0.2 --set 'movie.size=[320,180]' --set 'stills.size=[320,180]' "
                     "--set stills.samples=2");
  }
  static void TearDownTestSuite() { fs::remove_all(folder_.parent_path()); }

  static fs::path folder_;
  static swarf::test::ProgramRun run_;
};
fs::path DomeRun::folder_;
swarf::test::ProgramRun DomeRun::run_;

TEST_F(DomeRun, PassesAndSaysWhereTheReportIs) {
  EXPECT_EQ(run_.exit_code, 0) << run_.output;
  EXPECT_NE(run_.output.find("PASS"), std::string::npos) << run_.output;
  EXPECT_NE(run_.output.find("report.html"), std::string::npos) << run_.output;
}

TEST_F(DomeRun, MeetsExpectedJson) {
  const json metrics = read_json(folder_ / "metrics.json");
  const json expected = read_json(SWARF_SOURCE_DIR "/scenes/lin_koren_dome/expected.json");
  for (const json& bound : expected.at("bounds")) {
    const std::string name = bound.at("metric");
    const double value = at_path(metrics, name);
    EXPECT_GE(value, bound.at("min").get<double>()) << name << ": " << bound.at("why");
    EXPECT_LE(value, bound.at("max").get<double>()) << name << ": " << bound.at("why");
  }
}

TEST_F(DomeRun, LinKorenPlannerMeetsItsOwnTheory) {
  const json metrics = read_json(folder_ / "metrics.json");
  for (const json& row : metrics.at("planners")) {
    if (row.at("name") != "lin_koren") continue;
    const double measured = row.at("surface").at("scallop_max_um");
    const double theory = row.at("surface").at("scallop_theory_um");
    EXPECT_NEAR(measured, theory, 0.01 * theory);
    return;
  }
  FAIL() << "no row for lin_koren";
}

TEST_F(DomeRun, LeavesEveryFile) {
  for (const char* file : {"report.html", "metrics.json", "findings.json", "blocks.csv", "movie.mp4",
                           "still_part.png", "still_deviation.png", "still_fan.png", "still_machine.png",
                           "machine.glb", "part.glb", "stock.vdb"}) {
    EXPECT_TRUE(fs::exists(folder_ / file)) << file;
    EXPECT_GT(fs::file_size(folder_ / file), 2U) << file;
  }
  EXPECT_FALSE(fs::exists(folder_.string() + ".part"));
}

TEST_F(DomeRun, GltfValidatorFindsNoError) {
  const std::string command = SWARF_SOURCE_DIR "/tests/gltf/validate.sh " +
                              (folder_ / "machine.glb").string() + " " + (folder_ / "part.glb").string();
  EXPECT_EQ(std::system(command.c_str()), 0);
}

TEST_F(DomeRun, PageOpens) {
  swarf::test::expect_pages_open((folder_ / "report.html").string());
}

/// Where Blender is installed (it is not needed to build or to test): five axes and the removal, played
/// there.
TEST_F(DomeRun, PlaysInBlender) {
  if (swarf::test::run_command("command -v blender").exit_code != 0)
    GTEST_SKIP() << "NOT CHECKED: there is no blender here";
  const std::string table = (folder_.parent_path() / "cycles.csv").string();
  const auto exported = run_swarf("export " + folder_.string() + " --trajectory " + table);
  ASSERT_EQ(exported.exit_code, 0) << exported.output;
  const auto played =
      swarf::test::run_command("blender -b --factory-startup --python-exit-code 1 --python " SWARF_SOURCE_DIR
                               "/tests/gltf/blender_plays.py -- " +
                               (folder_ / "machine.glb").string() + " " + table);
  EXPECT_EQ(played.exit_code, 0) << played.output;
  EXPECT_NE(played.output.find("BLENDER PLAYS"), std::string::npos) << played.output;
}

TEST_F(DomeRun, ComparesStockWithDesign) {
  const auto run = run_swarf("compare " + (folder_ / "stock.vdb").string() + " " + kScene +
                             " --json --scallop-um 25 --gouge-um 15");
  EXPECT_EQ(run.exit_code, 0) << run.output;
  const json result = json::parse(run.output);
  EXPECT_GT(at_path(result, "surface.excess_bound_um"), at_path(result, "surface.excess_max_um"));
  EXPECT_LT(at_path(result, "surface.mean_abs_um"), 10.0);
}

/// Corners of the facets in the order of the file, whether or not they share vertices there.
std::vector<std::array<float, 3>> corners_of(const fs::path& file) {
  const swarf::TriMesh mesh = swarf::mesh::load_mesh(file.string());
  std::vector<std::array<float, 3>> corners;
  for (const auto& triangle : mesh.triangles)
    for (const uint32_t vertex : triangle) corners.push_back(mesh.positions.at(vertex));
  return corners;
}

/// Two formats, the same facets to the last bit.
TEST_F(DomeRun, ExportsWithoutSimulating) {
  const fs::path stl = folder_ / "part.stl", ply = folder_ / "part.ply";
  const auto run =
      run_swarf("export " + folder_.string() + " --stl " + stl.string() + " --ply " + ply.string());
  EXPECT_EQ(run.exit_code, 0) << run.output;
  const auto corners = corners_of(ply);
  EXPECT_GT(corners.size(), 30000U);
  EXPECT_TRUE(corners == corners_of(stl));
}

TEST_F(DomeRun, RendersWithoutSimulating) {
  const std::string png = (folder_ / "again.png").string();
  const auto run =
      run_swarf("render " + folder_.string() + " --kind deviation --camera iso --labels --still " + png);
  EXPECT_EQ(run.exit_code, 0) << run.output;
  // The same picture as the run itself made: nothing but the folder went into it.
  EXPECT_EQ(swarf::test::read_text(png), swarf::test::read_text(folder_ / "still_deviation.png"));
}

TEST(DomeThreads, HashIsTheSameForAnyNumber) {
  std::string hash;
  for (const char* threads : {"1", "2", "4"}) {
    const fs::path folder = swarf::test::fresh_folder("dome_threads") / "run";
    const auto run = run_swarf("run " + kScene +
                               " --no-render --set toolpath.compare=false --set stock.voxel_mm=0.5 "
                               "--set interpolator.period_ms=4 " +
                               swarf::test::kSoonProven + "--threads " + threads + " -o " + folder.string());
    EXPECT_EQ(run.exit_code, 0) << run.output;
    const std::string found = at_path(read_json(folder / "metrics.json"), "stock.hash");
    if (!hash.empty()) {
      EXPECT_EQ(found, hash) << threads << " threads";
    }
    hash = found;
    fs::remove_all(folder.parent_path());
  }
}

}  // namespace

}  // namespace dome_test
