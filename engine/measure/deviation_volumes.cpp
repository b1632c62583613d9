// Volumes between stock and design.
#include <algorithm>
#include <cmath>
#include <limits>

#include "measure/deviation_side.h"
#include "measure/material_columns.h"
#include "mesh/mesh_check.h"

namespace swarf::measure {
namespace {

/// Regions whose cells look so much the same way are measured along their mean normal.
constexpr double kOneWay = 0.3;

/// Film between two surfaces: half of what either sees, which is right to the second order of the thickness
/// over the radius of curvature.
double film_volume(const std::array<SampledSide*, 2>& sides, const RegionMap& map, uint32_t region) {
  double volume = 0.0;
  for (size_t s = 0; s < 2; ++s) {
    for (uint32_t c = 0; c < map.region_of[s].size(); ++c) {
      if (map.region_of[s][c] != region) continue;
      volume += 0.5 * area_of(sides[s]->cells.corners(c)) * std::abs(sides[s]->samples[c].raw);
    }
  }
  return volume;
}

/// Columns along the mean normal of a region, over its extent.
ColumnGrid grid_over(const std::array<SampledSide*, 2>& sides, const RegionMap& map, uint32_t region) {
  const auto each_cell = [&](const auto& visit) {
    for (size_t s = 0; s < 2; ++s) {
      for (uint32_t c = 0; c < map.region_of[s].size(); ++c) {
        if (map.region_of[s][c] == region) visit(sides[s]->cells.corners(c));
      }
    }
  };
  Vec3 sum = Vec3::Zero();
  double area = 0.0;
  each_cell([&](const Corners& c) {
    sum += 0.5 * (c[1] - c[0]).cross(c[2] - c[0]);
    area += area_of(c);
  });
  ColumnGrid grid;
  grid.frame = column_frame(sum.norm() > kOneWay * area ? sum : Vec3(0.53, 0.61, 0.59));
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  each_cell([&](const Corners& corners) {
    for (const Vec3& corner : corners) {
      low = low.cwiseMin(grid.frame * corner);
      high = high.cwiseMax(grid.frame * corner);
    }
  });
  grid.low_u = low.x();
  grid.low_v = low.y();
  grid.step_u = std::max(high.x() - low.x(), 1e-6) / grid.n;
  grid.step_v = std::max(high.y() - low.y(), 1e-6) / grid.n;
  return grid;
}

double column_volume(const std::array<SampledSide*, 2>& sides, const RegionMap& map, uint32_t region) {
  const ColumnGrid grid = grid_over(sides, map, region);
  const auto belongs = [&](const ColumnEnd& end) {
    const size_t s = end.design ? 1 : 0;
    return map.region_of[s][sides[s]->cells.leaf_at(end.triangle, end.point)] == region;
  };
  double length = 0.0;
  each_run(sides[0]->side.own().mesh(), sides[1]->side.own().mesh(), grid, [&](const ColumnRun& run) {
    if (run.gouge == map.regions[region].gouge && (belongs(run.ends[0]) || belongs(run.ends[1])))
      length += run.length_mm;
  });
  return length * grid.step_u * grid.step_v;
}

}  // namespace

void measure_volumes(const std::array<SampledSide*, 2>& sides, const RegionMap& map,
                     const ComparisonInput& input, PartComparison& result) {
  const bool solids = !input.open_design && input.allowance == 0.0;
  for (uint32_t i = 0; i < result.regions.size(); ++i) {
    result.regions[i].volume_mm3 = solids ? column_volume(sides, map, i) : film_volume(sides, map, i);
  }
  if (!solids) return;
  const TriMesh &stock = input.stock->mesh(), &design = input.design->mesh();
  const MaterialVolumes volumes = volumes_between(stock, design);
  result.excess_mm3 = volumes.excess_mm3;
  result.gouge_mm3 = volumes.gouge_mm3;
  result.difference_mm3 = mesh::enclosed_volume(stock) - mesh::enclosed_volume(design);
}

}  // namespace swarf::measure
