// Signs at faces, edges and vertices, and meshes that run through themselves.
#include <gtest/gtest.h>

#include "base/rng.h"
#include "base/units.h"
#include "mesh/mesh_check.h"
#include "mesh/mesh_crossing.h"
#include "mesh/mesh_lines.h"
#include "mesh/mesh_shells.h"
#include "mesh/signed_distance.h"
#include "mesh/winding.h"
#include "support/solids.h"

namespace swarf::mesh {
namespace {

/// Signed distance to an axis-aligned box, by its closed form.
double box_distance(const Vec3& p, const Vec3& half) {
  const Vec3 q = p.cwiseAbs() - half;
  return q.cwiseMax(Vec3::Zero()).norm() + std::min(0.0, q.maxCoeff());
}

/// A wedge of 20 degrees along y whose sharp edge its slope has in two; a facet without area closes it.
TriMesh wedge(bool seam) {
  const double height = 30.0 * std::tan(20.0 * kPi / 180.0);
  const Vec3 a0(0, -20, 0), a1(0, 20, 0), e0(30, -20, 0), e1(30, 20, 0), t0(0, -20, height),
      t1(0, 20, height), middle(30, 3, 0);
  TriMesh mesh;
  test::add_quad(mesh, a0, a1, e1, e0);
  test::add_quad(mesh, a0, t0, t1, a1);
  test::add_triangle(mesh, a0, e0, t0);
  test::add_triangle(mesh, a1, t1, e1);
  if (seam) {
    test::add_triangle(mesh, e0, middle, t0);
    test::add_triangle(mesh, middle, t1, t0);
    test::add_triangle(mesh, middle, e1, t1);
    test::add_triangle(mesh, e0, e1, middle);
  } else {
    test::add_quad(mesh, e0, e1, t1, t0);
  }
  return mesh;
}

TEST(SignedDistance, AFacetWithoutAreaInASharpEdgeDoesNotTurnTheSign) {
  ASSERT_EQ(check_closed(wedge(true)), "");
  const SignedDistance plain(wedge(false)), seamed(wedge(true));
  Rng rng(11);
  for (int i = 0; i < 4000; ++i) {
    Vec3 p(30.0 + rng.uniform(-2, 3), rng.uniform(-21, 21), rng.uniform(-2, 2));
    if (i % 4 == 0) p.y() = 3.0;  // the vertex within the long side is nearest
    ASSERT_NEAR(seamed.at(p).distance_mm, plain.at(p).distance_mm, 1e-12)
        << "seed 11, point " << p.transpose();
  }
}

TEST(SignedDistance, OfABoxIsItsClosedFormEverywhere) {
  const Vec3 half(3, 2, 1);
  const SignedDistance distance(test::block(-half, half));
  Rng rng(7);
  for (int i = 0; i < 2000; ++i) {
    Vec3 p(rng.uniform(-5, 5), rng.uniform(-4, 4), rng.uniform(-3, 3));
    if (i % 4 == 1) p.x() = 3.0 + p.y() - 2.0;                    // in the plane that halves an edge's angle
    if (i % 4 == 2) p = (1.0 + 0.1 * rng.uniform(-5, 5)) * half;  // along the diagonal: a vertex is nearest
    ASSERT_NEAR(distance.at(p).distance_mm, box_distance(p, half), 1e-12)
        << "seed 7, point " << p.transpose();
  }
}

/// A needle of a notch: the mean of the vertex normals would give the wrong sign above its tip.
TEST(SignedDistance, HoldsItsSignAtAcuteCornersInAndOut) {
  const std::vector<double> x{0, 1, 1.02, 3}, y{0, 1, 2};
  const TriMesh slit = test::towers(x, y, 0.0, [](int i, int j) { return i == 1 && j == 0 ? 0.5 : 2.0; });
  const SignedDistance distance(slit);
  EXPECT_NEAR(distance.at({1.01, 0.5, 1.0}).distance_mm, 0.01, 1e-6);   // in the slit: air
  EXPECT_NEAR(distance.at({1.03, 0.5, 1.0}).distance_mm, -0.01, 1e-6);  // beside it: material
  EXPECT_NEAR(distance.at({1.01, 0.5, 0.4}).distance_mm, -0.1, 1e-6);   // below it
}

/// How often the mesh winds around the point, by all of its facets.
double turns_around(const TriMesh& mesh, const Vec3& p) {
  const WeldedMesh welded = weld(mesh);
  double turns = 0.0;
  for (uint32_t t = 0; t < welded.triangles.size(); ++t) turns += solid_angle(corners_of(welded, t), p);
  return turns;
}

/// A block in whose inside lie a flap of two sheets in one plane, z = 1, as a grid's mesh has
/// at sharp rims, and a small block that covers its place a second time.
TriMesh folded_block() {
  TriMesh mesh = test::block({0, 0, 0}, {8, 6, 4});
  const Vec3 a(3, 3, 1), b(3.6, 3.05, 1), c(3.1, 3.2, 1);
  test::add_triangle(mesh, a, b, c);
  test::add_triangle(mesh, a, c, b);
  test::append(mesh, test::block({5, 2, 2}, {5.2, 2.2, 2.2}));  // covered twice
  return mesh;
}

TEST(SignedDistance, OfAMeshThatRunsThroughItselfHasTheSignOfItsWindingNumber) {
  const TriMesh mesh = folded_block();
  ASSERT_EQ(check_closed(mesh), "");
  constexpr double kError = 0.25;
  const SignedDistance folded(mesh, kError), plain(mesh);
  Rng rng(5);
  int turned = 0;
  for (int i = 0; i < 4000; ++i) {
    Vec3 p(rng.uniform(-1, 9), rng.uniform(-1, 7), rng.uniform(-1, 5));
    if (i % 2 == 0) p.z() = 1.0;                                                // in the plane of the flap
    if (i % 8 == 1) p = Vec3(5.1, 2.1, 2.1) + 0.3 * (p - Vec3(4, 3, 2)) / 3.0;  // all round the inner block
    const double distance = folded.at(p).distance_mm;
    ASSERT_DOUBLE_EQ(std::abs(distance), std::abs(plain.at(p).distance_mm));
    if (std::abs(distance) <= kError) continue;
    ASSERT_EQ(distance<0.0, turns_around(mesh, p)> 0.5) << "seed 5, point " << p.transpose();
    if (distance * plain.at(p).distance_mm < 0.0) ++turned;
  }
  EXPECT_GT(turned, 100);
}

TEST(MeshLines, WindAroundAPointAsOftenAsAllFacetsTell) {
  TriMesh mesh = test::torus(3, 1, {0, 0, 0}, 24, 12);
  test::append(mesh, test::block({2, -1, -2}, {4, 1, 2}));
  const MeshLines lines(mesh);
  Rng rng(6);
  for (int i = 0; i < 1000; ++i) {
    Vec3 p(rng.uniform(-5, 5), rng.uniform(-5, 5), rng.uniform(-2.5, 2.5));
    // From where the rays pass corners of the block.
    if (i % 4 == 0) p = Vec3(4, 1, 2) - rng.uniform(0.1, 3) * winding_rays()[i / 4 % 3];
    ASSERT_NEAR(lines.winding(p), turns_around(mesh, p), 1e-9) << "seed 6, point " << p.transpose();
  }
}

TEST(SignedDistance, PointsBesideAnOpenSheetLieBeyondIt) {
  TriMesh sheet;
  test::add_quad(sheet, {0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0});
  const SignedDistance distance(sheet);
  EXPECT_DOUBLE_EQ(distance.at({2, 1, 0.5}).distance_mm, 0.5);
  EXPECT_DOUBLE_EQ(distance.at({2, 1, -0.5}).distance_mm, -0.5);
  EXPECT_DOUBLE_EQ(distance.at({2, 1, 0.5}).beyond_mm, 0.0);
  EXPECT_NEAR(distance.at({4.25, 1, 0.5}).beyond_mm, 0.25, 1e-12);
}

TEST(SignedDistance, NothingIsFoundBeyondTheGivenReach) {
  const SignedDistance distance(test::block({0, 0, 0}, {1, 1, 1}));
  EXPECT_TRUE(std::isinf(distance.at({3, 0.5, 0.5}, 1.9).distance_mm));
  EXPECT_DOUBLE_EQ(distance.at({3, 0.5, 0.5}, 2.0).distance_mm, 2.0);
}

size_t crossings(const TriMesh& mesh) {
  return find_crossings(SignedDistance(mesh)).pairs;
}

TEST(MeshCrossing, SoundSolidsHaveNone) {
  EXPECT_EQ(crossings(test::block({0, 0, 0}, {1, 2, 3})), 0U);
  EXPECT_EQ(crossings(test::towers({0, 1, 2, 3}, {0, 1, 2, 3}, 0,
                                   [](int i, int j) { return 1.0 + (i == 1 && j == 1); })),
            0U);
  EXPECT_EQ(crossings(test::sphere(25, {0.007, 0, 0}, 120, 60)), 0U);
  EXPECT_EQ(crossings(test::torus(30, 10, {0, 0, 0}, 120, 48)), 0U);
  TriMesh apart = test::block({0, 0, 0}, {1, 1, 1});
  test::append(apart, test::block({1.5, 0, 0}, {2, 1, 1}));
  EXPECT_EQ(crossings(apart), 0U);
}

TEST(MeshCrossing, BodiesThatRunThroughEachOtherAreFoundHoweverTheyLie) {
  const TriMesh first = test::block({0, 0, 0}, {2, 2, 2});
  const std::vector<std::pair<Vec3, Vec3>> others{{{1, 0, 0}, {3, 2, 2}},           // sides in one plane
                                                  {{1, 0.5, 0.5}, {3, 1.5, 1.5}},   // through a face
                                                  {{1, 1, 1}, {3, 3, 3}},           // corner in corner
                                                  {{-1, 0.5, 0.5}, {3, 1.5, 1.5}},  // right through
                                                  {{1.999, 0, 0}, {3, 2, 2}}};
  for (const auto& [low, high] : others) {
    TriMesh both = first;
    test::append(both, test::block(low, high));
    EXPECT_GT(crossings(both), 0U) << low.transpose() << " .. " << high.transpose();
  }
}

/// Random rotations of a pair that crosses by .01 mm, and of one that stays .01 mm apart.
TEST(MeshCrossing, RandomPosesOfNearMissesAreToldFromCrossings) {
  for (uint64_t seed = 1; seed <= 40; ++seed) {
    Rng rng(seed);
    const Vec3 axis(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
    const Mat3 turn = Eigen::AngleAxisd(rng.uniform(0, 3), axis.normalized()).toRotationMatrix();
    for (const double gap : {0.01, -0.01}) {
      TriMesh both = test::block({-10, -10, -10}, {10, 10, 10});
      test::append(both, test::block({10 + gap, -5, -5}, {20, 5, 5}));
      for (auto& p : both.positions) {
        const Eigen::Vector3f q = (turn * Vec3(p[0], p[1], p[2])).cast<float>();
        p = {q.x(), q.y(), q.z()};
      }
      ASSERT_EQ(crossings(both) > 0, gap < 0) << "seed " << seed << " gap " << gap;
    }
  }
}

TEST(FacetsAcross, NamesTheOtherFacetOfEachSide) {
  const TriMesh mesh = test::block({0, 0, 0}, {1, 1, 1});
  const auto welded = weld(mesh);
  const auto across = facets_across(welded.triangles);
  for (uint32_t side = 0; side < across.size(); ++side) {
    ASSERT_LT(across[side], welded.triangles.size());
    const auto& t = welded.triangles[side / 3];
    const auto& other = welded.triangles[across[side]];
    for (const uint32_t v : {t[side % 3], t[(side + 1) % 3]})
      EXPECT_TRUE(std::find(other.begin(), other.end(), v) != other.end());
  }
}

}  // namespace
}  // namespace swarf::mesh
