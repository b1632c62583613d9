#include "mesh/mesh_slivers.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace swarf::mesh {
namespace {

constexpr uint32_t kNobody = 0xffffffffU;
/// Flips of a row of slivers side by side follow each other, one a round.
constexpr int kRoundsMost = 50;

using Triangle = std::array<uint32_t, 3>;

/// Over the longest side, and which side that is.
struct Height {
  double mm = 0.0;
  size_t side = 0;
};

Height height_of(const WeldedMesh& mesh, const Triangle& triangle) {
  std::array<double, 3> lengths{};
  for (size_t k = 0; k < 3; ++k)
    lengths[k] = (mesh.points[triangle[(k + 1) % 3]] - mesh.points[triangle[k]]).norm();
  const auto longest =
      static_cast<size_t>(std::max_element(lengths.begin(), lengths.end()) - lengths.begin());
  const Vec3& a = mesh.points[triangle[longest]];
  const Vec3 side = mesh.points[triangle[(longest + 1) % 3]] - a,
             other = mesh.points[triangle[(longest + 2) % 3]] - a;
  return {side.cross(other).norm() / std::max(lengths[longest], 1e-300), longest};
}

/// Whether the sliver's longest side became the other diagonal.
bool flip(WeldedMesh& mesh, uint32_t sliver, const Height& height, uint32_t neighbour) {
  const Triangle& t = mesh.triangles[sliver];
  const Triangle& n = mesh.triangles[neighbour];
  const uint32_t a = t[height.side], b = t[(height.side + 1) % 3], c = t[(height.side + 2) % 3];
  const auto at_a = static_cast<size_t>(std::find(n.begin(), n.end(), a) - n.begin());
  if (at_a == 3) return false;
  const uint32_t d = n[(at_a + 1) % 3];
  if (d == b || d == c || n[(at_a + 2) % 3] != b) return false;
  const Triangle first{c, a, d}, second{d, b, c};
  if (std::min(height_of(mesh, first).mm, height_of(mesh, second).mm) <= height.mm) return false;
  mesh.triangles[sliver] = first;
  mesh.triangles[neighbour] = second;
  return true;
}

}  // namespace

double flip_slivers(WeldedMesh& mesh, double height_mm) {
  double moved_mm = 0.0;
  for (int round = 0; round < kRoundsMost; ++round) {
    const std::vector<uint32_t> across = facets_across(mesh.triangles);
    // Their sides are no longer as `across` knows them.
    std::vector<uint8_t> changed(mesh.triangles.size(), 0);
    bool flipped = false;
    double highest = 0.0;
    for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
      if (changed[i] != 0) continue;
      const Height height = height_of(mesh, mesh.triangles[i]);
      if (height.mm > height_mm) continue;
      const uint32_t neighbour = across[3 * size_t{i} + height.side];
      if (neighbour == kNobody || changed[neighbour] != 0 || !flip(mesh, i, height, neighbour)) continue;
      changed[i] = changed[neighbour] = 1;
      flipped = true;
      highest = std::max(highest, height.mm);
    }
    if (!flipped) break;
    moved_mm += highest;
  }
  return moved_mm;
}

double flip_slivers(TriMesh& mesh, double height_mm) {
  WeldedMesh welded = weld(mesh);
  const std::vector<std::array<uint32_t, 3>> before = welded.triangles;
  const double moved_mm = flip_slivers(welded, height_mm);
  if (welded.triangles == before) return 0.0;
  mesh = {};
  for (const Vec3& p : welded.points) {
    const Eigen::Vector3f f = p.cast<float>();
    mesh.positions.push_back({f.x(), f.y(), f.z()});
  }
  mesh.triangles = std::move(welded.triangles);
  return moved_mm;
}

}  // namespace swarf::mesh
