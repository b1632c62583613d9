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

}  // namespace
}  // namespace cad_design_test
