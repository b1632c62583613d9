// The mesh as a whole: closed and manifold on anything, exact on smooth sheets, volumes.
#include <gtest/gtest.h>

#include "base/parallel.h"
#include "base/units.h"
#include "mesh/mesh_ops.h"
#include "mesh_test_support.h"
#include "stock/mesher/stock_mesher.h"
#include "stock/stock.h"
#include "stock_test_support.h"

namespace swarf::stock {
namespace {

/// Short cuts everywhere in and around the box, with walls and crumbs of every thickness between them.
std::vector<Sweep> random_cuts(uint64_t seed, int count, double place) {
  Rng rng(seed);
  std::vector<Sweep> sweeps;
  for (int n = 0; n < count; ++n) {
    sweeps.push_back(random_sweep(rng, place, 1.5, n % 2 == 0 ? 0.0 : 0.2));
    sweeps.back().block = static_cast<uint32_t>(n);
  }
  return sweeps;
}

TEST(MeshShape, ClosedManifoldAndOrientedOnRandomCuts) {
  const Box box{{-3.1, -3.03, -3}, {3, 3.2, 3.07}};
  for (uint64_t seed = 1; seed <= 30; ++seed) {
    Rng rng(seed);
    const double voxel = rng.uniform(0.15, 0.5);
    Stock stock(box, voxel);
    stock.cut(random_cuts(seed, 60, 5.0), {rng.uniform(0.3, 1.2), 2.0});
    const TriMesh mesh = stock.mesh();
    EXPECT_EQ(manifold_fault(mesh), "") << "seed " << seed << " voxel " << voxel;
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    for (const auto& n : mesh.normals) {
      EXPECT_NEAR(Vec3(n[0], n[1], n[2]).norm(), 1.0, 1e-5) << "seed " << seed;
    }
    EXPECT_GT(enclosed_volume(mesh), 0.0) << "seed " << seed;
  }
}

TEST(MeshShape, EnclosesTheStocksVolumeOnRandomCuts) {
  const Box box{{-3.1, -3.03, -3}, {3, 3.2, 3.07}};
  for (uint64_t seed = 101; seed <= 104; ++seed) {
    Stock stock(box, 0.08);
    stock.cut(random_cuts(seed, 6, 4.0), {1.5, 4.0});
    EXPECT_NEAR(enclosed_volume(stock.mesh()), stock.volume_mm3(), 3e-3 * box.size().prod())
        << "seed " << seed;
  }
}

TEST(MeshShape, VolumeOfBlockAndSlot) {
  const Box box{{-10.02, -10.01, -12}, {40.03, 10.04, 0.05}};
  Stock stock(box, 0.2);
  EXPECT_NEAR(enclosed_volume(stock.mesh()), box.size().prod(), 1e-5 * box.size().prod());
  stock.cut(straight_sweeps({{0, 0, -2.95}, Vec3::UnitZ()}, {{30, 0, -2.95}, Vec3::UnitZ()}, 30),
            {5.0, 25.0});
  const double exact = box.size().prod() - 1135.6194490;  // theory 6
  EXPECT_NEAR(enclosed_volume(stock.mesh()), exact, 2e-4 * 1135.6);
}

TEST(MeshShape, PlanesAreExact) {
  constexpr uint64_t kSeed = 72;
  Rng rng(kSeed);
  for (int n = 0; n < 6; ++n) {
    const Vec3 axis = rng.direction(), point = 0.3 * rng.direction();
    Stock stock({{-3, -3, -3}, {3, 3, 3}}, 0.1);
    stock.cut(std::vector<Sweep>{{{point, axis}, {point, axis}, 0}}, {20.0, 40.0});
    size_t on_plane = 0;
    double farthest = 0.0, turned = 0.0;
    const TriMesh mesh = stock.mesh();
    for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
      const Vec3 p = vertex(mesh, v);
      const double off = std::abs((p - point).dot(axis));
      if (off > 0.05 || (3.0 - p.cwiseAbs().maxCoeff()) < 0.3) continue;
      ++on_plane;
      farthest = std::max(farthest, off);
      turned =
          std::max(turned, (Vec3(mesh.normals[v][0], mesh.normals[v][1], mesh.normals[v][2]) - axis).norm());
    }
    EXPECT_GT(on_plane, 1000U);
    EXPECT_LE(farthest, 1e-5) << "seed " << kSeed << " case " << n;
    EXPECT_LE(turned, 1e-3) << "seed " << kSeed << " case " << n;
  }
}

TEST(MeshShape, CylinderWithinAnEighthOfVoxelSquaredOverRadius) {
  // A pocket turned in space; walls only, away from its edges.
  constexpr double kVoxel = 0.1;
  for (const double r : {1.5, 4.0}) {
    const Pose frame(Eigen::AngleAxisd(0.6, Vec3(1, 0.3, 0.2).normalized()));
    const Vec3 axis = frame.linear().col(2);
    Stock stock({{-5, -5, -5}, {5, 5, 5}}, kVoxel);
    stock.cut(std::vector<Sweep>{{{frame * Vec3(0, 0, -2), axis}, {frame * Vec3(0, 0, -2), axis}, 0}},
              {r, 3.0});
    const TriMesh mesh = stock.mesh();
    double farthest = 0.0;
    size_t on_wall = 0;
    for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
      const Vec3 p = frame.inverse() * vertex(mesh, v);
      if (p.z() < -1.7 || p.z() > 0.7 || p.head<2>().norm() > r + 0.1) continue;
      ++on_wall;
      farthest = std::max(farthest, std::abs(p.head<2>().norm() - r));
    }
    EXPECT_GT(on_wall, 1000U);
    EXPECT_LE(farthest, kVoxel * kVoxel / r / 8.0) << r;
  }
}

TEST(MeshShape, NothingLeftGivesAnEmptyMesh) {
  Stock stock({{-1, -1, -1}, {1, 1, 1}}, 0.2);
  stock.cut(std::vector<Sweep>{{{{0, 0, -5}, Vec3::UnitZ()}, {{0, 0, -5}, Vec3::UnitZ()}, 0}}, {5.0, 20.0});
  const TriMesh mesh = stock.mesh();
  EXPECT_TRUE(mesh.positions.empty());
  EXPECT_TRUE(mesh.triangles.empty());
}

TEST(MeshShape, TwoPartsAreTwoClosedSurfaces) {
  Stock stock({{-4, -2, -2}, {4, 2, 2}}, 0.2);
  stock.cut(std::vector<Sweep>{{{{0, -4, -3}, Vec3::UnitZ()}, {{0, 4, -3}, Vec3::UnitZ()}, 0}}, {1.03, 20.0});
  const TriMesh mesh = stock.mesh();
  EXPECT_EQ(manifold_fault(mesh), "");
  EXPECT_NEAR(enclosed_volume(mesh), 2 * (4 - 1.03) * 16, 1e-4 * 95);
  for (const auto& t : mesh.triangles) {
    for (const uint32_t v : t) EXPECT_EQ(vertex(mesh, v).x() > 0, vertex(mesh, t[0]).x() > 0);
  }
}

/// A wall between two slots, from above: x = centre -+ thickness / 2 stands over z = -1.
Stock walled(double thickness, double centre, double voxel) {
  Stock stock({{-3, -1, -2}, {3, 1, 0}}, voxel);
  for (const double side : {-1.0, 1.0}) {
    const double x = centre + side * (1.0 + 0.5 * thickness);
    stock.cut(std::vector<Sweep>{{{{x, -3, -1}, Vec3::UnitZ()}, {{x, 3, -1}, Vec3::UnitZ()}, 0}},
              {1.0, 20.0});
  }
  return stock;
}

TEST(MeshShape, ThinWallsStayClosed) {
  constexpr double kVoxel = 0.1;
  for (const double thickness : {0.02, 0.05, 0.09, 0.11, 0.15, 0.23}) {
    for (const double centre : {0.0, 0.031, 0.05, 0.0499}) {
      const TriMesh mesh = walled(thickness, centre, kVoxel).mesh();
      EXPECT_EQ(manifold_fault(mesh), "") << thickness << " at " << centre;
      double highest = -2.0;
      for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
        const Vec3 p = vertex(mesh, v);
        if (std::abs(p.x() - centre) < 0.4 && std::abs(p.y()) < 0.8) highest = std::max(highest, p.z());
      }
      // A wall that contains a sheet of grid points stands, one that lies between two of them is lost.
      const double to_lattice = std::abs(centre - kVoxel * std::round(centre / kVoxel));
      if (to_lattice < 0.5 * thickness - 1e-6) {
        EXPECT_GE(highest, -0.06) << thickness << " at " << centre;
      } else if (to_lattice > 0.5 * thickness + 1e-6) {
        EXPECT_LE(highest, -0.9) << thickness << " at " << centre;
      }
    }
  }
}

TEST(MeshShape, DecimationKeepsTheSlotsEdges) {
  const Box box{{-4, -4, -3}, {8, 4, 0}};
  Stock stock(box, 0.1);
  stock.cut(straight_sweeps({{0.03, 0.02, -1.53}, Vec3::UnitZ()}, {{4.03, 0.02, -1.53}, Vec3::UnitZ()}, 4),
            {2.0, 20.0});
  const TriMesh fine = stock.mesh();
  double reached = 0.0;
  const TriMesh coarse = mesh::decimate(fine, 0.005, &reached);
  EXPECT_LE(reached, 0.005);
  // The curved ends of the slot need what is left; the planes collapse to a few large triangles.
  EXPECT_LT(coarse.triangles.size(), fine.triangles.size() / 15);
  EXPECT_EQ(manifold_fault(coarse), "");
  std::vector<EdgeLine> lines;
  for (const double z : {0.0, -1.53}) {
    lines.push_back(straight_edge({0.03, 2.02, z}, {4.03, 2.02, z}));
    lines.push_back(straight_edge({0.03, -1.98, z}, {4.03, -1.98, z}));
  }
  EXPECT_LE(edge_error(coarse, lines, 0.1).missed_mm, 0.010);
}

bool same(const TriMesh& a, const TriMesh& b) {
  return a.positions == b.positions && a.normals == b.normals && a.triangles == b.triangles;
}

TEST(StockMesher, GivesTheSameAsANewOneAfterEveryCut) {
  constexpr uint64_t kSeed = 73;
  const std::vector<Sweep> sweeps = random_cuts(kSeed, 25, 7.0);
  Stock stock({{-6, -6, -6}, {6, 6, 6}}, 0.2);
  StockMesher mesher(stock);
  mesher.mesh();
  const size_t all = mesher.leaves_meshed();
  for (size_t n = 0; n < sweeps.size(); ++n) {
    stock.cut(std::span(sweeps).subspan(n, 1), {0.8, 3.0});
    ASSERT_TRUE(same(mesher.mesh(), stock.mesh())) << "seed " << kSeed << " cut " << n;
    EXPECT_LT(mesher.leaves_meshed(), all / 2) << "cut " << n;
  }
  mesher.mesh();
  EXPECT_EQ(mesher.leaves_meshed(), 0U);
}

TEST(StockMesher, FollowsAStockUntilNothingIsLeftAndAfterItMoved) {
  Stock first({{-1, -1, -1}, {1, 1, 1}}, 0.1);
  StockMesher mesher(first);
  EXPECT_FALSE(mesher.mesh().triangles.empty());
  Stock stock = std::move(first);
  stock.cut(std::vector<Sweep>{{{{0, 0, -5}, Vec3::UnitZ()}, {{0, 0, -5}, Vec3::UnitZ()}, 0}}, {5.0, 20.0});
  EXPECT_TRUE(mesher.mesh().triangles.empty());
}

TEST(StockMesher, SameForAnyNumberOfThreads) {
  Stock stock({{-6, -6, -6}, {6, 6, 6}}, 0.2);
  stock.cut(random_cuts(74, 60, 7.0), {0.8, 3.0});
  const TriMesh expected = stock.mesh();
  for (const int threads : {1, 2, 4}) {
    set_thread_count(threads);
    EXPECT_TRUE(same(stock.mesh(), expected)) << threads;
  }
  set_thread_count(0);
}

}  // namespace
}  // namespace swarf::stock
