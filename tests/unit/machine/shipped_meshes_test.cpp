// The parts of the shipped machines: closed, and none of them inside another at home.
#include <gtest/gtest.h>

#include <cmath>

#include "mesh/mesh_io.h"
#include "shipped_machines.h"

namespace swarf::machine {
namespace {

constexpr double kCell = 20.0;       // mm
constexpr double kDepth = 0.3;       // mm under the surface: parts that only touch are not inside each other
constexpr double kSpacing = 25.0;    // mm between sampled points
constexpr double kOffGrid = 1.7e-4;  // mm: no vertical through a point meets an edge of the drawings

struct Triangle {
  Vec3 a, b, c;
};

/// A part where it stands at home, with its triangles sorted into cells of the floor.
class StandingPart {
 public:
  StandingPart(const TriMesh& mesh, const Pose& pose) {
    for (const auto& t : mesh.triangles) {
      const auto at = [&](uint32_t k) -> Vec3 {
        const auto& p = mesh.positions[k];
        return pose * Vec3(p[0], p[1], p[2]);
      };
      triangles_.push_back({at(t[0]), at(t[1]), at(t[2])});
      const Triangle& last = triangles_.back();
      for (const Vec3& p : {last.a, last.b, last.c}) bounds_.extend(p);
    }
    if (triangles_.empty()) return;
    columns_ = 1 + static_cast<int>((bounds_.max().x() - bounds_.min().x()) / kCell);
    rows_ = 1 + static_cast<int>((bounds_.max().y() - bounds_.min().y()) / kCell);
    cells_.resize(static_cast<size_t>(columns_) * static_cast<size_t>(rows_));
    for (size_t i = 0; i < triangles_.size(); ++i) {
      const Triangle& t = triangles_[i];
      const auto [x0, x1] = std::minmax({t.a.x(), t.b.x(), t.c.x()});
      const auto [y0, y1] = std::minmax({t.a.y(), t.b.y(), t.c.y()});
      for (int row = cell(y0, 1); row <= cell(y1, 1); ++row) {
        for (int column = cell(x0, 0); column <= cell(x1, 0); ++column) {
          cells_[index(column, row)].push_back(i);
        }
      }
    }
  }

  const std::vector<Triangle>& triangles() const { return triangles_; }

  /// Net number of times that the vertical above p leaves the part: 0 outside, whatever solids it is made of.
  bool holds(const Vec3& p) const {
    if (triangles_.empty() || !bounds_.contains(p)) return false;
    int leaves = 0;
    for (const size_t i : cells_[index(cell(p.x(), 0), cell(p.y(), 1))]) {
      const Triangle& t = triangles_[i];
      const auto turn = [&](const Vec3& u, const Vec3& v) {
        return (u.x() - p.x()) * (v.y() - p.y()) - (u.y() - p.y()) * (v.x() - p.x());
      };
      const double wa = turn(t.b, t.c), wb = turn(t.c, t.a), wc = turn(t.a, t.b), sum = wa + wb + wc;
      const bool above = (wa > 0 && wb > 0 && wc > 0) || (wa < 0 && wb < 0 && wc < 0);
      if (above && (wa * t.a.z() + wb * t.b.z() + wc * t.c.z()) / sum > p.z()) leaves += sum > 0 ? 1 : -1;
    }
    return leaves != 0;
  }

 private:
  int cell(double value, int side) const { return static_cast<int>((value - bounds_.min()[side]) / kCell); }
  size_t index(int column, int row) const { return static_cast<size_t>(row * columns_ + column); }

  std::vector<Triangle> triangles_;
  Eigen::AlignedBox3d bounds_;
  std::vector<std::vector<size_t>> cells_;
  int columns_ = 0, rows_ = 0;
};

/// The first point found just under the surface of one part and inside the other; none: NaN.
Vec3 shared_point(const StandingPart& one, const StandingPart& other) {
  for (const Triangle& t : one.triangles()) {
    const Vec3 normal = (t.b - t.a).cross(t.c - t.a);
    if (normal.norm() < 1e-6) continue;
    const double longest = std::max({(t.b - t.a).norm(), (t.c - t.a).norm(), (t.c - t.b).norm()});
    const int n = std::max(1, static_cast<int>(std::ceil(longest / kSpacing)));
    const Vec3 inwards = -kDepth * normal.normalized() + Vec3(kOffGrid, 0.6 * kOffGrid, 0.0);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; i + j < n; ++j) {
        const double u = (i + 1.0 / 3.0) / n, v = (j + 1.0 / 3.0) / n;
        const Vec3 p = t.a + u * (t.b - t.a) + v * (t.c - t.a) + inwards;
        if (other.holds(p)) return p;
      }
    }
  }
  return Vec3::Constant(std::nan(""));
}

/// A bolted joint, or a fit that the drawing means: a journal in its bearing, a nut on its screw.
bool are_joined(const MachineScene& scene, size_t one, size_t other) {
  const Link &a = scene.links[one], &b = scene.links[other];
  const bool bolted = (b.parent == static_cast<int>(one) && b.axis < 0) ||
                      (a.parent == static_cast<int>(other) && a.axis < 0);
  const std::string names = std::min(a.name, b.name) + ' ' + std::max(a.name, b.name);
  const bool fit = scene.model.name.starts_with("Lin & Koren") &&
                   (names == "cradle x_slide" || names == "spindle_head y_slide");
  return bolted || fit;
}

class ShippedMeshes : public testing::TestWithParam<std::string> {};

TEST_P(ShippedMeshes, AreClosedAndNoLinkLacksOne) {
  for (const Link& link : shipped_scene(GetParam()).links) {
    EXPECT_FALSE(link.mesh.triangles.empty()) << link.name;
    EXPECT_EQ(mesh::check_closed(link.mesh), "") << link.name;
  }
}

TEST_P(ShippedMeshes, NoPartStandsInsideAnotherAtHome) {
  const MachineScene& scene = shipped_scene(GetParam());
  kinematics::AxisValues home = kinematics::AxisValues::Zero();
  for (size_t i = 0; i < scene.model.axes.size(); ++i) home[static_cast<int>(i)] = scene.model.axes[i].home;
  const std::vector<Pose> poses = link_poses(scene, home);
  std::vector<StandingPart> parts;
  for (size_t i = 0; i < scene.links.size(); ++i) parts.emplace_back(scene.links[i].mesh, poses[i]);
  for (size_t i = 0; i < parts.size(); ++i) {
    for (size_t k = 0; k < parts.size(); ++k) {
      if (i == k || are_joined(scene, i, k)) continue;
      const Vec3 p = shared_point(parts[i], parts[k]);
      EXPECT_TRUE(std::isnan(p.x())) << scene.links[i].name << " stands inside " << scene.links[k].name
                                     << " at (" << p.transpose() << ") mm in M";
    }
  }
}

TEST(StandingParts, TheCheckSeesAPartInsideAnother) {
  TriMesh cube;
  for (int k = 0; k < 8; ++k) {
    cube.positions.push_back({k & 1 ? 10.0F : 0.0F, k & 2 ? 10.0F : 0.0F, k & 4 ? 10.0F : 0.0F});
  }
  cube.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  Pose beside = Pose::Identity(), overlapping = Pose::Identity();
  beside.translation() = Vec3(10.0, 0.0, 0.0);
  overlapping.translation() = Vec3(9.0, 1.0, 1.0);
  const StandingPart one(cube, Pose::Identity());
  EXPECT_TRUE(one.holds({5.0, 5.1, 5.0}));
  EXPECT_FALSE(one.holds({5.0, 5.1, 10.5}));
  EXPECT_TRUE(std::isnan(shared_point(one, StandingPart(cube, beside)).x()));
  EXPECT_FALSE(std::isnan(shared_point(one, StandingPart(cube, overlapping)).x()));
}

INSTANTIATE_TEST_SUITE_P(Machines, ShippedMeshes, testing::ValuesIn(shipped_machines()),
                         [](const auto& instance) { return instance.param; });

}  // namespace
}  // namespace swarf::machine
