#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/units.h"
#include "measure/measure.h"
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
  metrics.scallop_max_um = heights.back();
  metrics.scallop_mean_um = sum / static_cast<double>(heights.size());
  metrics.scallop_p05_um = percentile(heights, 0.05);
  metrics.scallop_p95_um = percentile(heights, 0.95);
}

/// Area that a ray stands for: |Su x Sv| du dv, half and quarter cells at the grid's edges.
double area_of_ray(const stock::SurfaceDexels& dexels, int iu, int iv) {
  const surface::Derivatives d = dexels.surface().derivatives(dexels.u(iu), dexels.v(iv));
  const double du = (iu == 0 || iu == dexels.nu() - 1 ? 0.5 : 1.0) / (dexels.nu() - 1);
  const double dv = (iv == 0 || iv == dexels.nv() - 1 ? 0.5 : 1.0) / (dexels.nv() - 1);
  return d.Su.cross(d.Sv).norm() * du * dv;
}

struct Sums {
  size_t within = 0;
  double deepest = 0.0, highest = 0.0;  ///< mm, both >= 0
};

void add_sample(const stock::SurfaceDexels& dexels, int iu, int iv, const MeasureLimits& limits,
                SurfaceMetrics& metrics, Sums& sums) {
  const size_t n = static_cast<size_t>(iv) * static_cast<size_t>(dexels.nu()) + static_cast<size_t>(iu);
  const double height = dexels.heights_mm()[n];
  const uint32_t block = dexels.blocks()[n];
  // A ray at the stock's very border starts with no material over the design: there is nothing left to cut.
  if (block == stock::kUncut && height > 0.0) ++metrics.uncut_samples;
  if (height >= -limits.gouge_mm && height <= limits.scallop_mm) ++sums.within;
  if (height < -limits.gouge_mm) metrics.gouge_area_mm2 += area_of_ray(dexels, iu, iv);
  if (-height > sums.deepest) {
    sums.deepest = -height;
    metrics.gouge_block = block;
  }
  if (height > sums.highest) {
    sums.highest = height;
    metrics.excess_block = block;
  }
}

void merge(const SurfaceMetrics& part, SurfaceMetrics& whole, double& within) {
  whole.samples += part.samples;
  whole.uncut_samples += part.uncut_samples;
  whole.gouge_area_mm2 += part.gouge_area_mm2;
  within += part.within_tolerance_pct * static_cast<double>(part.samples);
  if (part.gouge_max_um > whole.gouge_max_um) {
    whole.gouge_max_um = part.gouge_max_um;
    whole.gouge_block = part.gouge_block;
  }
  if (part.excess_max_um > whole.excess_max_um) {
    whole.excess_max_um = part.excess_max_um;
    whole.excess_block = part.excess_block;
  }
  whole.scallop_theory_um = std::max(whole.scallop_theory_um, part.scallop_theory_um);
}

}  // namespace

SurfaceMetrics measure_surface(const stock::SurfaceDexels& dexels, std::span<const stock::Sweep> sweeps,
                               std::span<const int> pass_of_sweep, const stock::CutterSolid& cutter,
                               const MeasureLimits& limits, std::vector<Ridge>* ridges) {
  SWARF_CHECK(sweeps.size() == pass_of_sweep.size(), "one pass number per sweep");
  for (const uint32_t block : dexels.blocks()) {
    const bool known = block == stock::kUncut || (block < sweeps.size() && sweeps[block].block == block);
    SWARF_CHECK(known, "sweeps must be indexed by the block that the dexels remember");
  }
  SurfaceMetrics metrics;
  metrics.samples = dexels.heights_mm().size();
  Sums sums;
  for (int iv = 0; iv < dexels.nv(); ++iv) {
    for (int iu = 0; iu < dexels.nu(); ++iu) add_sample(dexels, iu, iv, limits, metrics, sums);
  }
  metrics.gouge_max_um = um_from_mm(sums.deepest);
  metrics.excess_max_um = um_from_mm(sums.highest);
  metrics.within_tolerance_pct =
      100.0 * static_cast<double>(sums.within) / static_cast<double>(metrics.samples);
  const std::vector<Ridge> found = find_ridges(dexels, sweeps, pass_of_sweep, cutter);
  summarise_ridges(found, metrics);
  if (ridges != nullptr) ridges->insert(ridges->end(), found.begin(), found.end());
  return metrics;
}

SurfaceMetrics combine(const std::vector<SurfaceMetrics>& parts, const std::vector<Ridge>& ridges) {
  SurfaceMetrics whole;
  double within = 0.0;
  for (const SurfaceMetrics& part : parts) merge(part, whole, within);
  if (whole.samples > 0) whole.within_tolerance_pct = within / static_cast<double>(whole.samples);
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
