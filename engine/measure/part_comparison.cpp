#include "measure/part_comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/units.h"
#include "measure/deviation_side.h"

namespace swarf::measure {
namespace {

/// Sums over the area that was measured.
struct Sums {
  double area = 0.0, value = 0.0, absolute = 0.0, squares = 0.0, within = 0.0;
};

void add_sample(const DeviationSample& sample, double area, const ComparisonInput& input,
                SideSummary& summary, Sums& sums, PartComparison& result) {
  if (sample.state == CellState::kBeyond) summary.beyond_mm2 += area;
  if (sample.state == CellState::kFar) summary.unmeasured_mm2 += area;
  if (sample.state != CellState::kMeasured) return;
  summary.area_mm2 += area;
  if (sample.inside > 0.0 && sample.raw > 0.0) return;
  const double um = um_from_mm(sample.raw);
  summary.greatest_um = std::max(summary.greatest_um, std::abs(um));
  if (sample.edge) {
    summary.edge_mm2 += area;
    result.edge_greatest_um = std::max(result.edge_greatest_um, std::abs(um));
  }
  sums.area += area;
  sums.value += area * um;
  sums.absolute += area * std::abs(um);
  sums.squares += area * um * um;
  if (sample.counted <= input.excess && -sample.counted <= input.gouge) sums.within += area;
}

void summarise(const SampledSide& side, const ComparisonInput& input, Sums& sums, PartComparison& result) {
  SideSummary& summary = side.side.on_design() ? result.design : result.stock;
  for (size_t c = 0; c < side.cells.size(); ++c) {
    if (!side.cells.is_leaf(c)) continue;
    ++summary.samples;
    add_sample(side.samples[c], area_of(side.cells.corners(c)), input, summary, sums, result);
  }
}

/// The leaves as a mesh; each vertex carries the worst deviation of the cells around it.
TriMesh deviation_map(const SampledSide& side) {
  TriMesh map;
  for (const Vec3& p : side.cells.points()) {
    map.positions.push_back(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  }
  map.deviation_um.assign(map.positions.size(), std::numeric_limits<float>::quiet_NaN());
  for (uint32_t c = 0; c < side.cells.size(); ++c) {
    if (!side.cells.is_leaf(c)) continue;
    map.triangles.push_back(side.cells[c].corners);
    if (side.samples[c].state != CellState::kMeasured) continue;
    const double excess = side.worst(c, false), gouge = side.worst(c, true);
    const double own = std::max(excess, gouge) > std::abs(side.samples[c].raw)
                           ? (excess > gouge ? excess : -gouge)
                           : side.samples[c].raw;
    const auto um = static_cast<float>(um_from_mm(own));
    for (const uint32_t v : side.cells[c].corners) {
      float& there = map.deviation_um[v];
      if (std::isnan(there) || std::abs(um) > std::abs(there)) there = um;
    }
  }
  return map;
}

}  // namespace

PartComparison compare_parts(const ComparisonInput& input) {
  SWARF_CHECK(input.stock != nullptr && input.design != nullptr, "a comparison needs two meshes");
  SWARF_CHECK(input.pitch > 0.0 && input.allowance >= 0.0, "pitch and allowance of a comparison");
  const ComparisonScene scene(input);
  SampledSide stock(scene, false), design(scene, true);
  const std::array<SampledSide*, 2> sides{&stock, &design};
  for (SampledSide* side : sides) side->sample();
  PartComparison result;
  prove_extremes(sides, input, result);
  Sums sums;
  for (const SampledSide* side : sides) summarise(*side, input, sums, result);
  if (sums.area > 0.0) {
    result.mean_um = sums.value / sums.area;
    result.mean_abs_um = sums.absolute / sums.area;
    result.rms_um = std::sqrt(sums.squares / sums.area);
    result.within_tolerance_pct = 100.0 * sums.within / sums.area;
  }
  const RegionMap map = connect_regions(sides, input);
  result.region_count = map.regions.size();
  result.regions.assign(
      map.regions.begin(),
      map.regions.begin() + static_cast<ptrdiff_t>(std::min(map.regions.size(), kListedDeviations)));
  measure_volumes(sides, map, input, result);
  result.stock_map = deviation_map(stock);
  result.design_map = deviation_map(design);
  return result;
}

}  // namespace swarf::measure
