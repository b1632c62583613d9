// Sharp edges of the mesh at 0.1 mm voxels: at most 10 um from the true ones.
#include <gtest/gtest.h>

#include "base/units.h"
#include "mesh_test_support.h"
#include "stock/stock.h"
#include "stock_test_support.h"

namespace swarf::stock {
namespace {

constexpr double kVoxel = 0.1;
constexpr double kAllowed = 0.010;
constexpr double kRange = 0.15;

/// The outline of a slot along x' of the frame: two straight lines and two half circles at height z'.
std::vector<EdgeLine> slot_outline(const Pose& X_Wf, double length, double r, double z) {
  const auto at = [&](double x, double y) { return Vec3(X_Wf * Vec3(x, y, z)); };
  const Vec3 ex = r * X_Wf.linear().col(0), ey = r * X_Wf.linear().col(1);
  return {straight_edge(at(0, r), at(length - 0, r)), straight_edge(at(0, -r), at(length - 0, -r)),
          arc_edge(at(0, 0), -ex, ey, -0.5 * kPi, 0.5 * kPi),
          arc_edge(at(length, 0), ex, ey, -0.5 * kPi, 0.5 * kPi)};
}

void expect_sharp(const Stock& stock, const std::vector<EdgeLine>& lines, const std::string& what) {
  const TriMesh mesh = stock.mesh();
  EXPECT_EQ(manifold_fault(mesh), "") << what;
  const EdgeError error = edge_error(mesh, lines, kRange);
  EXPECT_LE(error.missed_mm, kAllowed) << what;
  EXPECT_LE(error.strayed_mm, kAllowed) << what;
  EXPECT_GT(error.sharp_edges, 300U) << what;
}

TEST(MeshEdges, SlotAlongTheAxes) {
  for (const Vec3& shift :
       {Vec3(0, 0, 0), Vec3(0.031, 0.067, 0.013), Vec3(0.05, 0.05, 0.05), Vec3(0, 0.0999, 0)}) {
    Stock stock({Vec3(-4, -4, -4) + shift, Vec3(12, 4, 0) + shift}, kVoxel);
    const Pose frame(Eigen::Translation3d(1.7 * shift));
    stock.cut(straight_sweeps({frame * Vec3(0, 0, -1.5), Vec3::UnitZ()},
                              {frame * Vec3(8, 0, -1.5), Vec3::UnitZ()}, 5),
              {2.0, 20.0});
    std::vector<EdgeLine> lines = slot_outline(frame, 8, 2, -1.5);
    const std::vector<EdgeLine> rim = slot_outline(frame, 8, 2, -0.7 * shift.z());
    lines.insert(lines.end(), rim.begin(), rim.end());
    expect_sharp(stock, lines, "shift " + text(shift));
  }
}

TEST(MeshEdges, SlotTurnedInSpace) {
  // A wide cutter faces the block in a turned plane, a small one cuts the slot into it.
  constexpr uint64_t kSeed = 71;
  Rng rng(kSeed);
  for (int n = 0; n < 5; ++n) {
    const Pose frame = Eigen::Translation3d(0.1 * rng.direction()) *
                       Eigen::AngleAxisd(rng.uniform(0.0, 3.1), rng.direction());
    const Vec3 axis = frame.linear().col(2);
    Stock stock({Vec3(-5, -5, -5), Vec3(5, 5, 5)}, kVoxel);
    stock.cut(std::vector<Sweep>{{{frame * Vec3(-1, 0, 0), axis}, {frame * Vec3(1, 0, 0), axis}, 0}},
              {20.0, 40.0});
    stock.cut(straight_sweeps({frame * Vec3(-1, 0, -1.2), axis}, {frame * Vec3(1, 0, -1.2), axis}, 3),
              {1.3, 20.0});
    const Pose slot = frame * Eigen::Translation3d(-1, 0, 0);
    std::vector<EdgeLine> lines = slot_outline(slot, 2, 1.3, -1.2);
    const std::vector<EdgeLine> rim = slot_outline(slot, 2, 1.3, 0.0);
    lines.insert(lines.end(), rim.begin(), rim.end());
    expect_sharp(stock, lines, fmt::format("seed {} case {}", kSeed, n));
  }
}

TEST(MeshEdges, FlatEndThatLeansSideways) {
  for (const double lean : {0.03, 0.2, 0.5}) {
    // The floor is a plane across the axis, the walls are planes along it, all parallel to the feed.
    const Pose frame = Eigen::Translation3d(0.013, 0.021, -2.017) * Eigen::AngleAxisd(lean, Vec3::UnitX());
    Stock stock({Vec3(-8, -5, -6), Vec3(8, 5, 0)}, kVoxel);
    const Vec3 axis = frame.linear().col(2);
    stock.cut(straight_sweeps({frame * Vec3(-12, 0, 0), axis}, {frame * Vec3(12, 0, 0), axis}, 4),
              {2.0, 20.0});
    std::vector<EdgeLine> lines;
    for (const double y : {-2.0, 2.0}) {
      lines.push_back(straight_edge(frame * Vec3(-7.8, y, 0), frame * Vec3(7.8, y, 0)));
      const Vec3 foot = frame * Vec3(0, y, 0);
      const Vec3 top = foot - axis * (foot.z() / axis.z());
      lines.push_back(straight_edge(top - Vec3(7.8, 0, 0), top + Vec3(7.8, 0, 0)));
    }
    expect_sharp(stock, lines, fmt::format("lean {}", lean));
  }
}

TEST(MeshEdges, RimAndBottomOfAPlungedPocket) {
  for (const double r : {4.0, 1.0}) {
    const Pose frame(Eigen::Translation3d(0.037, -0.021, 0.0));
    Stock stock({Vec3(-5, -5, -4), Vec3(5, 5, 0.04)}, kVoxel);
    stock.cut(
        std::vector<Sweep>{
            {{frame * Vec3(0, 0, 4), Vec3::UnitZ()}, {frame * Vec3(0, 0, -2.03), Vec3::UnitZ()}, 0}},
        {r, 20.0});
    const Vec3 ex = r * Vec3::UnitX(), ey = r * Vec3::UnitY();
    expect_sharp(stock,
                 {arc_edge(frame * Vec3(0, 0, 0.04), ex, ey, 0, 2 * kPi),
                  arc_edge(frame * Vec3(0, 0, -2.03), ex, ey, 0, 2 * kPi)},
                 fmt::format("r {}", r));
  }
}

TEST(MeshEdges, EdgesAndCornersOfTheBox) {
  for (const Box& box :
       {Box{{-1, -2, -1}, {1, 2, 3}}, Box{{-1.013, -2.031, -1.05}, {1.077, 2.0999, 3.0001}}}) {
    const Stock stock(box, kVoxel);
    std::vector<EdgeLine> lines;
    for (int axis = 0; axis < 3; ++axis) {
      for (int n = 0; n < 4; ++n) {
        Vec3 a = box.lower;
        a[(axis + 1) % 3] = n & 1 ? box.upper[(axis + 1) % 3] : box.lower[(axis + 1) % 3];
        a[(axis + 2) % 3] = n & 2 ? box.upper[(axis + 2) % 3] : box.lower[(axis + 2) % 3];
        Vec3 b = a;
        b[axis] = box.upper[axis];
        lines.push_back(straight_edge(a, b));
      }
    }
    expect_sharp(stock, lines, "box to " + text(box.upper));
    EXPECT_NEAR(enclosed_volume(stock.mesh()), box.size().prod(), 1e-5 * box.size().prod());
  }
}

}  // namespace
}  // namespace swarf::stock
