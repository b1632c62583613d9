#include "proof/region_proof.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace swarf::proof {
namespace {

/// Outside a set by no more than this is not told from inside, mm: a flank that runs along a wall.
constexpr double kTouch = 1e-6;
/// A region is divided no further below this share of what is allowed, mm.
constexpr double kSmallestShare = 0.01, kSmallest = 2e-6;
constexpr size_t kMostParts = 4000;  ///< of one region
constexpr size_t kRemembered = 6;    ///< sets that closed the regions before
constexpr size_t kHolders = 8;       ///< sets around a centre that are tried for a whole part

double most_over(const ConvexSet& set, const Polytope& body) {
  double most = -std::numeric_limits<double>::infinity();
  for (const Vec3& corner : body.corners) most = std::max(most, value(set, corner));
  return most;
}

bool holds(const ConvexSet& set, const Polytope& body, double tolerance_mm) {
  return std::all_of(body.corners.begin(), body.corners.end(),
                     [&](const Vec3& corner) { return value(set, corner) <= tolerance_mm; });
}

std::array<Vec3, 3> facet_of(const SolidDesign& design, uint32_t facet) {
  return {design.distance().corner(facet, 0), design.distance().corner(facet, 1),
          design.distance().corner(facet, 2)};
}

}  // namespace

bool RegionProver::is_closed_by_last(const Polytope& body) {
  for (size_t i = 0; i < last_.size(); ++i) {
    if (!holds(last_[i].set, body, kTouch)) continue;
    if (i > 0) std::swap(last_[i], last_[i - 1]);
    return true;
  }
  return false;
}

/// The raw stock's surface near the body lies below a plane that the whole body is above.
bool RegionProver::is_beyond_raw(const Polytope& body, const Vec3& centre, double radius) const {
  const stock::RawShape& raw = in_.stock.raw();
  const Box& box = raw.box();
  for (int k = 0; k < 3; ++k) {
    const auto all = [&](auto beyond) {
      return std::all_of(body.corners.begin(), body.corners.end(), beyond);
    };
    if (all([&](const Vec3& v) { return v[k] >= box.upper[k] - kTouch; })) return true;
    if (all([&](const Vec3& v) { return v[k] <= box.lower[k] + kTouch; })) return true;
  }
  if (raw.is_box()) return false;
  const stock::RawPoint seen = raw.at(centre);
  if (seen.distance_mm >= radius) return true;
  if (seen.distance_mm < -kTouch) return false;
  const stock::RawExtent extent = raw.extent(centre, radius, seen.normal);
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& corner : body.corners) least = std::min(least, seen.normal.dot(corner));
  return extent.greatest <= least + kTouch;
}

void RegionProver::find_candidates(const Polytope& body, const Vec3& centre, double radius) {
  candidates_.clear();
  std::vector<uint32_t> found;
  index_.find(body.box(), found);
  for (const uint32_t n : found) {
    const stock::CutterSolid& cutter = in_.cutters[n];
    for (uint32_t piece = 0; piece < cutter.pieces.size(); ++piece) {
      const SweepSet set(in_.sweeps[n], cutter, piece, centre);
      if (set.value(centre) <= radius) candidates_.push_back({set, n, piece});
    }
  }
}

/// The place of the design nearest to a place of a region, which is no farther than its own feature.
mesh::SignedPoint RegionProver::nearest(const Vec3& x, const Region& region, double above_mm) const {
  const double own = region.height(x) / std::cos(SolidDesign::kMostTurn);
  const mesh::SignedPoint near = in_.design.distance().at(x, std::max(own, above_mm) + kTouch);
  return std::isfinite(near.distance_mm) ? near : in_.design.distance().at(x);
}

bool RegionProver::is_leftover(const Vec3& x) const {
  if (!(in_.stock.raw().distance_mm(x) < -kTouch)) return false;
  std::vector<uint32_t> found;
  index_.find({x, x}, found);
  return std::none_of(found.begin(), found.end(), [&](uint32_t n) {
    const stock::CutterSolid& cutter = in_.cutters[n];
    for (size_t piece = 0; piece < cutter.pieces.size(); ++piece)
      if (SweepSet(in_.sweeps[n], cutter, piece, x).value(x) <= kTouch) return true;
    return false;
  });
}

/// From a leftover place away from the design, as far as the material goes on.
void RegionProver::climb(const Vec3& x, double height_mm) {
  if (height_mm <= found_mm_) return;
  const mesh::SignedPoint seen = in_.design.distance().at(x);
  found_mm_ = seen.distance_mm;
  top_ = x;
  foot_ = seen.foot;
  const Vec3 way = (x - seen.foot).normalized();
  double inside = 0.0, outside = std::max(1e-4, 0.1 * height_mm);
  const auto is_own = [&](double s) {
    const Vec3 y = x + s * way;
    return is_leftover(y) && in_.design.distance().at(y).distance_mm >= height_mm + (1.0 - 1e-6) * s;
  };
  constexpr double kMost = 1e3;
  while (outside < kMost && is_own(outside)) {
    inside = outside;
    outside *= 2.0;
  }
  for (int i = 0; i < 40 && outside - inside > 1e-7; ++i) {
    const double middle = 0.5 * (inside + outside);
    (is_own(middle) ? inside : outside) = middle;
  }
  const Vec3 highest = x + inside * way;
  const mesh::SignedPoint there = in_.design.distance().at(highest);
  if (!(there.distance_mm > found_mm_)) return;
  found_mm_ = there.distance_mm;
  top_ = highest;
  foot_ = there.foot;
}

void RegionProver::look_around(const Vec3& x, double height_mm) {
  constexpr double kLeast = 1e-5;  // mm
  Vec3 at = x;
  double most = height_mm;
  for (double step = height_mm; step > kLeast; step *= 0.5) {
    for (bool better = true; better;) {
      better = false;
      for (int n = 0; n < 27; ++n) {
        const Vec3 y = at + step * Vec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
        const double distance = in_.design.distance().at(y).distance_mm;
        if (!(distance > most + kLeast) || !is_leftover(y)) continue;
        most = distance;
        at = y;
        better = true;
      }
    }
  }
  if (!(most > found_mm_)) return;
  found_mm_ = most;
  top_ = at;
  foot_ = in_.design.distance().at(at).foot;
}

/// In two, by a plane a little inside the border of a set that holds the centre; without one across the
/// longest way.
void RegionProver::split(Part& part, const ConvexSet* by, const Vec3& centre) {
  Vec3 normal = Vec3::UnitZ();
  double offset = 0.0;
  if (by != nullptr) {
    const Vec3* worst = nullptr;
    double most = -std::numeric_limits<double>::infinity();
    for (const Vec3& corner : part.body.corners) {
      const double v = value(*by, corner);
      if (v <= most) continue;
      most = v;
      worst = &corner;
    }
    const Vec3 way = *worst - centre;
    double inside = 0.0, outside = 1.0;
    for (int i = 0; i < 12; ++i) {
      const double middle = 0.5 * (inside + outside);
      (value(*by, centre + middle * way) <= 0.0 ? inside : outside) = middle;
    }
    normal = gradient(*by, centre + outside * way);
    constexpr double kInside = 0.85;  // of the way to the border
    offset = normal.dot(centre + kInside * inside * way);
  } else {
    double longest = -1.0;
    for (const Vec3& a : part.body.corners) {
      const double length = (a - centre).norm();
      if (length <= longest) continue;
      longest = length;
      normal = (a - centre).normalized();
    }
    offset = normal.dot(centre);
  }
  auto [below, above] = cut_by_plane(part.body, normal, offset);
  for (Polytope* half : {&above, &below})
    if (!half->is_empty()) stack_.push_back({std::move(*half), part.near, false});
}

std::optional<RegionState> RegionProver::look_at(Part& part, const Region& region, double above_mm) {
  if (is_closed_by_last(part.body)) return std::nullopt;
  const Vec3 centre = part.body.centre();
  const double radius = part.body.radius(centre);
  if (is_beyond_raw(part.body, centre, radius)) return std::nullopt;
  if (part.is_root) {
    find_candidates(part.body, centre, radius);
    for (uint32_t n = 0; n < candidates_.size(); ++n) part.near.push_back(n);
  }
  std::vector<std::pair<double, uint32_t>> around;
  std::vector<uint32_t> kept;
  for (const uint32_t n : part.near) {
    const double at = value(candidates_[n].set, centre);
    if (at <= radius) kept.push_back(n);
    if (at <= 0.0) around.emplace_back(at, n);
  }
  part.near = std::move(kept);
  const size_t holders = std::min(kHolders, around.size());
  std::partial_sort(around.begin(), around.begin() + static_cast<std::ptrdiff_t>(holders), around.end());
  const ConvexSet* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < holders; ++i) {
    const Candidate& one = candidates_[around[i].second];
    const double most = most_over(one.set, part.body);
    if (most <= kTouch) {
      last_.push_front(one);
      if (last_.size() > kRemembered) last_.pop_back();
      return std::nullopt;
    }
    if (most >= least) continue;
    least = most;
    best = &one.set;
  }
  if (in_.stock.air_radius_mm(centre) - in_.stock_bound_mm >= radius) return std::nullopt;
  const mesh::SignedPoint seen = nearest(centre, region, above_mm);
  if (seen.distance_mm <= -radius) return std::nullopt;  // wholly in the design
  const NearerSet nearer{facet_of(in_.design, seen.triangle), region.height};
  const WithinSet within{nearer.facet, above_mm};
  // Places as near to their own feature as to another one stay: nobody else would answer for them.
  if (holds(within, part.body, kTouch) || holds(nearer, part.body, 0.0)) return std::nullopt;
  const double smallest = std::max(kSmallest, kSmallestShare * above_mm);
  if (radius < smallest || ++region_parts_ > kMostParts) return RegionState::kOpen;
  ConvexSet other = within;
  const auto offer = [&](const ConvexSet& set) {
    if (value(set, centre) > 0.0) return;
    const double most = most_over(set, part.body);
    if (most >= least) return;
    least = most;
    other = set;
    best = &other;
  };
  offer(within);
  offer(nearer);
  const stock::RawPoint raw = in_.stock.raw().at(centre);
  if (raw.distance_mm > -kTouch) offer(BeyondSet{raw.normal, raw.normal.dot(raw.foot)});
  if (best == nullptr && seen.distance_mm > above_mm && raw.distance_mm < -kTouch) {
    climb(centre, seen.distance_mm);
    return RegionState::kLeftover;
  }
  split(part, best, centre);
  return std::nullopt;
}

RegionState RegionProver::prove(const Region& region, double above_mm) {
  stack_.clear();
  region_parts_ = 0;
  stack_.push_back({region.body, {}, true});
  while (!stack_.empty()) {
    Part part = std::move(stack_.back());
    stack_.pop_back();
    ++parts_;
    const std::optional<RegionState> state = look_at(part, region, above_mm);
    if (state) return *state;
  }
  return RegionState::kProven;
}

}  // namespace swarf::proof
