// Decimation keeps its promise: the measured error, the attributes, the topology.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/parallel.h"
#include "base/rng.h"
#include "base/units.h"
#include "mesh/mesh_distance.h"
#include "mesh/mesh_ops.h"

namespace swarf::mesh::mesh_ops_decimate {
namespace {

/// Sphere of radius r as a closed grid of latitudes and longitudes, with the vertex number as its deviation.
TriMesh sphere(double r, uint32_t around, uint32_t down) {
  TriMesh mesh;
  mesh.positions.push_back({0, 0, static_cast<float>(r)});
  for (uint32_t i = 1; i < down; ++i) {
    for (uint32_t k = 0; k < around; ++k) {
      const double polar = kPi * i / down, turn = 2 * kPi * k / around;
      mesh.positions.push_back({static_cast<float>(r * std::sin(polar) * std::cos(turn)),
                                static_cast<float>(r * std::sin(polar) * std::sin(turn)),
                                static_cast<float>(r * std::cos(polar))});
    }
  }
  mesh.positions.push_back({0, 0, static_cast<float>(-r)});
  const auto last = static_cast<uint32_t>(mesh.positions.size() - 1);
  const auto at = [&](uint32_t i, uint32_t k) { return 1 + (i - 1) * around + k % around; };
  for (uint32_t k = 0; k < around; ++k) {
    mesh.triangles.push_back({0, at(1, k), at(1, k + 1)});
    mesh.triangles.push_back({last, at(down - 1, k + 1), at(down - 1, k)});
    for (uint32_t i = 1; i + 1 < down; ++i) {
      mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  }
  for (size_t v = 0; v < mesh.positions.size(); ++v) mesh.deviation_um.push_back(static_cast<float>(v));
  return mesh;
}

double volume(const TriMesh& mesh) {
  double six = 0;
  for (const auto& t : mesh.triangles) {
    const auto at = [&](int k) {
      const auto& p = mesh.positions[t[k]];
      return Vec3(p[0], p[1], p[2]);
    };
    six += at(0).dot(at(1).cross(at(2)));
  }
  return six / 6;
}

/// Every edge has exactly one partner running the other way.
bool closed(const TriMesh& mesh) {
  std::map<std::pair<uint32_t, uint32_t>, int> edges;
  for (const auto& t : mesh.triangles) {
    for (size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  }
  return std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
    const auto partner = edges.find({edge.first.second, edge.first.first});
    return edge.second == 1 && partner != edges.end() && partner->second == 1;
  });
}

TEST(Decimate, SphereStaysClosedWithinTheStatedError) {
  const TriMesh mesh = sphere(50, 400, 200);
  // The grid itself is 1.5 um off the sphere, so errors of that size leave nothing to remove.
  for (const auto& [allowed, share] : {std::pair{0.005, 0.95}, {0.02, 0.6}, {0.2, 0.05}}) {
    double reached = -1;
    const TriMesh coarse = decimate(mesh, allowed, &reached);
    EXPECT_GT(reached, 0.0) << allowed;
    EXPECT_LE(reached, allowed);
    const std::vector<double> all = distances(mesh.positions, coarse);
    EXPECT_EQ(reached, *std::max_element(all.begin(), all.end())) << "the reported error is the measured one";
    EXPECT_LT(static_cast<double>(coarse.triangles.size()),
              share * static_cast<double>(mesh.triangles.size()))
        << allowed;
    EXPECT_TRUE(closed(coarse)) << allowed;
    const double area = 4 * kPi * 50 * 50;
    EXPECT_NEAR(volume(coarse), volume(mesh), 2 * allowed * area);
  }
}

TEST(Decimate, FewerTrianglesForLargerErrors) {
  const TriMesh mesh = sphere(20, 300, 150);
  size_t before = mesh.triangles.size();
  for (const double allowed : {0.005, 0.05, 0.5}) {
    const size_t now = decimate(mesh, allowed, nullptr).triangles.size();
    EXPECT_LT(now, before) << allowed;
    before = now;
  }
}

TEST(Decimate, VerticesAreOriginalOnesWithTheirAttributes) {
  TriMesh mesh = sphere(50, 200, 100);
  compute_vertex_normals(mesh, kPi);
  Rng rng(7);
  for (size_t v = 0; v < mesh.positions.size(); ++v) {
    mesh.colours.push_back({static_cast<uint8_t>(rng.next()), static_cast<uint8_t>(rng.next()), 9, 255});
  }
  const TriMesh coarse = decimate(mesh, 0.05, nullptr);
  ASSERT_EQ(coarse.deviation_um.size(), coarse.positions.size());
  ASSERT_EQ(coarse.normals.size(), coarse.positions.size());
  ASSERT_EQ(coarse.colours.size(), coarse.positions.size());
  for (size_t v = 0; v < coarse.positions.size(); ++v) {
    const auto original = static_cast<size_t>(coarse.deviation_um[v]);
    ASSERT_EQ(coarse.positions[v], mesh.positions[original]);
    ASSERT_EQ(coarse.normals[v], mesh.normals[original]);
    ASSERT_EQ(coarse.colours[v], mesh.colours[original]);
  }
}

TEST(Decimate, OpenBorderStays) {
  TriMesh mesh;
  constexpr uint32_t kSide = 101;
  for (uint32_t y = 0; y < kSide; ++y) {
    for (uint32_t x = 0; x < kSide; ++x)
      mesh.positions.push_back({static_cast<float>(x), static_cast<float>(y), 0});
  }
  for (uint32_t y = 0; y + 1 < kSide; ++y) {
    for (uint32_t x = 0; x + 1 < kSide; ++x) {
      const uint32_t a = y * kSide + x;
      mesh.triangles.push_back({a, a + 1, a + kSide + 1});
      mesh.triangles.push_back({a, a + kSide + 1, a + kSide});
    }
  }
  double reached = -1;
  const TriMesh coarse = decimate(mesh, 0.01, &reached);
  EXPECT_LT(coarse.triangles.size(), 2000U);
  EXPECT_LE(reached, 1e-6);  // a plane loses nothing, least of all its corners
  double area = 0;
  for (const auto& t : coarse.triangles) {
    const auto &a = coarse.positions[t[0]], &b = coarse.positions[t[1]], &c = coarse.positions[t[2]];
    const double twice = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    EXPECT_GE(twice, 0.0) << "a triangle was turned over";
    area += 0.5 * twice;
  }
  EXPECT_NEAR(area, 1e4, 1e-6);
}

/// The planes of a needle hardly tell its tip from its foot, so that its collapse seems to cost nothing.
TEST(Decimate, APlaceThatCannotBecomeLighterKeepsItselfOnly) {
  TriMesh mesh = sphere(50, 400, 200);
  const size_t of_sphere = mesh.triangles.size();
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  for (int k = 0; k < 3; ++k)
    mesh.positions.push_back({60.0F + 1e-4F * static_cast<float>(std::cos(kPi * 2 / 3 * k)),
                              1e-4F * static_cast<float>(std::sin(kPi * 2 / 3 * k)), 0.0F});
  mesh.positions.push_back({60.0F, 0.0F, 1.0F});
  const uint32_t a = first, b = first + 1, c = first + 2, tip = first + 3;
  mesh.triangles.insert(mesh.triangles.end(), {{a, c, b}, {a, b, tip}, {b, c, tip}, {c, a, tip}});
  mesh.deviation_um.resize(mesh.positions.size(), 0.0F);
  double reached = -1;
  const TriMesh coarse = decimate(mesh, 0.02, &reached);
  EXPECT_LE(reached, 0.02);
  EXPECT_LT(static_cast<double>(coarse.triangles.size()), 0.6 * static_cast<double>(of_sphere));
  EXPECT_TRUE(closed(coarse));
  EXPECT_EQ(bounds(coarse).upper.x(), bounds(mesh).upper.x());
}

TEST(Decimate, SameForAnyNumberOfThreads) {
  const TriMesh mesh = sphere(50, 300, 150);
  set_thread_count(1);
  const TriMesh one = decimate(mesh, 0.01, nullptr);
  set_thread_count(0);
  const TriMesh all = decimate(mesh, 0.01, nullptr);
  EXPECT_EQ(one.positions, all.positions);
  EXPECT_EQ(one.triangles, all.triangles);
}

TEST(Decimate, SplitVerticesAreWeldedSoThatCreasesDoNotTear) {
  TriMesh mesh = sphere(10, 60, 30);
  mesh.deviation_um.clear();
  compute_vertex_normals(mesh, 0.0);  // every face gets vertices of its own
  ASSERT_GT(mesh.positions.size(), mesh.triangles.size());
  const TriMesh coarse = decimate(mesh, 0.2, nullptr);
  EXPECT_TRUE(closed(coarse));
  EXPECT_LT(coarse.triangles.size(), mesh.triangles.size());
}

TEST(Decimate, EmptyMeshStaysEmpty) {
  double reached = -1;
  EXPECT_TRUE(decimate(TriMesh{}, 0.1, &reached).triangles.empty());
  EXPECT_EQ(reached, 0.0);
}

TEST(Decimate, SheetsThatTouchAlongAnEdgeGetVerticesOfTheirOwn) {
  // Two tetrahedra on the edge 0-1.
  TriMesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
  mesh.triangles = {{0, 3, 2}, {0, 1, 3}, {0, 2, 1}, {1, 2, 3}, {0, 5, 4}, {0, 1, 5}, {0, 4, 1}, {1, 4, 5}};
  for (int v = 0; v < 6; ++v) mesh.deviation_um.push_back(static_cast<float>(v));
  const TriMesh result = decimate(mesh, 1e-4, nullptr);
  ASSERT_EQ(result.triangles.size(), 8U);
  ASSERT_EQ(result.positions.size(), 8U);
  std::set<std::pair<uint32_t, uint32_t>> edges;
  for (const auto& t : result.triangles) {
    for (int c = 0; c < 3; ++c) EXPECT_TRUE(edges.emplace(t[c], t[(c + 1) % 3]).second);
  }
  for (const auto& [from, to] : edges) EXPECT_TRUE(edges.contains({to, from})) << from << " " << to;
  EXPECT_EQ(result.deviation_um, (std::vector<float>{0, 1, 2, 3, 4, 5, 0, 1}));
}

}  // namespace
}  // namespace swarf::mesh::mesh_ops_decimate
