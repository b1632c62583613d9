#include "mesh/mesh_lines.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/winding.h"

namespace swarf::mesh {
namespace {

constexpr uint32_t kFacetsOfLeaf = 4;
constexpr double kLarger = 1e-9;  // of a facet
/// Of the box test: wider than its rounding and than what kLarger adds; mm.
constexpr double kBoxSlack = 1e-6;

Vec3 vertex_of(const TriMesh& mesh, uint32_t v) {
  const auto& p = mesh.positions[v];
  return {p[0], p[1], p[2]};
}

bool passes_box(const Box& box, const Vec3& p, const Vec3& way) {
  double enter = -std::numeric_limits<double>::infinity(), leave = -enter;
  for (int a = 0; a < 3; ++a) {
    const double low = box.lower[a] - kBoxSlack - p[a], high = box.upper[a] + kBoxSlack - p[a];
    if (way[a] == 0.0) {
      if (low > 0.0 || high < 0.0) return false;
      continue;
    }
    const double s0 = low / way[a], s1 = high / way[a];
    enter = std::max(enter, std::min(s0, s1));
    leave = std::min(leave, std::max(s0, s1));
  }
  return enter <= leave;
}

}  // namespace

MeshLines::MeshLines(const TriMesh& mesh) {
  facets_.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    const Vec3 a = vertex_of(mesh, t[0]);
    facets_.push_back({a, vertex_of(mesh, t[1]) - a, vertex_of(mesh, t[2]) - a});
  }
  if (!facets_.empty()) build(0, static_cast<uint32_t>(facets_.size()));
}

/// Halves at the middle facet along the longest extent of their middles.
uint32_t MeshLines::build(uint32_t begin, uint32_t end) {
  const double infinite = std::numeric_limits<double>::infinity();
  Box box{Vec3::Constant(infinite), Vec3::Constant(-infinite)}, middles = box;
  const auto middle = [](const Facet& f) { return Vec3(f.a + (f.ab + f.ac) / 3.0); };
  for (uint32_t i = begin; i < end; ++i) {
    const Facet& f = facets_[i];
    for (const Vec3& p : {f.a, Vec3(f.a + f.ab), Vec3(f.a + f.ac)}) {
      box.lower = box.lower.cwiseMin(p);
      box.upper = box.upper.cwiseMax(p);
    }
    middles.lower = middles.lower.cwiseMin(middle(f));
    middles.upper = middles.upper.cwiseMax(middle(f));
  }
  const auto node = static_cast<uint32_t>(nodes_.size());
  nodes_.push_back({box, begin, end, 0});
  if (end - begin <= kFacetsOfLeaf) return node;
  int axis = 0;
  middles.size().maxCoeff(&axis);
  const uint32_t half = begin + (end - begin) / 2;
  std::nth_element(facets_.begin() + begin, facets_.begin() + half, facets_.begin() + end,
                   [&](const Facet& a, const Facet& b) { return middle(a)[axis] < middle(b)[axis]; });
  build(begin, half);
  nodes_[node].second = build(half, end);
  return node;
}

template <typename Visit>
void MeshLines::each_along(const Vec3& point, const Vec3& way, const Visit& visit) const {
  std::array<uint32_t, 64> open;  // a balanced tree of 2^32 facets is half as deep
  size_t count = 0;
  if (!nodes_.empty()) open[count++] = 0;
  while (count > 0) {
    const uint32_t n = open[--count];
    const Node& node = nodes_[n];
    if (!passes_box(node.box, point, way)) continue;
    if (node.second == 0) {
      for (uint32_t i = node.begin; i < node.end; ++i) {
        if (!visit(facets_[i])) return;
      }
      continue;
    }
    open[count++] = node.second;
    open[count++] = n + 1;
  }
}

void MeshLines::add_hits(const Vec3& point, const Vec3& way, std::vector<double>& hits) const {
  each_along(point, way, [&](const Facet& f) {
    // Moeller & Trumbore 1997.
    const Vec3 across = way.cross(f.ac), from = point - f.a;
    const double det = f.ab.dot(across);
    if (det == 0.0) return true;
    const double u = from.dot(across) / det;
    if (u < -kLarger || u > 1.0 + kLarger) return true;
    const Vec3 turned = from.cross(f.ab);
    const double v = way.dot(turned) / det;
    if (v >= -kLarger && u + v <= 1.0 + kLarger) hits.push_back(f.ac.dot(turned) / det);
    return true;
  });
}

double MeshLines::winding(const Vec3& point) const {
  const auto corners = [](const Facet& f) { return std::array{f.a, Vec3(f.a + f.ab), Vec3(f.a + f.ac)}; };
  for (const Vec3& ray : winding_rays()) {
    int turns = 0;
    bool sure = true;
    each_along(point, ray, [&](const Facet& f) {
      const std::optional<int> crossing = ray_crossing(corners(f), point, ray);
      sure = crossing.has_value();
      turns += crossing.value_or(0);
      return sure;
    });
    if (sure) return turns;
  }
  double turns = 0.0;
  for (const Facet& f : facets_) turns += solid_angle(corners(f), point);
  return turns;
}

}  // namespace swarf::mesh
