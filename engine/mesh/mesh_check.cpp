#include "mesh/mesh_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "mesh/mesh_ops.h"

namespace swarf::mesh {
namespace {

constexpr double kInch = 25.4;  // mm
/// A design whose box has less than this share of the stock's diagonal is suspicious enough to try inches.
constexpr double kTinyShare = 1.0 / 15.0;
/// A design whose box has more than this many times the stock's diagonal may have been scaled from inches
/// twice.
constexpr double kHugeShare = 5.0;
/// The design may reach beyond the stock by rounding of its file; share of the stock's diagonal.
constexpr double kFitSlack = 1e-5;

std::string text(const Vec3& p) {
  return fmt::format("({:.3f}, {:.3f}, {:.3f})", p.x(), p.y(), p.z());
}

/// One edge of the welded mesh: how often it is run through upwards (low to high vertex) and downwards.
struct Edge {
  uint32_t low, high, up, down;
};

std::vector<Edge> edges_of(const WeldedMesh& mesh) {
  std::vector<uint64_t> runs;  // low, high, and whether it runs down
  runs.reserve(3 * mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    for (size_t i = 0; i < 3; ++i) {
      const uint64_t a = t[i], b = t[(i + 1) % 3];
      runs.push_back(std::min(a, b) << 33U | std::max(a, b) << 1U | (a > b ? 1U : 0U));
    }
  }
  std::sort(runs.begin(), runs.end());
  std::vector<Edge> edges;
  edges.reserve(runs.size() / 2);
  for (const uint64_t run : runs) {
    const auto low = static_cast<uint32_t>(run >> 33U), high = static_cast<uint32_t>(run >> 1U);
    if (edges.empty() || edges.back().low != low || edges.back().high != high)
      edges.push_back({low, high, 0, 0});
    ++((run & 1U) != 0 ? edges.back().down : edges.back().up);
  }
  return edges;
}

/// Edges with one kind of fault: how many, the first, and the box around all.
struct EdgeFaults {
  size_t count = 0;
  Vec3 first_from, first_to;
  Box box;

  void add(const Vec3& from, const Vec3& to) {
    if (count++ == 0) {
      first_from = from;
      first_to = to;
      box = {from, from};
    }
    box.lower = box.lower.cwiseMin(from).cwiseMin(to);
    box.upper = box.upper.cwiseMax(from).cwiseMax(to);
  }
  std::string where() const {
    return fmt::format("the first from {} to {} mm, all of them within {} .. {} mm", text(first_from),
                       text(first_to), text(box.lower), text(box.upper));
  }
};

/// True when the surface is closed and evenly oriented.
bool check_edges(const WeldedMesh& mesh, const SourceLocation& where, const std::string& name,
                 Diagnostics& diagnostics) {
  EdgeFaults open, crowded, turned;
  for (const Edge& e : edges_of(mesh)) {
    EdgeFaults* faults = e.up + e.down == 1  ? &open
                         : e.up + e.down > 2 ? &crowded
                         : e.up != 1         ? &turned
                                             : nullptr;
    if (faults != nullptr) faults->add(mesh.points[e.low], mesh.points[e.high]);
  }
  if (open.count > 0) {
    diagnostics.error("mesh-open", where,
                      fmt::format("the {} is open: {} boundary edges, {}", name, open.count, open.where()),
                      "close the holes in the CAD or repair program and export again");
  }
  if (crowded.count > 0) {
    diagnostics.error(
        "mesh-non-manifold", where,
        fmt::format("{} edges are shared by more than two facets, {}", crowded.count, crowded.where()),
        "remove doubled facets and inner walls, and keep solids that touch along an edge apart");
  }
  if (turned.count > 0) {
    diagnostics.error(
        "mesh-turned-facets", where,
        fmt::format("{} edges lie between facets of opposite orientation, {}", turned.count, turned.where()),
        "orient all facets outward (\"unify normals\" in most repair programs)");
  }
  return open.count + crowded.count + turned.count == 0;
}

double volume_of(const WeldedMesh& mesh) {
  double six_volumes = 0.0;
  const Vec3 origin = mesh.points.empty() ? Vec3(Vec3::Zero()) : mesh.points.front();
  for (const auto& t : mesh.triangles) {
    six_volumes +=
        (mesh.points[t[0]] - origin).dot((mesh.points[t[1]] - origin).cross(mesh.points[t[2]] - origin));
  }
  return six_volumes / 6.0;
}

bool box_holds(const Box& outer, const Box& inner) {
  const double slack = kFitSlack * outer.size().norm();
  return (inner.lower - outer.lower).minCoeff() >= -slack && (outer.upper - inner.upper).minCoeff() >= -slack;
}

/// How a design that reaches beyond the stock is brought into it.
std::string outside_remedy(const Box& design, const Box& stock) {
  const Vec3 room = stock.size() - design.size();
  if (room.minCoeff() < -kFitSlack * stock.size().norm()) return "give both in mm, or make the stock larger";
  Vec3 by = Vec3::Zero();
  for (int a = 0; a < 3; ++a) {
    const double up = stock.lower[a] - design.lower[a], down = stock.upper[a] - design.upper[a];
    by[a] = up > 0.0 ? up : std::min(down, 0.0);
  }
  return fmt::format(
      "moved by X {:.3f} Y {:.3f} Z {:.3f} mm it lies in the stock: design.position_mm, or design.origin "
      "= \"corner\" or \"centre\" puts that point of its top on the work's zero",
      by.x(), by.y(), by.z());
}

void check_size(const Box& design, const Box& stock, const SourceLocation& where, Diagnostics& diagnostics) {
  const double share = design.size().norm() / stock.size().norm();
  const std::string numbers =
      fmt::format("the design measures {} and the stock {}", text(design.size()), text(stock.size()));
  if (share < kTinyShare && box_holds(stock, {kInch * design.lower, kInch * design.upper})) {
    diagnostics.error(
        "mesh-in-inches", where,
        fmt::format("the design mesh is probably in inches: {} mm; 25.4 times larger it fits", numbers),
        "export it in mm");
    return;
  }
  if (box_holds(stock, design)) return;
  if (share > kHugeShare && box_holds(stock, {design.lower / kInch, design.upper / kInch})) {
    diagnostics.error(
        "mesh-scaled-by-25", where,
        fmt::format("the design mesh is probably scaled twice: {} mm; 25.4 times smaller it fits", numbers),
        "export it in mm, without a conversion from inches");
    return;
  }
  diagnostics.error("mesh-outside-stock", where,
                    fmt::format("the design mesh ({} .. {} mm) reaches beyond the stock ({} .. {} mm)",
                                text(design.lower), text(design.upper), text(stock.lower), text(stock.upper)),
                    outside_remedy(design, stock));
}

/// Facets with area; the others are told.
size_t count_facets(const TriMesh& mesh, const SourceLocation& where, Diagnostics& diagnostics) {
  size_t sound = 0, flat = 0;
  Vec3 first = Vec3::Zero();
  for (const auto& t : mesh.triangles) {
    const auto corner = [&](size_t i) {
      return Eigen::Vector3f(mesh.positions[t[i]].data()).cast<double>().eval();
    };
    const Vec3 a = corner(0);
    if ((corner(1) - a).cross(corner(2) - a).squaredNorm() > 0.0) {
      ++sound;
    } else if (flat++ == 0) {
      first = a;
    }
  }
  if (flat > 0 && sound > 0) {
    diagnostics.warning(
        "mesh-zero-area", where,
        fmt::format("{} of {} facets have no area, the first at {} mm", flat, flat + sound, text(first)),
        "they are not measured; a repair program removes them");
  }
  return sound;
}

uint64_t hash_of(const std::array<float, 3>& p) {
  uint64_t hash = 0x9e3779b97f4a7c15ULL;
  for (const float value : p) {
    hash = (hash ^ std::bit_cast<uint32_t>(value)) * 0xff51afd7ed558ccdULL;
    hash ^= hash >> 32U;
  }
  return hash;
}

}  // namespace

std::vector<uint32_t> position_numbers(const std::vector<std::array<float, 3>>& positions) {
  constexpr uint32_t kFree = 0xffffffffU;
  // Open addressing with linear probing, at most half full: a slot box_holds the first vertex of its
  // position.
  std::vector<uint32_t> slots(std::bit_ceil(2 * positions.size() + 1), kFree);
  std::vector<uint32_t> numbers(positions.size());
  uint32_t distinct = 0;
  for (uint32_t v = 0; v < positions.size(); ++v) {
    const auto& p = positions[v];
    const std::array<float, 3> key{p[0] + 0.0F, p[1] + 0.0F, p[2] + 0.0F};  // -0 and 0 are one place
    size_t slot = hash_of(key) & (slots.size() - 1);
    while (slots[slot] != kFree && positions[slots[slot]] != p) slot = (slot + 1) & (slots.size() - 1);
    if (slots[slot] == kFree) {
      slots[slot] = v;
      numbers[v] = distinct++;
    } else {
      numbers[v] = numbers[slots[slot]];
    }
  }
  return numbers;
}

WeldedMesh weld(const TriMesh& mesh) {
  const std::vector<uint32_t> numbers = position_numbers(mesh.positions);
  WeldedMesh welded;
  for (uint32_t v = 0; v < numbers.size(); ++v) {
    if (numbers[v] < welded.points.size()) continue;
    welded.points.emplace_back(mesh.positions[v][0], mesh.positions[v][1], mesh.positions[v][2]);
  }
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    const uint32_t a = numbers[t[0]], b = numbers[t[1]], c = numbers[t[2]];
    if (a == b || b == c || c == a) continue;
    welded.triangles.push_back({a, b, c});
    welded.sources.push_back(i);
  }
  return welded;
}

void check_design_mesh(const TriMesh& mesh, const std::string& path, const Box* stock_W,
                       Diagnostics& diagnostics, const std::string& name) {
  const SourceLocation where{path, 0, 0};
  const auto broken = std::count_if(mesh.positions.begin(), mesh.positions.end(), [](const auto& p) {
    return !(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]));
  });
  if (broken > 0) {
    diagnostics.error(
        "mesh-not-finite", where,
        fmt::format("{} of {} vertices have NaN or infinite coordinates", broken, mesh.positions.size()),
        "export the mesh again");
    return;
  }
  if (count_facets(mesh, where, diagnostics) == 0) {
    diagnostics.error(
        "mesh-empty", where,
        fmt::format("the {} has no facet with area ({} facets read)", name, mesh.triangles.size()),
        "export the solid, not its edges or points");
    return;
  }
  const WeldedMesh welded = weld(mesh);
  const bool closed = check_edges(welded, where, name, diagnostics);
  const double volume = volume_of(welded);
  const Vec3 size = bounds(mesh).size();
  constexpr double kLeastShare = 1e-9;  // of the greatest extent's cube
  if (closed && std::abs(volume) <= kLeastShare * std::pow(size.maxCoeff(), 3)) {
    diagnostics.error(
        "mesh-no-volume", where,
        fmt::format("the {} encloses no volume ({:.3g} mm3): a sheet of zero thickness", name, volume),
        "export a solid body");
  } else if (closed && volume < 0.0) {
    diagnostics.error("mesh-inverted", where,
                      fmt::format("the {} is inside out: it encloses {:.3f} mm3", name, volume),
                      "turn all its facets round (\"flip normals\")");
  }
  if (stock_W != nullptr) check_size(bounds(mesh), *stock_W, where, diagnostics);
}

std::vector<uint32_t> facets_across(const std::vector<std::array<uint32_t, 3>>& triangles) {
  constexpr uint32_t kNone = 0xffffffffU;
  struct Side {
    uint64_t ends;
    uint32_t place;
    bool operator<(const Side& other) const {
      return ends != other.ends ? ends < other.ends : place < other.place;
    }
  };
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (uint32_t i = 0; i < 3 * triangles.size(); ++i) {
    const uint64_t a = triangles[i / 3][i % 3], b = triangles[i / 3][(i + 1) % 3];
    sides.push_back({std::min(a, b) << 32U | std::max(a, b), i});
  }
  std::sort(sides.begin(), sides.end());
  std::vector<uint32_t> across(sides.size(), kNone);
  for (size_t i = 0; i < sides.size();) {
    size_t end = i + 1;
    while (end < sides.size() && sides[end].ends == sides[i].ends) ++end;
    if (end - i == 2) {
      across[sides[i].place] = sides[i + 1].place / 3;
      across[sides[i + 1].place] = sides[i].place / 3;
    }
    i = end;
  }
  return across;
}

double enclosed_volume(const TriMesh& mesh) {
  return volume_of(weld(mesh));
}

std::string check_closed(const TriMesh& mesh) {
  std::string open;
  for (const Edge& e : edges_of(weld(mesh))) {
    if (e.up > 1 || e.down > 1)
      return fmt::format("edge {}-{} runs twice in the same direction", e.low, e.high);
    if (open.empty() && e.up != e.down) {
      open = fmt::format("edge {}-{} has a triangle on one side only", e.low, e.high);
    }
  }
  return open;
}

}  // namespace swarf::mesh
