#include "mesh/mesh_ops.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "base/angles.h"
#include "base/check.h"
#include "base/parallel.h"

namespace swarf::mesh {
namespace {

Vec3 position(const TriMesh& mesh, uint32_t vertex) {
  const auto& p = mesh.positions[vertex];
  return {p[0], p[1], p[2]};
}

/// Outward, as long as twice the triangle's area.
Vec3 cross_of(const TriMesh& mesh, uint32_t triangle) {
  const auto& t = mesh.triangles[triangle];
  const Vec3 a = position(mesh, t[0]);
  return (position(mesh, t[1]) - a).cross(position(mesh, t[2]) - a);
}

/// Unit normal of each face; zero for faces without area.
std::vector<Vec3> face_normals(const TriMesh& mesh) {
  std::vector<Vec3> normals;
  normals.reserve(mesh.triangles.size());
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 cross = cross_of(mesh, t);
    const double length = cross.norm();
    normals.push_back(length > 0.0 ? Vec3(cross / length) : Vec3::Zero());
  }
  return normals;
}

double corner_angle(const TriMesh& mesh, uint32_t corner) {
  const auto& t = mesh.triangles[corner / 3];
  const Vec3 apex = position(mesh, t[corner % 3]);
  const Vec3 a = position(mesh, t[(corner + 1) % 3]) - apex, b = position(mesh, t[(corner + 2) % 3]) - apex;
  return angle_between(a, b);
}

/// Corners (3 * triangle + place) around each vertex, ascending, in compressed rows.
struct CornerRows {
  std::vector<uint32_t> start, corners;

  explicit CornerRows(const TriMesh& mesh)
      : start(mesh.positions.size() + 1, 0), corners(3 * mesh.triangles.size()) {
    for (const auto& t : mesh.triangles) {
      for (const uint32_t v : t) ++start[v + 1];
    }
    for (size_t v = 0; v + 1 < start.size(); ++v) start[v + 1] += start[v];
    std::vector<uint32_t> next(start.begin(), start.end() - 1);
    for (uint32_t c = 0; c < corners.size(); ++c) corners[next[mesh.triangles[c / 3][c % 3]]++] = c;
  }
};

/// The vertex's normal as face `self` sees it: only faces within the crease angle of it count.
Vec3 corner_normal(std::span<const uint32_t> around, const std::vector<Vec3>& faces,
                   const std::vector<double>& angles, uint32_t self, double min_cosine) {
  Vec3 sum = Vec3::Zero();
  for (const uint32_t c : around) {
    if (faces[c / 3].dot(faces[self / 3]) >= min_cosine) sum += angles[c] * faces[c / 3];
  }
  const double length = sum.norm();
  return length > 0.0 ? Vec3(sum / length) : Vec3::UnitZ();
}

/// A copy of vertex v with all its attributes; returns its index.
uint32_t duplicate_vertex(TriMesh& mesh, uint32_t v) {
  const auto copy = static_cast<uint32_t>(mesh.positions.size());
  mesh.positions.push_back(std::array(mesh.positions[v]));
  mesh.normals.push_back(std::array(mesh.normals[v]));
  if (!mesh.colours.empty()) mesh.colours.push_back(std::array(mesh.colours[v]));
  if (!mesh.deviation_um.empty()) mesh.deviation_um.push_back(float{mesh.deviation_um[v]});
  return copy;
}

/// Corners (3 * triangle + place) whose triangle turns away from the vertex normal, ascending by vertex.
std::vector<std::pair<uint32_t, uint32_t>> creased_corners(const TriMesh& mesh, double min_cosine) {
  constexpr size_t kTrianglesPerTask = 8192;
  std::vector<std::vector<std::pair<uint32_t, uint32_t>>> parts(mesh.triangles.size() / kTrianglesPerTask +
                                                                1);
  parallel_chunks(mesh.triangles.size(), kTrianglesPerTask, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const Vec3 cross = cross_of(mesh, static_cast<uint32_t>(i));
      const double least = min_cosine * cross.norm();
      for (uint32_t c = 0; c < 3; ++c) {
        const uint32_t v = mesh.triangles[i][c];
        const Vec3 normal(mesh.normals[v][0], mesh.normals[v][1], mesh.normals[v][2]);
        if (cross.dot(normal) < least) {
          parts[begin / kTrianglesPerTask].emplace_back(v, 3 * static_cast<uint32_t>(i) + c);
        }
      }
    }
  });
  std::vector<std::pair<uint32_t, uint32_t>> corners;
  for (const auto& part : parts) corners.insert(corners.end(), part.begin(), part.end());
  std::sort(corners.begin(), corners.end());
  return corners;
}

}  // namespace

Box bounds(const TriMesh& mesh) {
  SWARF_CHECK(!mesh.positions.empty(), "a mesh without vertices has no bounds");
  Box box{position(mesh, 0), position(mesh, 0)};
  for (uint32_t v = 1; v < mesh.positions.size(); ++v) {
    box.lower = box.lower.cwiseMin(position(mesh, v));
    box.upper = box.upper.cwiseMax(position(mesh, v));
  }
  return box;
}

void place(TriMesh& mesh, const Placement& placement) {
  if (placement.stays() || mesh.positions.empty()) return;
  std::vector<Vec3> turned;
  turned.reserve(mesh.positions.size());
  for (const auto& p : mesh.positions) turned.push_back(placement.turn * Vec3(p[0], p[1], p[2]));
  Box box{turned.front(), turned.front()};
  for (const Vec3& p : turned) box = {box.lower.cwiseMin(p), box.upper.cwiseMax(p)};
  const Vec3 by = placement.pose(box).translation();
  for (size_t n = 0; n < turned.size(); ++n) {
    const Eigen::Vector3f f = (turned[n] + by).cast<float>();
    mesh.positions[n] = {f.x(), f.y(), f.z()};
  }
  mesh.normals.clear();
}

void compute_vertex_normals(TriMesh& mesh, double crease_rad) {
  const std::vector<Vec3> faces = face_normals(mesh);
  const CornerRows rows(mesh);
  std::vector<double> angles(rows.corners.size());
  for (uint32_t c = 0; c < angles.size(); ++c) angles[c] = corner_angle(mesh, c);
  const double min_cosine = std::cos(crease_rad);
  const auto vertices = static_cast<uint32_t>(mesh.positions.size());
  mesh.normals.assign(vertices, {0.0F, 0.0F, 1.0F});
  for (uint32_t v = 0; v < vertices; ++v) {
    const std::span around(rows.corners.data() + rows.start[v], rows.start[v + 1] - rows.start[v]);
    // Corners that see the same faces get bitwise the same sum, so equality decides which share a copy.
    std::map<std::array<float, 3>, uint32_t> copies;
    for (const uint32_t c : around) {
      const Vec3 n = corner_normal(around, faces, angles, c, min_cosine);
      const std::array<float, 3> key{static_cast<float>(n.x()), static_cast<float>(n.y()),
                                     static_cast<float>(n.z())};
      auto found = copies.find(key);
      if (found == copies.end()) {
        const uint32_t index = copies.empty() ? v : duplicate_vertex(mesh, v);
        mesh.normals[index] = key;
        found = copies.emplace(key, index).first;
      }
      mesh.triangles[c / 3][c % 3] = found->second;
    }
  }
}

void split_creases(TriMesh& mesh, double crease_rad) {
  SWARF_CHECK(mesh.normals.size() == mesh.positions.size(), "creases are found by the vertex normals");
  const double min_cosine = std::cos(crease_rad);
  const auto corners = creased_corners(mesh, min_cosine);
  /// A new vertex of the vertex at hand, and the sum of its triangles.
  struct Copy {
    uint32_t vertex;
    Vec3 sum;
  };
  std::vector<Copy> copies;
  for (size_t i = 0; i < corners.size(); ++i) {
    const auto [v, corner] = corners[i];
    if (i == 0 || corners[i - 1].first != v) copies.clear();
    const Vec3 cross = cross_of(mesh, corner / 3);
    auto copy = std::find_if(copies.begin(), copies.end(), [&](const Copy& c) {
      return c.sum.dot(cross) >= min_cosine * c.sum.norm() * cross.norm();
    });
    if (copy == copies.end()) copy = copies.insert(copies.end(), {duplicate_vertex(mesh, v), Vec3::Zero()});
    copy->sum += cross;
    const Eigen::Vector3f normal = copy->sum.normalized().cast<float>();
    mesh.normals[copy->vertex] = {normal.x(), normal.y(), normal.z()};
    mesh.triangles[corner / 3][corner % 3] = copy->vertex;
  }
}

}  // namespace swarf::mesh
