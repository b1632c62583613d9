#include "mesh/mesh_shells.h"

#include <algorithm>
#include <numeric>

#include "mesh/winding.h"

namespace swarf::mesh {
namespace {

/// Per facet the first facet of its shell.
std::vector<uint32_t> first_facets(const std::vector<uint32_t>& across) {
  std::vector<uint32_t> root(across.size() / 3);
  std::iota(root.begin(), root.end(), 0U);
  const auto find = [&](uint32_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (uint32_t side = 0; side < across.size(); ++side) {
    if (across[side] >= root.size()) continue;
    const uint32_t a = find(side / 3), b = find(across[side]);
    root[std::max(a, b)] = std::min(a, b);
  }
  for (uint32_t i = 0; i < root.size(); ++i) root[i] = find(i);
  return root;
}

}  // namespace

std::vector<Shell> shells_of(const WeldedMesh& mesh, const std::vector<uint32_t>& across) {
  const std::vector<uint32_t> first = first_facets(across);
  std::vector<uint32_t> number(first.size());
  std::vector<Shell> shells;
  for (uint32_t facet = 0; facet < first.size(); ++facet) {
    const std::array<Vec3, 3> corners = corners_of(mesh, facet);
    if (first[facet] == facet) {
      number[facet] = static_cast<uint32_t>(shells.size());
      shells.push_back({{}, {corners[0], corners[0]}});
    }
    Shell& shell = shells[number[first[facet]]];
    shell.facets.push_back(facet);
    for (const Vec3& corner : corners) {
      shell.box.lower = shell.box.lower.cwiseMin(corner);
      shell.box.upper = shell.box.upper.cwiseMax(corner);
    }
  }
  return shells;
}

std::array<Vec3, 3> corners_of(const WeldedMesh& mesh, uint32_t facet) {
  const auto& t = mesh.triangles[facet];
  return {mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]};
}

bool holds(const Box& box, const Vec3& p) {
  return (p - box.lower).minCoeff() >= 0.0 && (box.upper - p).minCoeff() >= 0.0;
}

double winding(const WeldedMesh& mesh, const Shell& shell, const Vec3& p) {
  double turns = 0.0;
  for (const uint32_t facet : shell.facets) turns += solid_angle(corners_of(mesh, facet), p);
  return turns;
}

}  // namespace swarf::mesh
