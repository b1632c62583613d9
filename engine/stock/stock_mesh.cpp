#include <openvdb/tools/VolumeToMesh.h>

#include <array>
#include <cmath>

#include "base/parallel.h"
#include "stock/stock_grid_internal.h"

namespace swarf::stock {
namespace {

constexpr size_t kVerticesPerTask = 2048;

/// The 4x4x4 values around a cell, from which its eight corner gradients follow.
struct Neighbourhood {
  float values[4][4][4];
};

/// The values of one leaf position: an array, or one value for all of it.
struct LeafView {
  const float* values = nullptr;
  float constant = 0.0F;
};

LeafView leaf_view(const LevelSet& set, int i, int j, int k) {
  const openvdb::Coord place = openvdb::Coord(i, j, k) - set.map.lower;
  const openvdb::Coord& size = set.map.dimension;
  const bool known = place.x() >= 0 && place.y() >= 0 && place.z() >= 0 && place.x() < size.x() &&
                     place.y() < size.y() && place.z() < size.z();
  if (!known) return {nullptr, set.band()};
  const size_t n = set.map.index(place.x(), place.y(), place.z());
  if (set.map.states[n] == LeafState::kLeaf) return {set.map.leaves[n]->buffer().data(), 0.0F};
  return {nullptr, set.map.states[n] == LeafState::kSolid ? -set.band() : set.band()};
}

/// Looks the leaves up once for all 64 values; there are at most two along each axis.
Neighbourhood neighbourhood(const LevelSet& set, const openvdb::Coord& low) {
  const openvdb::Coord first = low.offsetBy(-1), leaf(first.x() >> 3, first.y() >> 3, first.z() >> 3);
  const auto next = [&](int axis, int n) { return ((first[axis] + n) >> 3) - leaf[axis]; };  // 0 or 1
  LeafView views[2][2][2];
  for (int i = 0; i <= next(0, 3); ++i) {
    for (int j = 0; j <= next(1, 3); ++j) {
      for (int k = 0; k <= next(2, 3); ++k) {
        views[i][j][k] = leaf_view(set, leaf.x() + i, leaf.y() + j, leaf.z() + k);
      }
    }
  }
  Neighbourhood around;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      for (int k = 0; k < 4; ++k) {
        const LeafView& view = views[next(0, i)][next(1, j)][next(2, k)];
        const int offset = ((first.x() + i) & 7) * 64 + ((first.y() + j) & 7) * 8 + ((first.z() + k) & 7);
        around.values[i][j][k] = view.values != nullptr ? view.values[offset] : view.constant;
      }
    }
  }
  return around;
}

/// Gradient of the level set at a point: trilinear mean of the central differences at the cell's corners.
Vec3 gradient(const LevelSet& set, const Vec3& point_W) {
  const Vec3 index = point_W / set.voxel;
  const Vec3 cell = index.array().floor();
  const Vec3 f = index - cell;
  const Neighbourhood around = neighbourhood(
      set, {static_cast<int>(cell.x()), static_cast<int>(cell.y()), static_cast<int>(cell.z())});
  const auto& v = around.values;
  Vec3 sum = Vec3::Zero();
  for (int corner = 0; corner < 8; ++corner) {
    const int a = corner >> 2, b = corner >> 1 & 1, c = corner & 1;
    const int i = a + 1, j = b + 1, k = c + 1;
    const double weight = (a ? f.x() : 1.0 - f.x()) * (b ? f.y() : 1.0 - f.y()) * (c ? f.z() : 1.0 - f.z());
    sum += weight * Vec3(v[i + 1][j][k] - v[i - 1][j][k], v[i][j + 1][k] - v[i][j - 1][k],
                         v[i][j][k + 1] - v[i][j][k - 1]);
  }
  return sum;
}

using Triangle = std::array<uint32_t, 3>;

/// The mesher winds its polygons clockwise seen from outside; a quad is split along its shorter diagonal.
void add_quad(const std::vector<openvdb::Vec3s>& points, const openvdb::Vec4I& q,
              std::vector<Triangle>& triangles) {
  const bool first = (points[q[0]] - points[q[2]]).lengthSqr() <= (points[q[1]] - points[q[3]]).lengthSqr();
  if (first) {
    triangles.push_back({q[0], q[2], q[1]});
    triangles.push_back({q[0], q[3], q[2]});
  } else {
    triangles.push_back({q[1], q[3], q[2]});
    triangles.push_back({q[1], q[0], q[3]});
  }
}

}  // namespace

TriMesh surface_mesh(const LevelSet& set, double adaptivity) {
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> triangles;
  std::vector<openvdb::Vec4I> quads;
  openvdb::tools::volumeToMesh(*set.grid, points, triangles, quads, 0.0, adaptivity);
  TriMesh mesh;
  mesh.triangles.reserve(triangles.size() + 2 * quads.size());
  for (const openvdb::Vec3I& t : triangles) mesh.triangles.push_back({t[0], t[2], t[1]});
  for (const openvdb::Vec4I& q : quads) add_quad(points, q, mesh.triangles);
  mesh.positions.resize(points.size());
  mesh.normals.resize(points.size());
  parallel_chunks(points.size(), kVerticesPerTask, [&](size_t begin, size_t end) {
    for (size_t n = begin; n < end; ++n) {
      mesh.positions[n] = {points[n].x(), points[n].y(), points[n].z()};
      const Vec3 g = gradient(set, Vec3(points[n].x(), points[n].y(), points[n].z()));
      const double length = g.norm();
      const Eigen::Vector3f unit = (length > 0.0 ? Vec3(g / length) : Vec3::UnitZ().eval()).cast<float>();
      mesh.normals[n] = {unit.x(), unit.y(), unit.z()};
    }
  });
  return mesh;
}

}  // namespace swarf::stock
