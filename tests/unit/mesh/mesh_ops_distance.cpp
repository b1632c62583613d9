// Point to mesh distance against closed forms and against brute force.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/rng.h"
#include "mesh/mesh_distance.h"

namespace swarf::mesh {
namespace {

std::array<float, 3> random_point(Rng& rng, double half) {
  return {static_cast<float>(rng.uniform(-half, half)), static_cast<float>(rng.uniform(-half, half)),
          static_cast<float>(rng.uniform(-half, half))};
}

Vec3 to_eigen(const std::array<float, 3>& p) {
  return {p[0], p[1], p[2]};
}

TEST(MeshDistance, ClosestPointInEachRegionOfATriangle) {
  const Vec3 a(0, 0, 0), b(4, 0, 0), c(0, 3, 0);
  const auto expect = [&](const Vec3& p, const Vec3& nearest) {
    EXPECT_LT((closest_point_on_triangle(p, a, b, c) - nearest).norm(), 1e-14) << p.transpose();
  };
  expect({1, 1, 5}, {1, 1, 0});  // face
  expect({-1, -2, 1}, a);        // corners
  expect({6, -1, 1}, b);
  expect({-1, 5, 0}, c);
  expect({2, -3, 2}, {2, 0, 0});  // edges
  expect({-3, 1, 2}, {0, 1, 0});
  expect({2 + 3, 1.5 + 4, 7}, {2, 1.5, 0});  // along the normal (3, 4) of the long edge
}

TEST(MeshDistance, DegenerateTrianglesActAsTheirEdges) {
  const Vec3 a(0, 0, 0), b(4, 0, 0), c(1, 0, 0);
  EXPECT_LT((closest_point_on_triangle({3, 2, 0}, a, b, c) - Vec3(3, 0, 0)).norm(), 1e-14);
  EXPECT_LT((closest_point_on_triangle({3, 2, 0}, a, a, a) - a).norm(), 1e-14);
}

/// The tree finds what a loop over all triangles finds. Failing case: seed and point are printed.
TEST(MeshDistance, TreeAgreesWithBruteForce) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    Rng rng(seed);
    TriMesh mesh;
    const auto vertices = static_cast<uint32_t>(3 + rng.next() % 60);
    for (uint32_t i = 0; i < vertices; ++i) mesh.positions.push_back(random_point(rng, 10));
    for (int i = 0; i < 100; ++i) {
      mesh.triangles.push_back({static_cast<uint32_t>(rng.next() % vertices),
                                static_cast<uint32_t>(rng.next() % vertices),
                                static_cast<uint32_t>(rng.next() % vertices)});
    }
    const MeshDistance distance(mesh);
    for (int i = 0; i < 50; ++i) {
      const Vec3 p = to_eigen(random_point(rng, 15));
      double best = std::numeric_limits<double>::infinity();
      for (const auto& t : mesh.triangles) {
        const Vec3 q =
            closest_point_on_triangle(p, to_eigen(mesh.positions[t[0]]), to_eigen(mesh.positions[t[1]]),
                                      to_eigen(mesh.positions[t[2]]));
        best = std::min(best, (q - p).norm());
      }
      ASSERT_DOUBLE_EQ(distance.nearest(p).distance_mm, best)
          << "seed " << seed << " point " << p.transpose();
    }
  }
}

TEST(MeshDistance, EmptyMeshIsInfinitelyFar) {
  EXPECT_EQ(MeshDistance(TriMesh{}).nearest(Vec3::Zero()).distance_mm,
            std::numeric_limits<double>::infinity());
  EXPECT_TRUE(distances({}, TriMesh{}).empty());
}

}  // namespace
}  // namespace swarf::mesh
