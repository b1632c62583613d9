// Limits below what the facets of a design allow are told before the verdict.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "mesh/mesh_io.h"
#include "support/program_run.h"
#include "support/solids.h"

namespace facet_limit_test {
namespace {

/// A round boss of 48 sides, radius 3.4 mm: its facets lie 7.28 um within the round wall.
void write_boss(const std::filesystem::path& folder) {
  constexpr int kSides = 48;
  swarf::TriMesh mesh;
  const auto at = [&](int k, double z) {
    const double angle = 2.0 * M_PI * (k % kSides) / kSides;
    return swarf::Vec3(3.4 * std::cos(angle), 3.4 * std::sin(angle), z);
  };
  for (int k = 0; k < kSides; ++k) {
    swarf::test::add_quad(mesh, at(k, -10), at(k + 1, -10), at(k + 1, 0), at(k, 0));
    swarf::test::add_triangle(mesh, {0, 0, 0}, at(k, 0), at(k + 1, 0));
    swarf::test::add_triangle(mesh, {0, 0, -10}, at(k + 1, -10), at(k, -10));
  }
  swarf::mesh::save_mesh((folder / "boss.stl").string(), mesh);
  swarf::test::write_text(folder / "boss.nc",
                          "%\nG21 G90 G17 G54\nT1 M6\nS3000 M3\nG0 X-20 Y0\nG43 H1 Z5\nG1 Z-10 F900\nX-6.4\n"
                          "G2 I6.4 J0\nG1 X-20\nG0 Z50\nM30\n%\n");
}

TEST(FacetLimit, BelowWhatTheFacetsAllowIsWarnedOf) {
  const std::filesystem::path folder = swarf::test::fresh_folder("facet_limit");
  write_boss(folder);
  const auto told = [&](const char* limit) {
    return swarf::test::run_swarf(
               "run " + (folder / "boss.nc").string() + " --tool 6 --stock -4,-4,-10,4,4,0 --design " +
               (folder / "boss.stl").string() + " --no-render --set accept.gouge_max_um=1 " +
               "--set accept.excess_max_um=" + limit + " -o " + (folder / "out").string())
        .output;
  };
  const std::string below = told("2");
  EXPECT_NE(
      below.find("accept.excess_max_um = 2 um is below what the facets allow: they lie about 7.3 um off"),
      std::string::npos)
      << below;
  EXPECT_NE(below.find("limit-below-facets"), std::string::npos) << below;
  const std::string above = told("12");
  EXPECT_EQ(above.find("accept.excess_max_um = 12"), std::string::npos) << above;
}

}  // namespace
}  // namespace facet_limit_test
