// Cells beyond a limit that hang together.
#include <algorithm>
#include <numeric>

#include "measure/deviation_side.h"

#include "base/disjoint_sets.h"

namespace swarf::measure {
namespace {

/// The violating cells of one sign on both sides, numbered through.
struct Violators {
  std::array<std::vector<uint32_t>, 2> cells;      ///< per side
  std::array<std::vector<uint32_t>, 2> number_of;  ///< per side and cell; kNoDeviationRegion

  size_t size() const { return cells[0].size() + cells[1].size(); }
  uint32_t cell(size_t number) const {
    return number < cells[0].size() ? cells[0][number] : cells[1][number - cells[0].size()];
  }
  size_t side(size_t number) const { return number < cells[0].size() ? 0 : 1; }
};

Violators find_violators(const std::array<SampledSide*, 2>& sides, bool gouge, double limit) {
  Violators violators;
  uint32_t count = 0;
  for (size_t s = 0; s < 2; ++s) {
    violators.number_of[s].assign(sides[s]->cells.size(), kNoDeviationRegion);
    for (uint32_t c = 0; c < sides[s]->cells.size(); ++c) {
      if (sides[s]->worst(c, gouge) <= limit) continue;
      violators.cells[s].push_back(c);
      violators.number_of[s][c] = count++;
    }
  }
  return violators;
}

void join_neighbours(const SampledSide& side, const std::vector<uint32_t>& cells,
                     const std::vector<uint32_t>& number_of, DisjointSets& sets) {
  std::vector<uint32_t> first(side.cells.points().size(), kNoDeviationRegion);
  for (const uint32_t cell : cells) {
    side.cells.each_point(cell, [&](uint32_t point) {
      if (first[point] == kNoDeviationRegion) first[point] = number_of[cell];
      sets.join(first[point], number_of[cell]);
    });
  }
}

void join_across(const SampledSide& side, const SampledSide& other, const std::vector<uint32_t>& cells,
                 const std::vector<uint32_t>& number_of, const std::vector<uint32_t>& other_numbers,
                 DisjointSets& sets) {
  for (const uint32_t cell : cells) {
    const DeviationSample& sample = side.samples[cell];
    const uint32_t opposite = other_numbers[other.cells.leaf_at(sample.facet, sample.foot)];
    if (opposite != kNoDeviationRegion) sets.join(number_of[cell], opposite);
  }
}

void add_regions(const std::array<SampledSide*, 2>& sides, bool gouge, double limit, RegionMap& map) {
  const Violators violators = find_violators(sides, gouge, limit);
  DisjointSets sets(violators.size());
  for (size_t s = 0; s < 2; ++s) {
    join_neighbours(*sides[s], violators.cells[s], violators.number_of[s], sets);
    join_across(*sides[s], *sides[1 - s], violators.cells[s], violators.number_of[s],
                violators.number_of[1 - s], sets);
  }
  std::vector<uint32_t> region_of_root(violators.size(), kNoDeviationRegion);
  for (uint32_t n = 0; n < violators.size(); ++n) {
    const uint32_t root = sets.root(n), cell = violators.cell(n);
    const size_t s = violators.side(n);
    if (region_of_root[root] == kNoDeviationRegion) {
      region_of_root[root] = static_cast<uint32_t>(map.regions.size());
      map.regions.emplace_back().gouge = gouge;
    }
    DeviationRegion& region = map.regions[region_of_root[root]];
    map.region_of[s][cell] = region_of_root[root];
    (s == 0 ? region.stock_area_mm2 : region.design_area_mm2) += area_of(sides[s]->cells.corners(cell));
    const double um = 1e3 * sides[s]->worst(cell, gouge);
    if (um <= region.worst_um) continue;
    region.worst_um = um;
    region.on_design = s == 1;
    region.place = sides[s]->worst_place(cell, gouge);
  }
}

}  // namespace

RegionMap connect_regions(const std::array<SampledSide*, 2>& sides, const ComparisonInput& input) {
  RegionMap map;
  for (size_t s = 0; s < 2; ++s) map.region_of[s].assign(sides[s]->cells.size(), kNoDeviationRegion);
  add_regions(sides, false, input.excess, map);
  add_regions(sides, true, input.gouge, map);
  std::vector<uint32_t> order(map.regions.size()), rank(map.regions.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return map.regions[a].worst_um > map.regions[b].worst_um; });
  std::vector<DeviationRegion> sorted;
  for (uint32_t i = 0; i < order.size(); ++i) {
    rank[order[i]] = i;
    sorted.push_back(map.regions[order[i]]);
  }
  map.regions = std::move(sorted);
  for (auto& of_side : map.region_of) {
    for (uint32_t& region : of_side) region = region == kNoDeviationRegion ? region : rank[region];
  }
  return map;
}

}  // namespace swarf::measure
