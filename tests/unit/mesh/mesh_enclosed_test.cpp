// Facets within other bodies of a mesh, against a walk through the bodies from outside.
#include "mesh/mesh_enclosed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "support/solids.h"

namespace swarf::mesh::enclosed {
namespace {

using test::block;
using test::together;
using test::turned;

size_t count_enclosed(const TriMesh& mesh) {
  const Enclosed found = find_enclosed(mesh);
  const auto count = static_cast<size_t>(std::count(found.facets.begin(), found.facets.end(), uint8_t{1}));
  EXPECT_EQ(found.facets.size(), mesh.triangles.size());
  EXPECT_EQ(found.around.empty(), count == 0);
  return count;
}

const TriMesh kCasting = block({0, 0, 0}, {40, 40, 40});
const TriMesh kSunk = block({10, 10, 10}, {20, 20, 20});
const TriMesh kScrew = block({10, 10, 30}, {12, 12, 45});  // its foot is 10 deep in the casting

/// Its sides have an edge at `height`.
TriMesh divided_block(const Vec3& low, const Vec3& high, double height) {
  const auto at = [&](int corner, double z) {
    return Vec3(corner == 1 || corner == 2 ? high.x() : low.x(), corner >= 2 ? high.y() : low.y(), z);
  };
  TriMesh mesh;
  test::add_quad(mesh, at(3, low.z()), at(2, low.z()), at(1, low.z()), at(0, low.z()));
  test::add_quad(mesh, at(0, high.z()), at(1, high.z()), at(2, high.z()), at(3, high.z()));
  for (int i = 0; i < 4; ++i) {
    const int j = (i + 1) % 4;
    test::add_quad(mesh, at(i, low.z()), at(j, low.z()), at(j, height), at(i, height));
    test::add_quad(mesh, at(i, height), at(j, height), at(j, high.z()), at(i, high.z()));
  }
  return mesh;
}

/// A prism with a face in the plane x = z, in which an edge of the casting lies: that face is half inside.
TriMesh wedge() {
  const auto at = [](double x, double z, bool back) { return Vec3(x, back ? 20.0 : 10.0, z); };
  TriMesh mesh;
  const Vec2 corners[] = {{30, 30}, {50, 30}, {50, 50}};
  const auto point = [&](int i, bool back) { return at(corners[i % 3].x(), corners[i % 3].y(), back); };
  test::add_triangle(mesh, point(0, false), point(1, false), point(2, false));
  test::add_triangle(mesh, point(2, true), point(1, true), point(0, true));
  for (int i = 0; i < 3; ++i)
    test::add_quad(mesh, point(i + 1, false), point(i, false), point(i, true), point(i + 1, true));
  return mesh;
}

TEST(Enclosed, WhatLiesWithinABodyIsFound) {
  struct Case {
    const char* name;
    TriMesh mesh;
    size_t enclosed;
  };
  TriMesh open = kCasting;
  open.triangles.pop_back();
  TriMesh one_turned = kCasting;
  std::swap(one_turned.triangles.front()[0], one_turned.triangles.front()[1]);
  for (const Case& c :
       {Case{"one body", kCasting, 0}, Case{"no body", {}, 0},
        Case{"a body in a body", together({kCasting, kSunk}), 12},
        Case{"the inner one first", together({kSunk, kCasting}), 12},
        Case{"three in each other", together({kSunk, kCasting, block({5, 5, 5}, {30, 30, 30})}), 24},
        Case{"the foot of a screw", together({kCasting, kScrew}), 2},
        Case{"beside", together({kCasting, block({50, 0, 0}, {60, 10, 10})}), 0},
        Case{"touching outside", together({kCasting, block({40, 5, 5}, {50, 30, 30})}), 0},
        Case{"the same twice", together({kCasting, kCasting}), 0},
        Case{"in a cavity", together({kCasting, turned(block({5, 5, 5}, {30, 30, 30})), kSunk}), 24},
        Case{"in an open shell", together({open, kSunk}), 0},
        Case{"in a shell with a turned facet", together({one_turned, kSunk}), 0},
        Case{"in a shell turned inward", together({turned(kCasting), kSunk}), 0},
        Case{"flush with a face: what touches it stays",
             together({kCasting, block({20, 2, 30}, {30, 8, 40})}), 2},
        Case{"an edge around it in the face",
             together({kCasting, divided_block({20, 2, 30}, {30, 8, 50}, 40)}), 2},
        Case{"a face through an edge of the other", together({kCasting, wedge()}), 0},
        Case{"in the hole of a ring",
             together({test::torus(30, 10, {0, 0, 0}, 60, 20), block({-1, -1, -1}, {1, 1, 1})}), 0},
        Case{"in the ring",
             together({test::torus(30, 10, {0, 0, 0}, 60, 20), block({29, -1, -1}, {31, 1, 1})}), 12}}) {
    SCOPED_TRACE(c.name);
    EXPECT_EQ(count_enclosed(c.mesh), c.enclosed);
  }
}

TEST(Enclosed, ShellsOfManyFacetsAreLetBe) {
  EXPECT_EQ(
      count_enclosed(together({test::torus(30, 10, {0, 0, 0}, 128, 62), block({29, -1, -1}, {31, 1, 1})})),
      12u);
  EXPECT_EQ(
      count_enclosed(together({test::torus(30, 10, {0, 0, 0}, 128, 64), block({29, -1, -1}, {31, 1, 1})})),
      0u);
}

TEST(Enclosed, TheBoxesAroundHoldIt) {
  const Enclosed found = find_enclosed(together({kScrew, kCasting, block({100, 0, 0}, {110, 10, 10})}));
  ASSERT_EQ(found.around.size(), 1u);
  EXPECT_EQ(found.around[0].lower, Vec3(0, 0, 0));
  EXPECT_EQ(found.around[0].upper, Vec3(40, 40, 40));
}

/// Nearest facet from `from` along `along`, both sides; the number of triangles: none.
size_t first_met(const TriMesh& mesh, const std::vector<uint8_t>& left_out, const Vec3& from,
                 const Vec3& along) {
  size_t met = mesh.triangles.size();
  double nearest = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (left_out[i] != 0) continue;
    std::array<Vec3, 3> c;
    for (size_t k = 0; k < 3; ++k) {
      const auto& p = mesh.positions[mesh.triangles[i][k]];
      c[k] = {p[0], p[1], p[2]};
    }
    Eigen::Matrix3d m;
    m << c[1] - c[0], c[2] - c[0], -along;
    const Vec3 at = m.inverse() * (from - c[0]);
    if (!(at.x() >= 0.0 && at.y() >= 0.0 && at.x() + at.y() <= 1.0 && at.z() > 0.0 && at.z() < nearest))
      continue;
    nearest = at.z();
    met = i;
  }
  return met;
}

TEST(Enclosed, RaysFromOutsideMeetTheSameFacets) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(0.0, 60.0), size(2.0, 40.0), any(-1.0, 1.0);
  size_t enclosed = 0;
  for (int scene = 0; scene < 40; ++scene) {
    TriMesh mesh;
    for (int body = 0; body < 8; ++body) {
      const Vec3 low(place(random), place(random), place(random));
      test::append(mesh, block(low, low + Vec3(size(random), size(random), size(random))));
    }
    const Enclosed found = find_enclosed(mesh);
    enclosed += static_cast<size_t>(std::count(found.facets.begin(), found.facets.end(), uint8_t{1}));
    const std::vector<uint8_t> none(mesh.triangles.size(), 0);
    for (int ray = 0; ray < 200; ++ray) {
      const Vec3 from = 200.0 * Vec3(any(random), any(random), any(random)).normalized();
      const Vec3 along = Vec3(place(random), place(random), place(random)) - from;
      EXPECT_EQ(first_met(mesh, found.facets, from, along), first_met(mesh, none, from, along)) << scene;
    }
  }
  EXPECT_GT(enclosed, 50u);
}

}  // namespace
}  // namespace swarf::mesh::enclosed
