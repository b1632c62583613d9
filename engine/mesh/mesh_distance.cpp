#include "mesh/mesh_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/parallel.h"

namespace swarf::mesh {
namespace {

constexpr uint32_t kLeafSize = 4;
/// Deeper than any median-split tree over 2^32 triangles.
constexpr size_t kStackSize = 64;

double box_distance_squared(const Eigen::Vector3f& lower, const Eigen::Vector3f& upper, const Vec3& p) {
  const Vec3 outside = (lower.cast<double>() - p).cwiseMax(p - upper.cast<double>()).cwiseMax(Vec3::Zero());
  return outside.squaredNorm();
}

Vec3 closest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double length_squared = ab.squaredNorm();
  if (length_squared == 0.0) return a;
  return a + std::clamp((p - a).dot(ab) / length_squared, 0.0, 1.0) * ab;
}

/// Nearest of the three edges' points: for triangles without area.
Vec3 closest_on_edges(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  Vec3 best = closest_on_segment(p, a, b);
  for (const Vec3& q : {closest_on_segment(p, b, c), closest_on_segment(p, c, a)}) {
    if ((q - p).squaredNorm() < (best - p).squaredNorm()) best = q;
  }
  return best;
}

}  // namespace

Vec3 closest_point_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return a;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return b;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return c;
  const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
  const double area = va + vb + vc;
  if (!(area > 0.0) || va <= 0.0 || vb <= 0.0 || vc <= 0.0) return closest_on_edges(p, a, b, c);
  return a + (vb / area) * ab + (vc / area) * ac;
}

MeshDistance::MeshDistance(const TriMesh& mesh) : mesh_(mesh), order_(mesh.triangles.size()) {
  std::iota(order_.begin(), order_.end(), 0U);
  std::vector<Eigen::Vector3f> centres(order_.size());
  for (uint32_t t = 0; t < centres.size(); ++t) {
    centres[t] = ((vertex(t, 0) + vertex(t, 1) + vertex(t, 2)) / 3.0).cast<float>();
  }
  nodes_.reserve(order_.size());
  if (!order_.empty()) build(0, static_cast<uint32_t>(order_.size()), centres);
}

Vec3 MeshDistance::vertex(uint32_t triangle, int corner) const {
  const auto& p = mesh_.positions[mesh_.triangles[triangle][corner]];
  return {p[0], p[1], p[2]};
}

void MeshDistance::grow(Node& node, uint32_t begin, uint32_t end) const {
  node.lower.setConstant(std::numeric_limits<float>::infinity());
  node.upper = -node.lower;
  for (uint32_t i = begin; i < end; ++i) {
    for (int corner = 0; corner < 3; ++corner) {
      const auto& p = mesh_.positions[mesh_.triangles[order_[i]][corner]];
      const Eigen::Vector3f v(p[0], p[1], p[2]);
      node.lower = node.lower.cwiseMin(v);
      node.upper = node.upper.cwiseMax(v);
    }
  }
}

void MeshDistance::build(uint32_t begin, uint32_t end, const std::vector<Eigen::Vector3f>& centres) {
  const size_t self = nodes_.size();
  nodes_.emplace_back();
  grow(nodes_[self], begin, end);
  if (end - begin <= kLeafSize) {
    nodes_[self].first = begin;
    nodes_[self].count = end - begin;
    return;
  }
  int axis = 0;
  (nodes_[self].upper - nodes_[self].lower).maxCoeff(&axis);
  const uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](uint32_t s, uint32_t t) {
                     return std::pair(centres[s][axis], s) < std::pair(centres[t][axis], t);
                   });
  build(begin, middle, centres);
  nodes_[self].first = static_cast<uint32_t>(nodes_.size());
  build(middle, end, centres);
}

void MeshDistance::search_leaf(const Node& leaf, const Vec3& p, double& best, NearestPoint& nearest) const {
  for (uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
    const uint32_t t = order_[i];
    const Vec3 candidate = closest_point_on_triangle(p, vertex(t, 0), vertex(t, 1), vertex(t, 2));
    const double distance = (candidate - p).squaredNorm();
    if (distance >= best) continue;
    best = distance;
    nearest.point = candidate;
    nearest.triangle = t;
  }
}

NearestPoint MeshDistance::nearest(const Vec3& p) const {
  NearestPoint nearest;
  double best = nearest.distance_mm = std::numeric_limits<double>::infinity();
  if (nodes_.empty()) return nearest;
  std::array<std::pair<uint32_t, double>, kStackSize> stack;
  size_t depth = 0;
  stack[depth++] = {0U, 0.0};
  while (depth > 0) {
    const auto [index, bound] = stack[--depth];
    if (bound >= best) continue;
    const Node& node = nodes_[index];
    if (node.count > 0) {
      search_leaf(node, p, best, nearest);
      continue;
    }
    std::pair<uint32_t, double> near{index + 1, 0.0}, far{node.first, 0.0};
    near.second = box_distance_squared(nodes_[near.first].lower, nodes_[near.first].upper, p);
    far.second = box_distance_squared(nodes_[far.first].lower, nodes_[far.first].upper, p);
    if (far.second < near.second) std::swap(near, far);
    stack[depth++] = far;
    stack[depth++] = near;
  }
  nearest.distance_mm = std::sqrt(best);
  return nearest;
}

double max_distance(std::span<const std::array<float, 3>> points, const TriMesh& mesh) {
  constexpr size_t kChunk = 2048;
  const MeshDistance distance(mesh);
  std::vector<double> worst((points.size() + kChunk - 1) / kChunk, 0.0);
  parallel_chunks(points.size(), kChunk, [&](size_t begin, size_t end) {
    double& mine = worst[begin / kChunk];
    for (size_t i = begin; i < end; ++i) {
      mine = std::max(mine, distance.nearest({points[i][0], points[i][1], points[i][2]}).distance_mm);
    }
  });
  return worst.empty() ? 0.0 : *std::max_element(worst.begin(), worst.end());
}

}  // namespace swarf::mesh
