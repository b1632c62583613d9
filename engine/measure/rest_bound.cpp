#include "measure/rest_bound.h"

#include <algorithm>

#include "measure/column_range.h"
#include "stock/rays/ray_height.h"

namespace swarf::measure {

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
                       double enough, std::span<const uint32_t> kept, std::span<const double> floors) {
  sets_.clear();
  owners_.clear();
  covered_.clear();
  sags_ = {kNever, kNever, kNever};
  add_box(input_.stock.box(), cell.shape, sets_);
  if (cell.raw_outside) sets_.push_back(*cell.raw_outside);
  sets_.insert(sets_.end(), own.begin(), own.end());
  for (const Corner& corner : cell.corners) add_owner(cell, corner.near, tops);
  HighestLeft left = left_by_sets();
  // Where the bound is highest, the sweep that is lowest there may lower it.
  constexpr size_t kMostOwners = 10;
  while (left.height > enough && left.height < kNever && owners_.size() < kMostOwners) {
    if (!add_owner(cell, owner_at(cell, left, kept, floors), tops)) break;
    const double before = left.height;
    const HighestLeft next = left_by_sets();
    if (!(next.height < before)) break;
    left = next;
    // Where it falls slowly, smaller cells do better.
    constexpr double kWorthwhile = 0.2;
    if (!(before - left.height > kWorthwhile * (before - enough))) break;
  }
  return left.height;
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
uint32_t RestBound::owner_at(const Cell& cell, const HighestLeft& left, std::span<const uint32_t> kept,
                             std::span<const double> floors) const {
  const CellCorner at = place_in(cell.shape, left.place, root_.bounds);
  double height = left.height;
  uint32_t owner = stock::kUncut;
  const auto look_at = [&](uint32_t n) {
    const double low = lowest_cut(at, near_[n], height, root_.cell.area_mm2() == 0.0, input_.field);
    if (low >= height) return;
    height = low;
    owner = n;
  };
  for (const uint32_t n : owners_) look_at(n);
  for (size_t k = 0; k < 3; ++k) {
    const uint32_t guess = between({cell.corners[k].near, cell.corners[(k + 1) % 3].near});
    if (guess < near_.size()) look_at(guess);
  }
  for (size_t i = 0; i < kept.size(); ++i) {
    if (floors[i] < height) look_at(kept[i]);
  }
  return owner;
}

}  // namespace swarf::measure
