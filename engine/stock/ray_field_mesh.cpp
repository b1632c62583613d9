#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_map>

#include "base/check.h"
#include "mesh/mesh_check.h"
#include "stock/dexel_kernel.h"
#include "stock/ray_field.h"

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

/// Corners that share a ray, as a forest whose roots are the least corners.
class CornerSets {
 public:
  explicit CornerSets(size_t corners) : parent_(corners) { std::iota(parent_.begin(), parent_.end(), 0U); }
  uint32_t root(uint32_t c) {
    while (parent_[c] != c) c = parent_[c] = parent_[parent_[c]];
    return c;
  }
  void join(uint32_t a, uint32_t b) {
    const uint32_t ra = root(a), rb = root(b);
    parent_[std::max(ra, rb)] = std::min(ra, rb);
  }

 private:
  std::vector<uint32_t> parent_;
};

/// Facets with their unit normals; those without area are left out.
struct Facets {
  std::vector<Triangle> triangles;
  std::vector<Vec3> normals;
};

Facets facets_with_area(const std::vector<Triangle>& triangles, const std::vector<Vec3>& points) {
  Facets facets;
  for (const Triangle& t : triangles) {
    const Vec3 cross = (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]);
    const double length = cross.norm();
    if (!(length > 0.0)) continue;
    facets.triangles.push_back(t);
    facets.normals.emplace_back(cross / length);
  }
  return facets;
}

/// Joins the corners on both sides of every smooth edge. An edge of other than two facets is sharp.
CornerSets smooth_corners(const Facets& facets, double crease_rad) {
  CornerSets sets(3 * facets.triangles.size());
  const std::vector<Side> sides = sides_of(facets.triangles);
  const double least_cosine = std::cos(crease_rad);
  for (size_t i = 0; i < sides.size();) {
    size_t end = i + 1;
    while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high) ++end;
    const uint32_t a = sides[i].corner, b = sides[end - 1].corner;
    if (end - i == 2 && facets.normals[a / 3].dot(facets.normals[b / 3]) >= least_cosine) {
      const bool same = facets.triangles[a / 3][a % 3] == facets.triangles[b / 3][b % 3];
      sets.join(a, same ? b : next_corner(b));
      sets.join(next_corner(a), same ? next_corner(b) : b);
    }
    i = end;
  }
  return sets;
}

/// The edges between two facets whose corners did not join.
std::vector<SharpEdge> sharp_edges(const Facets& facets, double crease_rad, const RayField& field) {
  std::vector<SharpEdge> edges;
  const std::vector<Side> sides = sides_of(facets.triangles);
  const double least_cosine = std::cos(crease_rad);
  const auto ray = [&](uint32_t corner) { return field.triangles[corner / 3][corner % 3]; };
  for (size_t i = 0; i + 1 < sides.size(); ++i) {
    const uint32_t a = sides[i].corner, b = sides[i + 1].corner;
    if (sides[i].low != sides[i + 1].low || sides[i].high != sides[i + 1].high) continue;
    if (facets.normals[a / 3].dot(facets.normals[b / 3]) >= least_cosine) continue;
    const bool same = facets.triangles[a / 3][a % 3] == facets.triangles[b / 3][b % 3];
    edges.push_back(
        {{ray(a), ray(next_corner(a))}, {ray(same ? b : next_corner(b)), ray(same ? next_corner(b) : b)}});
  }
  return edges;
}

double corner_angle(const Triangle& t, size_t place, const std::vector<Vec3>& points) {
  const Vec3& apex = points[t[place]];
  const Vec3 a = points[t[(place + 1) % 3]] - apex, b = points[t[(place + 2) % 3]] - apex;
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// One ray per set of corners, its normal the mean of their facets weighted by the corners' angles.
void place_rays(const Facets& facets, const std::vector<Vec3>& points, double crease_rad, RayField& field) {
  CornerSets sets = smooth_corners(facets, crease_rad);
  std::vector<uint32_t> ray_of(3 * facets.triangles.size());
  field.triangles.resize(facets.triangles.size());
  for (uint32_t c = 0; c < ray_of.size(); ++c) {
    const Triangle& t = facets.triangles[c / 3];
    if (sets.root(c) == c) {
      ray_of[c] = static_cast<uint32_t>(field.points.size());
      field.points.push_back(points[t[c % 3]]);
      field.normals.emplace_back(Vec3::Zero());
    }
    const uint32_t ray = ray_of[c] = ray_of[sets.root(c)];
    field.normals[ray] += corner_angle(t, c % 3, points) * facets.normals[c / 3];
    field.triangles[c / 3][c % 3] = ray;
  }
  for (Vec3& normal : field.normals) normal.normalize();
}

/// Halves every edge that is longer than the pitch; true when there was one. Both triangles of an edge find
/// the same middle, so the division has no gaps.
bool divide_long_edges(RayField& field) {
  std::unordered_map<uint64_t, uint32_t> middles;  // looked up only: its order never shows
  const double longest2 = field.pitch_mm * field.pitch_mm;
  const auto middle = [&](uint32_t a, uint32_t b) {
    const uint64_t key = uint64_t{std::min(a, b)} << 32U | std::max(a, b);
    const auto [found, is_new] = middles.try_emplace(key, static_cast<uint32_t>(field.points.size()));
    if (is_new) {
      field.points.emplace_back(0.5 * (field.points[a] + field.points[b]));
      field.normals.emplace_back((field.normals[a] + field.normals[b]).normalized());
    }
    return found->second;
  };
  std::vector<Triangle> divided;
  divided.reserve(2 * field.triangles.size());
  for (Triangle t : field.triangles) {
    const auto is_long = [&](int i) {
      return (field.points[t[i]] - field.points[t[(i + 1) % 3]]).squaredNorm() > longest2;
    };
    const int marks = int{is_long(0)} + int{is_long(1)} + int{is_long(2)};
    if (marks == 0) {
      divided.push_back(t);
      continue;
    }
    // Turn the triangle so that side 0 is long, and with two long sides the short one comes last.
    while (!is_long(0) || (marks == 2 && is_long(2))) t = {t[1], t[2], t[0]};
    const uint32_t m0 = middle(t[0], t[1]);
    if (marks == 1) {
      divided.insert(divided.end(), {{t[0], m0, t[2]}, {m0, t[1], t[2]}});
      continue;
    }
    const uint32_t m1 = middle(t[1], t[2]);
    divided.push_back({m0, t[1], m1});
    if (marks == 2) {
      divided.insert(divided.end(), {{t[0], m0, m1}, {t[0], m1, t[2]}});
    } else {
      const uint32_t m2 = middle(t[2], t[0]);
      divided.insert(divided.end(), {{t[0], m0, m2}, {m0, m1, m2}, {m2, m1, t[2]}});
    }
  }
  field.triangles = std::move(divided);
  return !middles.empty();
}

void connect_rays(RayField& field) {
  for (const Side& side : sides_of(field.triangles)) {
    if (field.edges.empty() || field.edges.back() != std::array{side.low, side.high}) {
      field.edges.push_back({side.low, side.high});
    }
  }
  field.areas_mm2.assign(field.size(), 0.0);
  field.star_begin.assign(field.size() + 1, 0);
  for (const Triangle& t : field.triangles) {
    const Vec3& a = field.points[t[0]];
    const double area = 0.5 * (field.points[t[1]] - a).cross(field.points[t[2]] - a).norm();
    for (const uint32_t ray : t) {
      field.areas_mm2[ray] += area / 3.0;
      ++field.star_begin[ray + 1];
    }
  }
  std::partial_sum(field.star_begin.begin(), field.star_begin.end(), field.star_begin.begin());
  field.star.resize(3 * field.triangles.size());
  std::vector<uint32_t> next(field.star_begin.begin(), field.star_begin.end() - 1);
  for (uint32_t c = 0; c < field.star.size(); ++c) field.star[next[field.triangles[c / 3][c % 3]]++] = c / 3;
}

/// Halves order[begin, end) at the median of its widest extent in place and direction until a tile holds it.
void group_rays(RayField& field, uint32_t begin, uint32_t end, std::vector<uint32_t>& sorted) {
  if (end - begin <= kTileRays) {
    const auto first = static_cast<uint32_t>(field.order.size());
    field.order.insert(field.order.end(), sorted.begin() + begin, sorted.begin() + end);
    add_tile(field, first);
    return;
  }
  // A turn of the normal by one radian is as bad for a tile as this many pitches of width.
  const double weight = 16.0 * field.pitch_mm;
  const auto value = [&](uint32_t ray, int axis) {
    return axis < 3 ? field.points[ray][axis] : weight * field.normals[ray][axis - 3];
  };
  int widest = 0;
  double width = -1.0;
  for (int axis = 0; axis < 6; ++axis) {
    double low = value(sorted[begin], axis), high = low;
    for (uint32_t i = begin; i < end; ++i) {
      low = std::min(low, value(sorted[i], axis));
      high = std::max(high, value(sorted[i], axis));
    }
    if (high - low > width) {
      width = high - low;
      widest = axis;
    }
  }
  const uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(sorted.begin() + begin, sorted.begin() + middle, sorted.begin() + end,
                   [&](uint32_t a, uint32_t b) {
                     return std::pair(value(a, widest), a) < std::pair(value(b, widest), b);
                   });
  group_rays(field, begin, middle, sorted);
  group_rays(field, middle, end, sorted);
}

}  // namespace

RayFieldPtr rays_on_mesh(const TriMesh& mesh, double pitch_mm, double crease_rad) {
  SWARF_CHECK(pitch_mm > 0.0, "rays need a pitch");
  const mesh::WeldedMesh welded = mesh::weld(mesh);
  const Facets facets = facets_with_area(welded.triangles, welded.points);
  SWARF_CHECK(!facets.triangles.empty(), "a design mesh needs facets with area");
  auto field = std::make_shared<RayField>();
  field->pitch_mm = pitch_mm;
  field->design = std::make_shared<DesignMesh>(mesh);
  place_rays(facets, welded.points, crease_rad, *field);
  field->facets = field->triangles;
  field->sharp_edges = sharp_edges(facets, crease_rad, *field);
  while (divide_long_edges(*field)) {
  }
  connect_rays(*field);
  std::vector<uint32_t> sorted(field->size());
  std::iota(sorted.begin(), sorted.end(), 0U);
  group_rays(*field, 0, static_cast<uint32_t>(sorted.size()), sorted);
  return field;
}

double RayField::own_depth(const Vec3& point, const Vec3& normal, double depth_mm, double share) const {
  if (design == nullptr || depth_mm <= 0.0) return depth_mm;
  // Interpolated normals lean up to the crease's angle from the facets: the distance then is that much
  // shorter.
  constexpr double kLean = 0.85;       // cos(30 deg), and a little for rounding
  constexpr double kFloatMesh = 2e-5;  // mm: vertices are floats
  constexpr int kHalvings = 40;
  // On a flat face the column follows the facet's own normal, and the distance is the depth.
  constexpr double kFlat = 1.0 - 1e-4;
  const auto& facet = design->mesh.triangles[design->distance.nearest(point).triangle];
  const auto vertex = [&](size_t k) {
    const auto& p = design->mesh.positions[facet[k]];
    return Vec3(p[0], p[1], p[2]);
  };
  const Vec3 across = (vertex(1) - vertex(0)).cross(vertex(2) - vertex(0));
  const bool flat = std::abs(across.dot(normal)) >= (1.0 - 1e-9) * across.norm();
  const double least = flat ? kFlat : kLean;
  const auto is_own = [&](double s) {
    return design->distance.nearest(point - s * normal).distance_mm >= least * s - kFloatMesh;
  };
  // Far beyond the part the distance is nearly the depth again: what is not own on the way ends it.
  constexpr double kThinnest = 0.1;  // mm
  double low = 0.0, high = std::numeric_limits<double>::infinity();
  for (double s = depth_mm;; s *= 0.5) {
    if (!is_own(s)) high = s;
    if (s <= kThinnest) break;
  }
  if (high > depth_mm) return depth_mm;
  for (int i = 0; i < kHalvings && high - low > std::max(1e-9, share * high); ++i) {
    const double middle = 0.5 * (low + high);
    (is_own(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace swarf::stock
