// A CAD file as the design, from flags and behind either key of a scene.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "support/program_run.h"

namespace cad_design_test {
namespace {

namespace fs = std::filesystem;
using swarf::test::run_swarf;

const fs::path kJob = fs::path(SWARF_SOURCE_DIR) / "scenes/shop/slot_ramped";

nlohmann::json metrics_of(const fs::path& folder) {
  return nlohmann::json::parse(swarf::test::read_text(folder / "metrics.json"));
}

TEST(CadDesign, StepBehindDesignIsMeasuredOnItsFaces) {
  const fs::path folder = swarf::test::fresh_folder("cad_design_flag");
  const auto run = run_swarf("run " + (kJob / "part.nc").string() +
                             " --tools T1=50,T2=12 --stock -50,-25,-20,50,25,1 --design " +
                             (kJob / "part.step").string() + " --no-render -o " + (folder / "out").string());
  EXPECT_NE(run.exit_code, 2) << run.output;
  EXPECT_NE(run.output.find("measured on the faces themselves"), std::string::npos) << run.output;
  EXPECT_TRUE(metrics_of(folder / "out")["surface"]["gouge_max_um"].is_number());
}

TEST(CadDesign, BehindTheKeyOfAMeshIsTheSame) {
  const fs::path folder = swarf::test::fresh_folder("cad_design_key");
  const std::string scene = (kJob / "scene.toml").string();
  const auto plain = run_swarf("run " + scene + " --no-render -o " + (folder / "step").string());
  const auto behind = run_swarf("run " + scene + " --set 'design={mesh=\"part.step\"}' --no-render -o " +
                                (folder / "mesh").string());
  EXPECT_EQ(plain.exit_code, 0) << plain.output;
  EXPECT_EQ(behind.exit_code, 0) << behind.output;
  EXPECT_EQ(metrics_of(folder / "step")["surface"], metrics_of(folder / "mesh")["surface"]);
}

/// The part's box is 100 x 50 mm about the work's zero, its top at Z 0.
TEST(CadDesign, StandsWhereItsPlaceSays) {
  const fs::path folder = swarf::test::fresh_folder("cad_design_place");
  const std::string run =
      "run " + (kJob / "scene.toml").string() + " --no-render -o " + (folder / "out").string();
  const auto surface_of = [&](const std::string& options, int exit_code) {
    const auto done = run_swarf(run + options);
    EXPECT_EQ(done.exit_code, exit_code) << options << "\n" << done.output;
    return metrics_of(folder / "out")["surface"];
  };
  const std::string wide =
      " --set stock.box_mm='[[-50.1,-25.1,-20],[50.1,25.1,1]]' --set design.position_mm=";
  surface_of(" --set design.origin='\"centre\"'", 0);
  surface_of(" --set design.origin='\"corner\"' --set design.position_mm='[-50,-25,0]'", 0);
  surface_of(" --set design.rotation_deg='[0,0,180]'", 0);
  surface_of(
      " --set 'design={mesh=\"part.stl\",origin=\"centre\"}' --set accept.gouge_max_um=14 "
      "--set accept.excess_max_um=22",
      0);
  const auto moved = surface_of(wide + "'[0,0.03,0]'", 1);
  EXPECT_NEAR(moved["gouge_max_um"].get<double>(), 30.0, 1.0);
}

TEST(CadDesign, BesideTheStockIsToldWithTheWayIntoIt) {
  const auto run = run_swarf("run " + (kJob / "scene.toml").string() +
                             " --set design.position_mm='[200,0,0]' --no-render -o " +
                             swarf::test::fresh_folder("cad_design_beside").string());
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.output.find("moved by X -200.000 Y 0.000 Z 0.000 mm it lies in the stock"), std::string::npos)
      << run.output;
}

}  // namespace
}  // namespace cad_design_test
