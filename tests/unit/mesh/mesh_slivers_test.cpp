// Triangles that the rounding of their corners turns: their longest sides are flipped.
#include "mesh/mesh_slivers.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "mesh/mesh_check.h"

namespace mesh_slivers_test {
namespace {

using swarf::TriMesh;
using swarf::Vec3;

constexpr double kHeight = 2e-4;

Vec3 corner(const TriMesh& mesh, size_t triangle, size_t k) {
  const auto& p = mesh.positions[mesh.triangles[triangle][k]];
  return {p[0], p[1], p[2]};
}

double least_height(const TriMesh& mesh) {
  double least = 1e9;
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = corner(mesh, t, 0), ab = corner(mesh, t, 1) - a, ac = corner(mesh, t, 2) - a;
    least = std::min(least, ab.cross(ac).norm() / std::max({ab.norm(), ac.norm(), (ac - ab).norm()}));
  }
  return least;
}

/// A pyramid 10 mm high over a square of 20 mm, one side of whose base has a vertex in its middle that lies
/// `aside_mm` off it: of the side's two facets one is a sliver.
TriMesh pyramid(float aside_mm) {
  TriMesh mesh;
  mesh.positions = {{0, 0, 0}, {20, 0, 0}, {20, 20, 0}, {0, 20, 0}, {10, 10, 10}, {10, 0, aside_mm}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 5}, {5, 1, 4}, {0, 5, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  return mesh;
}

TEST(FlipSlivers, MoveNoPlaceByMoreThanTheirHeight) {
  TriMesh mesh = pyramid(1e-5F);
  ASSERT_LT(least_height(mesh), 2e-5);
  const double moved = swarf::mesh::flip_slivers(mesh, kHeight);
  EXPECT_NEAR(moved, 1e-5, 1e-7);
  EXPECT_GT(least_height(mesh), 1.0);
  EXPECT_EQ(mesh.triangles.size(), 8u);
  EXPECT_NEAR(swarf::mesh::enclosed_volume(mesh), 4000.0 / 3.0, 20.0 * 20.0 * 1e-5);
  const auto across = swarf::mesh::facets_across(mesh.triangles);
  EXPECT_EQ(std::count(across.begin(), across.end(), 0xffffffffU), 0) << "the mesh is open";
}

TEST(FlipSlivers, LeaveAMeshWithoutThemAsItIs) {
  TriMesh mesh = pyramid(0.5F);
  mesh.normals.assign(mesh.positions.size(), {0, 0, 1});
  const TriMesh before = mesh;
  EXPECT_EQ(swarf::mesh::flip_slivers(mesh, kHeight), 0.0);
  EXPECT_EQ(mesh.triangles, before.triangles);
  EXPECT_EQ(mesh.normals, before.normals);
}

}  // namespace
}  // namespace mesh_slivers_test
