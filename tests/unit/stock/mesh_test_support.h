// What the mesh tests share: manifoldness, volume, distances between meshed and true edges.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "base/frames.h"
#include "base/units.h"
#include "mesh/mesh_distance.h"
#include "mesh/tri_mesh.h"

namespace swarf::stock {

inline Vec3 vertex(const TriMesh& mesh, uint32_t v) {
  return {mesh.positions[v][0], mesh.positions[v][1], mesh.positions[v][2]};
}

/// A directed edge of a mesh.
struct HalfEdge {
  uint32_t from, to, third, triangle;  ///< `third`: the triangle's other vertex
  bool operator<(const HalfEdge& other) const {
    return std::pair(from, to) < std::pair(other.from, other.to);
  }
};

/// All directed edges in order.
class HalfEdges {
 public:
  explicit HalfEdges(const TriMesh& mesh) : start_(mesh.positions.size() + 1, 0) {
    for (const auto& t : mesh.triangles) {
      for (const uint32_t v : t) ++start_[v + 1];
    }
    for (size_t v = 0; v + 1 < start_.size(); ++v) start_[v + 1] += start_[v];
    edges_.resize(3 * mesh.triangles.size());
    std::vector<uint32_t> next(start_.begin(), start_.end() - 1);
    for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
      const auto& t = mesh.triangles[i];
      for (int c = 0; c < 3; ++c) edges_[next[t[c]]++] = {t[c], t[(c + 1) % 3], t[(c + 2) % 3], i};
    }
    for (size_t v = 0; v + 1 < start_.size(); ++v) {
      std::sort(edges_.begin() + start_[v], edges_.begin() + start_[v + 1]);
    }
  }
  const std::vector<HalfEdge>& all() const { return edges_; }
  std::span<const HalfEdge> around(uint32_t v) const {
    return std::span(edges_).subspan(start_[v], start_[v + 1] - start_[v]);
  }
  /// Null if there is none.
  const HalfEdge* find(uint32_t from, uint32_t to) const {
    for (const HalfEdge& e : around(from)) {
      if (e.to == to) return &e;
    }
    return nullptr;
  }

 private:
  std::vector<uint32_t> start_;
  std::vector<HalfEdge> edges_;
};

/// The first fault that keeps the mesh from being a closed oriented manifold, or "": every directed edge once
/// and its reverse once, one fan around each vertex, no vertex without a triangle.
inline std::string manifold_fault(const TriMesh& mesh) {
  const HalfEdges edges(mesh);
  for (size_t i = 0; i < edges.all().size(); ++i) {
    const HalfEdge& e = edges.all()[i];
    if (e.from == e.to) return fmt::format("triangle with vertex {} twice", e.from);
    if (i > 0 && !(edges.all()[i - 1] < e)) return fmt::format("directed edge {} {} twice", e.from, e.to);
    if (edges.find(e.to, e.from) == nullptr) {
      return fmt::format("edge {} {} has one triangle", e.from, e.to);
    }
  }
  for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
    const std::span<const HalfEdge> around = edges.around(v);
    if (around.empty()) return fmt::format("vertex {} without a triangle", v);
    const HalfEdge* at = &around[0];
    size_t count = 0;
    do {
      at = edges.find(v, at->third);
      ++count;
    } while (at != &around[0] && count <= around.size());
    if (count != around.size()) return fmt::format("vertex {} has two fans", v);
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

/// A piece of a true edge: centre + cos(t) a + sin(t) b for t in [from, to], a and b of one length and at
/// right angles; or straight, centre + t a for t in [0, 1].
struct EdgeLine {
  Vec3 centre, a, b;
  double from = 0.0, to = 1.0;
  bool straight = true;

  Vec3 at(double t) const {
    return straight ? Vec3(centre + t * a) : Vec3(centre + std::cos(t) * a + std::sin(t) * b);
  }
  /// Infinite for points beyond the ends.
  double distance(const Vec3& p) const {
    constexpr double kBeyond = std::numeric_limits<double>::infinity();
    const Vec3 d = p - centre;
    if (straight) {
      const double t = d.dot(a) / a.squaredNorm();
      return t < 0.0 || t > 1.0 ? kBeyond : (d - t * a).norm();
    }
    const double r = a.norm(), x = d.dot(a) / r, y = d.dot(b) / r;
    double turn = std::fmod(std::atan2(y, x) - from, 2.0 * kPi);
    if (turn < 0.0) turn += 2.0 * kPi;
    return turn > to - from ? kBeyond : std::hypot(std::hypot(x, y) - r, d.dot(a.cross(b)) / (r * r));
  }
};

inline EdgeLine straight_edge(const Vec3& a, const Vec3& b) {
  return {a, b - a, Vec3::Zero()};
}

inline EdgeLine arc_edge(const Vec3& centre, const Vec3& a, const Vec3& b, double from, double to) {
  return {centre, a, b, from, to, false};
}

struct EdgeError {
  double missed_mm = 0.0;   ///< farthest point of the true edges from the mesh: what is cut off or filled
  double strayed_mm = 0.0;  ///< farthest point of the mesh's own sharp edges from the true edges, no
                            ///< farther than the lower of the two triangles is high
  Vec3 strayed_W = Vec3::Zero();  ///< that point
  size_t sharp_edges = 0;
};

/// Compares within `range_mm` of the true edges only, so that other edges of the part do not count. An edge
/// of the mesh is sharp when its faces differ by more than 30 degrees.
inline EdgeError edge_error(const TriMesh& mesh, const std::vector<EdgeLine>& lines, double range_mm) {
  constexpr int kPoints = 150;
  EdgeError error;
  const mesh::MeshDistance distance(mesh);
  for (const EdgeLine& line : lines) {
    for (int i = 0; i <= kPoints; ++i) {
      const Vec3 p = line.at(line.from + (line.to - line.from) * i / kPoints);
      error.missed_mm = std::max(error.missed_mm, distance.nearest(p).distance_mm);
    }
  }
  std::vector<Vec3> normals;
  std::vector<double> heights;
  for (const auto& t : mesh.triangles) {
    const Vec3 ab = vertex(mesh, t[1]) - vertex(mesh, t[0]), ac = vertex(mesh, t[2]) - vertex(mesh, t[0]);
    normals.push_back(ab.cross(ac).normalized());
    heights.push_back(ab.cross(ac).norm() / std::max({ab.norm(), ac.norm(), (ac - ab).norm(), 1e-12}));
  }
  const HalfEdges edges(mesh);
  for (const HalfEdge& e : edges.all()) {
    if (e.from > e.to) continue;
    const HalfEdge* reverse = edges.find(e.to, e.from);
    if (reverse == nullptr) continue;
    const Vec3 &normal = normals[e.triangle], &other = normals[reverse->triangle];
    if (normal.dot(other) > std::cos(0.52)) continue;
    // However a needle is turned, it stands off its sheet by no more than its height.
    const double height = std::min(heights[e.triangle], heights[reverse->triangle]);
    for (const uint32_t v : {e.from, e.to}) {
      double stray = std::numeric_limits<double>::infinity();
      for (const EdgeLine& line : lines) stray = std::min(stray, line.distance(vertex(mesh, v)));
      if (stray > range_mm) continue;
      ++error.sharp_edges;
      if (std::min(stray, height) <= error.strayed_mm) continue;
      error.strayed_mm = std::min(stray, height);
      error.strayed_W = vertex(mesh, v);
    }
  }
  return error;
}

}  // namespace swarf::stock
