#include "position/part_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/mesh_check.h"

namespace swarf::position {
namespace {

/// Cosine of the angle within which an edge counts as faced.
constexpr double kFacing = 0.5;

std::string place_text(const Vec3& p) {
  return fmt::format("({:.3f}, {:.3f}, {:.3f}) mm", p.x(), p.y(), p.z());
}

Vec3 position_of(const TriMesh& mesh, uint32_t vertex) {
  const auto& p = mesh.positions[vertex];
  return {p[0], p[1], p[2]};
}

/// Sides of facets with three places, sorted by their ends.
struct PartSide {
  uint64_t ends;
  uint32_t side;
};
std::vector<PartSide> sorted_sides(const TriMesh& mesh, const std::vector<uint32_t>& number) {
  std::vector<PartSide> sides;
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    std::array<uint64_t, 3> v{};
    for (size_t k = 0; k < 3; ++k) v[k] = number[mesh.triangles[i][k]];
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
    for (size_t k = 0; k < 3; ++k) {
      const uint64_t a = v[k], b = v[(k + 1) % 3];
      sides.push_back({std::min(a, b) << 32U | std::max(a, b), static_cast<uint32_t>(3 * i + k)});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const PartSide& a, const PartSide& b) {
    return a.ends != b.ends ? a.ends < b.ends : a.side < b.side;
  });
  return sides;
}

BorderEdge border_edge(const TriMesh& mesh, uint32_t side) {
  const auto& t = mesh.triangles[side / 3];
  const uint32_t k = side % 3;
  BorderEdge edge;
  edge.side = side;
  edge.from = position_of(mesh, t[k]);
  edge.to = position_of(mesh, t[(k + 1) % 3]);
  const Vec3 way = edge.to - edge.from, inner = position_of(mesh, t[(k + 2) % 3]) - edge.from;
  edge.outwards = -(inner - inner.dot(way) / way.squaredNorm() * way).stableNormalized();
  return edge;
}

Vec3 nearest_on(const BorderEdge& edge, const Vec3& p) {
  const Vec3 way = edge.to - edge.from;
  return edge.from + std::clamp((p - edge.from).dot(way) / way.squaredNorm(), 0.0, 1.0) * way;
}

/// Border edges by the least x of theirs, so that those near an edge follow each other.
class EdgesAlongX {
 public:
  explicit EdgesAlongX(const std::vector<BorderEdge>& edges) : edges_(edges), order_(edges.size()) {
    for (size_t i = 0; i < order_.size(); ++i) order_[i] = i;
    std::stable_sort(order_.begin(), order_.end(), [&](size_t a, size_t b) { return low(a) < low(b); });
    for (const BorderEdge& e : edges) longest_ = std::max(longest_, std::abs(e.to.x() - e.from.x()));
  }

  /// Distance from the middle of an edge to the nearest that it faces; infinite beyond `reach`.
  double across(size_t edge, double reach) const {
    const BorderEdge& e = edges_[edge];
    const Vec3 middle = 0.5 * (e.from + e.to);
    double best = std::numeric_limits<double>::infinity();
    auto at = std::lower_bound(order_.begin(), order_.end(), middle.x() - reach - longest_,
                               [&](size_t i, double x) { return low(i) < x; });
    for (; at != order_.end() && low(*at) <= middle.x() + reach; ++at) {
      if (*at == edge) continue;
      const Vec3 to = nearest_on(edges_[*at], middle) - middle;
      const double distance = to.norm();
      if (distance < best && distance <= reach && to.dot(e.outwards) >= kFacing * distance) best = distance;
    }
    return best;
  }

 private:
  double low(size_t i) const { return std::min(edges_[i].from.x(), edges_[i].to.x()); }

  const std::vector<BorderEdge>& edges_;
  std::vector<size_t> order_;
  double longest_ = 0.0;
};

/// What the mesh module finds; an open mesh is told by its borders.
void check_facets(const TriMesh& mesh, const std::string& path, Diagnostics& diagnostics) {
  Diagnostics found;
  mesh::check_design_mesh(mesh, path, nullptr, found, "part");
  for (const Diagnostic& d : found.list()) {
    if (d.code == "mesh-open") continue;
    if (d.code == "mesh-non-manifold" || d.code == "mesh-turned-facets" || d.severity != Severity::kError) {
      diagnostics.warning(d.code, d.where, d.text, d.fix);
    } else {
      diagnostics.error(d.code, d.where, d.text, d.fix);
    }
  }
}

void tell_gaps(const GapReport& report, const std::string& path, const ToolProfile& profile, double sink_mm,
               Diagnostics& diagnostics) {
  const double sink = sinks_into(profile, report.widest.width_mm);
  const std::string depth =
      std::isinf(sink) ? "falls through" : fmt::format("sinks up to {:.4f} mm between level rims", sink);
  const std::string text =
      fmt::format("{} border edges face others across gaps; the widest is {:.4f} mm at {}: the cutter {}",
                  report.edges, report.widest.width_mm, place_text(report.widest.at), depth);
  const char* fix = "join the surfaces in the CAD program (\"sew\") and export again";
  if (sink > sink_mm) {
    diagnostics.error("part-gap-wide", {path, 0, 0}, text, fix);
  } else {
    diagnostics.warning("part-gap", {path, 0, 0}, text, fix);
  }
}

}  // namespace

Borders::Borders(const TriMesh& mesh)
    : side_(3 * mesh.triangles.size(), 0), corner_(3 * mesh.triangles.size(), 0) {
  const std::vector<uint32_t> number = mesh::position_numbers(mesh.positions);
  const std::vector<PartSide> sides = sorted_sides(mesh, number);
  std::vector<uint8_t> vertex(mesh.positions.size(), 0);
  for (size_t i = 0; i < sides.size(); ++i) {
    const bool alone = (i == 0 || sides[i - 1].ends != sides[i].ends) &&
                       (i + 1 == sides.size() || sides[i + 1].ends != sides[i].ends);
    if (!alone) continue;
    side_[sides[i].side] = 1;
    vertex[sides[i].ends >> 32U] = vertex[sides[i].ends & 0xffffffffU] = 1;
  }
  for (uint32_t i = 0; i < side_.size(); ++i) {
    corner_[i] = vertex[number[mesh.triangles[i / 3][i % 3]]];
    if (side_[i] != 0) edges_.push_back(border_edge(mesh, i));
  }
}

bool Borders::on_border(const Rest& rest) const {
  const auto number = static_cast<size_t>(rest.number);
  if (rest.what == Touched::kEdge) return side_[number] != 0;
  return rest.what == Touched::kVertex && corner_[number] != 0;
}

GapReport gaps(const Borders& borders, double reach_mm) {
  const EdgesAlongX order(borders.edges());
  GapReport report;
  for (size_t i = 0; i < borders.edges().size(); ++i) {
    const BorderEdge& edge = borders.edges()[i];
    const Vec3 middle = 0.5 * (edge.from + edge.to);
    const double width = order.across(i, reach_mm);
    if (std::isinf(width)) {
      if (report.lone_edges++ == 0) report.first_lone = middle;
      continue;
    }
    if (report.edges++ == 0 || width > report.widest.width_mm) report.widest = {width, middle};
  }
  return report;
}

double sinks_into(const ToolProfile& profile, double width_mm) {
  const double half = 0.5 * width_mm;
  return half <= profile.radius() ? profile.height(half) : std::numeric_limits<double>::infinity();
}

void check_part(const TriMesh& mesh, const std::string& path, const ToolProfile& profile, double sink_mm,
                Diagnostics& diagnostics) {
  check_facets(mesh, path, diagnostics);
  if (diagnostics.has_errors()) return;
  const GapReport report = gaps(Borders(mesh), 2.0 * profile.radius());
  if (report.edges > 0) tell_gaps(report, path, profile, sink_mm, diagnostics);
  if (report.lone_edges > 0) {
    diagnostics.note(
        "part-ends", {path, 0, 0},
        fmt::format("{} border edges face no other within the cutter's diameter of {:.3f} mm, the first "
                    "at {}: beside them a tool falls",
                    report.lone_edges, 2.0 * profile.radius(), place_text(report.first_lone)));
  }
}

}  // namespace swarf::position
