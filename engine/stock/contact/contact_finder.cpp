#include "stock/contact/contact_finder.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "stock/contact/contact_passage.h"
#include "stock/level_set/leaf_kernel.h"
#include "stock/level_set/stock_grid_internal.h"

namespace swarf::stock {
namespace {

constexpr double kHalfLeaf = 0.5 * (kLeafSide - 1);  // voxels, from the centre to the outer grid points
constexpr double kBoundGap = 0.05;                   // voxels: bounds need not be sharper
constexpr double kRounding = 1e-4;                   // voxels: of sums in single precision

/// Low to high, the lesser of two linear functions plus the values: a bit for each sum below `least`.
uint32_t row_below(const float* values, float first, float first_step, float second, float second_step,
                   float least, float reach) {
  uint32_t bits = 0;
  for (int k = 0; k < kLeafSide; ++k) {
    const auto n = static_cast<float>(k);
    const float bound = std::min(first + n * first_step, second + n * second_step);
    const bool open = values[k] + bound < least && values[k] <= reach;
    bits |= static_cast<uint32_t>(open) << static_cast<uint32_t>(k);
  }
  return bits;
}

}  // namespace

ContactFinder::ContactFinder(const Stock& stock, Tiles tiles)
    : stock_(stock), tiles_(tiles), voxel_(stock.voxel_mm()) {
  refresh();
}

double ContactFinder::deep_mm() const {
  return kDeep * voxel_;
}

void ContactFinder::refresh() {
  const LevelSet& set = stock_.level_set();
  const LeafMap& map = set.map;
  levels_.clear();
  Level level{{map.dimension.x(), map.dimension.y(), map.dimension.z()}, {}};
  level.material.resize(map.size());
  const auto height = static_cast<size_t>(map.dimension.z());
  for (size_t column = 0; column < map.size(); column += height) {
    if (tiles_ == Tiles::kOwn && !set.owns(column)) continue;
    for (size_t n = column; n < column + height; ++n)
      level.material[n] = map.states[n] != LeafState::kAir ? 1 : 0;
  }
  levels_.push_back(std::move(level));
  while (levels_.back().material.size() > 1) {
    const Level& low = levels_.back();
    Level up{{(low.size[0] + 1) / 2, (low.size[1] + 1) / 2, (low.size[2] + 1) / 2}, {}};
    const auto at = [&](int i, int j, int k) {
      return (static_cast<size_t>(i) * up.size[1] + j) * up.size[2] + k;
    };
    up.material.assign(at(up.size[0] - 1, up.size[1] - 1, up.size[2] - 1) + 1, 0);
    size_t n = 0;
    for (int i = 0; i < low.size[0]; ++i)
      for (int j = 0; j < low.size[1]; ++j)
        for (int k = 0; k < low.size[2]; ++k) up.material[at(i / 2, j / 2, k / 2)] |= low.material[n++];
    levels_.push_back(std::move(up));
  }
}

double ContactFinder::Bound::least(double half) const {
  return std::min(at[0] - half * slope[0].lpNorm<1>(), at[1] - half * slope[1].lpNorm<1>());
}

ContactFinder::Bound ContactFinder::bound_at(const SweepMap& map, const RevolvedPart& part,
                                             const Vec3& centre, double enough) const {
  const Vec3 start = map.start(centre), end = map.end(centre);
  const RevolvedPart::Nearest nearest = part.nearest(start, end - start, kBoundGap * voxel_, enough);
  Bound bound;
  bound.centre = centre;
  bound.at[0] = nearest.floor + nearest.normal.dot(start - nearest.place);
  bound.at[1] = nearest.floor + nearest.normal.dot(end - nearest.place);
  bound.slope[0] = map.R0t.transpose() * nearest.normal;
  bound.slope[1] = map.R1t.transpose() * nearest.normal;
  return bound;
}

double ContactFinder::value_at(size_t leaf, int place) const {
  const LevelSet& set = stock_.level_set();
  if (set.map.states[leaf] == LeafState::kLeaf) return set.values(leaf)[place];
  return set.map.states[leaf] == LeafState::kSolid ? -set.band() : set.band();
}

Vec3 ContactFinder::point_at(size_t leaf, int place) const {
  const openvdb::Coord origin = stock_.level_set().map.origin(leaf);
  return Vec3(origin.x() + place / 64, origin.y() + place / 8 % 8, origin.z() + place % 8) * voxel_;
}

size_t ContactFinder::candidates(size_t leaf, const Bound& bound, double least, double reach_voxels,
                                 uint16_t* places) const {
  const LevelSet& set = stock_.level_set();
  static constexpr int kRows = kLeafVoxels / kLeafSide;
  std::array<float, kLeafSide> solid;
  solid.fill(-set.band());
  const bool is_leaf = set.map.states[leaf] == LeafState::kLeaf;
  const float* values = is_leaf ? set.values(leaf) : solid.data();
  const auto below = static_cast<float>(least + kRounding * voxel_);
  const auto reach = static_cast<float>(reach_voxels * voxel_);
  const Vec3 first_step = bound.slope[0] * voxel_, second_step = bound.slope[1] * voxel_;
  size_t count = 0;
  for (int row = 0; row < kRows; ++row) {
    const Vec3 place(row / kLeafSide - kHalfLeaf, row % kLeafSide - kHalfLeaf, -kHalfLeaf);
    uint32_t open = row_below(
        is_leaf ? values + row * kLeafSide : values, static_cast<float>(bound.at[0] + first_step.dot(place)),
        static_cast<float>(first_step.z()), static_cast<float>(bound.at[1] + second_step.dot(place)),
        static_cast<float>(second_step.z()), below, reach);
    for (; open != 0; open &= open - 1)
      places[count++] = static_cast<uint16_t>(row * kLeafSide + __builtin_ctz(open));
  }
  return count;
}

void ContactFinder::each_leaf(const SweepMap& map, const RevolvedPart& part, const double& least,
                              const std::function<bool(size_t leaf, const Bound& bound)>& visit) const {
  const LevelSet& set = stock_.level_set();
  struct Cell {
    int level, i, j, k;
  };
  std::vector<Cell> open{{static_cast<int>(levels_.size()) - 1, 0, 0, 0}};
  while (!open.empty()) {
    const Cell cell = open.back();
    open.pop_back();
    const Level& level = levels_[static_cast<size_t>(cell.level)];
    const size_t index = (static_cast<size_t>(cell.i) * level.size[1] + cell.j) * level.size[2] + cell.k;
    if (level.material[index] == 0) continue;
    const int side = kLeafSide << cell.level;  // voxels
    const double half = 0.5 * (side - 1) * voxel_;
    const openvdb::Coord& lower = set.map.lower;
    const Vec3 centre =
        voxel_ * (Vec3(lower.x(), lower.y(), lower.z()) * kLeafSide + Vec3(cell.i, cell.j, cell.k) * side) +
        Vec3::Constant(half);
    const double most = least + set.band();  // no value lies below -band
    const Bound bound = bound_at(map, part, centre, most + std::sqrt(3.0) * half);
    if (bound.least(half) >= most) continue;
    if (cell.level == 0) {
      if (set.map.states[index] != LeafState::kAir && !visit(index, bound)) return;
      continue;
    }
    const Level& below = levels_[static_cast<size_t>(cell.level) - 1];
    for (int child = 0; child < 8; ++child) {
      const Cell next{cell.level - 1, 2 * cell.i + (child >> 2), 2 * cell.j + (child >> 1 & 1),
                      2 * cell.k + (child & 1)};
      if (next.i < below.size[0] && next.j < below.size[1] && next.k < below.size[2]) open.push_back(next);
    }
  }
}

double ContactFinder::gap(const SweepMap& map, const RevolvedPart& part, double above, double reach) const {
  const LevelSet& set = stock_.level_set();
  double best = above;
  each_leaf(map, part, best, [&](size_t leaf, const Bound& bound) {
    const LeafFloor& floor = set.map.floors[leaf];
    const Vec3 rise(floor.slope[0], floor.slope[1], floor.slope[2]);
    const double half = kHalfLeaf * voxel_;
    const double sum = floor.value + std::min(bound.at[0] - half * (bound.slope[0] + rise).lpNorm<1>(),
                                              bound.at[1] - half * (bound.slope[1] + rise).lpNorm<1>());
    if (sum >= best + kRounding * voxel_) return true;
    uint16_t places[kLeafVoxels];
    const size_t count = candidates(leaf, bound, best, reach, places);
    for (size_t n = 0; n < count; ++n) {
      const Vec3 point = point_at(leaf, places[n]);
      const Vec3 start = map.start(point);
      const double value = value_at(leaf, places[n]);
      const auto nearest = part.nearest(start, map.end(point) - start, kExactGap * voxel_, best - value);
      best = std::min(best, value + nearest.value);
      if (best < -deep_mm()) return false;
    }
    return true;
  });
  return best;
}

bool ContactFinder::may_be_shallow(const SweepMap& map, const RevolvedPart& part, double gap) const {
  // The sum is 2-Lipschitz, and every point has a grid point within kReach voxels.
  if (gap > 2.0 * kReach * voxel_) return false;
  const double hint = -kHint * voxel_;
  return this->gap(map, part, hint, kWide) < hint;
}

}  // namespace swarf::stock
