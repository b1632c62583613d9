#include "mesh/signed_distance.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "mesh/mesh_check.h"

namespace swarf::mesh {
namespace {

/// The welded mesh as floats again (its points were floats), without facets that have no area.
TriMesh sound_part(const TriMesh& mesh) {
  const WeldedMesh welded = weld(mesh);
  TriMesh sound;
  sound.positions.reserve(welded.points.size());
  for (const Vec3& p : welded.points) {
    const Eigen::Vector3f f = p.cast<float>();
    sound.positions.push_back({f.x(), f.y(), f.z()});
  }
  for (const auto& t : welded.triangles) {
    const Vec3& a = welded.points[t[0]];
    const double area2 = (welded.points[t[1]] - a).cross(welded.points[t[2]] - a).squaredNorm();
    if (area2 > 0.0) sound.triangles.push_back(t);
  }
  return sound;
}

double corner_angle(const Vec3& apex, const Vec3& a, const Vec3& b) {
  return std::atan2((a - apex).cross(b - apex).norm(), (a - apex).dot(b - apex));
}

}  // namespace

SignedDistance::SignedDistance(const TriMesh& mesh) : mesh_(sound_part(mesh)) {
  SWARF_CHECK(!mesh_.triangles.empty(), "distances need a mesh with area");
  tree_ = std::make_unique<MeshDistance>(mesh_);
  face_normals_.reserve(mesh_.triangles.size());
  for (uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
    const Vec3 a = corner(t, 0);
    face_normals_.push_back((corner(t, 1) - a).cross(corner(t, 2) - a).normalized());
  }
  across_ = facets_across(mesh_.triangles);
  add_vertex_normals();
}

void SignedDistance::add_vertex_normals() {
  vertex_normals_.assign(mesh_.positions.size(), Vec3::Zero());
  on_border_.assign(mesh_.positions.size(), 0);
  for (uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
    for (size_t i = 0; i < 3; ++i) {
      const uint32_t v = mesh_.triangles[t][i];
      vertex_normals_[v] +=
          corner_angle(corner(t, i), corner(t, (i + 1) % 3), corner(t, (i + 2) % 3)) * face_normals_[t];
      if (across_[3 * size_t{t} + i] != kBorder) continue;
      on_border_[v] = on_border_[mesh_.triangles[t][(i + 1) % 3]] = 1;
    }
  }
}

Vec3 SignedDistance::corner(uint32_t triangle, size_t place) const {
  const auto& p = mesh_.positions[mesh_.triangles[triangle][place]];
  return {p[0], p[1], p[2]};
}

Vec3 SignedDistance::pseudo_normal(const NearestPoint& nearest, bool& border) const {
  const uint32_t t = nearest.triangle;
  const auto edge = [&](size_t side) -> Vec3 {
    const uint32_t other = across_[3 * size_t{t} + side];
    border = other == kBorder;
    return border ? face_normals_[t] : Vec3(face_normals_[t] + face_normals_[other]);
  };
  const auto vertex = [&](size_t place) -> Vec3 {
    const uint32_t v = mesh_.triangles[t][place];
    border = on_border_[v] != 0;
    return vertex_normals_[v];
  };
  border = false;
  switch (nearest.feature) {
    case Feature::kFace:
      return face_normals_[t];
    case Feature::kEdgeAB:
      return edge(0);
    case Feature::kEdgeBC:
      return edge(1);
    case Feature::kEdgeCA:
      return edge(2);
    case Feature::kA:
      return vertex(0);
    case Feature::kB:
      return vertex(1);
    case Feature::kC:
      return vertex(2);
  }
  return face_normals_[t];
}

SignedPoint SignedDistance::at(const Vec3& p, double within_mm) const {
  const NearestPoint nearest = tree_->nearest(p, within_mm);
  SignedPoint result;
  if (std::isinf(nearest.distance_mm)) return result;
  bool border = false;
  const Vec3 normal = pseudo_normal(nearest, border);
  const double length = normal.norm();
  result.foot = nearest.point;
  result.triangle = nearest.triangle;
  result.normal = length > 0.0 ? Vec3(normal / length) : face_normals_[nearest.triangle];
  const Vec3 away = p - nearest.point;
  const double height = away.dot(result.normal);
  result.distance_mm = height >= 0.0 ? nearest.distance_mm : -nearest.distance_mm;
  if (border) result.beyond_mm = (away - height * result.normal).norm();
  return result;
}

}  // namespace swarf::mesh
