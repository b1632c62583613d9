// What swarf export writes of a stock is a solid that swarf compare takes: closed, free of crossings.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "support/program_run.h"

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

}  // namespace

}  // namespace exported_meshes_test
