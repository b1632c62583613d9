#include "measure/design_cell.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "base/angles.h"

namespace swarf::measure {
namespace {

constexpr size_t kLengthSamples = 8;

CellCorner corner_on(const surface::Surface& surface, double u, double v) {
  const surface::Derivatives d = surface.derivatives(u, v);
  return {d.S, surface::outward_normal(surface, d, {u, v}), {u, v}};
}

/// n = N/|N|, N = Su x Sv: |dn| <= |dN| / |N|, |dN/du| <= |Suu||Sv| + |Su||Suv|; |Su|, |Sv| and |N| are
/// bounded from the rectangle's centre. Infinite where N may vanish.
PatchBounds bounds_over(const surface::SurfacePtr& surface, const Vec2& low, const Vec2& high) {
  PatchBounds bounds{surface, surface->bend_bounds(low, high)};
  const Vec2 centre = 0.5 * (low + high), half = 0.5 * (high - low);
  const surface::Derivatives d = surface->derivatives(centre.x(), centre.y());
  const surface::BendBounds& b = bounds.bends;
  const double uu = b.uu.most(), uv = b.uv.most(), vv = b.vv.most();
  const double change_u = uu * half.x() + uv * half.y(), change_v = uv * half.x() + vv * half.y();
  const double Su = d.Su.norm() + change_u, Sv = d.Sv.norm() + change_v;
  bounds.most_u = Su;
  bounds.most_v = Sv;
  const double N_u = uu * Sv + Su * uv, N_v = uv * Sv + Su * vv;
  const double N = d.Su.cross(d.Sv).norm() - N_u * half.x() - N_v * half.y();
  const double far = std::numeric_limits<double>::infinity();
  bounds.turn_u = N > 0.0 ? N_u / N : N_u > 0.0 ? far : 0.0;
  bounds.turn_v = N > 0.0 ? N_v / N : N_v > 0.0 ? far : 0.0;
  return bounds;
}

/// How far the edge beside a side leaves it, as the parameters do: aside of it in the metric that the longest
/// steps along u and v make, in which all offsets from one side are parallel, so that between two places none
/// is greater than at both.
struct Strip {
  double mm = 0.0, turn = 0.0;
};
Strip strip_beside(const Vec2& from, const Vec2& to, const EdgePiece& edge, const PatchBounds& bounds) {
  Strip widest;
  const Vec2 scale(bounds.most_u, bounds.most_v), way = (to - from).cwiseProduct(scale);
  const double length2 = way.squaredNorm();
  const auto [low, high] = std::minmax(edge.from, edge.to);
  for (size_t i = low + 1; i < high; ++i) {
    const Vec2 off = ((*edge.places)[i] - from).cwiseProduct(scale);
    const double along = length2 > 0.0 ? std::clamp(off.dot(way) / length2, 0.0, 1.0) : 0.0;
    const Vec2 aside = (off - along * way).cwiseAbs();
    widest.mm = std::max(widest.mm, aside.sum());
    const auto turn = [](double by, double mm, double most) { return mm > 0.0 ? by * mm / most : 0.0; };
    widest.turn = std::max(widest.turn, turn(bounds.turn_u, aside.x(), bounds.most_u) +
                                            turn(bounds.turn_v, aside.y(), bounds.most_v));
  }
  return widest;
}

/// The strip beside its sides lies as far from the places of the cell.
void widen(DesignCell& cell, const Strip& strip) {
  cell.strip_mm = std::max(cell.strip_mm, strip.mm);
  cell.stray_mm += strip.mm;
  cell.flatness_mm += strip.mm;
  cell.turn += strip.turn;
}

/// Length of the longest of a few lines of one parameter: only the size of cells hangs on it.
double length_along(const surface::Surface& surface, bool along_u) {
  double longest = 0.0;
  for (size_t i = 0; i <= kLengthSamples; ++i) {
    double length = 0.0;
    for (size_t k = 0; k <= kLengthSamples; ++k) {
      const double fixed = static_cast<double>(i) / kLengthSamples,
                   t = static_cast<double>(k) / kLengthSamples;
      const surface::Derivatives d = along_u ? surface.derivatives(t, fixed) : surface.derivatives(fixed, t);
      length += (along_u ? d.Su : d.Sv).norm() / (kLengthSamples + 1);
    }
    longest = std::max(longest, length);
  }
  return longest;
}

void add_surface(const surface::SurfacePtr& surface, double size_mm, std::vector<RootCell>& cells) {
  const auto parts = [&](bool along_u) {
    return std::max(1, static_cast<int>(std::ceil(length_along(*surface, along_u) / size_mm)));
  };
  const int nu = parts(true), nv = parts(false);
  for (int j = 0; j < nv; ++j) {
    for (int i = 0; i < nu; ++i) {
      const double u0 = static_cast<double>(i) / nu, u1 = static_cast<double>(i + 1) / nu;
      const double v0 = static_cast<double>(j) / nv, v1 = static_cast<double>(j + 1) / nv;
      const PatchBounds bounds = bounds_over(surface, {u0, v0}, {u1, v1});
      const CellCorner a = corner_on(*surface, u0, v0), b = corner_on(*surface, u1, v0),
                       c = corner_on(*surface, u1, v1), d = corner_on(*surface, u0, v1);
      cells.push_back({make_cell({a, b, c}, bounds), bounds});
      cells.push_back({make_cell({a, c, d}, bounds), bounds});
    }
  }
}

void divide_root(const RootCell& root, double size_mm, std::vector<RootCell>& cells) {
  if (root.cell.longest_edge() <= size_mm) {
    cells.push_back(root);
    return;
  }
  // The longest edge is halved: long thin facets keep their shape no worse.
  const std::array<CellCorner, 3>& corners = root.cell.corners;
  size_t first = 0;
  double longest = -1.0;
  for (size_t k = 0; k < 3; ++k) {
    const double length = (corners[k].point - corners[(k + 1) % 3].point).norm();
    if (length > longest) {
      longest = length;
      first = k;
    }
  }
  const size_t second = (first + 1) % 3, third = (first + 2) % 3;
  const CellCorner &a = corners[first], &b = corners[second], &c = corners[third];
  const EdgePiece& edge = root.edges[first];
  const CellCorner m = middle(a, b, root.bounds, edge);
  const auto add = [&](const std::array<CellCorner, 3>& part, const CellEdges& edges) {
    RootCell half = root;
    half.cell = make_cell(part, root.bounds, edges);
    half.edges = edges;
    divide_root(half, size_mm, cells);
  };
  add({a, m, c}, {edge.first_half(), EdgePiece{}, root.edges[third]});
  add({m, b, c}, {edge.second_half(), root.edges[second], EdgePiece{}});
}

void add_divided(const std::array<CellCorner, 3>& corners, double size_mm, std::vector<RootCell>& cells,
                 const PatchBounds& bounds = {}, const CellEdges& edges = {}) {
  divide_root({make_cell(corners, bounds, edges), bounds, edges}, size_mm, cells);
}

/// The part of a surface over a facet that stands for it.
void add_part(const stock::FacetSheets& sheets, uint32_t facet, double size_mm,
              std::vector<RootCell>& cells) {
  const surface::SurfacePtr& surface = sheets.surface_of(facet);
  const surface::FacetOnSurface& on = sheets.on_surface(facet);
  const std::array<Vec2, 3>& uv = on.uv;
  Vec2 low = uv[0].cwiseMin(uv[1]).cwiseMin(uv[2]), high = uv[0].cwiseMax(uv[1]).cwiseMax(uv[2]);
  CellEdges edges;
  for (size_t k = 0; k < 3; ++k) {
    if (on.edges[k] == surface::FacetOnSurface::kNone) continue;
    const surface::EdgePlaces& places = sheets.under->edges[static_cast<size_t>(on.edges[k])];
    edges[k] = {&places, 0, places.size() - 1};
    for (const Vec2& place : places) {
      low = low.cwiseMin(place);
      high = high.cwiseMax(place);
    }
  }
  const PatchBounds bounds = bounds_over(surface, low, high);
  const auto corner = [&](size_t k) { return corner_on(*surface, uv[k].x(), uv[k].y()); };
  add_divided({corner(0), corner(1), corner(2)}, size_mm, cells, bounds, edges);
}

Vec3 turned_by(const Vec3& n, const Vec3& m, double share) {
  const double angle = angle_between(n, m);
  return Eigen::AngleAxisd(share * angle, n.cross(m).normalized()) * n;
}

constexpr double kFanStep = 0.2;  // rad; the columns' directions between them are bounded, not sampled

/// Columns along an edge, from corner a to b on one side of a step of its fan and from d to c on the other.
/// Halved along the edge alone: halving the longest side of a cell without area makes three of one, each half
/// as long.
void add_fan_step(const std::array<CellCorner, 4>& step, double size_mm, const PatchBounds& bounds,
                  std::vector<RootCell>& fan) {
  const auto& [a, b, c, d] = step;
  if ((b.point - a.point).norm() > size_mm) {
    const CellCorner ab = middle(a, b, bounds), dc = middle(d, c, bounds);
    add_fan_step({a, ab, dc, d}, size_mm, bounds, fan);
    add_fan_step({ab, b, c, dc}, size_mm, bounds, fan);
    return;
  }
  fan.push_back({make_cell({a, b, c}, bounds), bounds});
  fan.push_back({make_cell({a, c, d}, bounds), bounds});
}

/// The columns between the two sides of a sharp edge, in steps of at most kFanStep. Outside a convex edge
/// they answer for what stands there, inside a concave one for what is cut.
void add_fan(const stock::FacetSheets& sheets, const stock::SharpEdge& edge, double size_mm,
             std::vector<RootCell>& cells) {
  const Vec3 &from = sheets.points[edge.left[0]], &to = sheets.points[edge.left[1]];
  const auto normals = [&](int end) {
    return std::pair(sheets.normals[edge.left[end]], sheets.normals[edge.right[end]]);
  };
  const auto [n0, m0] = normals(0);
  const auto [n1, m1] = normals(1);
  const bool convex = (to - from).dot(n0.cross(m0)) > 0.0;
  const double angle = std::max(angle_between(n0, m0), angle_between(n1, m1));
  const int steps = std::max(1, static_cast<int>(std::ceil(angle / kFanStep)));
  std::vector<RootCell> fan;
  PatchBounds bounds;
  bounds.edge_chord_mm = edge.chord_mm;
  for (int i = 0; i < steps; ++i) {
    const double low = static_cast<double>(i) / steps, high = static_cast<double>(i + 1) / steps;
    const CellCorner a{from, turned_by(n0, m0, low)}, b{to, turned_by(n1, m1, low)},
        c{to, turned_by(n1, m1, high)}, d{from, turned_by(n0, m0, high)};
    add_fan_step({a, b, c, d}, size_mm, bounds, fan);
  }
  for (RootCell& cell : fan) {
    (convex ? cell.looks_down : cell.looks_up) = false;
    cells.push_back(cell);
  }
}

/// Where sharp edges of a mesh meet: the directions of the edges, and the facets' normals beside them.
struct SharpVertex {
  std::vector<Vec3> edges, normals;
};

struct ByCoordinates {
  bool operator()(const Vec3& a, const Vec3& b) const {
    return std::tuple(a.x(), a.y(), a.z()) < std::tuple(b.x(), b.y(), b.z());
  }
};

/// The directions that point away from all edges: their extreme ones, in order around the mean. Fewer than
/// three: no direction is nearest to the vertex itself.
std::vector<Vec3> away_from(const std::vector<Vec3>& edges) {
  constexpr double kSame = 1e-6;  // rad; vertices are floats
  std::vector<Vec3> rays;
  for (size_t i = 0; i < edges.size(); ++i) {
    for (size_t j = 0; j < i; ++j) {
      for (const double side : {1.0, -1.0}) {
        const Vec3 ray = (side * edges[i].cross(edges[j])).normalized();
        const auto is_away = [&](const Vec3& edge) { return ray.dot(edge) <= kSame; };
        const auto is_same = [&](const Vec3& other) { return (other - ray).norm() < kSame; };
        if (ray.norm() > 0.5 && std::all_of(edges.begin(), edges.end(), is_away) &&
            std::none_of(rays.begin(), rays.end(), is_same))
          rays.push_back(ray);
      }
    }
  }
  if (rays.size() < 3) return {};
  Vec3 mean = Vec3::Zero();
  for (const Vec3& ray : rays) mean += ray;
  const Vec3 x = (rays[0] - rays[0].dot(mean) / mean.squaredNorm() * mean).normalized();
  const Vec3 y = mean.normalized().cross(x);
  std::sort(rays.begin(), rays.end(), [&](const Vec3& a, const Vec3& b) {
    return std::atan2(a.dot(y), a.dot(x)) < std::atan2(b.dot(y), b.dot(x));
  });
  return rays;
}

/// Columns of one vertex between three directions, divided until they turn by no more than kFanStep.
void add_spread(const Vec3& vertex, const std::array<Vec3, 3>& normals, std::vector<RootCell>& fan) {
  size_t widest = 0;
  double most = 0.0;
  for (size_t k = 0; k < 3; ++k) {
    const double angle = (normals[k] - normals[(k + 1) % 3]).norm();
    if (angle > most) {
      most = angle;
      widest = k;
    }
  }
  if (most <= kFanStep) {
    const PatchBounds flat;
    fan.push_back(
        {make_cell({CellCorner{vertex, normals[0]}, {vertex, normals[1]}, {vertex, normals[2]}}, flat),
         flat});
    return;
  }
  const Vec3 &a = normals[widest], &b = normals[(widest + 1) % 3], &c = normals[(widest + 2) % 3];
  const Vec3 m = (a + b).normalized();
  add_spread(vertex, {a, m, c}, fan);
  add_spread(vertex, {m, b, c}, fan);
}

/// Outside a corner where sharp edges meet the columns answer for what stands there, inside one for what is
/// cut. Corners that are neither (a saddle) have no columns of their own.
void add_vertex_fan(const Vec3& vertex, const SharpVertex& sharp, std::vector<RootCell>& cells) {
  const std::vector<Vec3> rays = away_from(sharp.edges);
  if (rays.empty()) return;
  Vec3 mean = Vec3::Zero();
  for (const Vec3& ray : rays) mean += ray;
  const auto faces_it = [&](const Vec3& normal) { return mean.dot(normal) > 0.0; };
  const bool outside = std::all_of(sharp.normals.begin(), sharp.normals.end(), faces_it);
  // Where walls within the part meet its surface, nothing tells the outside.
  if (!outside && std::any_of(sharp.normals.begin(), sharp.normals.end(), faces_it)) return;
  std::vector<RootCell> fan;
  for (size_t i = 0; i < rays.size(); ++i)
    add_spread(vertex, {mean.normalized(), rays[i], rays[(i + 1) % rays.size()]}, fan);
  for (RootCell& cell : fan) {
    (outside ? cell.looks_down : cell.looks_up) = false;
    cells.push_back(cell);
  }
}

void add_vertex_fans(const stock::FacetSheets& sheets, std::vector<RootCell>& cells) {
  std::map<Vec3, SharpVertex, ByCoordinates> vertices;
  for (const stock::SharpEdge& edge : sheets.sharp_edges) {
    for (const int end : {0, 1}) {
      SharpVertex& vertex = vertices[sheets.points[edge.left[end]]];
      const Vec3 way = sheets.points[edge.left[1 - end]] - sheets.points[edge.left[end]];
      vertex.edges.push_back(way.normalized());
      vertex.normals.push_back(sheets.normals[edge.left[end]]);
      vertex.normals.push_back(sheets.normals[edge.right[end]]);
    }
  }
  for (const auto& [place, vertex] : vertices) add_vertex_fan(place, vertex, cells);
}

}  // namespace

double DesignCell::radius() const {
  const Vec3 c = centroid();
  double r2 = 0.0;
  for (const CellCorner& corner : corners) r2 = std::max(r2, (corner.point - c).squaredNorm());
  return std::sqrt(r2);
}

double DesignCell::longest_edge() const {
  double l2 = 0.0;
  for (size_t k = 0; k < 3; ++k)
    l2 = std::max(l2, (corners[k].point - corners[(k + 1) % 3].point).squaredNorm());
  return std::sqrt(l2);
}

double DesignCell::area_mm2() const {
  return 0.5 * (corners[1].point - corners[0].point).cross(corners[2].point - corners[0].point).norm();
}

CellCorner DesignCell::side(size_t k) const {
  const CellCorner &a = corners[k], &b = corners[(k + 1) % 3];
  return {0.5 * (a.point + b.point) - 0.25 * bends[k], 0.5 * (a.normal + b.normal)};
}

double most_over_pairs(double q01, double q12, double q20) {
  const double &a = q01, &b = q12, &c = q20;
  const double longest = std::max({a, b, c});
  // On an edge, or where the gradient is the same toward all corners.
  if (2.0 * longest >= a + b + c) return 0.25 * longest;
  return a * b * c / (2.0 * (a * b + b * c + c * a) - a * a - b * b - c * c);
}

DesignCell make_cell(const std::array<CellCorner, 3>& corners, const PatchBounds& bounds,
                     const CellEdges& edges) {
  DesignCell cell{corners};
  std::array<double, 3> bend{}, stray{}, lean{};
  for (size_t k = 0; k < 3; ++k) {
    const CellCorner &a = corners[k], &b = corners[(k + 1) % 3];
    lean[k] = (a.normal - b.normal).squaredNorm();
    if (bounds.surface == nullptr) continue;
    const Vec2 d = b.uv - a.uv;
    const double du = std::abs(d.x()), dv = std::abs(d.y());
    const surface::BendBounds& m = bounds.bends;
    cell.bends[k] = d.x() * d.x() * m.uu.mean + 2.0 * d.x() * d.y() * m.uv.mean + d.y() * d.y() * m.vv.mean;
    bend[k] = cell.bends[k].norm();
    stray[k] = (m.uu.stray + m.uv.stray) * du * du + (m.uv.stray + m.vv.stray) * dv * dv;
    const double turn = (du > 0.0 ? bounds.turn_u * du : 0.0) + (dv > 0.0 ? bounds.turn_v * dv : 0.0);
    cell.turn = std::max(cell.turn, turn);
  }
  if (bounds.surface != nullptr) {
    cell.stray_mm = 0.5 * most_over_pairs(stray[0], stray[1], stray[2]);
    cell.flatness_mm = cell.stray_mm + 0.5 * most_over_pairs(bend[0], bend[1], bend[2]);
    Strip widest;
    for (size_t k = 0; k < 3; ++k) {
      if (!edges[k].is_divided()) continue;
      const Strip strip = strip_beside(corners[k].uv, corners[(k + 1) % 3].uv, edges[k], bounds);
      widest = {std::max(widest.mm, strip.mm), std::max(widest.turn, strip.turn)};
    }
    widen(cell, widest);
  } else {
    // |sum l_k n_k|^2 = 1 - sum over pairs l_j l_k |n_j - n_k|^2.
    cell.turn = 1.0 - std::sqrt(std::max(0.0, 1.0 - most_over_pairs(lean[0], lean[1], lean[2])));
    widen(cell, {bounds.edge_chord_mm, 0.0});
  }
  return cell;
}

CellCorner middle(const CellCorner& a, const CellCorner& b, const PatchBounds& bounds,
                  const EdgePiece& edge) {
  const Vec2 uv = edge.is_divided() ? (*edge.places)[(edge.from + edge.to) / 2] : Vec2(0.5 * (a.uv + b.uv));
  if (bounds.surface != nullptr) return corner_on(*bounds.surface, uv.x(), uv.y());
  return {0.5 * (a.point + b.point), (a.normal + b.normal).normalized(), uv};
}

CellCorner place_in(const DesignCell& cell, const Vec3& l, const PatchBounds& bounds) {
  CellCorner place{Vec3::Zero(), Vec3::Zero()};
  for (size_t k = 0; k < 3; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    place.point += l[row] * cell.corners[k].point;
    place.normal += l[row] * cell.corners[k].normal;
    place.uv += l[row] * cell.corners[k].uv;
  }
  if (bounds.surface != nullptr) return corner_on(*bounds.surface, place.uv.x(), place.uv.y());
  place.normal.normalize();
  return place;
}

std::vector<RootCell> root_cells(const stock::RayField& field, double size_mm) {
  std::vector<RootCell> cells;
  if (field.surface != nullptr) {
    add_surface(field.surface, size_mm, cells);
    return cells;
  }
  const stock::FacetSheets& sheets = *field.sheets;
  for (uint32_t f = 0; f < sheets.facets.size(); ++f) {
    const auto corner = [&](size_t k) { return CellCorner{sheets.corner(f, k), sheets.normal_at(f, k)}; };
    if (sheets.is_curved(f))
      add_part(sheets, f, size_mm, cells);
    else
      add_divided({corner(0), corner(1), corner(2)}, size_mm, cells);
  }
  for (const stock::SharpEdge& e : sheets.sharp_edges) add_fan(sheets, e, size_mm, cells);
  add_vertex_fans(sheets, cells);
  return cells;
}

namespace {

/// Into how many a flat triangle of these squared sides is divided until none is longer: its longest side is
/// halved again and again. The median to a side a has the square (2 b^2 + 2 c^2 - a^2) / 4.
double halved_until(std::array<double, 3> sides2, double most2) {
  std::sort(sides2.begin(), sides2.end());
  const auto [c2, b2, a2] = sides2;
  if (a2 <= most2) return 1.0;
  const double median2 = 0.25 * (2.0 * b2 + 2.0 * c2 - a2);
  return halved_until({0.25 * a2, b2, median2}, most2) + halved_until({0.25 * a2, c2, median2}, most2);
}

/// Of the columns beside a sharp edge.
double expected_fan(const stock::FacetSheets& sheets, const stock::SharpEdge& edge, double size_mm) {
  const double length = (sheets.points[edge.left[1]] - sheets.points[edge.left[0]]).norm();
  const double angle = angle_between(sheets.normals[edge.left[0]], sheets.normals[edge.right[0]]);
  const double halvings = std::max(0.0, std::ceil(std::log2(length / size_mm)));
  return 2.0 * std::max(1.0, std::ceil(angle / kFanStep)) * std::exp2(halvings);
}

}  // namespace

double expected_roots(const stock::RayField& field, double size_mm) {
  if (field.surface != nullptr) {
    double area = 0.0;
    for (const double part : field.areas_mm2) area += part;
    return 2.0 * area / (size_mm * size_mm);
  }
  const stock::FacetSheets& sheets = *field.sheets;
  double roots = 0.0;
  for (uint32_t f = 0; f < sheets.facets.size(); ++f) {
    const auto side = [&](size_t k) {
      return (sheets.corner(f, k) - sheets.corner(f, (k + 1) % 3)).squaredNorm();
    };
    roots += halved_until({side(0), side(1), side(2)}, size_mm * size_mm);
  }
  for (const stock::SharpEdge& edge : sheets.sharp_edges) roots += expected_fan(sheets, edge, size_mm);
  return roots;
}

}  // namespace swarf::measure
