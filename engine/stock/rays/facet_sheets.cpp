#include "stock/rays/facet_sheets.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "base/angles.h"
#include "base/check.h"
#include "base/disjoint_sets.h"
#include "mesh/mesh_check.h"
#include "mesh/mesh_distance.h"

namespace swarf::stock {
namespace {

using Triangle = std::array<uint32_t, 3>;

/// A triangle's side from its lower to its higher vertex.
struct Side {
  uint32_t low, high, corner;  ///< corner = 3 * triangle + place of its first vertex
  bool operator<(const Side& other) const {
    return std::tie(low, high, corner) < std::tie(other.low, other.high, other.corner);
  }
};

std::vector<Side> sides_of(const std::vector<Triangle>& triangles) {
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (uint32_t c = 0; c < 3 * triangles.size(); ++c) {
    const Triangle& t = triangles[c / 3];
    const uint32_t a = t[c % 3], b = t[(c + 1) % 3];
    sides.push_back({std::min(a, b), std::max(a, b), c});
  }
  std::sort(sides.begin(), sides.end());
  return sides;
}

uint32_t next_corner(uint32_t corner) {
  return corner % 3 == 2 ? corner - 2 : corner + 1;
}

/// Facets with their unit normals; those without area are left out.
struct Facets {
  std::vector<Triangle> triangles;
  std::vector<Vec3> normals;
  std::vector<std::array<Vec3, 3>> at_corners;  ///< of the surfaces under them; empty: facets alone
  std::vector<uint32_t> sources;                ///< triangles of the mesh
  double least_cosine = 0.0;                    ///< between smooth neighbours

  const Vec3& normal_at(uint32_t corner) const {
    return at_corners.empty() ? normals[corner / 3] : at_corners[corner / 3][corner % 3];
  }
};

Facets facets_with_area(const mesh::WeldedMesh& welded, double crease_rad) {
  Facets facets;
  facets.least_cosine = std::cos(crease_rad);
  const std::vector<Vec3>& points = welded.points;
  for (size_t i = 0; i < welded.triangles.size(); ++i) {
    const Triangle& t = welded.triangles[i];
    const Vec3 cross = (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]);
    const double length = cross.norm();
    if (!(length > 0.0)) continue;
    facets.triangles.push_back(t);
    facets.normals.emplace_back(cross / length);
    facets.sources.push_back(welded.sources[i]);
  }
  return facets;
}

/// The outward normal of the surface under a corner; the facet's where there is none.
Vec3 normal_under(const surface::UnderFacets& under, uint32_t triangle, size_t corner, const Vec3& facet) {
  const surface::FacetOnSurface& on = under.facets[triangle];
  if (on.surface == surface::FacetOnSurface::kNone) return facet;
  const surface::Surface& surface = *under.surfaces[static_cast<size_t>(on.surface)];
  // All of a plane has one normal, to the last bit.
  const Vec2& uv = on.uv[under.is_curved(triangle) ? corner : 0];
  const Vec3 normal = surface::outward_normal(surface, surface.derivatives(uv.x(), uv.y()), uv);
  return normal.squaredNorm() > 0.5 ? normal : facet;
}

void take_normals_under(const surface::UnderFacets& under, Facets& facets) {
  facets.least_cosine = std::cos(kSameTangent);
  for (size_t f = 0; f < facets.triangles.size(); ++f) {
    std::array<Vec3, 3> normals;
    for (size_t k = 0; k < 3; ++k) normals[k] = normal_under(under, facets.sources[f], k, facets.normals[f]);
    facets.at_corners.push_back(normals);
  }
}

/// Whether two facets go on smoothly across the side that begins at these corners of theirs: what they turn
/// by there, at both of its ends.
bool is_smooth(const Facets& facets, uint32_t a, uint32_t b) {
  const bool same = facets.triangles[a / 3][a % 3] == facets.triangles[b / 3][b % 3];
  const uint32_t at_a = same ? b : next_corner(b), at_end = same ? next_corner(b) : b;
  return facets.normal_at(a).dot(facets.normal_at(at_a)) >= facets.least_cosine &&
         facets.normal_at(next_corner(a)).dot(facets.normal_at(at_end)) >= facets.least_cosine;
}

/// Joins the corners on both sides of every smooth edge. An edge of other than two facets is sharp.
DisjointSets smooth_corners(const Facets& facets) {
  DisjointSets sets(3 * facets.triangles.size());
  const std::vector<Side> sides = sides_of(facets.triangles);
  for (size_t i = 0; i < sides.size();) {
    size_t end = i + 1;
    while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high) ++end;
    const uint32_t a = sides[i].corner, b = sides[end - 1].corner;
    if (end - i == 2 && is_smooth(facets, a, b)) {
      const bool same = facets.triangles[a / 3][a % 3] == facets.triangles[b / 3][b % 3];
      sets.join(a, same ? b : next_corner(b));
      sets.join(next_corner(a), same ? next_corner(b) : b);
    }
    i = end;
  }
  return sets;
}

double corner_angle(const Triangle& t, size_t place, const std::vector<Vec3>& points) {
  const Vec3& apex = points[t[place]];
  const Vec3 a = points[t[(place + 1) % 3]] - apex, b = points[t[(place + 2) % 3]] - apex;
  return angle_between(a, b);
}

/// One corner per set, its normal the mean of their facets weighted by the angles there.
void place_corners(const Facets& facets, const std::vector<Vec3>& points, FacetSheets& sheets) {
  DisjointSets sets = smooth_corners(facets);
  std::vector<uint32_t> number(3 * facets.triangles.size());
  sheets.facets.resize(facets.triangles.size());
  for (uint32_t c = 0; c < number.size(); ++c) {
    const Triangle& t = facets.triangles[c / 3];
    if (sets.root(c) == c) {
      number[c] = static_cast<uint32_t>(sheets.points.size());
      sheets.points.push_back(points[t[c % 3]]);
      sheets.normals.emplace_back(Vec3::Zero());
    }
    const uint32_t corner = number[c] = number[sets.root(c)];
    sheets.normals[corner] += corner_angle(t, c % 3, points) * facets.normal_at(c);
    sheets.facets[c / 3][c % 3] = corner;
  }
  for (Vec3& normal : sheets.normals) normal.normalize();
}

/// Two facets that follow each other in the list of sides: an edge that is sharp between them, or smooth.
void join_sides(const Facets& facets, FacetSheets& sheets) {
  const std::vector<Side> sides = sides_of(facets.triangles);
  const auto corner = [&](uint32_t c) { return sheets.facets[c / 3][c % 3]; };
  const auto same_edge = [&](size_t i, size_t j) {
    return j < sides.size() && sides[i].low == sides[j].low && sides[i].high == sides[j].high;
  };
  sheets.neighbours.assign(facets.triangles.size(),
                           {FacetSheets::kNone, FacetSheets::kNone, FacetSheets::kNone});
  for (size_t i = 0; i + 1 < sides.size(); ++i) {
    if (!same_edge(i, i + 1)) continue;
    const uint32_t a = sides[i].corner, b = sides[i + 1].corner;
    const bool two = !same_edge(i, i + 2) && (i == 0 || !same_edge(i, i - 1));
    if (is_smooth(facets, a, b)) {
      if (!two) continue;
      sheets.neighbours[a / 3][a % 3] = b / 3;
      sheets.neighbours[b / 3][b % 3] = a / 3;
      continue;
    }
    const bool same = facets.triangles[a / 3][a % 3] == facets.triangles[b / 3][b % 3];
    const auto chord = [&](uint32_t c) { return sheets.on_surface(c / 3).chords_mm[c % 3]; };
    const bool curved = sheets.is_curved(a / 3) && sheets.is_curved(b / 3);
    sheets.sharp_edges.push_back({{corner(a), corner(next_corner(a))},
                                  {corner(same ? b : next_corner(b)), corner(same ? next_corner(b) : b)},
                                  curved ? std::max(chord(a), chord(b)) : 0.0});
  }
}

void number_sheets(FacetSheets& sheets) {
  DisjointSets sets(sheets.facets.size());
  for (uint32_t f = 0; f < sheets.facets.size(); ++f) {
    for (const uint32_t next : sheets.neighbours[f]) {
      if (next != FacetSheets::kNone) sets.join(f, next);
    }
  }
  for (uint32_t f = 0; f < sheets.facets.size(); ++f) sheets.sheet.push_back(sets.root(f));
}

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double t = std::clamp((p - a).dot(ab) / std::max(ab.squaredNorm(), 1e-300), 0.0, 1.0);
  return (p - a - t * ab).norm();
}

/// Barycentric coordinates of a point in the plane of the facet (a, b, c).
Vec3 barycentric_of(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 across = (b - a).cross(c - a);
  const double wb = (p - a).cross(c - a).dot(across), wc = (b - a).cross(p - a).dot(across);
  return Vec3(across.squaredNorm() - wb - wc, wb, wc) / across.squaredNorm();
}

}  // namespace

FacetPlace FacetSheets::place(uint32_t facet, const Vec3& l) const {
  if (is_curved(facet)) {
    const std::array<Vec2, 3>& uv = on_surface(facet).uv;
    return place_at(facet, l.x() * uv[0] + l.y() * uv[1] + l.z() * uv[2]);
  }
  const auto& t = facets[facet];
  const Vec3 normal = l.x() * normal_at(facet, 0) + l.y() * normal_at(facet, 1) + l.z() * normal_at(facet, 2);
  // In differences: where the facet lies in a plane z = c, so does the place, to the last digit.
  const Vec3 &a = points[t[0]], &b = points[t[1]], &c = points[t[2]];
  const Vec3 low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
  const Vec3 point = a + l.y() * (b - a) + l.z() * (c - a);
  return {point.cwiseMax(low).cwiseMin(high), normal.normalized(), facet};
}

FacetPlace FacetSheets::place_at(uint32_t facet, const Vec2& uv) const {
  const Vec2 at = uv.cwiseMax(Vec2::Zero()).cwiseMin(Vec2::Ones());
  const surface::Surface& surface = *surface_of(facet);
  const surface::Derivatives d = surface.derivatives(at.x(), at.y());
  return {d.S, surface::outward_normal(surface, d, at), facet};
}

const surface::EdgePlaces* FacetSheets::edge_of(uint32_t facet, size_t side) const {
  if (under == nullptr) return nullptr;
  const int edge = on_surface(facet).edges[side];
  return edge == surface::FacetOnSurface::kNone ? nullptr : &under->edges[static_cast<size_t>(edge)];
}

bool FacetSheets::side_near(uint32_t facet, size_t side, const Vec3& centre, double radius_mm) const {
  return distance_to_segment(centre, corner(facet, side), corner(facet, (side + 1) % 3)) <= radius_mm;
}

std::optional<FacetPlace> FacetSheets::meet(uint32_t facet, const Vec3& centre, double radius_mm,
                                            const Vec3& point, const Vec3& along) const {
  constexpr double kOnEdge = 1e-9;  // share of the facet: a line through an edge meets one of its sides
  std::optional<FacetPlace> met;
  each_near(facet, centre, radius_mm, [&](uint32_t f) {
    const Vec3 &a = corner(f, 0), ab = corner(f, 1) - a, ac = corner(f, 2) - a;
    const Vec3 h = along.cross(ac);
    const double det = ab.dot(h);
    if (!(std::abs(det) > std::numeric_limits<double>::min())) return false;
    const Vec3 offset = point - a;
    const double wb = offset.dot(h) / det, wc = along.dot(offset.cross(ab)) / det;
    if (!(wb >= -kOnEdge && wc >= -kOnEdge && wb + wc <= 1.0 + kOnEdge)) return false;
    met = place(f, {1.0 - wb - wc, wb, wc});
    return true;
  });
  return met;
}

FacetPlace FacetSheets::nearest(uint32_t facet, const Vec3& centre, double radius_mm,
                                const Vec3& point) const {
  double least = std::numeric_limits<double>::infinity();
  Vec3 best = Vec3::Zero();
  uint32_t on = facet;
  each_near(facet, centre, radius_mm, [&](uint32_t f) {
    const Vec3 near = mesh::closest_point_on_triangle(point, corner(f, 0), corner(f, 1), corner(f, 2));
    const double distance2 = (near - point).squaredNorm();
    if (distance2 >= least) return false;
    least = distance2;
    best = near;
    on = f;
    return false;
  });
  return place(on, barycentric_of(best, corner(on, 0), corner(on, 1), corner(on, 2)));
}

FacetSheets facet_sheets(const TriMesh& mesh, double crease_rad, surface::UnderFacetsPtr under) {
  const mesh::WeldedMesh welded = mesh::weld(mesh);
  Facets facets = facets_with_area(welded, crease_rad);
  SWARF_CHECK(!facets.triangles.empty(), "a design mesh needs facets with area");
  FacetSheets sheets;
  sheets.sources = facets.sources;
  if (under != nullptr) {
    SWARF_CHECK(under->facets.size() == mesh.triangles.size(), "a place on a surface for every facet");
    take_normals_under(*under, facets);
    sheets.under = std::move(under);
    sheets.normals_under = facets.at_corners;
  }
  place_corners(facets, welded.points, sheets);
  join_sides(facets, sheets);
  number_sheets(sheets);
  return sheets;
}

}  // namespace swarf::stock
