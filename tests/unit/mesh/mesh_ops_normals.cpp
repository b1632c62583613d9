// Vertex normals, creases and bounds.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "base/check.h"
#include "base/units.h"
#include "mesh/mesh_ops.h"

namespace swarf::mesh {
namespace {

TriMesh cube() {
  TriMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.positions.push_back(
        {static_cast<float>(i & 1), static_cast<float>(i >> 1 & 1), static_cast<float>(i >> 2)});
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

TEST(MeshOpsNormals, SharpCubeSplitsEachCornerIntoThreeFaceNormals) {
  TriMesh mesh = cube();
  mesh.deviation_um = {0, 1, 2, 3, 4, 5, 6, 7};
  compute_vertex_normals(mesh, rad_from_deg(30));
  EXPECT_EQ(mesh.positions.size(), 24U);
  ASSERT_EQ(mesh.normals.size(), 24U);
  ASSERT_EQ(mesh.deviation_um.size(), 24U);
  std::set<std::array<float, 3>> directions(mesh.normals.begin(), mesh.normals.end());
  EXPECT_EQ(directions.size(), 6U);
  for (size_t v = 0; v < 24; ++v) {
    const auto& p = mesh.positions[v];
    EXPECT_EQ(mesh.deviation_um[v], p[0] + 2 * p[1] + 4 * p[2]) << "a copy lost its attribute, vertex " << v;
    for (size_t k = 0; k < 3; ++k) {
      const float outward = p[k] > 0.5F ? 1.0F : -1.0F;
      EXPECT_TRUE(mesh.normals[v][k] == 0.0F || mesh.normals[v][k] == outward) << v;
    }
  }
}

TEST(MeshOpsNormals, SmoothCubeKeepsItsVerticesAndPointsAlongTheDiagonals) {
  TriMesh mesh = cube();
  compute_vertex_normals(mesh, rad_from_deg(95));
  ASSERT_EQ(mesh.positions.size(), 8U);
  // Angle weights make the result independent of how the faces are split into triangles.
  for (size_t v = 0; v < 8; ++v) {
    for (size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(mesh.normals[v][k], (mesh.positions[v][k] > 0.5F ? 1.0 : -1.0) / std::sqrt(3.0), 1e-6);
    }
  }
}

TEST(MeshOpsNormals, DegenerateFacesCountForNothing) {
  TriMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 1}};
  compute_vertex_normals(mesh, rad_from_deg(180));
  for (const auto& n : mesh.normals) EXPECT_EQ(n, (std::array<float, 3>{0, 0, 1}));
}

TEST(MeshOpsNormals, BoundsHoldEveryVertexAndNoMore) {
  const Box box = bounds(cube());
  EXPECT_EQ(box.lower, Vec3(0, 0, 0));
  EXPECT_EQ(box.upper, Vec3(1, 1, 1));
  EXPECT_THROW(bounds(TriMesh{}), InternalError);
}

}  // namespace
}  // namespace swarf::mesh
