#include "mesh/vertices_at.h"

#include <array>
#include <optional>
#include <unordered_map>
#include <vector>

#include "mesh/mesh_distance.h"
#include "mesh/mixed_corners.h"

namespace swarf::mesh {
namespace {

/// A vertex has at least this share of each corner of its triangle.
constexpr double kInsideShare = 0.01;

/// Shares of the corners at a point of the triangle's plane; none outside or beside a side.
std::optional<Vec3> shares_inside(const TriMesh& mesh, uint32_t triangle, const Vec3& point) {
  const auto& t = mesh.triangles[triangle];
  const Vec3 a = vec3_of(mesh.positions[t[0]]), ab = vec3_of(mesh.positions[t[1]]) - a,
             ac = vec3_of(mesh.positions[t[2]]) - a;
  const Vec3 cross = ab.cross(ac);
  const double area2 = cross.squaredNorm();
  if (!(area2 > 0.0)) return {};
  const double v = (point - a).cross(ac).dot(cross) / area2, w = ab.cross(point - a).dot(cross) / area2;
  const Vec3 shares(1.0 - v - w, v, w);
  return shares.minCoeff() >= kInsideShare ? std::optional(shares) : std::nullopt;
}

/// The triangle becomes three around a new vertex; the numbers of the two that are new are the last.
void divide_around(TriMesh& mesh, uint32_t triangle, const Vec3& shares) {
  const std::array<uint32_t, 3> t = mesh.triangles[triangle];
  const auto vertex = static_cast<uint32_t>(mesh.positions.size());
  mesh.positions.push_back(floats_of(mixed_corners(mesh.positions, t, shares)));
  mesh.normals.push_back(floats_of(mixed_corners(mesh.normals, t, shares).normalized()));
  mesh.triangles[triangle] = {t[0], t[1], vertex};
  mesh.triangles.push_back({t[1], t[2], vertex});
  mesh.triangles.push_back({t[2], t[0], vertex});
}

}  // namespace

void add_vertices_at(std::span<const Vec3> places, double within_mm, TriMesh& mesh) {
  if (places.empty() || mesh.triangles.empty()) return;
  const TriMesh before = mesh;
  const MeshDistance distance(before);
  std::unordered_map<uint32_t, std::vector<uint32_t>> parts;  // of the triangles there were
  for (const Vec3& place : places) {
    const NearestPoint near = distance.nearest(place, within_mm);
    if (!(near.distance_mm <= within_mm)) continue;
    std::vector<uint32_t>& among = parts.try_emplace(near.triangle, 1, near.triangle).first->second;
    for (const uint32_t triangle : among) {
      const auto shares = shares_inside(mesh, triangle, near.point);
      if (!shares) continue;
      const auto first = static_cast<uint32_t>(mesh.triangles.size());
      divide_around(mesh, triangle, *shares);
      among.push_back(first);
      among.push_back(first + 1);
      break;
    }
  }
}

}  // namespace swarf::mesh
