// The edges that a flat end leaves, in the mesh that the shipped program exports: 90 degrees, 0.1 mm voxels.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "mesh/mesh_distance.h"
#include "mesh/mesh_io.h"
#include "support/program_run.h"

namespace sharp_edges_test {
namespace {

using swarf::Vec3;

/// Greatest distance of the exported mesh from points on the true edge between two ends, mm.
double worst_distance(const swarf::mesh::MeshDistance& mesh, const Vec3& from, const Vec3& to) {
  constexpr int kSamples = 997;  // no multiple of the voxel
  double worst = 0.0;
  for (int i = 0; i <= kSamples; ++i) {
    const Vec3 point = from + (to - from) * (static_cast<double>(i) / kSamples);
    worst = std::max(worst, (mesh.nearest(point).point - point).norm());
  }
  return worst;
}

TEST(SharpEdges, OfASlotLieWithinTenMicrometresOfTheTruth) {
  const auto folder = swarf::test::fresh_folder("sharp_edges");
  const std::string run = (folder / "run").string(), ply = (folder / "part.ply").string();
  const auto cut = swarf::test::run_swarf("run " SWARF_SOURCE_DIR "/scenes/exact_slot_flat/scene.toml -o " +
                                          run + " --no-render --set stock.voxel_mm=0.1");
  ASSERT_EQ(cut.exit_code, 0) << cut.output;
  const auto exported = swarf::test::run_swarf("export " + run + " --ply " + ply);
  ASSERT_EQ(exported.exit_code, 0) << exported.output;
  const swarf::TriMesh mesh = swarf::mesh::load_mesh(ply);
  const swarf::mesh::MeshDistance distance(mesh);
  for (const double y : {-5.0, 5.0}) {
    EXPECT_LE(worst_distance(distance, {0, y, 0}, {30, y, 0}), 0.010) << "rim at y = " << y;
    EXPECT_LE(worst_distance(distance, {0, y, -3}, {30, y, -3}), 0.010) << "corner of the floor at y = " << y;
  }
  for (int i = 0; i < 180; ++i) {  // the round end of the slot
    const double angle = M_PI * (i + 0.5) / 180.0 - M_PI / 2;
    for (const double z : {0.0, -3.0}) {
      const Vec3 point(30.0 + 5.0 * std::cos(angle), 5.0 * std::sin(angle), z);
      EXPECT_LE((distance.nearest(point).point - point).norm(), 0.010)
          << "round end, " << angle << " rad, z " << z;
    }
  }
  std::filesystem::remove_all(folder);
}

}  // namespace

}  // namespace sharp_edges_test
