// The ray that tells inside from outside, against closed forms, and where it passes edges and corners.
#include "collision/winding.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/collision/toy_machine.h"

namespace swarf::collision {
namespace {

Body winding_body(const TriMesh& mesh, const Pose& placed = Pose::Identity()) {
  return mesh_body("body", BodyKind::kFixture, -1, mesh, placed);
}

TriMesh joined(const TriMesh& a, const TriMesh& b) {
  TriMesh both = a;
  const auto first = static_cast<uint32_t>(a.positions.size());
  both.positions.insert(both.positions.end(), b.positions.begin(), b.positions.end());
  for (const auto& t : b.triangles) both.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return both;
}

TEST(Winding, OfABoxWhereverItStands) {
  Rng rng(7);
  for (const double far : {0.0, 300.0, 2000.0}) {
    Pose placed = Pose::Identity();
    placed.translation() = Vec3(far, -far, 0.5 * far);
    const Body box = winding_body(box_mesh(Vec3(-10, -5, -2), Vec3(10, 5, 2)), placed);
    for (int i = 0; i < 2000; ++i) {
      const Vec3 p(rng.uniform(-12, 12), rng.uniform(-6, 6), rng.uniform(-3, 3));
      const bool inside = std::abs(p.x()) < 10 && std::abs(p.y()) < 5 && std::abs(p.z()) < 2;
      ASSERT_NEAR(winding_number(box, placed * p), inside ? 1.0 : 0.0, 1e-9) << p.transpose();
    }
  }
}

/// Each of the rays of winding.cpp is sent at edges and corners; and from places on the lattice of the box.
TEST(Winding, WhereRaysPassEdgesAndCorners) {
  const Body box = winding_body(box_mesh(Vec3(-10, -5, -2), Vec3(10, 5, 2)));
  for (const Vec3& ray :
       {Vec3(0.5374, 0.2963, 0.7897), Vec3(-0.6871, 0.6317, -0.3588), Vec3(0.2219, -0.8903, 0.3977)})
    for (int corner = 0; corner < 8; ++corner)
      for (const double along : {-30.0, -3.0, -0.5}) {
        const Vec3 at(corner & 1 ? 10 : -10, corner & 2 ? 5 : -5, corner & 4 ? 2 : -2);
        for (const Vec3& aimed :
             {at, Vec3(0, at.y(), at.z()), Vec3(at.x(), at.y(), 0.3), Vec3(0, 0, at.z())}) {
          const Vec3 p = aimed + along * ray;
          const bool inside = std::abs(p.x()) < 10 && std::abs(p.y()) < 5 && std::abs(p.z()) < 2;
          ASSERT_NEAR(winding_number(box, p), inside ? 1.0 : 0.0, 1e-9) << p.transpose();
        }
      }
}

TEST(Winding, ShellsThatOverlapCountTwiceAndHollowsNone) {
  const TriMesh outer = box_mesh(Vec3(-10, -10, -10), Vec3(10, 10, 10));
  TriMesh hollow = box_mesh(Vec3(-4, -4, -4), Vec3(4, 4, 4));
  EXPECT_NEAR(winding_number(winding_body(joined(outer, hollow)), Vec3(1, 2, 3)), 2.0, 1e-9);
  for (auto& t : hollow.triangles) std::swap(t[0], t[1]);
  const Body shell = winding_body(joined(outer, hollow));
  EXPECT_NEAR(winding_number(shell, Vec3(1, 2, 3)), 0.0, 1e-9);
  EXPECT_NEAR(winding_number(shell, Vec3(7, 2, 3)), 1.0, 1e-9);
  EXPECT_FALSE(holds_point(shell, Vec3(1, 2, 3)));
  EXPECT_TRUE(holds_point(shell, Vec3(7, 2, 3)));
}

/// Facets without area change nothing, and a foil of a hundredth of a millimetre has an inside.
TEST(Winding, OfAFoilWithFlatFacets) {
  TriMesh foil = box_mesh(Vec3(-50, -50, 0), Vec3(50, 50, 0.01));
  foil.triangles.push_back({0, 1, 1});
  foil.triangles.push_back({1, 0, 0});
  const Body body = winding_body(foil);
  EXPECT_NEAR(winding_number(body, Vec3(3, 4, 0.005)), 1.0, 1e-9);
  EXPECT_NEAR(winding_number(body, Vec3(3, 4, 0.011)), 0.0, 1e-9);
  EXPECT_NEAR(winding_number(body, Vec3(3, 4, -0.001)), 0.0, 1e-9);
}

}  // namespace
}  // namespace swarf::collision
