#include <gtest/gtest.h>

#include "base/units.h"
#include "mesh/mesh_ops.h"

namespace swarf::mesh {
namespace {

/// Two quads that meet in the edge 0-1: one in z = 0, one turned about it by `turn` against it.
TriMesh folded(double turn) {
  const auto c = static_cast<float>(std::cos(turn)), s = static_cast<float>(std::sin(turn));
  TriMesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {-1, 1, 0}, {c, 0, -s}, {c, 1, -s}};
  mesh.triangles = {{2, 0, 1}, {2, 1, 3}, {0, 4, 5}, {0, 5, 1}};
  mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {s, 0, c}, {s, 0, c}};
  mesh.deviation_um = {0, 1, 2, 3, 4, 5};
  return mesh;
}

TEST(SplitCreases, EdgeGetsTheNormalOfEitherSide) {
  TriMesh mesh = folded(0.5 * kPi);
  split_creases(mesh, 0.5);
  ASSERT_EQ(mesh.positions.size(), 8U);
  EXPECT_EQ(mesh.triangles[0], (std::array<uint32_t, 3>{2, 0, 1}));
  EXPECT_EQ(mesh.triangles[1], (std::array<uint32_t, 3>{2, 1, 3}));
  EXPECT_EQ(mesh.triangles[2], (std::array<uint32_t, 3>{6, 4, 5}));
  EXPECT_EQ(mesh.triangles[3], (std::array<uint32_t, 3>{6, 5, 7}));
  for (const uint32_t copy : {6U, 7U}) {
    EXPECT_EQ(mesh.positions[copy], mesh.positions[copy - 6]);
    EXPECT_EQ(mesh.deviation_um[copy], mesh.deviation_um[copy - 6]);
    EXPECT_NEAR(mesh.normals[copy][0], 1.0F, 1e-6F);
  }
}

TEST(SplitCreases, SmoothPlacesStayAsTheyAre) {
  TriMesh mesh = folded(0.4);
  split_creases(mesh, 0.5);
  EXPECT_EQ(mesh.triangles, folded(0.4).triangles);
  EXPECT_EQ(mesh.normals, folded(0.4).normals);
}

TEST(SplitCreases, TrianglesWithoutAreaSplitNothing) {
  TriMesh mesh = folded(0.0);
  mesh.triangles.push_back({0, 1, 1});
  split_creases(mesh, 0.5);
  EXPECT_EQ(mesh.positions.size(), 6U);
}

}  // namespace
}  // namespace swarf::mesh
