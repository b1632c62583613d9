// What swarf export writes of a stock is a solid that swarf compare takes: closed, free of crossings.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "mesh/mesh_check.h"
#include "mesh/mesh_io.h"
#include "mesh/mesh_ops.h"
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
    // The glTF, decimated within 2 um, comes in again at its place and size.
    const std::string glb = (folder / "part.glb").string();
    ASSERT_EQ(run_swarf("export " + out + " --gltf " + glb).exit_code, 0);
    const swarf::TriMesh part = swarf::mesh::load_mesh(stl), again = swarf::mesh::load_mesh(glb);
    const swarf::Box there = swarf::mesh::bounds(part), here = swarf::mesh::bounds(again);
    EXPECT_LT((here.lower - there.lower).norm(), 4e-3);
    EXPECT_LT((here.upper - there.upper).norm(), 4e-3);
    const double volume = swarf::mesh::enclosed_volume(part);
    EXPECT_NEAR(swarf::mesh::enclosed_volume(again), volume, 1e-3 * volume);
    EXPECT_LT(again.triangles.size(), part.triangles.size());
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
