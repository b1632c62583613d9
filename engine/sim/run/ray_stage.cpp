#include "sim/run/ray_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "base/units.h"
#include "measure/measure.h"
#include "sim/run/design_rays.h"
#include "sim/run/ray_cutters.h"
#include "sim/run/result.h"
#include "sim/run/tile_ranks.h"
#include "stock/rays/free_ranges.h"

namespace swarf::sim {
namespace {

/// Of making and cutting the measuring rays, which for a mesh of a million facets take half a minute.
constexpr int kRaySteps = 5;

std::vector<stock::RayFieldPtr> same_rays(const MeasuredPath& measured) {
  std::vector<stock::RayFieldPtr> fields;
  for (const stock::SurfaceDexels& dexels : measured.dexels) fields.push_back(dexels.field_ptr());
  return fields;
}

double theory_scallop_um(const toolpath::ToolPath& path) {
  double highest = 0.0;
  for (size_t i = 0; i < path.elements.size(); ++i) {
    if (const auto* pass = path.elements.pass(i)) highest = std::max(highest, pass->scallop_theory_mm);
  }
  return um_from_mm(highest);
}

/// Each surface of the design.
std::vector<measure::SurfaceMetrics> measured_parts(const Job& job, MeasuredPath& measured) {
  std::vector<measure::SurfaceMetrics> parts;
  if (measured.dexels.empty()) return parts;
  const RayCutters rays = ray_cutters(job, measured);
  const measure::MeasureLimits limits{job.scene.accept.scallop_band_um() * kMicrometre,
                                      job.scene.accept.gouge_band_um() * kMicrometre};
  const measure::SweepCutters cutters(rays.solids, rays.solid_of);
  const stock::FreeRange ranges(same_rays(measured));
  const stock::RawShape raw = job.scene.stock.body_W();
  const measure::RayMaterial material{raw, ranges};
  for (const stock::SurfaceDexels& dexels : measured.dexels)
    parts.push_back(measure::measure_surface(dexels, measured.rays.sweeps, rays.passes, cutters, limits,
                                             &measured.ridges, &material));
  return parts;
}

void take_rays(Ranks& ranks, int rank, std::vector<stock::SurfaceDexels>& dexels) {
  const std::vector<Bytes> told = rays_of(ranks, rank);
  bool same = told.size() == dexels.size();
  for (size_t i = 0; same && i < dexels.size(); ++i)
    same = dexels[i].take_tiles(told[i], {rank, ranks.size()});
  if (!same)
    throw InputError("rank-differs", {fmt::format("rank {}", rank)}, "this rank measures another design",
                     "give every machine the same program, version and files");
}

}  // namespace

void cut_ray_share(const Job& job, MeasuredPath& measured, Share share, const std::function<void()>& step,
                   const MeasuredPath* same_design) {
  if (job.has_design()) {
    JobSweeps own =
        measured.rays.sweeps.empty() ? ray_sweeps(job, *measured.cycles) : std::move(measured.rays);
    measured.rays = with_carried(std::move(own), *measured.carried);
  }
  step();
  const auto fields = same_design != nullptr ? same_rays(*same_design) : design_rays(job, measured.mesh_rays);
  step();
  measured.dexels = design_dexels(job, fields);
  step();
  const RayCutters rays = ray_cutters(job, measured);
  const auto tool_of = [&](uint32_t block) { return rays.solid_of[block]; };
  for (stock::SurfaceDexels& dexels : measured.dexels) {
    for_each_tool(measured.rays.sweeps, tool_of, [&](size_t tool, std::span<const stock::Sweep> part) {
      dexels.cut(part, rays.solids[tool], share);
    });
  }
  step();
}

void cut_dexels(const Job& job, MeasuredPath& measured, Progress& progress, Ranks* ranks,
                const MeasuredPath* same_design) {
  const auto start = std::chrono::steady_clock::now();
  if (ranks != nullptr) ask_for_rays(*ranks);
  progress.begin("cut measuring rays", kRaySteps, "steps");
  cut_ray_share(
      job, measured, ranks != nullptr ? share_of(*ranks) : Share{},
      [&, done = 0]() mutable { progress.advance(++done); }, same_design);
  for (int rank = 1; ranks != nullptr && rank < ranks->size(); ++rank)
    take_rays(*ranks, rank, measured.dexels);
  for (stock::SurfaceDexels& dexels : measured.dexels) dexels.limit_depths();
  progress.end();
  measured.dexel_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void measure_dexels(const Job& job, MeasuredPath& measured) {
  measured.surface = measure::combine(measured_parts(job, measured), measured.ridges);
  measured.surface.scallop_theory_um = theory_scallop_um(measured.path);
}

}  // namespace swarf::sim
