// Ridges far below the voxel size: what the mesh keeps of them, beside what OpenVDB's mesher keeps.
#include <gtest/gtest.h>
#include <openvdb/io/File.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "mesh/tri_mesh.h"
#include "stock/stock.h"
#include "support/scratch.h"

namespace swarf::stock::mesh_ridges_test {
namespace {

constexpr double kVoxel = 0.1, kRadius = 50.0, kRidge = 0.010;
const double kPitch = 2.0 * std::sqrt(2.0 * kRadius * kRidge);

/// Grooves of a wide radius side by side along Y, whose ridges stand 10 um over the grooves' bottoms at z =
/// 0.
Stock ridged(double shift) {
  Stock stock({{-6, -1, -2}, {6, 1, 0.5}}, kVoxel);
  for (int n = -3; n <= 3; ++n) {
    const Vec3 tip(n * kPitch + shift, -10, kRadius);
    stock.cut(std::vector<Sweep>{{{tip, Vec3::UnitY()}, {tip, Vec3::UnitY()}, 0}}, {kRadius, 20.0});
  }
  return stock;
}

struct Heights {
  double lowest = 1.0, highest = -1.0;
  void take(double x, double y, double z) {
    if (std::abs(x) > 5.0 || std::abs(y) > 0.8 || z < -0.5) return;
    lowest = std::min(lowest, z);
    highest = std::max(highest, z);
  }
};

Heights our_heights(const Stock& stock) {
  Heights heights;
  for (const auto& p : stock.mesh().positions) heights.take(p[0], p[1], p[2]);
  return heights;
}

Heights openvdb_heights(const Stock& stock) {
  const std::string path = test::scratch_text() + "mesh_ridges_test.vdb";
  stock.save(path, {});
  openvdb::io::File file(path);
  file.open();
  const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid(file.beginName().gridName()));
  file.close();
  std::remove(path.c_str());
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> triangles;
  std::vector<openvdb::Vec4I> quads;
  openvdb::tools::volumeToMesh(*grid, points, triangles, quads, 0.0, 0.0);
  Heights heights;
  for (const openvdb::Vec3s& p : points) heights.take(p.x(), p.y(), p.z());
  return heights;
}

TEST(MeshRidges, RidgesOfTenMicrometresStay) {
  // Sheets that meet at two degrees are one to the mesher, so a vertex lies up to half a voxel beside the
  // ridge.
  const double slope = 0.5 * kPitch / kRadius;
  for (const double shift : {0.0, 0.013, 0.037, 0.05}) {
    const Heights heights = our_heights(ridged(shift));
    EXPECT_GE(heights.highest, kRidge - slope * 0.5 * kVoxel) << shift;
    EXPECT_LE(heights.highest, 1.005 * kRidge) << shift;
    EXPECT_NEAR(heights.lowest, 0.0, 1e-4) << shift;
  }
}

TEST(MeshRidges, AreNoFlatterThanOpenVdbMeshesThem) {
  constexpr double kRounding = 1e-6;
  for (const double shift : {0.0, 0.013, 0.037, 0.05}) {
    const Stock stock = ridged(shift);
    const Heights ours = our_heights(stock), theirs = openvdb_heights(stock);
    EXPECT_GE(ours.highest, theirs.highest - kRounding) << shift;
  }
}

}  // namespace
}  // namespace swarf::stock::mesh_ridges_test
