#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_map>

#include "base/check.h"
#include "base/parallel.h"
#include "stock/rays/dexel_kernel.h"
#include "stock/rays/ray_field.h"

namespace swarf::stock {
namespace {

// Of the pitch, see rays_on_mesh: how near two rays may stand, how far apart places are offered.
constexpr double kRaysApart = 0.8, kFill = 1.0 / 3.0;
/// A ray on the border of a sheet answers for no depth: inside the sheet rays stand as near to it as this.
constexpr double kInside = 0.3;
/// Walls are this much denser than rays, along each of two directions.
constexpr double kWallShare = 0.5;
constexpr size_t kRaysPerTask = 1024;

/// Rays by the cube they stand in, whose side is twice the reach: eight cubes hold all within it.
class RaysByPlace {
 public:
  RaysByPlace(const RayField& field, double reach_mm) : field_(field), side_(2.0 * reach_mm) {}

  void add(uint32_t ray) {
    const Vec3 cube = (field_.points[ray] / side_).array().floor();
    const auto [head, is_new] = first_.try_emplace(key(cube), ray);
    next_.push_back(is_new ? kNone : head->second);
    head->second = ray;
  }
  /// Whether one of the rays in the cubes around a point is such a one.
  template <typename Test>
  bool any_near(const Vec3& point, const Test& test) const {
    const Vec3 low = (point / side_ - Vec3::Constant(0.5)).array().floor();
    for (int code = 0; code < 8; ++code) {
      const auto head = first_.find(key(low + Vec3(code >> 2, code >> 1 & 1, code & 1)));
      if (head == first_.end()) continue;
      for (uint32_t ray = head->second; ray != kNone; ray = next_[ray])
        if (test(ray)) return true;
    }
    return false;
  }
  /// Rays in the cubes around a point.
  template <typename Visit>
  void each_near(const Vec3& point, const Visit& visit) const {
    any_near(point, [&](uint32_t ray) {
      visit(ray);
      return false;
    });
  }

 private:
  static constexpr uint32_t kNone = 0xffffffffU;
  static uint64_t key(const Vec3& cube) {
    constexpr uint64_t kMask = (uint64_t{1} << 21U) - 1;
    const auto part = [&](double x) { return static_cast<uint64_t>(static_cast<int64_t>(x)) & kMask; };
    return part(cube.x()) << 42U | part(cube.y()) << 21U | part(cube.z());
  }

  const RayField& field_;
  double side_;
  std::unordered_map<uint64_t, uint32_t> first_;  // looked up only: its order never shows
  std::vector<uint32_t> next_;
};

/// A place t of the way along an edge.
Vec2 place_along(const surface::EdgePlaces& places, double t) {
  const double at = t * static_cast<double>(places.size() - 1);
  const size_t i = std::min(static_cast<size_t>(at), places.size() - 2);
  return places[i] + (at - static_cast<double>(i)) * (places[i + 1] - places[i]);
}

/// Whether a place of a curved facet lies beyond the edge that one of its sides stands for.
bool is_beyond_edge(const FacetSheets& sheets, uint32_t facet, const Vec3& l) {
  for (size_t k = 0; k < 3; ++k) {
    const surface::EdgePlaces* edge = sheets.edge_of(facet, k);
    const auto a = static_cast<Eigen::Index>(k), b = static_cast<Eigen::Index>((k + 1) % 3);
    if (edge == nullptr || !(l[a] + l[b] > 0.0)) continue;
    const std::array<Vec2, 3>& uv = sheets.on_surface(facet).uv;
    const Vec2 at = l.x() * uv[0] + l.y() * uv[1] + l.z() * uv[2];
    const Vec2 on = place_along(*edge, l[b] / (l[a] + l[b])), way = uv[(k + 1) % 3] - uv[k];
    const auto left = [&](const Vec2& way_to) { return way.x() * way_to.y() - way.y() * way_to.x(); };
    const double inward = left(uv[(k + 2) % 3] - uv[k]);
    if (inward * left(at - on) < 0.0) return true;
  }
  return false;
}

/// A place t of the way along a side: in the plane z = c where the side is, to the last digit.
FacetPlace place_on_side(const FacetSheets& sheets, uint32_t facet, size_t side, double t) {
  if (sheets.is_curved(facet)) {
    Vec3 l = Vec3::Zero();
    l[static_cast<Eigen::Index>(side)] = 1.0 - t;
    l[static_cast<Eigen::Index>((side + 1) % 3)] = t;
    if (const surface::EdgePlaces* edge = sheets.edge_of(facet, side))
      return sheets.place_at(facet, place_along(*edge, t));
    return sheets.place(facet, l);
  }
  const uint32_t from = sheets.facets[facet][side], to = sheets.facets[facet][(side + 1) % 3];
  const Vec3 &at_from = sheets.normal_at(facet, side), &at_to = sheets.normal_at(facet, (side + 1) % 3);
  if (t == 1.0) return {sheets.points[to], at_to, facet};
  const Vec3 normal = at_from + t * (at_to - at_from);
  return {sheets.points[from] + t * (sheets.points[to] - sheets.points[from]), normal.normalized(), facet};
}

/// Places offered to a field, which takes those that no ray of the sheet is near to.
class Placement {
 public:
  Placement(RayField& field, double crease_rad)
      : field_(field),
        sheets_(*field.sheets),
        near_(field, kFarthestRay * field.pitch_mm),
        least_cosine_(std::cos(crease_rad)) {}

  void fill() {
    offer_border_corners();
    for (uint32_t f = 0; f < sheets_.facets.size(); ++f) {
      for (size_t k = 0; k < 3; ++k) {
        if (sheets_.neighbours[f][k] == FacetSheets::kNone) offer_side(f, k, field_.pitch_mm);
      }
    }
    borders_ = field_.size();
    for (uint32_t f = 0; f < sheets_.facets.size(); ++f) offer_inside(f, field_.pitch_mm);
    for (uint32_t f = 0; f < sheets_.facets.size(); ++f) {
      for (size_t k = 0; k < 3; ++k) offer_side(f, k, kFill * field_.pitch_mm);
      offer_inside(f, kFill * field_.pitch_mm);
    }
  }
  const RaysByPlace& near() const { return near_; }

 private:
  void offer(const FacetPlace& place, bool on_border = false) {
    const double apart2 = std::pow(kRaysApart * field_.pitch_mm, 2),
                 inside2 = std::pow(kInside * field_.pitch_mm, 2);
    const bool covered = near_.any_near(place.point, [&](uint32_t ray) {
      return (field_.points[ray] - place.point).squaredNorm() <
                 (on_border || ray >= borders_ ? apart2 : inside2) &&
             sheets_.sheet[field_.facet_of[ray]] == sheets_.sheet[place.facet] &&
             field_.normals[ray].dot(place.normal) >= least_cosine_;
    });
    if (covered) return;
    field_.points.push_back(place.point);
    field_.normals.push_back(place.normal);
    field_.facet_of.push_back(place.facet);
    near_.add(static_cast<uint32_t>(field_.points.size() - 1));
  }

  /// Corners of a sheet where its border turns.
  void offer_border_corners() {
    constexpr double kStraight = 0.5;  // |sum of the ways out|: 29 degrees
    std::vector<Vec3> ways(sheets_.points.size(), Vec3::Zero());
    std::vector<int> count(sheets_.points.size(), 0);
    const auto each_border = [&](const auto& visit) {
      for (uint32_t f = 0; f < sheets_.facets.size(); ++f) {
        for (size_t k = 0; k < 3; ++k) {
          if (sheets_.neighbours[f][k] == FacetSheets::kNone) visit(f, k);
        }
      }
    };
    each_border([&](uint32_t f, size_t k) {
      const uint32_t a = sheets_.facets[f][k], b = sheets_.facets[f][(k + 1) % 3];
      const Vec3 way = (sheets_.points[b] - sheets_.points[a]).normalized();
      ways[a] += way;
      ways[b] -= way;
      ++count[a];
      ++count[b];
    });
    each_border([&](uint32_t f, size_t k) {
      const uint32_t a = sheets_.facets[f][k];
      if (count[a] == 2 && ways[a].norm() < kStraight) return;
      offer(place_on_side(sheets_, f, k, 0.0), true);
    });
  }

  void offer_side(uint32_t facet, size_t k, double step) {
    const bool on_border = sheets_.neighbours[facet][k] == FacetSheets::kNone;
    const double length = (sheets_.corner(facet, (k + 1) % 3) - sheets_.corner(facet, k)).norm();
    const int parts = std::max(1, static_cast<int>(std::ceil(length / step)));
    for (int i = 0; i <= parts; ++i)
      offer(place_on_side(sheets_, facet, k, static_cast<double>(i) / parts), on_border);
  }

  /// The points of a square grid in the facet's plane, whose origin is that of W: facets of one plane share
  /// it.
  void offer_inside(uint32_t facet, double step) {
    const Vec3 a = sheets_.corner(facet, 0), ab = sheets_.corner(facet, 1) - a,
               ac = sheets_.corner(facet, 2) - a;
    const Vec3 normal = ab.cross(ac).normalized();
    int least = 0;
    normal.cwiseAbs().minCoeff(&least);
    const Vec3 e1 = normal.cross(Vec3::Unit(least)).normalized(), e2 = normal.cross(e1);
    const auto flat = [&](const Vec3& p) { return Vec2(p.dot(e1) / step, p.dot(e2) / step); };
    const Vec2 A = flat(a), B = flat(ab), C = flat(ac);
    const double det = B.x() * C.y() - B.y() * C.x();
    const std::array<Vec2, 3> corners{A, A + B, A + C};
    const auto [low, high] = std::minmax({corners[0].y(), corners[1].y(), corners[2].y()});
    for (double row = std::ceil(low); row <= high; row += 1.0) {
      const auto [first, last] = along_row(corners, row);
      for (double column = std::ceil(first); column <= last; column += 1.0) {
        const Vec2 p = Vec2(column, row) - A;
        const double wb = (p.x() * C.y() - p.y() * C.x()) / det, wc = (B.x() * p.y() - B.y() * p.x()) / det;
        if (wb < 0.0 || wc < 0.0 || wb + wc > 1.0) continue;
        if (sheets_.is_curved(facet) && is_beyond_edge(sheets_, facet, {1.0 - wb - wc, wb, wc})) continue;
        offer(sheets_.place(facet, {1.0 - wb - wc, wb, wc}));
      }
    }
  }

  /// From where to where a triangle lies on a row.
  static std::pair<double, double> along_row(const std::array<Vec2, 3>& corners, double row) {
    double first = std::numeric_limits<double>::infinity(), last = -first;
    for (size_t k = 0; k < 3; ++k) {
      const Vec2 &p = corners[k], &q = corners[(k + 1) % 3];
      if ((p.y() < row) == (q.y() < row)) continue;
      const double x = p.x() + (row - p.y()) / (q.y() - p.y()) * (q.x() - p.x());
      first = std::min(first, x);
      last = std::max(last, x);
    }
    return {first, last};
  }

  RayField& field_;
  const FacetSheets& sheets_;
  RaysByPlace near_;
  double least_cosine_;
  size_t borders_ = 0;  ///< rays before this one stand on borders
};

/// The rays of each facet: rays[begin[f] .. begin[f + 1]).
struct RaysOfFacets {
  std::vector<uint32_t> begin, rays;
};

RaysOfFacets rays_of_facets(const RayField& field) {
  RaysOfFacets lists;
  lists.begin.assign(field.sheets->facets.size() + 1, 0);
  for (const uint32_t facet : field.facet_of) ++lists.begin[facet + 1];
  std::partial_sum(lists.begin.begin(), lists.begin.end(), lists.begin.begin());
  lists.rays.resize(field.size());
  std::vector<uint32_t> next(lists.begin.begin(), lists.begin.end() - 1);
  for (uint32_t ray = 0; ray < field.size(); ++ray) lists.rays[next[field.facet_of[ray]]++] = ray;
  return lists;
}

/// The nearest ray of the facet's sheet.
uint32_t ray_nearest(const RayField& field, const RaysByPlace& near, const FacetPlace& place) {
  uint32_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  near.each_near(place.point, [&](uint32_t ray) {
    const double distance2 = (field.points[ray] - place.point).squaredNorm();
    if (distance2 > least || field.sheets->sheet[field.facet_of[ray]] != field.sheets->sheet[place.facet])
      return;
    if (field.normals[ray].dot(place.normal) <= 0.0) return;  // the other side of a thin smooth part
    if (distance2 == least && ray > nearest) return;
    least = distance2;
    nearest = ray;
  });
  return nearest;
}

/// Each facet's area in equal shares to the rays on it and to the nearest ones of places spread over it
/// evenly (the R2 sequence of the plastic number): the sum is the design's area.
void share_areas(RayField& field, const RaysByPlace& near, const RaysOfFacets& lists) {
  const FacetSheets& sheets = *field.sheets;
  field.areas_mm2.assign(field.size(), 0.0);
  const auto fraction = [](double x) { return x - std::floor(x); };
  for (uint32_t f = 0; f < sheets.facets.size(); ++f) {
    const Vec3 ab = sheets.corner(f, 1) - sheets.corner(f, 0), ac = sheets.corner(f, 2) - sheets.corner(f, 0);
    const double area = 0.5 * ab.cross(ac).norm(),
                 longest = std::max({ab.norm(), ac.norm(), (ac - ab).norm()});
    const double step = kFill * field.pitch_mm;
    const auto places = static_cast<size_t>(std::ceil(std::max(area / (step * step), longest / step)));
    const double share = area / static_cast<double>(places + lists.begin[f + 1] - lists.begin[f]);
    for (uint32_t i = lists.begin[f]; i < lists.begin[f + 1]; ++i) field.areas_mm2[lists.rays[i]] += share;
    for (size_t i = 0; i < places; ++i) {
      double u = fraction(0.5 + 0.7548776662466927 * static_cast<double>(i));
      double v = fraction(0.5 + 0.5698402909980532 * static_cast<double>(i));
      if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
      }
      field.areas_mm2[ray_nearest(field, near, sheets.place(f, {1.0 - u - v, u, v}))] += share;
    }
  }
}

/// How far apart neighbours are at most.
double neighbour_reach(const RayField& field) {
  return 2.0 * kFarthestRay * field.pitch_mm;
}

/// Rays that no third one stands between. `near`: within that reach.
void find_neighbours(const RayField& field, const RaysByPlace& near, uint32_t ray,
                     std::vector<uint32_t>& around, std::vector<std::array<uint32_t, 2>>& edges) {
  constexpr double kBetween = 1.0 + 1e-6;  // the corners of a square stand between those of its diagonal
  const double reach = neighbour_reach(field);
  const Vec3& foot = field.points[ray];
  around.clear();
  near.each_near(foot, [&](uint32_t other) {
    if (other != ray && (field.points[other] - foot).norm() <= reach &&
        field.normals[other].dot(field.normals[ray]) > 0.0)
      around.push_back(other);
  });
  const uint32_t own = field.facet_of[ray];
  const auto is_own = [&](uint32_t other) { return field.facet_of[other] == own; };
  if (!std::all_of(around.begin(), around.end(), is_own)) {
    // Only facets that hang together with the ray's own one nearby.
    std::vector<uint32_t> facets;
    field.sheets->each_near(own, foot, reach, [&](uint32_t facet) {
      facets.push_back(facet);
      return false;
    });
    std::sort(facets.begin(), facets.end());
    std::erase_if(around, [&](uint32_t other) {
      return !std::binary_search(facets.begin(), facets.end(), field.facet_of[other]);
    });
  }
  std::sort(around.begin(), around.end());
  for (const uint32_t other : around) {
    if (other < ray) continue;
    const Vec3 middle = 0.5 * (foot + field.points[other]);
    const double radius2 = 0.25 * kBetween * (foot - field.points[other]).squaredNorm();
    const bool between = std::any_of(around.begin(), around.end(), [&](uint32_t third) {
      return third != other && (field.points[third] - middle).squaredNorm() <= radius2;
    });
    if (!between) edges.push_back({ray, other});
  }
}

void connect_rays(RayField& field) {
  RaysByPlace near(field, neighbour_reach(field));
  for (uint32_t ray = 0; ray < field.size(); ++ray) near.add(ray);
  std::vector<std::vector<std::array<uint32_t, 2>>> parts((field.size() + kRaysPerTask - 1) / kRaysPerTask);
  parallel_chunks(field.size(), kRaysPerTask, [&](size_t begin, size_t end) {
    std::vector<uint32_t> around;
    for (size_t ray = begin; ray < end; ++ray)
      find_neighbours(field, near, static_cast<uint32_t>(ray), around, parts[begin / kRaysPerTask]);
  });
  for (const auto& part : parts) field.edges.insert(field.edges.end(), part.begin(), part.end());
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

void group_all(RayField& field) {
  std::vector<uint32_t> sorted(field.size());
  std::iota(sorted.begin(), sorted.end(), 0U);
  group_rays(field, 0, static_cast<uint32_t>(sorted.size()), sorted);
}

RayFieldPtr walls_on(const std::shared_ptr<const FacetSheets>& sheets, double pitch_mm, double crease_rad) {
  auto walls = std::make_shared<RayField>();
  walls->pitch_mm = kWallShare * pitch_mm;
  walls->sheets = sheets;
  Placement(*walls, crease_rad).fill();
  group_all(*walls);
  return walls;
}

}  // namespace

RayFieldPtr rays_on_mesh(const TriMesh& mesh, double pitch_mm, double crease_rad,
                         const surface::UnderFacetsPtr& under) {
  SWARF_CHECK(pitch_mm > 0.0, "rays need a pitch");
  auto field = std::make_shared<RayField>();
  field->pitch_mm = pitch_mm;
  field->design = std::make_shared<DesignMesh>(mesh, under);
  field->sheets = std::make_shared<FacetSheets>(facet_sheets(mesh, crease_rad, under));
  Placement placement(*field, crease_rad);
  placement.fill();
  const RaysOfFacets lists = rays_of_facets(*field);
  share_areas(*field, placement.near(), lists);
  connect_rays(*field);
  group_all(*field);
  field->walls = walls_on(field->sheets, pitch_mm, crease_rad);
  return field;
}

RayFieldPtr rays_at(std::vector<Vec3> points, std::vector<Vec3> normals,
                    std::shared_ptr<const DesignMesh> design, double pitch_mm) {
  SWARF_CHECK(points.size() == normals.size(), "one normal per ray");
  auto field = std::make_shared<RayField>();
  field->points = std::move(points);
  field->normals = std::move(normals);
  field->design = std::move(design);
  field->pitch_mm = pitch_mm;
  if (field->size() > 0) group_all(*field);
  return field;
}

}  // namespace swarf::stock
