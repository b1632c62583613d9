#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/units.h"
#include "measure/highest.h"
#include "measure/measure.h"
#include "measure/pass_rule.h"
#include "measure/regions.h"
#include "measure/ridges.h"

namespace swarf::measure {
namespace {

/// Value below which `share` of the sorted values lie, linear between them.
double percentile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<size_t>(place);
  const size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

void summarise_ridges(const std::vector<Ridge>& ridges, SurfaceMetrics& metrics) {
  metrics.ridges = ridges.size();
  if (ridges.empty()) return;
  std::vector<double> heights;
  double sum = 0.0;
  for (const Ridge& ridge : ridges) {
    heights.push_back(ridge.height_um);
    sum += ridge.height_um;
  }
  std::sort(heights.begin(), heights.end());
  // Passes that cross below the design leave nothing standing there.
  metrics.scallop_max_um = std::max(0.0, heights.back());
  metrics.scallop_mean_um = sum / static_cast<double>(heights.size());
  metrics.scallop_p05_um = percentile(heights, 0.05);
  metrics.scallop_p95_um = percentile(heights, 0.95);
}

/// The highest material on every ray and the block under or beside it.
struct Tops {
  std::vector<double> heights_mm;
  std::vector<uint32_t> blocks;
  size_t overhung = 0;
};

Tops tops_of(const stock::SurfaceDexels& dexels) {
  Tops tops{dexels.heights_mm(), dexels.blocks(), 0};
  uint32_t last = 0xffffffffU;
  dexels.each_above([&](uint32_t ray, const stock::MaterialAbove& m) {
    if (m.high - m.low < stock::kSliver) return;
    tops.overhung += ray != last ? 1 : 0;
    last = ray;
    tops.heights_mm[ray] = m.high;
    tops.blocks[ray] = m.high_block != stock::kUncut ? m.high_block : m.low_block;
  });
  return tops;
}

void keep_worst(std::vector<Region>& regions) {
  std::sort(regions.begin(), regions.end(), larger);
  if (regions.size() > kListedRegions) regions.resize(kListedRegions);
}

/// Areas and counts of the rays themselves.
void summarise_rays(const stock::SurfaceDexels& dexels, const Tops& tops, const MeasureLimits& limits,
                    SurfaceMetrics& metrics) {
  const stock::RayField& field = dexels.field();
  metrics.samples = field.size();
  metrics.overhung_samples = tops.overhung;
  double within = 0.0;
  for (size_t n = 0; n < field.size(); ++n) {
    const double height = dexels.heights_mm()[n], top = tops.heights_mm[n], area = field.areas_mm2[n];
    metrics.area_mm2 += area;
    // A ray at the stock's very border starts with no material over the design: there is nothing left to cut.
    if (dexels.blocks()[n] == stock::kUncut && height > 0.0) ++metrics.uncut_samples;
    if (height >= -limits.gouge_mm && top <= limits.scallop_mm) within += area;
    if (height < -limits.gouge_mm) metrics.gouge_area_mm2 += area;
    if (dexels.blocks()[n] == stock::kUncut && um_from_mm(-height) > metrics.missing_max_um) {
      metrics.missing_max_um = um_from_mm(-height);
      metrics.missing_place = field.points[n];
    }
    if (um_from_mm(top) > metrics.excess_max_um) {
      metrics.excess_max_um = um_from_mm(top);
      metrics.excess_top = field.points[n] + top * field.normals[n];
      metrics.excess_block = tops.blocks[n];
    }
  }
  metrics.within_tolerance_pct = 100.0 * within / metrics.area_mm2;
}

/// Material between the rays: a ridge stands as high as it was refined to.
void raise_excess(const std::vector<Ridge>& ridges, SurfaceMetrics& metrics) {
  for (const Ridge& ridge : ridges) {
    if (ridge.height_um <= metrics.excess_max_um) continue;
    metrics.excess_max_um = ridge.height_um;
    metrics.excess_top = ridge.top;
    metrics.excess_block = ridge.block_a;
  }
}

/// The rays around which the highest material is looked for: the highest ones, the worst of the worst
/// regions, and those beside the highest ridges.
std::vector<uint32_t> starts_of(const stock::RayField& field, const Tops& tops,
                                const std::vector<Region>& regions, const std::vector<Ridge>& ridges) {
  constexpr size_t kHighestRays = 16, kWorstRegions = 20, kHighestRidges = 8;
  std::vector<uint32_t> rays = highest_rays(field, tops.heights_mm, kHighestRays);
  for (size_t n = 0; n < std::min(kWorstRegions, regions.size()); ++n) rays.push_back(regions[n].ray);
  std::vector<Ridge> highest(std::min(kHighestRidges, ridges.size()));
  std::partial_sort_copy(ridges.begin(), ridges.end(), highest.begin(), highest.end(),
                         [](const Ridge& a, const Ridge& b) { return a.height_um > b.height_um; });
  for (const Ridge& ridge : highest) rays.push_back(ridge.ray);
  std::sort(rays.begin(), rays.end());
  rays.erase(std::unique(rays.begin(), rays.end()), rays.end());
  return rays;
}

/// `region_of`: of each ray, in metrics.excesses.
void refine_excess(const stock::RayField& field, std::span<const uint32_t> rays,
                   std::span<const uint32_t> region_of, double limit_mm, const PeakInput& input,
                   SurfaceMetrics& metrics) {
  const std::vector<Peak> peaks = find_peaks(field, rays, input);
  for (size_t n = 0; n < rays.size(); ++n) {
    const Peak& peak = peaks[n];
    const double um = um_from_mm(peak.height_mm);
    if (um > metrics.excess_max_um) {
      metrics.excess_max_um = um;
      metrics.excess_top = peak.top;
      metrics.excess_block = peak.block;
    }
    if (peak.height_mm > limit_mm)
      join_region({um, 0.0, 0.0, peak.place, peak.block, 0, rays[n], peak.top}, region_of[rays[n]],
                  field.pitch_mm, metrics.excesses);
  }
}

void merge(const SurfaceMetrics& part, SurfaceMetrics& whole, double& within) {
  whole.samples += part.samples;
  whole.area_mm2 += part.area_mm2;
  whole.overhung_samples += part.overhung_samples;
  whole.gouge_regions += part.gouge_regions;
  whole.excess_regions += part.excess_regions;
  whole.gouges.insert(whole.gouges.end(), part.gouges.begin(), part.gouges.end());
  whole.excesses.insert(whole.excesses.end(), part.excesses.begin(), part.excesses.end());
  whole.uncut_samples += part.uncut_samples;
  whole.gouge_area_mm2 += part.gouge_area_mm2;
  within += part.within_tolerance_pct * part.area_mm2;
  if (part.gouge_max_um > whole.gouge_max_um) {
    whole.gouge_max_um = part.gouge_max_um;
    whole.gouge_bottom = part.gouge_bottom;
    whole.gouge_block = part.gouge_block;
  }
  if (part.missing_max_um > whole.missing_max_um) {
    whole.missing_max_um = part.missing_max_um;
    whole.missing_place = part.missing_place;
  }
  if (part.excess_max_um > whole.excess_max_um) {
    whole.excess_max_um = part.excess_max_um;
    whole.excess_top = part.excess_top;
    whole.excess_block = part.excess_block;
  }
  whole.scallop_theory_um = std::max(whole.scallop_theory_um, part.scallop_theory_um);
}

}  // namespace

SurfaceMetrics measure_surface(const stock::SurfaceDexels& dexels, std::span<const stock::Sweep> sweeps,
                               std::span<const int> pass_of_sweep, const SweepCutters& cutters,
                               const MeasureLimits& limits, std::vector<Ridge>* ridges,
                               const RayMaterial* material) {
  SWARF_CHECK(pass_of_sweep.empty() || sweeps.size() == pass_of_sweep.size(),
              "one pass number per sweep, or none");
  for (const uint32_t block : dexels.blocks()) {
    const bool known = block == stock::kUncut || (block < sweeps.size() && sweeps[block].block == block);
    SWARF_CHECK(known, "sweeps must be indexed by the block that the dexels remember");
  }
  SurfaceMetrics metrics;
  const Tops tops = tops_of(dexels);
  summarise_rays(dexels, tops, limits, metrics);
  const PassRule rule(sweeps, pass_of_sweep, dexels.field().pitch_mm);
  Region deepest;
  metrics.gouges = find_gouges(dexels, sweeps, rule, cutters, limits.gouge_mm, &deepest);
  metrics.gouge_max_um = deepest.worst_um;
  metrics.gouge_bottom = deepest.end;
  metrics.gouge_block = deepest.block;
  const SweepIndex index(sweeps, cutters);
  const std::vector<Ridge> found = find_ridges(dexels, sweeps, rule, cutters, index);
  summarise_ridges(found, metrics);
  raise_excess(found, metrics);
  std::vector<uint32_t> region_of;
  metrics.excesses =
      find_regions(dexels.field(), tops.heights_mm, tops.blocks, limits.scallop_mm, &region_of);
  for (Region& region : metrics.excesses)
    region.end =
        dexels.field().points[region.ray] + tops.heights_mm[region.ray] * dexels.field().normals[region.ray];
  if (material != nullptr)
    refine_excess(dexels.field(), starts_of(dexels.field(), tops, metrics.excesses, found), region_of,
                  limits.scallop_mm, {*material, sweeps, cutters, index}, metrics);
  metrics.gouge_regions = metrics.gouges.size();
  metrics.excess_regions = metrics.excesses.size();
  keep_worst(metrics.gouges);
  keep_worst(metrics.excesses);
  if (ridges != nullptr) ridges->insert(ridges->end(), found.begin(), found.end());
  return metrics;
}

SurfaceMetrics combine(const std::vector<SurfaceMetrics>& parts, const std::vector<Ridge>& ridges) {
  SurfaceMetrics whole;
  double within = 0.0;
  for (const SurfaceMetrics& part : parts) merge(part, whole, within);
  if (whole.area_mm2 > 0.0) whole.within_tolerance_pct = within / whole.area_mm2;
  keep_worst(whole.gouges);
  keep_worst(whole.excesses);
  summarise_ridges(ridges, whole);
  return whole;
}

std::vector<HistogramBin> height_histogram(const stock::SurfaceDexels& dexels, double low_um, double high_um,
                                           int bins) {
  SWARF_CHECK(bins > 0 && high_um > low_um, "a histogram needs bins and a range");
  std::vector<HistogramBin> histogram;
  const double width = (high_um - low_um) / bins;
  for (int n = 0; n < bins; ++n) histogram.push_back({low_um + n * width, low_um + (n + 1) * width, 0});
  for (const double height : dexels.heights_mm()) {
    const double place = std::floor((um_from_mm(height) - low_um) / width);
    ++histogram[static_cast<size_t>(std::clamp(place, 0.0, static_cast<double>(bins - 1)))].count;
  }
  return histogram;
}

}  // namespace swarf::measure
