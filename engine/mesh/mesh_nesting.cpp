#include "mesh/mesh_nesting.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "base/parallel.h"
#include "base/units.h"
#include "mesh/mesh_check.h"

namespace swarf::mesh {
namespace {

/// Windings are whole numbers unless the point lies on the shell.
constexpr double kClearlyOther = 0.75;

struct Shell {
  std::vector<uint32_t> facets;
  Box box;
  double volume_mm3 = 0.0;
  Vec3 place = Vec3::Zero();  ///< in the middle of the largest facet
};

using Corners = std::array<Vec3, 3>;

Corners corners_of(const WeldedMesh& mesh, uint32_t facet) {
  const auto& t = mesh.triangles[facet];
  return {mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]};
}

/// Per facet the first facet of its shell: those that share an edge hang together.
std::vector<uint32_t> first_facets(const WeldedMesh& mesh) {
  std::vector<uint32_t> root(mesh.triangles.size());
  std::iota(root.begin(), root.end(), 0U);
  const auto find = [&](uint32_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  const std::vector<uint32_t> across = facets_across(mesh.triangles);
  for (uint32_t side = 0; side < across.size(); ++side) {
    if (across[side] >= root.size()) continue;
    const uint32_t a = find(side / 3), b = find(across[side]);
    root[std::max(a, b)] = std::min(a, b);
  }
  for (uint32_t i = 0; i < root.size(); ++i) root[i] = find(i);
  return root;
}

void measure(const WeldedMesh& mesh, Shell& shell) {
  double largest = -1.0;
  const Vec3 origin = corners_of(mesh, shell.facets.front())[0];
  shell.box = {origin, origin};
  for (const uint32_t facet : shell.facets) {
    const Corners c = corners_of(mesh, facet);
    const Vec3 normal = (c[1] - c[0]).cross(c[2] - c[0]);
    shell.volume_mm3 += (c[0] - origin).dot(normal) / 6.0;
    for (const Vec3& corner : c) {
      shell.box.lower = shell.box.lower.cwiseMin(corner);
      shell.box.upper = shell.box.upper.cwiseMax(corner);
    }
    if (normal.squaredNorm() <= largest) continue;
    largest = normal.squaredNorm();
    shell.place = (c[0] + c[1] + c[2]) / 3.0;
  }
}

std::vector<Shell> shells_of(const WeldedMesh& mesh) {
  const std::vector<uint32_t> first = first_facets(mesh);
  std::vector<uint32_t> number(first.size());
  std::vector<Shell> shells;
  for (uint32_t facet = 0; facet < first.size(); ++facet) {
    if (first[facet] == facet) {
      number[facet] = static_cast<uint32_t>(shells.size());
      shells.emplace_back();
    }
    shells[number[first[facet]]].facets.push_back(facet);
  }
  return shells;
}

bool holds(const Box& box, const Vec3& p) {
  return (p - box.lower).minCoeff() >= 0.0 && (box.upper - p).minCoeff() >= 0.0;
}

/// How often the shell winds around a point: 1 inside a body, -1 inside a cavity, 0 outside.
double winding(const WeldedMesh& mesh, const Shell& shell, const Vec3& p) {
  double angle = 0.0;
  for (const uint32_t facet : shell.facets) {
    const Corners c = corners_of(mesh, facet);
    const Vec3 a = c[0] - p, b = c[1] - p, d = c[2] - p;
    const double la = a.norm(), lb = b.norm(), ld = d.norm();
    angle +=
        2.0 * std::atan2(a.dot(b.cross(d)), la * lb * ld + a.dot(b) * ld + b.dot(d) * la + d.dot(a) * lb);
  }
  return angle / (4.0 * kPi);
}

}  // namespace

std::optional<MisplacedBody> find_misplaced_body(const TriMesh& mesh) {
  const WeldedMesh welded = weld(mesh);
  std::vector<Shell> shells = shells_of(welded);
  if (shells.empty()) return {};
  parallel_chunks(shells.size(), 1, [&](size_t n, size_t) { measure(welded, shells[n]); });
  std::vector<double> around(shells.size(), 0.0);
  parallel_chunks(shells.size(), 1, [&](size_t n, size_t) {
    for (size_t other = 0; other < shells.size(); ++other) {
      if (other != n && holds(shells[other].box, shells[n].place))
        around[n] += winding(welded, shells[other], shells[n].place);
    }
  });
  for (size_t n = 0; n < shells.size(); ++n) {
    const double right = shells[n].volume_mm3 < 0.0 ? 1.0 : 0.0;
    if (std::abs(around[n] - right) > kClearlyOther)
      return MisplacedBody{shells[n].place, shells[n].volume_mm3, static_cast<int>(std::lround(around[n]))};
  }
  return {};
}

void check_bodies(const TriMesh& mesh, const std::string& path, Diagnostics& diagnostics,
                  const std::string& name) {
  const std::optional<MisplacedBody> body = find_misplaced_body(mesh);
  if (!body) return;
  const Vec3& p = body->place;
  const char* fault = body->volume_mm3 < 0.0
                          ? (body->around < 1 ? "is turned inward but lies in no body: it is inside out"
                                              : "is a cavity in the material of two bodies at once")
                          : "lies inside another body's material";
  diagnostics.error(
      "mesh-nested-bodies", {path},
      fmt::format("a body of the {} ({:.3f} mm3, with a facet at ({:.3f}, {:.3f}, {:.3f}) mm) {}", name,
                  std::abs(body->volume_mm3), p.x(), p.y(), p.z(), fault),
      "unite the bodies in the CAD program; the facets of a cavity point into it, those of a body outward");
}

}  // namespace swarf::mesh
