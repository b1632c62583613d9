// What the mesh tests share: manifoldness, volume, distances between meshed and true edges.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "base/frames.h"
#include "mesh/mesh_distance.h"
#include "mesh/tri_mesh.h"

namespace swarf::stock {

inline Vec3 vertex(const TriMesh& mesh, uint32_t v) {
  return {mesh.positions[v][0], mesh.positions[v][1], mesh.positions[v][2]};
}

/// The first fault that keeps the mesh from being a closed oriented manifold, or "": every directed edge once
/// and its reverse once, one fan around each vertex, no vertex without a triangle.
inline std::string manifold_fault(const TriMesh& mesh) {
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> opposite;  // directed edge -> third vertex
  std::vector<uint32_t> degree(mesh.positions.size(), 0), any(mesh.positions.size(), 0);
  for (const auto& t : mesh.triangles) {
    for (int c = 0; c < 3; ++c) {
      const uint32_t a = t[c], b = t[(c + 1) % 3];
      if (a == b) return fmt::format("triangle with vertex {} twice", a);
      if (!opposite.emplace(std::pair{a, b}, t[(c + 2) % 3]).second) {
        return fmt::format("directed edge {} {} twice", a, b);
      }
      ++degree[a];
      any[a] = b;
    }
  }
  for (const auto& [edge, third] : opposite) {
    if (!opposite.contains({edge.second, edge.first})) {
      return fmt::format("edge {} {} has one triangle", edge.first, edge.second);
    }
  }
  for (uint32_t v = 0; v < degree.size(); ++v) {
    if (degree[v] == 0) return fmt::format("vertex {} without a triangle", v);
    uint32_t around = 0, at = any[v];
    do {
      at = opposite[{v, at}];
      ++around;
    } while (at != any[v] && around <= degree[v]);
    if (around != degree[v]) return fmt::format("vertex {} has two fans", v);
  }
  return "";
}

inline double enclosed_volume(const TriMesh& mesh) {
  double six = 0.0;
  for (const auto& t : mesh.triangles) {
    six += vertex(mesh, t[0]).dot(vertex(mesh, t[1]).cross(vertex(mesh, t[2])));
  }
  return six / 6.0;
}

/// A polyline on the true edge, fine enough to count as the edge.
using EdgeLine = std::vector<Vec3>;

inline EdgeLine straight_edge(const Vec3& a, const Vec3& b, int count = 150) {
  EdgeLine line;
  for (int i = 0; i <= count; ++i) line.push_back(a + (b - a) * i / count);
  return line;
}

/// centre + cos(t) a + sin(t) b for t in [from, to].
inline EdgeLine arc_edge(const Vec3& centre, const Vec3& a, const Vec3& b, double from, double to) {
  EdgeLine line;
  constexpr int kCount = 500;
  for (int i = 0; i <= kCount; ++i) {
    const double t = from + (to - from) * i / kCount;
    line.push_back(centre + std::cos(t) * a + std::sin(t) * b);
  }
  return line;
}

struct EdgeError {
  double missed_mm = 0.0;   ///< farthest point of the true edges from the mesh: what is cut off or filled
  double strayed_mm = 0.0;  ///< farthest point of the mesh's own sharp edges from the true edges
  size_t sharp_edges = 0;
};

inline double segment_distance(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double t = d.squaredNorm() > 0.0 ? std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0) : 0.0;
  return (p - a - t * d).norm();
}

/// Compares within `range_mm` of the true edges only, so that other edges of the part do not count. An edge
/// of the mesh is sharp when its faces differ by more than 30 degrees.
inline EdgeError edge_error(const TriMesh& mesh, const std::vector<EdgeLine>& lines, double range_mm) {
  EdgeError error;
  const mesh::MeshDistance distance(mesh);
  for (const EdgeLine& line : lines) {
    for (const Vec3& p : line) error.missed_mm = std::max(error.missed_mm, distance.nearest(p).distance_mm);
  }
  const auto from_lines = [&](const Vec3& p) {
    double least = 1e9;
    for (const EdgeLine& line : lines) {
      size_t nearest = 0;
      for (size_t i = 0; i < line.size(); ++i) {
        if ((line[i] - p).squaredNorm() < (line[nearest] - p).squaredNorm()) nearest = i;
      }
      if (nearest == 0 || nearest + 1 == line.size()) continue;  // beyond the line's ends
      least = std::min({least, segment_distance(p, line[nearest - 1], line[nearest]),
                        segment_distance(p, line[nearest], line[nearest + 1])});
    }
    return least;
  };
  std::map<std::pair<uint32_t, uint32_t>, Vec3> normals;
  for (const auto& t : mesh.triangles) {
    const Vec3 cross =
        (vertex(mesh, t[1]) - vertex(mesh, t[0])).cross(vertex(mesh, t[2]) - vertex(mesh, t[0]));
    // Slivers have no direction of their own.
    const Vec3 unit = cross.norm() > 1e-7 ? Vec3(cross.normalized()) : Vec3::Zero();
    for (int c = 0; c < 3; ++c) normals[{t[c], t[(c + 1) % 3]}] = unit;
  }
  for (const auto& [edge, normal] : normals) {
    if (edge.first > edge.second) continue;
    const Vec3 other = normals[{edge.second, edge.first}];
    if (normal.isZero() || other.isZero() || normal.dot(other) > std::cos(0.52)) continue;
    for (const uint32_t v : {edge.first, edge.second}) {
      const double stray = from_lines(vertex(mesh, v));
      if (stray > range_mm) continue;
      ++error.sharp_edges;
      error.strayed_mm = std::max(error.strayed_mm, stray);
    }
  }
  return error;
}

}  // namespace swarf::stock
