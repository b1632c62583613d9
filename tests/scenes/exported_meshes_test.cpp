// What swarf export writes of a stock is a solid that swarf compare takes: closed, free of crossings.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "support/page_opens.h"

namespace exported_meshes_test {
namespace {

using swarf::test::run_swarf;

TEST(ExportedMeshes, CanBeCompared) {
  for (const char* name : {"exact_slot_ball", "exact_scallop_flat_cylinder"}) {
    SCOPED_TRACE(name);
    const auto folder = swarf::test::fresh_folder(std::string("exported_") + name);
    const std::string out = (folder / "run").string(), stl = (folder / "part.stl").string();
    const auto run = run_swarf("run " SWARF_SOURCE_DIR "/scenes/" + std::string(name) +
                               "/scene.toml --no-render -o " + out);
    ASSERT_EQ(run.exit_code, 0) << run.output;
    const auto exported = run_swarf("export " + out + " --stl " + stl);
    ASSERT_EQ(exported.exit_code, 0) << exported.output;
    const auto compare = run_swarf("compare " + stl + " " + stl + " --excess-um .1 --gouge-um .1");
    EXPECT_EQ(compare.exit_code, 0) << compare.output;
    std::filesystem::remove_all(folder);
  }
}

/// The page of a small part is light, and the error of the part in it, measured by its own decimation and
/// said in the file, stays within its 2 um.
TEST(ExportedMeshes, ThePageOfASmallPartIsLight) {
  const auto folder = swarf::test::fresh_folder("light_page");
  const auto run = run_swarf("run " SWARF_SOURCE_DIR "/scenes/nc_pocket/scene.toml --no-render --report -o " +
                             (folder / "run").string());
  ASSERT_LE(run.exit_code, 1) << run.output;
  EXPECT_LT(std::filesystem::file_size(folder / "run/report.html"), 5'000'000U);
  const std::string part = swarf::test::read_text(folder / "run/part.glb");
  const std::string key = "\"decimation_error_um\":";
  const size_t at = part.find(key);
  ASSERT_NE(at, std::string::npos);
  const double error_um = std::stod(part.substr(at + key.size(), 16));
  EXPECT_GT(error_um, 0.0) << "the part is not as it was meshed";
  EXPECT_LE(error_um, 2.0);
  swarf::test::expect_review(folder / "run");
  std::filesystem::remove_all(folder);
}

}  // namespace

}  // namespace exported_meshes_test
