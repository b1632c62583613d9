#include "mesh/patch_borders.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "mesh/mixed_corners.h"

namespace swarf::mesh {
namespace {

void weld_copies(const TriMesh& mesh, PatchBorders& out) {
  std::vector<uint32_t> order(mesh.positions.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    return std::pair(mesh.positions[a], a) < std::pair(mesh.positions[b], b);
  });
  out.welded.resize(order.size());
  out.on_crease.assign(order.size(), 0);
  for (size_t i = 0, first = 0; i < order.size(); ++i) {
    const bool copy = i > 0 && mesh.positions[order[i]] == mesh.positions[order[first]];
    if (!copy) first = i;
    out.welded[order[i]] = order[first];
    if (copy) out.on_crease[order[i]] = out.on_crease[order[first]] = 1;
  }
}

/// Of all triangles: a side within a patch is there twice.
std::vector<uint64_t> sorted_sides(const TriMesh& mesh) {
  std::vector<uint64_t> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (const auto& t : mesh.triangles)
    for (size_t k = 0; k < 3; ++k) sides.push_back(side_key(t[k], t[(k + 1) % 3]));
  std::sort(sides.begin(), sides.end());
  return sides;
}

/// Unit normals of up to two borders at each vertex, within the patch; zero where there is none.
std::vector<std::array<Vec3, 2>> inward_normals(const TriMesh& mesh) {
  const std::vector<uint64_t> sides = sorted_sides(mesh);
  const auto on_border = [&](uint64_t key) {
    const auto found = std::lower_bound(sides.begin(), sides.end(), key);
    return found + 1 == sides.end() || *(found + 1) != key;
  };
  std::vector<std::array<Vec3, 2>> inward(mesh.positions.size(), {Vec3::Zero(), Vec3::Zero()});
  for (const auto& t : mesh.triangles)
    for (size_t k = 0; k < 3; ++k) {
      if (!on_border(side_key(t[k], t[(k + 1) % 3]))) continue;
      const Vec3 a = vec3_of(mesh.positions[t[k]]), b = vec3_of(mesh.positions[t[(k + 1) % 3]]),
                 c = vec3_of(mesh.positions[t[(k + 2) % 3]]);
      const Vec3 in = (b - a).cross(c - a).normalized().cross(b - a).normalized();
      for (const uint32_t v : {t[k], t[(k + 1) % 3]})
        (inward[v][0].isZero() ? inward[v][0] : inward[v][1]) = in;
    }
  return inward;
}

}  // namespace

PatchBorders patch_borders(const TriMesh& mesh, double inset_mm) {
  PatchBorders out;
  weld_copies(mesh, out);
  constexpr double kNarrow = 0.2;  // in a sharper corner the places are farther inside than from its sides
  for (const auto& [m, n] : inward_normals(mesh))
    out.inset.emplace_back(inset_mm * (m + n) / (n.isZero() ? 1.0 : std::max(1.0 + m.dot(n), kNarrow)));
  return out;
}

}  // namespace swarf::mesh
