#include "sim/run/flank_figures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "base/minima.h"
#include "measure/flank_error.h"
#include "motion/blocks/block_motion.h"
#include "motion/interpolator.h"
#include "sim/job/flank_job.h"
#include "sim/run/flank_rays.h"
#include "sim/run/result.h"

namespace swarf::sim {
namespace {

void add_height(double height, const Vec3& place, FlankHeights& all) {
  if (height > all.greatest_mm) all.greatest_mm = height, all.greatest_W = place;
  if (height < all.least_mm) all.least_mm = height, all.least_W = place;
}

void add_heights(const Heights& heights, const stock::SurfaceDexels& dexels, FlankHeights& all) {
  for (size_t i = 0; i < heights.size(); ++i)
    if (heights[i]) add_height(*heights[i], dexels.points()[i], all);
}

void compare(const Heights& predicted, const stock::SurfaceDexels& dexels, FlankFigures& figures) {
  for (size_t i = 0; i < predicted.size(); ++i) {
    // Where nothing was cut the stock ends below the envelope.
    if (!predicted[i] || dexels.blocks()[i] == stock::kUncut) {
      ++figures.rays_elsewhere;
      continue;
    }
    ++figures.rays_compared;
    add_height(dexels.heights_mm()[i], dexels.points()[i], figures.cut);
    const double difference = std::abs(*predicted[i] - dexels.heights_mm()[i]);
    if (difference <= figures.difference_max_mm) continue;
    figures.difference_max_mm = difference;
    figures.difference_W = dexels.points()[i];
  }
}

std::vector<FlankProfileRow> profile_of(const Heights& predicted, const stock::SurfaceDexels& dexels) {
  std::vector<FlankProfileRow> rows;
  for (int iu = 0; iu < dexels.nu(); ++iu) {
    FlankProfileRow row;
    row.u = dexels.u(iu);
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    row.predicted_least_mm = row.measured_least_mm = kInfinity;
    row.predicted_greatest_mm = row.measured_greatest_mm = -kInfinity;
    for (int iv = 0; iv < dexels.nv(); ++iv) {
      const auto i = static_cast<size_t>(iv * dexels.nu() + iu);
      if (!predicted[i]) continue;
      row.predicted_least_mm = std::min(row.predicted_least_mm, *predicted[i]);
      row.predicted_greatest_mm = std::max(row.predicted_greatest_mm, *predicted[i]);
      row.measured_least_mm = std::min(row.measured_least_mm, dexels.heights_mm()[i]);
      row.measured_greatest_mm = std::max(row.measured_greatest_mm, dexels.heights_mm()[i]);
    }
    if (std::isfinite(row.predicted_least_mm)) rows.push_back(row);
  }
  return rows;
}

double height_or_nan(const std::optional<double>& height) {
  return height.value_or(std::numeric_limits<double>::quiet_NaN());
}

FlankMap map_of(const Heights& predicted, const stock::SurfaceDexels& dexels) {
  FlankMap map;
  for (int iu = 0; iu < dexels.nu(); ++iu) map.u.push_back(dexels.u(iu));
  for (int iv = 0; iv < dexels.nv(); ++iv) map.v.push_back(dexels.v(iv));
  for (size_t i = 0; i < map.u.size() * map.v.size(); ++i) {
    const bool cut = dexels.blocks()[i] != stock::kUncut;
    map.predicted_mm.push_back(height_or_nan(predicted[i]));
    map.cut_mm.push_back(cut ? dexels.heights_mm()[i] : height_or_nan({}));
  }
  return map;
}

/// Greatest of what `next` differs from `base`.
void widen(const Heights& base, const Heights& next, double& most) {
  for (size_t i = 0; i < base.size(); ++i)
    if (base[i] && next[i]) most = std::max(most, std::abs(*next[i] - *base[i]));
}

void add_envelopes(const Job& job, const MeasuredPath& measured, FlankFigures& figures) {
  const std::vector<PosedPass> exact = exact_poses(job), blocks = block_poses(job, *measured.cycles),
                               cycles = cycle_poses(job, *measured.cycles);
  const bool by_cycles = job.scene.stock.cut_by == CutBy::kCycles;
  for (size_t s = 0; s < measured.dexels.size(); ++s) {
    const stock::SurfaceDexels& dexels = measured.dexels[s];
    const SurfaceEnvelope of_blocks(job, blocks, s), of_cycles(job, cycles, s);
    const Heights on_axes = heights_of({job, exact, s}, dexels);
    const Heights at_blocks = heights_of(of_blocks, dexels), at_cycles = heights_of(of_cycles, dexels);
    add_heights(on_axes, dexels, figures.placed);
    add_heights(at_blocks, dexels, figures.blocks_left);
    const double most = figures.cycles_left.most_mm();
    add_heights(at_cycles, dexels, figures.cycles_left);
    if (figures.cycles_left.most_mm() > most)
      figures.worst_element = of_cycles.element_at(figures.cycles_left.most_W());
    widen(on_axes, at_blocks, figures.blocks_add_mm);
    widen(at_blocks, at_cycles, figures.cycles_add_mm);
    const Heights& cut = by_cycles ? at_cycles : at_blocks;
    compare(cut, dexels, figures);
    figures.maps.push_back(map_of(cut, dexels));
    if (s == 0) figures.profile = profile_of(cut, dexels);
  }
}

/// e of the chords that the cycles of a path make.
class ChordErrors {
 public:
  ChordErrors(const Job& job, const motion::Cycles& cycles) : job_(job), elements_(cycles.elements()) {
    motion::CycleReader reader(cycles);
    motion::Cycle last;
    int last_pass = -1;
    for (size_t k = 0; k < cycles.size(); ++k) {
      const motion::Cycle cycle = reader.at(k);
      const int pass = pass_of(elements_, static_cast<size_t>(cycle.sample.element));
      if (pass != last_pass) u_ = 0.0;
      // Half way each axis has gone half of its way.
      if (pass >= 0 && pass == last_pass)
        add(kinematics::forward(cycles.machines().front(), 0.5 * (last.q + cycle.q)), pass);
      last = cycle;
      last_pass = pass;
    }
  }
  double least_mm = 0.0, greatest_mm = 0.0;

 private:
  void add(const ToolPose& pose, int pass) {
    const flank::FlankTask& task = job_.flank[static_cast<size_t>(pass)].task;
    const double middle = 0.5 * (std::max(task.profile.low, task.tip_below_mm) + task.profile.high);
    const flank::Foot foot =
        flank::foot_of(*task.surface, pose.tip_W + middle * pose.axis_W, std::clamp(u_, 0.0, 1.0), 0.5);
    if (!(foot.u > 0.0 && foot.u < 1.0)) return;
    u_ = foot.u;
    const flank::AxisError error = flank::axis_error(task, pose, foot.u);
    least_mm = std::min(least_mm, error.least_mm);
    greatest_mm = std::max(greatest_mm, error.greatest_mm);
  }
  const Job& job_;
  const toolpath::Elements& elements_;
  double u_ = 0.0;
};

FlankFeedRow feed_row(const Job& job, const MeasuredPath& measured, flank::FeedRule rule,
                      const std::string& name) {
  FlankFeedRow row;
  row.name = name;
  row.used = rule == flank_rule(job);
  motion::MotionResult result;
  std::unique_ptr<motion::Cycles> own;
  const motion::Cycles* cycles = measured.cycles.get();
  if (row.used) {
    result.statistics = measured.motion.statistics;
  } else {
    own = std::make_unique<motion::Cycles>(flank::flank_path(job.flank, rule).elements, machines_by_tool(job),
                                           job.scene.tools.front(), job.scene.motion);
    Progress silent;
    result = motion::interpolate(*own, silent);
    cycles = own.get();
  }
  const ChordErrors errors(job, *cycles);
  row.least_mm = errors.least_mm;
  row.greatest_mm = errors.greatest_mm;
  row.time_s = result.statistics.time_s;
  const double feeding = result.statistics.cycle.feed_s;
  row.feed_mean_mm_s = feeding > 0.0 ? result.statistics.path_length_mm / feeding : 0.0;
  return row;
}

void add_geometry(const Job& job, FlankFigures& figures) {
  const auto depths = static_cast<size_t>(job.scene.flank->depth_passes);
  figures.surfaces = job.design.size();
  figures.passes = job.flank.size();
  for (const flank::FlankPass& pass : job.flank) figures.blocks += pass.stations.size() - 1;
  figures.plan_seconds = job.flank_seconds;
  constexpr int kRulings = 512;
  for (const flank::FlankPass& pass : job.flank) {
    const auto twist = [&](double u) { return measure::ruling_twist(*pass.task.surface, u); };
    figures.twist_max_rad =
        std::max(figures.twist_max_rad, greatest_sampled(twist, 0.0, 1.0, kRulings).value);
  }
  for (size_t k = depths - 1; k < job.flank.size(); k += depths) {
    const auto bound = [&](double u) { return flank::twist_bound(job.flank[k].task, u); };
    figures.twist_bound_mm =
        std::max(figures.twist_bound_mm, greatest_sampled(bound, 0.0, 1.0, kRulings).value);
  }
  for (const flank::Placement placement :
       {flank::Placement::kPublished, flank::Placement::kBalanced, flank::Placement::kMinimax}) {
    FlankPlacementRow row{flank::placement_name(placement), {}, placement == job.scene.flank->placement};
    for (size_t k = depths - 1; k < job.flank.size(); k += depths) {
      flank::FlankTask task = job.flank[k].task;
      task.placement = placement;
      const flank::WorstError worst = flank::worst_error(task);
      if (std::abs(worst.mm) > std::abs(row.worst.mm)) row.worst = worst;
    }
    figures.placements.push_back(row);
  }
  const flank::FlankTask& first = job.flank.front().task;
  figures.guides = {flank::guide_figures(*first.surface, 0.0), flank::guide_figures(*first.surface, 1.0)};
  const double corner = figures.guides[0].radius_min_mm;
  constexpr double kPaperPeriod = 1e-3;
  if (std::isfinite(corner)) {
    figures.feed_1um_mm_s = flank::sagitta_feed(corner, kPaperPeriod, 1e-3);
    figures.feed_5um_mm_s = flank::sagitta_feed(corner, kPaperPeriod, 5e-3);
  }
  // Ma et al., limits of their C axis.
  constexpr flank::RotaryLimit kPaperC{0.8, 0.5};
  constexpr double kPaperPlace = 0.6;
  figures.c_feed = flank::c_limited_feed(*first.surface, kPaperPlace, kPaperC);
  figures.c_feed_least = flank::least_c_feed(*first.surface, kPaperC);
}

}  // namespace

FlankFigures flank_figures(const Job& job, const MeasuredPath& measured, Progress& progress) {
  progress.begin("flank: envelope and feeds", 3, "steps");
  FlankFigures figures;
  add_geometry(job, figures);
  progress.advance(1);
  add_envelopes(job, measured, figures);
  progress.advance(2);
  using flank::FeedRule;
  if (job.scene.flank->motion.limit_mm > 0.0) {
    figures.feeds.push_back(feed_row(job, measured, FeedRule::kBisected, "bisected"));
    figures.feeds.push_back(feed_row(job, measured, FeedRule::kConstant, "constant, same limit"));
    figures.feeds.push_back(feed_row(job, measured, FeedRule::kCurvature, "curvature of the guides alone"));
  }
  figures.feeds.push_back(feed_row(job, measured, FeedRule::kProgrammed, "as programmed"));
  if (job.scene.flank->all_machines) figures.machines = flank_machines(job, measured.dexels);
  progress.end();
  return figures;
}

}  // namespace swarf::sim
