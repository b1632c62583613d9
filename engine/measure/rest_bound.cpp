#include "measure/rest_bound.h"

#include <algorithm>

#include "measure/column_range.h"
#include "measure/raw_cell.h"
#include "mesh/mesh_distance.h"
#include "stock/rays/ray_height.h"
#include "stock/sweep/convex_motion.h"

namespace swarf::measure {
namespace {

/// Where another face is as near need not be known closer than this, of itself.
constexpr double kShareOfRange = 1e-3;

/// Where a line leaves the raw stock for good; as leaves_box.
double leaves_raw(const stock::RawShape& raw, const Vec3& point, const Vec3& way) {
  if (raw.is_box()) return leaves_box(raw.box(), point, way);
  const std::vector<stock::RawInterval> material = raw.along(point, way);
  return material.empty() ? -kNever : material.back().high;
}

}  // namespace

bool resists_division(const Cell& cell, double voxel_mm) {
  constexpr double kResisting = 1.0 / 8.0;  // of a voxel
  return cell.shape.radius() <= kResisting * voxel_mm;
}

double distance_to(const Box& box, const Vec3& p) {
  return (p - p.cwiseMax(box.lower).cwiseMin(box.upper)).norm();
}

void take_raw(const stock::RawShape& raw, Corner& corner) {
  const CellCorner& at = corner.at;
  if (raw.is_box()) {
    corner.top = std::min(leaves_box(raw.box(), at.point, at.normal), corner.range);
    // Without stock at the place the design lacks material: as much as to the box.
    corner.height = corner.top > -kNever ? corner.top : -distance_to(raw.box(), at.point);
  } else {
    corner.height = std::min(stock::raw_column(raw, at.point, at.normal).height_mm, corner.range);
    corner.top = corner.height;
  }
}

double look_at_raw(const stock::RawShape& raw, const std::vector<CornerHeights>& own, double top,
                   Cell& cell) {
  for (const CornerHeights& heights : own)
    top = std::min(top, *std::max_element(heights.begin(), heights.end()));
  top = raw_air_above(cell.shape, raw, std::max(top, 0.0));
  cell.raw_outside = raw_outside(cell.shape, raw, top);
  return top;
}

double counted_depth(const CertificateInput& input, const CellCorner& corner, double depth, double share) {
  if (depth <= 0.0) return depth;
  depth = input.field.own_depth(corner.point, corner.normal, depth, share);
  const double through = leaves_raw(input.stock.raw(), corner.point, -corner.normal);
  return through > 0.0 ? std::min(depth, through) : depth;
}

bool asks_above(const CertificateInput& input) {
  return input.wants_excess || input.wants_scallop;
}

void take_range(const CertificateInput& input, Corner& corner) {
  const CellCorner& at = corner.at;
  corner.range = kNever;
  if (!asks_above(input) && input.field.design != nullptr) return;
  if (input.field.design == nullptr) {
    const stock::FreeRange::Range range = input.ranges(at.point, at.normal);
    corner.range = range.mm;
    if (range.mm < kNever) corner.wall = range.wall;
    return;
  }
  const double through = leaves_box(input.stock.box(), at.point, at.normal);
  if (!(through > 0.0)) return;
  corner.range = input.field.own_depth(at.point, -at.normal, through, kShareOfRange);
  if (corner.range >= through) return;
  const mesh::NearestPoint near =
      input.field.design->distance.nearest(beyond(at.point, at.normal, corner.range));
  corner.wall = near.point;
  corner.facet = near.triangle;
}

void keep_own(const CertificateInput& input, Corner& corner) {
  const CellCorner& at = corner.at;
  if (corner.height < 0.0 && corner.near != stock::kUncut)
    corner.height = -counted_depth(input, at, -corner.height);
  if (corner.height > 0.0 && corner.range == kNever && input.field.design != nullptr)
    corner.height = input.field.own_depth(at.point, -at.normal, corner.height, kShareOfRange);
}

double lowest_cut(const CellCorner& at, const NearSweep& near, double highest, bool fans,
                  const stock::RayField& field) {
  if (stays_above(at, near, highest)) return kNever;
  const double low = stock::ray_height(at.point, at.normal, near.map, *near.cutter);
  // Cuts shallower than this are not looked at closer, mm: distances from facets know no more.
  constexpr double kShallow = 2e-5;
  // Columns that fan out from an edge or a corner are touched there by all that ends in its faces.
  if (low >= -kShallow && !fans) return low;
  double least = kNever;
  for (const cutter::ConvexPiece& piece : near.cutter->pieces) {
    const stock::RayInterval cut = stock::ray_interval(at.point, at.normal, near.map, piece);
    if (cut.hit() && cut.high > cut.low + (fans ? kTouch : 0.0) &&
        field.answers_for(at.point, at.normal, cut.high))
      least = std::min(least, cut.low);
  }
  return least;
}

double rest_top(const CellCorner& at, double range, const stock::RawShape& raw,
                std::span<const NearSweep> sweeps) {
  std::vector<stock::RayInterval> cuts;
  for (const NearSweep& near : sweeps) {
    for (const cutter::ConvexPiece& piece : near.cutter->pieces) {
      const stock::RayInterval cut = stock::ray_interval(at.point, at.normal, near.map, piece);
      if (cut.hit() && cut.high > 0.0) cuts.push_back(cut);
    }
  }
  std::sort(cuts.begin(), cuts.end(), [](const auto& a, const auto& b) { return a.high > b.high; });
  std::vector<stock::RawInterval> material = raw.along(at.point, at.normal);
  for (auto piece = material.rbegin(); piece != material.rend(); ++piece) {
    double top = std::min(piece->high, range);
    for (const stock::RayInterval& cut : cuts) {
      if (cut.high + kTouch < top) break;
      top = std::min(top, cut.low);
    }
    if (top > std::max(piece->low, 0.0)) return top;
  }
  return 0.0;
}

uint32_t between(const std::array<uint32_t, 2>& sweeps) {
  return sweeps[0] == stock::kUncut || sweeps[1] == stock::kUncut ? stock::kUncut
                                                                  : sweeps[0] / 2 + sweeps[1] / 2;
}

namespace {

/// Places whose hull holds the cell but for its stray; three where it is flat.
struct HullOfCell {
  std::array<Vec3, 6> places;
  size_t count = 0;

  explicit HullOfCell(const Cell& cell) {
    for (const Corner& corner : cell.corners) places[count++] = corner.at.point;
    for (size_t k = 0; k < 3 && cell.shape.is_curved(); ++k) places[count++] = cell.shape.side(k).point;
  }
  std::span<const Vec3> list() const { return std::span(places).first(count); }
};

/// Where no column that begins beyond a face of the box leads down to it the box is missed, and what is
/// lacking is the distance to it, a convex function: the most over the cell, mm. Nothing elsewhere.
std::optional<double> lacking_beside(const Cell& cell, const Box& box, std::span<const Vec3> hull) {
  const auto is_missed = [&](const Vec3& out, double face) {
    const bool beyond =
        std::any_of(hull.begin(), hull.end(), [&](const Vec3& p) { return out.dot(p) > face; });
    return !beyond || std::all_of(cell.corners.begin(), cell.corners.end(), [&](const Corner& corner) {
      return out.dot(corner.at.normal) + cell.shape.turn <= 0.0;
    });
  };
  for (int a = 0; a < 3; ++a)
    if (!is_missed(Vec3::Unit(a), box.upper[a]) || !is_missed(-Vec3::Unit(a), -box.lower[a])) return {};
  double most = 0.0;
  for (const Vec3& p : hull) most = std::max(most, distance_to(box, p));
  return most;
}

}  // namespace

double stood_before(const Cell& cell, const stock::RawShape& raw) {
  if (!raw.is_box()) return raw_stood(cell.shape, raw);
  const Box& box = raw.box();
  double inside = kNever, least = kNever, top = kNever;
  const HullOfCell hull(cell);
  for (const Vec3& p : hull.list())
    inside = std::min({inside, (p - box.lower).minCoeff(), (box.upper - p).minCoeff()});
  for (const Corner& corner : cell.corners) {
    const Vec3& p = corner.at.point;
    const double leave = leaves_box(box, p, corner.at.normal);
    least = std::min(least, leave > -kNever ? leave : -distance_to(box, p) - cell.shape.radius());
    top = std::min(top, corner.top);
  }
  if (inside < cell.shape.stray_mm) {
    if (const auto lacking = lacking_beside(cell, box, hull.list())) return -*lacking - cell.shape.stray_mm;
    return std::min(0.0, least) - cell.shape.flatness_mm;
  }
  return std::max(0.0, top - cell.shape.flatness_mm - top * std::min(1.0, cell.shape.turn));
}

namespace {

/// What a piece of a sweep covers of the middle column of a cell.
struct Layer {
  double low, high;  ///< mm
  const NearSweep* near;
  const cutter::ConvexPiece* piece;
};

/// From the lowest up.
std::vector<Layer> layers_of(const DesignCell& cell, std::span<const NearSweep> sweeps) {
  const Vec3 foot = cell.centroid(), way = cell.mean_normal();
  std::vector<Layer> layers;
  for (const NearSweep& near : sweeps) {
    for (const cutter::ConvexPiece& piece : near.cutter->pieces) {
      const stock::RayInterval cut = stock::ray_interval(foot, way, near.map, piece);
      if (cut.hit()) layers.push_back({cut.low, cut.high, &near, &piece});
    }
  }
  std::stable_sort(layers.begin(), layers.end(),
                   [](const Layer& a, const Layer& b) { return a.low < b.low; });
  return layers;
}

/// Whether the piece holds the place at `top` in the instant in which it is nearest to the one at `low`: in
/// another it may.
bool reaches_up(const CellCorner& at, const NearSweep& near, const cutter::ConvexPiece& piece, double low,
                double top) {
  const Vec3 from = at.point + low * at.normal, to = at.point + top * at.normal;
  const Vec3 P = near.map.start(from);
  const double t = stock::nearest_instant(piece, P, near.map.end(from) - P).t;
  const Vec3 X = (1.0 - t) * near.map.start(to) + t * near.map.end(to);
  return cutter::support(piece, X.head<2>().norm(), X.z()).value <= kTouch;
}

double mean(const CornerHeights& heights) {
  return (heights[0] + heights[1] + heights[2]) / 3.0;
}

double most_of_corners(const CornerHeights& heights) {
  return *std::max_element(heights.begin(), heights.end());
}

/// At no corner above, and not all but the same.
bool is_lower(const CornerHeights& a, const CornerHeights& b) {
  for (size_t k = 0; k < 3; ++k)
    if (!(a[k] <= b[k])) return false;
  return mean(a) < mean(b) - kTouch;
}

}  // namespace

bool RestBound::ends_below(const Cell& cell, const CornerHeights& tops) const {
  for (size_t k = 0; k < 3; ++k) {
    const Corner& corner = cell.corners[k];
    if (corner.near == stock::kUncut) continue;
    const NearSweep& near = near_[corner.near];
    const bool reaches = std::any_of(
        near.cutter->pieces.begin(), near.cutter->pieces.end(), [&](const cutter::ConvexPiece& piece) {
          return reaches_up(corner.at, near, piece, corner.height, std::min(tops[k], corner.top));
        });
    if (!reaches) return true;
  }
  return false;
}

std::optional<CornerHeights> RestBound::lowered(const Cell& cell, const CornerHeights& tops, double enough,
                                                std::span<const NearSweep> sweeps) const {
  CornerHeights lowest = tops;
  for (const CornerHeights& set : sets_)
    if (is_lower(set, lowest)) lowest = set;
  const std::vector<Layer> layers = layers_of(cell.shape, sweeps);
  const CornerHeights bottom{cell.corners[0].height, cell.corners[1].height, cell.corners[2].height};
  // In one instant a sweep may cover only a part of what it does in all: the part from `share` of its own
  // depth on.
  const auto lowers = [&](const Layer& layer, double share) {
    CornerHeights from = bottom;
    for (size_t k = 0; k < 3 && share < 1.0; ++k) from[k] = lowest[k] - share * (mean(lowest) - layer.low);
    const Covered covered = covered_from(cell.shape, *layer.near, *layer.piece, from, lowest);
    if (!is_lower(covered.heights, lowest)) return false;
    lowest = covered.heights;
    return true;
  };
  const auto next = [&](double share) {
    const double top = mean(lowest), slack = 2.0 * kTouch + cell.shape.flatness_mm;
    return std::any_of(layers.begin(), layers.end(), [&](const Layer& layer) {
      return layer.low < top && layer.high + slack >= top && lowers(layer, share);
    });
  };
  constexpr double kLeastShare = 1.0 / 16.0;
  constexpr int kMostSteps = 64;
  const auto descend = [&] {
    for (int step = 0; step < kMostSteps && most_of_corners(lowest) > enough; ++step) {
      double share = 1.0;
      while (share >= kLeastShare && !next(share)) share *= 0.5;
      if (share < kLeastShare) break;
    }
  };
  descend();
  if (most_of_corners(lowest) <= enough) return lowest;
  // Where the columns end below a layer at one corner and within it at another they may as well end higher.
  const CornerHeights leaning = lowest;
  const double level = most_of_corners(leaning);
  lowest = {level, level, level};
  descend();
  if (most_of_corners(lowest) < level - kTouch) return lowest;
  return is_lower(leaning, tops) ? std::optional(leaning) : std::nullopt;
}

Seams RestBound::seams_of(const Cell& cell) const {
  constexpr double kLeastArea = 1e-6;  // mm2: halves may keep the longest side
  Seams seams;
  const bool exact = is_flat(cell.shape) || root_.bounds.surface != nullptr;
  if (!exact || !root_.looks_up || !(cell.shape.area_mm2() > kLeastArea)) return seams;
  for (size_t k = 0; k < 3; ++k)
    if (cell.edges[k].places == nullptr) seams[k] = seam_of(cell, k);
  return seams;
}

std::optional<CellCorner> RestBound::seam_of(const Cell& cell, size_t side) const {
  const size_t next = (side + 1) % 3;
  const Corner &a = cell.corners[side], &b = cell.corners[next];
  if (a.near == b.near || a.near == stock::kUncut || b.near == stock::kUncut) return std::nullopt;
  const NearSweep& near = near_[a.near];
  const auto place = [&](double share) {
    Vec3 weights = Vec3::Zero();
    weights[static_cast<Eigen::Index>(side)] = 1.0 - share;
    weights[static_cast<Eigen::Index>(next)] = share;
    return place_in(cell.shape, weights, root_.bounds);
  };
  const auto is_covered = [&](double share) {
    const CellCorner at = place(share);
    const double from = std::min(a.height, b.height), top = (1.0 - share) * a.top + share * b.top;
    return std::any_of(near.cutter->pieces.begin(), near.cutter->pieces.end(), [&](const auto& piece) {
      return covered_from({{at, at, at}}, near, piece, {from, from, from}, {top, top, top}).heights[0] <
             kNever;
    });
  };
  constexpr double kEnd = 1.0 / 16.0;  // of the side: no slivers
  if (!is_covered(kEnd) || is_covered(1.0 - kEnd)) return std::nullopt;
  double low = kEnd, high = 1.0 - kEnd;
  constexpr int kHalvings = 40;
  for (int n = 0; n < kHalvings; ++n) {
    const double share = 0.5 * (low + high);
    (is_covered(share) ? low : high) = share;
  }
  return place(low);
}

std::vector<CornerHeights> RestBound::own_above(const Cell& cell) const {
  std::vector<CornerHeights> bounds;
  const CornerHeights ranges{cell.corners[0].range, cell.corners[1].range, cell.corners[2].range};
  for (const Corner& corner : cell.corners) {
    if (!corner.wall) continue;
    const auto own = corner.facet && is_flat(cell.shape)
                         ? own_to_facet(cell.shape, input_.field.design->mesh, *corner.facet, ranges, 1.0)
                         : own_to_point(cell.shape, *corner.wall);
    if (own) bounds.push_back(*own);
  }
  return bounds;
}

CornerHeights tops_of(const std::vector<CornerHeights>& own, double top) {
  CornerHeights tops{top, top, top};
  double least = top;
  for (const CornerHeights& bound : own) {
    const double most = *std::max_element(bound.begin(), bound.end());
    if (most >= least) continue;
    least = most;
    tops = bound;
  }
  return tops;
}

void add_box(const Box& box, const DesignCell& cell, std::vector<CornerHeights>& sets) {
  for (int a = 0; a < 3; ++a) {
    sets.push_back(outside_from(cell, Vec3::Unit(a), box.upper[a]));
    sets.push_back(outside_from(cell, -Vec3::Unit(a), -box.lower[a]));
  }
}

double RestBound::left(const Cell& cell, const std::vector<CornerHeights>& own, const CornerHeights& tops,
                       double enough, const KeptSweeps& kept) {
  sets_.clear();
  owners_.clear();
  covered_.clear();
  sags_ = {kNever, kNever, kNever};
  add_box(input_.stock.box(), cell.shape, sets_);
  if (cell.raw_outside) sets_.push_back(*cell.raw_outside);
  sets_.insert(sets_.end(), own.begin(), own.end());
  const auto first = static_cast<std::ptrdiff_t>(sets_.size());
  for (const Corner& corner : cell.corners) add_owner(cell, corner.near, tops);
  HighestLeft left = left_by_sets();
  // Where the bound is highest, the sweep that is lowest there may lower it.
  constexpr size_t kMostOwners = 10;
  while (left.height > enough && left.height < kNever && owners_.size() < kMostOwners) {
    if (!add_owner(cell, owner_at(cell, left, kept), tops)) break;
    const double before = left.height;
    const HighestLeft next = left_by_sets();
    if (!(next.height < before)) break;
    left = next;
    // Where it falls slowly, smaller cells do better.
    constexpr double kWorthwhile = 0.2;
    if (!(before - left.height > kWorthwhile * (before - enough))) break;
  }
  const bool covered = std::any_of(sets_.begin() + first, sets_.end(),
                                   [](const CornerHeights& set) { return set[0] < kNever; });
  if (left.height > enough && !covered && resists_division(cell, input_.stock.voxel_mm()))
    left = left_with_others(cell, left, tops, enough, kept);
  return left.height;
}

/// Beside a hole none of the sweeps that cut the corners lowest may cover all of the cell, and one that left
/// the floor around it may: no place tells which, so those that cut its middle are tried.
HighestLeft RestBound::left_with_others(const Cell& cell, HighestLeft left, const CornerHeights& tops,
                                        double enough, const KeptSweeps& kept) {
  constexpr size_t kMostTried = 16;
  const CellCorner at = place_in(cell.shape, Vec3::Constant(1.0 / 3.0), root_.bounds);
  const bool fans = root_.cell.area_mm2() == 0.0;
  size_t tried = 0;
  for (size_t i = 0; i < kept.numbers.size() && tried < kMostTried && left.height > enough; ++i) {
    const uint32_t n = kept.numbers[i];
    if (kept.floors[i] > enough || lowest_cut(at, near_[n], enough, fans, input_.field) > enough) continue;
    if (!add_owner(cell, n, tops)) continue;
    ++tried;
    const HighestLeft next = left_by_sets();
    if (next.height < left.height) left = next;
  }
  return left;
}

/// Of all sets, or of the sweeps alone, which all sag where the design bulges.
HighestLeft RestBound::left_by_sets() const {
  const HighestLeft all = highest_left(sets_);
  if (covered_.empty()) return all;
  const HighestLeft sagging = highest_left(covered_, sags_);
  return sagging.height < all.height ? sagging : all;
}

/// What the sweep covers joins the sets; false when it is among them.
bool RestBound::add_owner(const Cell& cell, uint32_t n, const CornerHeights& tops) {
  if (n == stock::kUncut || std::find(owners_.begin(), owners_.end(), n) != owners_.end()) return false;
  owners_.push_back(n);
  const CornerHeights from{cell.corners[0].height, cell.corners[1].height, cell.corners[2].height};
  for (const cutter::ConvexPiece& piece : near_[n].cutter->pieces) {
    const Covered covered = covered_from(cell.shape, near_[n], piece, from, tops);
    sets_.push_back(covered.heights);
    if (!cell.shape.is_curved() || covered.heights[0] == kNever) continue;
    covered_.push_back(covered.heights);
    for (size_t k = 0; k < 3; ++k) sags_[k] = std::min(sags_[k], covered.sags[k]);
  }
  return true;
}

/// The sweep that leaves least where the bound is highest; none when all leave more.
uint32_t RestBound::owner_at(const Cell& cell, const HighestLeft& left, const KeptSweeps& kept) {
  const CellCorner at = place_in(cell.shape, left.place, root_.bounds);
  double height = left.height;
  uint32_t owner = stock::kUncut;
  const bool fans = root_.cell.area_mm2() == 0.0;
  const auto look_at = [&](uint32_t n) {
    const double low = lowest_cut(at, near_[n], height, fans, input_.field);
    if (low >= height) return;
    height = low;
    owner = n;
  };
  for (const uint32_t n : owners_) look_at(n);
  for (size_t k = 0; k < 3; ++k) {
    const uint32_t guess = between({cell.corners[k].near, cell.corners[(k + 1) % 3].near});
    if (guess < near_.size()) look_at(guess);
  }
  column_heights(at, kept.planes, kept.numbers.size(), planes_);
  for (size_t i = 0; i < kept.numbers.size(); ++i) {
    if (kept.floors[i] < height && planes_[i] < height + kPlaneSlack) look_at(kept.numbers[i]);
  }
  return owner;
}

}  // namespace swarf::measure
