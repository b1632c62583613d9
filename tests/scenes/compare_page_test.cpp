// The page of swarf compare, two revisions of a stock, and stocks that are moved first.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "measure/alignment.h"
#include "mesh/mesh_io.h"
#include "support/program_run.h"
#include "support/solids.h"

namespace compare_page_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using swarf::Pose;
using swarf::TriMesh;
using swarf::Vec3;
using swarf::test::ProgramRun;
using swarf::test::read_text;
using swarf::test::run_swarf;

/// A plate 40 x 40 x 10 with towers of these heights beside its middle.
TriMesh plate(double first, double second) {
  return swarf::test::towers({-20, -12, -6, 4, 11, 20}, {-20, -7, 3, 20}, 0.0, [&](int i, int j) {
    return j != 1 ? 10.0 : i == 1 ? first : i == 3 ? second : 10.0;
  });
}

class ComparePage : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = swarf::test::fresh_folder(std::string("compare_page_") +
                                        testing::UnitTest::GetInstance()->current_test_info()->name());
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string file(const std::string& name, const TriMesh& mesh) {
    const std::string path = (folder_ / name).string();
    swarf::mesh::save_mesh(path, mesh);
    return path;
  }
  fs::path folder_;
};

TEST_F(ComparePage, ShowsTheWorstPlacesWithPicturesSectionsAndHistogram) {
  const std::string out = (folder_ / "out").string();
  const ProgramRun run = run_swarf("compare '" + file("a<b>.stl", plate(10.3, 9.9)) + "' " +
                                   file("design.stl", plate(10.0, 10.0)) + " --pitch-mm 0.8 -o " + out);
  ASSERT_EQ(run.exit_code, 1) << run.output;
  const std::string page = read_text(out + "/report.html");
  for (const char* text : {"a&lt;b&gt;.stl", "excess 300.000 µm", "gouge 100.000 µm", "id=\"finding-2\"",
                           "class=\"finding-picture\"", "Area by deviation", "across X", "Place 2, close",
                           "class=\"scale-bar\"", "Regions beyond a limit", "id=\"part-glb\""})
    EXPECT_NE(page.find(text), std::string::npos) << text;
  EXPECT_EQ(page.find("id=\"finding-3\""), std::string::npos);
  EXPECT_EQ(page.find("Lin &amp; Koren"), std::string::npos);
  for (const char* name : {"place_1.png", "place_2.png", "metrics.json", "deviation.ply", "design.png"})
    EXPECT_GT(fs::file_size(out + "/" + name), 500U) << name;
  // Over an earlier result, whole.
  const ProgramRun good = run_swarf("compare " + (folder_ / "design.stl").string() + " " +
                                    (folder_ / "design.stl").string() + " --pitch-mm 0.8 -o " + out);
  ASSERT_EQ(good.exit_code, 0) << good.output;
  EXPECT_FALSE(fs::exists(out + "/place_1.png"));
  EXPECT_NE(read_text(out + "/report.html").find("None, in what was checked"), std::string::npos);
}

TEST_F(ComparePage, AMovedStockIsBroughtBack) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(0.03, Vec3(1, 1, 4).normalized()).toRotationMatrix();
  pose.translation() = Vec3(1.5, -0.7, 0.4);
  const TriMesh design = plate(14.0, 12.0);
  const std::string words = "compare " + file("stock.stl", swarf::measure::moved(design, pose)) + " " +
                            file("design.stl", design) + " --pitch-mm 0.8 --json ";
  EXPECT_EQ(run_swarf(words).exit_code, 1);
  const auto pair = [&](const Vec3& p) {
    const Vec3 at = pose * p;
    char text[200];
    std::snprintf(text, sizeof text, " --align %.9f,%.9f,%.9f=%g,%g,%g", at.x(), at.y(), at.z(), p.x(), p.y(),
                  p.z());
    return std::string(text);
  };
  const std::string pairs = pair({-20, -20, 0}) + pair({20, -20, 0}) + pair({-20, 20, 10});
  for (const std::string& options : {pairs, std::string("--best-fit"), pairs + " --best-fit"}) {
    const ProgramRun run = run_swarf(words + options);
    ASSERT_EQ(run.exit_code, 0) << options << run.output;
    const json alignment = json::parse(run.output).at("alignment");
    EXPECT_LT(alignment.at("rms_um").get<double>(), 0.1) << options;
    const Pose back = pose.inverse();
    for (int r = 0; r < 3; ++r)
      EXPECT_NEAR(alignment.at("matrix_mm").at(r).at(3).get<double>(), back.matrix()(r, 3), 1e-4) << options;
  }
  EXPECT_NE(run_swarf(words.substr(0, words.find(" --json")) + " --best-fit").output.find("turned by 1.7188"),
            std::string::npos);
  for (const char* bad : {"1,2,3", "1,2,3=4,5", "1,2,3=4,5,6x", "1,2,nan=4,5,6", ""}) {
    const ProgramRun run = run_swarf(words + "--align '" + bad + "'");
    EXPECT_EQ(run.exit_code, 2) << bad << run.output;
  }
  EXPECT_NE(run_swarf(words + "--align 0,0,0=0,0,0").output.find("[points-on-a-line]"), std::string::npos);
}

TEST_F(ComparePage, TwoRevisionsOfAStockSayWhatChanged) {
  const auto run = [&](const std::string& name, const char* depth) {
    swarf::test::write_text(
        folder_ / (name + ".ngc"),
        std::string("G21 G90\nT1 M6\nS9000 M3\nG0 X5 Y5\nZ2\nG1 Z-") + depth + " F600\nX15\nG0 Z20\nM2\n");
    const ProgramRun done =
        run_swarf("run " + (folder_ / (name + ".ngc")).string() + " --tool 6 --stock 0,0,-8,20,10,0 " +
                  "--voxel 0.5 --no-render -o " + (folder_ / name).string());
    EXPECT_LE(done.exit_code, 1) << done.output;
    return (folder_ / name / "stock.vdb").string();
  };
  const std::string earlier = run("earlier", "2"), now = run("now", "2.5");
  const ProgramRun changed =
      run_swarf("compare " + now + " " + earlier + " --pitch-mm 1 -o " + (folder_ / "out").string());
  EXPECT_EQ(changed.exit_code, 1) << changed.output;
  const std::string page = read_text(folder_ / "out/report.html");
  EXPECT_NE(page.find("What changed"), std::string::npos);
  EXPECT_NE(page.find("<code>removed</code>"), std::string::npos);
  EXPECT_EQ(run_swarf("compare " + now + " " + now + " --pitch-mm 1").exit_code, 0);
}

/// A solid of STEP against the STL of the same solid, and against one that is 20 um too high: proven, with a
/// page. The facets of the STEP file are exact there.
TEST_F(ComparePage, AStepDesignIsComparedAndProven) {
  const std::string assets = SWARF_SOURCE_DIR "/assets/programs/stepnode/";
  TriMesh mesh = swarf::mesh::load_mesh(assets + "step_block.stl");
  const std::string step = assets + "simple_block_workpiece.stp", out = (folder_ / "out").string();
  const ProgramRun same =
      run_swarf("compare " + file("same.stl", mesh) + " " + step + " --pitch-mm 2 --json");
  ASSERT_EQ(same.exit_code, 0) << same.output;
  EXPECT_LT(json::parse(same.output).at("surface").at("excess_bound_um").get<double>(), 0.1);
  float top = mesh.positions.front()[2];
  for (const auto& p : mesh.positions) top = std::max(top, p[2]);
  for (auto& p : mesh.positions)
    if (p[2] == top) p[2] += 0.02F;
  const ProgramRun high =
      run_swarf("compare " + file("high.stl", mesh) + " " + step + " --pitch-mm 2 -o " + out);
  EXPECT_EQ(high.exit_code, 1) << high.output;
  const json metrics = json::parse(read_text(out + "/metrics.json"));
  EXPECT_NEAR(metrics.at("surface").at("excess_max_um").get<double>(), 20.0, 0.02);
  EXPECT_NE(read_text(out + "/report.html").find("id=\"finding-1\""), std::string::npos);
}

}  // namespace
}  // namespace compare_page_test
