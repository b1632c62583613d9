#include "proof/solid_design.h"

#include <algorithm>
#include <array>
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cmath>
#include <utility>

namespace swarf::proof {
namespace {

namespace bg = boost::geometry;
using TreePoint = bg::model::point<double, 3, bg::cs::cartesian>;
using TreeBox = bg::model::box<TreePoint>;
using TreeEntry = std::pair<TreeBox, uint32_t>;

TreeBox tree_box(const Box& box) {
  return {TreePoint(box.lower.x(), box.lower.y(), box.lower.z()),
          TreePoint(box.upper.x(), box.upper.y(), box.upper.z())};
}

/// Facets that turn by less than this hang together as one plane; rad. The wedge between them is thinner than
/// a touch.
constexpr double kFlatTurn = 1e-7;
constexpr double kThinCone = 1e-6;
/// A facet less high than this has a normal that the rounding of its corners turns, mm: what its neighbours'
/// edges carry is then not known from it.
constexpr double kNeedle = 2e-4;

Box facet_box(const mesh::SignedDistance& design, uint32_t facet) {
  const Vec3 a = design.corner(facet, 0), b = design.corner(facet, 1), c = design.corner(facet, 2);
  return {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
}

/// Sides of a facet as its wedges see them.
enum class EdgeKind { kFlat, kHollow, kStandsOut, kUnknown };

struct Edge {
  EdgeKind kind = EdgeKind::kUnknown;
  Vec3 other = Vec3::Zero();  ///< normal of the facet across
};

bool is_needle(const mesh::SignedDistance& design, uint32_t facet) {
  const Vec3 a = design.corner(facet, 0), ab = design.corner(facet, 1) - a, ac = design.corner(facet, 2) - a;
  return ab.cross(ac).norm() < kNeedle * std::max({ab.norm(), ac.norm(), (ac - ab).norm()});
}

/// The facet across a side; its corner that the side has not tells whether the edge stands out.
Edge edge_of(const mesh::SignedDistance& design, uint32_t facet, size_t place) {
  const uint32_t other = design.across()[3 * facet + place];
  if (other == mesh::SignedDistance::kBorder || other == mesh::SignedDistance::kSeam) return {};
  if (is_needle(design, other) || is_needle(design, facet)) return {};
  const Vec3 &n = design.face_normal(facet), &m = design.face_normal(other);
  if (n.cross(m).norm() <= kFlatTurn && n.dot(m) > 0.0) return {EdgeKind::kFlat, m};
  const auto& own = design.mesh().triangles[facet];
  const uint32_t from = own[place], to = own[(place + 1) % 3];
  for (size_t k = 0; k < 3; ++k) {
    const uint32_t vertex = design.mesh().triangles[other][k];
    if (vertex == from || vertex == to) continue;
    const double above = n.dot(design.corner(other, k) - design.corner(facet, place));
    return {above < 0.0 ? EdgeKind::kStandsOut : EdgeKind::kHollow, m};
  }
  return {};
}

Vec3 turned(const Vec3& from, const Vec3& to, double share) {
  const double angle = std::acos(std::clamp(from.dot(to), -1.0, 1.0));
  if (angle < 1e-9) return from;
  return (std::sin((1.0 - share) * angle) * from + std::sin(share * angle) * to).normalized();
}

void add_wedge(const Vec3& a, const Vec3& b, const Vec3& from, const Vec3& to,
               std::vector<FeatureCell>& cells) {
  const double angle = std::acos(std::clamp(from.dot(to), -1.0, 1.0));
  const int parts = std::max(1, static_cast<int>(std::ceil(angle / SolidDesign::kMostTurn)));
  for (int i = 0; i < parts; ++i)
    cells.push_back({{a, b},
                     {turned(from, to, static_cast<double>(i) / parts),
                      turned(from, to, static_cast<double>(i + 1) / parts)}});
}

void add_cone(const Vec3& vertex, const std::array<Vec3, 3>& ways, std::vector<FeatureCell>& cells) {
  // Thinner than a touch: the edges of a hollow rim span such cones by the rounding of their corners.
  if (std::abs(ways[0].dot(ways[1].cross(ways[2]))) < kThinCone) return;
  size_t widest = 0;
  double most = 0.0;
  for (size_t k = 0; k < 3; ++k) {
    const double turn = (ways[(k + 1) % 3] - ways[k]).norm();
    if (turn > most) {
      most = turn;
      widest = k;
    }
  }
  if (most <= SolidDesign::kMostTurn) {
    cells.push_back({{vertex}, {ways[0], ways[1], ways[2]}});
    return;
  }
  const Vec3 &a = ways[widest], &b = ways[(widest + 1) % 3], &c = ways[(widest + 2) % 3];
  const Vec3 middle = (a + b).normalized();
  add_cone(vertex, {a, middle, c}, cells);
  add_cone(vertex, {middle, b, c}, cells);
}

/// The extreme directions of the normal cone of a vertex: m with m . e <= 0 for all edges e that leave it.
/// Each is across two of the edges.
std::vector<Vec3> extreme_ways(const std::vector<Vec3>& edges) {
  constexpr double kAngle = 1e-9;
  std::vector<Vec3> ways;
  const auto holds = [&](const Vec3& m) {
    return std::all_of(edges.begin(), edges.end(), [&](const Vec3& e) { return m.dot(e) <= kAngle; });
  };
  for (size_t i = 0; i < edges.size(); ++i) {
    for (size_t j = i + 1; j < edges.size(); ++j) {
      const Vec3 across = edges[i].cross(edges[j]);
      if (across.norm() < kFlatTurn) continue;
      for (const double sign : {1.0, -1.0}) {
        const Vec3 m = sign * across.normalized();
        if (!holds(m)) continue;
        const bool known =
            std::any_of(ways.begin(), ways.end(), [&](const Vec3& w) { return (w - m).norm() < kFlatTurn; });
        if (!known) ways.push_back(m);
      }
    }
  }
  return ways;
}

/// The cone's directions lie in the fan of triangles around their mean. The edges of a hollow corner have
/// such a cone too, which points into the body.
void add_vertex(const mesh::SignedDistance& design, const Vec3& vertex, std::vector<Vec3> ways,
                std::vector<FeatureCell>& cells) {
  if (ways.size() < 3) return;  // no more than a wedge's border
  Vec3 mean = Vec3::Zero();
  for (const Vec3& m : ways) mean += m;
  if (mean.norm() < kFlatTurn) return;
  mean.normalize();
  constexpr double kAside = 1e-4;  // mm; far above the rounding of floats
  if (design.at(vertex + kAside * mean).distance_mm < 0.0) return;
  int least = 0;
  mean.cwiseAbs().minCoeff(&least);
  const Vec3 e1 = mean.cross(Vec3::Unit(least)).normalized(), e2 = mean.cross(e1);
  std::sort(ways.begin(), ways.end(), [&](const Vec3& a, const Vec3& b) {
    return std::atan2(a.dot(e2), a.dot(e1)) < std::atan2(b.dot(e2), b.dot(e1));
  });
  if (ways.size() == 3) {
    add_cone(vertex, {ways[0], ways[1], ways[2]}, cells);
    return;
  }
  for (size_t k = 0; k < ways.size(); ++k)
    add_cone(vertex, {mean, ways[k], ways[(k + 1) % ways.size()]}, cells);
}

}  // namespace

struct SolidDesign::Tree {
  bg::index::rtree<TreeEntry, bg::index::rstar<16>> boxes;
};

SolidDesign::SolidDesign(const TriMesh& mesh, double chord_mm) : distance_(mesh), chord_mm_(chord_mm) {
  std::vector<TreeEntry> entries;
  for (uint32_t n = 0; n < facets(); ++n) entries.emplace_back(tree_box(facet_box(distance_, n)), n);
  tree_ = std::make_unique<const Tree>(Tree{decltype(Tree::boxes)(entries)});
}

SolidDesign::~SolidDesign() = default;

void SolidDesign::find(const Box& box, std::vector<uint32_t>& found) const {
  const size_t first = found.size();
  for (auto it = tree_->boxes.qbegin(bg::index::intersects(tree_box(box))); it != tree_->boxes.qend(); ++it)
    found.push_back(it->second);
  std::sort(found.begin() + static_cast<std::ptrdiff_t>(first), found.end());
}

std::vector<FeatureCell> SolidDesign::cells() const {
  std::vector<FeatureCell> cells;
  const TriMesh& mesh = distance_.mesh();
  std::vector<std::vector<Vec3>> edges(mesh.positions.size());
  for (uint32_t f = 0; f < facets(); ++f) {
    const std::array<Vec3, 3> p{distance_.corner(f, 0), distance_.corner(f, 1), distance_.corner(f, 2)};
    const Vec3& n = distance_.face_normal(f);
    cells.push_back({{p[0], p[1], p[2]}, {n}});
    for (size_t k = 0; k < 3; ++k) {
      const Edge edge = edge_of(distance_, f, k);
      if (edge.kind == EdgeKind::kFlat) continue;
      const Vec3 &a = p[k], &b = p[(k + 1) % 3];
      const uint32_t from = mesh.triangles[f][k], to = mesh.triangles[f][(k + 1) % 3];
      edges[from].push_back((b - a).normalized());
      edges[to].push_back((a - b).normalized());
      // What lies across is not known: a quarter turn from either side holds any wedge.
      if (edge.kind == EdgeKind::kUnknown) add_wedge(a, b, n, (b - a).normalized().cross(n), cells);
      const bool is_first = distance_.across()[3 * f + k] > f;
      if (edge.kind == EdgeKind::kStandsOut && is_first) add_wedge(a, b, n, edge.other, cells);
    }
  }
  for (size_t v = 0; v < edges.size(); ++v) {
    if (edges[v].size() < 6) continue;  // each edge is met from both sides: fewer than three end here
    std::vector<Vec3> once;
    for (const Vec3& e : edges[v])
      if (std::none_of(once.begin(), once.end(), [&](const Vec3& o) { return (o - e).norm() < kFlatTurn; }))
        once.push_back(e);
    const auto& at = mesh.positions[v];
    add_vertex(distance_, Vec3(at[0], at[1], at[2]), extreme_ways(once), cells);
  }
  return cells;
}

}  // namespace swarf::proof
