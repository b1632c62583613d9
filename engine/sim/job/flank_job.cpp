#include "sim/job/flank_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/units.h"
#include "flank/extended_surface.h"
#include "flank/flank_check.h"
#include "measure/flank_error.h"

namespace swarf::sim {
namespace {

double longest_ruling(const surface::Surface& S) {
  constexpr int kRulings = 256;
  double longest = 0.0;
  for (int i = 0; i <= kRulings; ++i)
    longest = std::max(longest, S.derivatives(static_cast<double>(i) / kRulings, 0.0).Sv.norm());
  return longest;
}

/// The last pass reaches guide curve 0 with its flank, not with the end of the cutter.
void check_lower_end(const FlankSettings& settings, const flank::FlankProfile& profile,
                     Diagnostics& diagnostics) {
  if (settings.tip_below_mm >= profile.low) return;
  diagnostics.error("flank-above-guide", settings.where,
                    fmt::format("the flank begins {:.3f} mm above the tip, and guide curve 0 (v = 0) lies "
                                "{:g} mm above it: the end of the cutter would stand there",
                                profile.low, settings.tip_below_mm),
                    fmt::format("flank.tip_below_mm = {:.3f} or more", std::ceil(1e3 * profile.low) / 1e3));
}

/// No feed goes below the placement's own error.
void check_limit(const FlankSettings& settings, const flank::FlankTask& task, Diagnostics& diagnostics) {
  const double limit = settings.motion.limit_mm;
  if (limit <= 0.0) return;
  const flank::WorstError worst = flank::worst_error(task);
  if (std::abs(worst.mm) < limit) return;
  flank::FlankTask best = task;
  best.placement = flank::Placement::kMinimax;
  diagnostics.error(
      "limit-unreachable", settings.where,
      fmt::format(
          "flank.limit_um = {:g} cannot be kept by any feed: the {} placement alone errs by {:.3f} um "
          "at u = {:.4f}, v = {:.3f}",
          um_from_mm(limit), flank::placement_name(task.placement), um_from_mm(worst.mm), worst.u, worst.v),
      fmt::format("placement = \"minimax\" errs by {:.3f} um; a smaller cutter errs less",
                  um_from_mm(std::abs(flank::worst_error(best).mm))));
}

void add_tasks(const FlankSettings& settings, const surface::SurfacePtr& surface,
               const flank::FlankProfile& profile, std::vector<FlankPass>& passes) {
  const double step = longest_ruling(*surface) / settings.depth_passes;
  const surface::SurfacePtr on = flank::extended(surface);
  const double before = settings.motion.overrun_mm / on->derivatives(0.0, 0.5).Su.norm();
  const double behind = settings.motion.overrun_mm / on->derivatives(1.0, 0.5).Su.norm();
  for (int k = settings.depth_passes - 1; k >= 0; --k)
    passes.push_back(
        {{on, profile, settings.placement, settings.tip_below_mm - k * step, -before, 1.0 + behind}, {}});
}

}  // namespace

flank::FlankMotion flank_motion(const Job& job) {
  flank::FlankMotion motion = job.scene.flank->motion;
  motion.period_s = job.scene.motion.period_s;
  motion.law = job.scene.block_law;
  return motion;
}

void load_flank(Job& job, Diagnostics& diagnostics) {
  const FlankSettings& settings = *job.scene.flank;
  const auto start = std::chrono::steady_clock::now();
  bool ruled = !job.design.empty() && !job.design_mesh;
  for (const surface::SurfacePtr& surface : job.design) ruled = ruled && measure::is_ruled(*surface);
  if (!ruled)
    diagnostics.error("flank-needs-ruled", settings.where,
                      "only ruled surfaces are milled by the flank, and the design is none",
                      "[design] kind = \"ruled\", kind = \"nurbs\" of degree 1 along v, or a surface file "
                      "of such");
  const std::optional<flank::FlankProfile> profile = flank::flank_profile(job.scene.tools.front());
  if (!profile)
    diagnostics.error(
        "no-flank", settings.where,
        fmt::format("{} has no flank that could mill: {}", cutter::call_name(job.scene.tools.front()),
                    cutter::describe(job.scene.tools.front())),
        "a cylinder, a taper or a barrel has one");
  if (!ruled || !profile) return;
  check_lower_end(settings, *profile, diagnostics);
  if (diagnostics.has_errors()) return;
  for (const surface::SurfacePtr& surface : job.design) add_tasks(settings, surface, *profile, job.flank);
  for (const FlankPass& pass : job.flank) {
    flank::check_task(pass.task, settings.where, diagnostics);
    if (!diagnostics.has_errors()) check_limit(settings, pass.task, diagnostics);
    if (diagnostics.has_errors()) return;
  }
  for (FlankPass& pass : job.flank)
    pass.stations = flank::stations_of(pass.task, flank_motion(job), settings.where);
  job.flank_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

flank::FeedRule flank_rule(const Job& job) {
  return job.scene.flank->motion.limit_mm > 0.0 ? flank::FeedRule::kBisected : flank::FeedRule::kProgrammed;
}

toolpath::ToolPath flank_path(const Job& job, flank::FeedRule rule) {
  std::vector<std::vector<flank::Station>> stations;
  for (const FlankPass& pass : job.flank) stations.push_back(pass.stations);
  return flank::flank_path(stations, flank_motion(job), rule, job.scene.flank->where);
}

}  // namespace swarf::sim
