#include "sim/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "base/side_by_side.h"
#include "cutter/profile.h"
#include "motion/interpolator.h"
#include "sim/job/design_place.h"
#include "sim/job/driven_part.h"
#include "sim/judge/findings.h"
#include "sim/run/cycle_sweeps.h"
#include "sim/run/design_rays.h"
#include "sim/run/highest_place.h"
#include "sim/run/missing_material.h"
#include "sim/run/prove_part.h"
#include "sim/run/ray_cutters.h"
#include "sim/run/ray_stage.h"
#include "sim/run/recorder.h"
#include "sim/run/shot_places.h"
#include "sim/run/starting_clamping.h"
#include "sim/run/tile_ranks.h"
#include "toolpath/feed_way.h"

namespace swarf::sim {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The tables that the options ask for.
class Tables {
 public:
  Tables(const Job& job, const motion::Cycles& cycles, const CutOptions& options) {
    if (options.save_folder.empty()) return;
    blocks_.emplace(options.save_folder + "/" + kBlockTable, job, cycles);
    if (const TrajectoryFormat format = job.scene.output.trajectory; format != TrajectoryFormat::kNone)
      cycles_ = open_cycle_table(options.save_folder + "/" + cycle_table_name(format), job, cycles);
  }
  void add(std::span<const motion::Cycle> window) {
    if (blocks_) blocks_->add(window);
    if (cycles_) cycles_->add(window);
  }
  void finish() {
    if (blocks_) blocks_->finish();
    if (cycles_) cycles_->finish();
  }

 private:
  std::optional<BlockTable> blocks_;
  std::unique_ptr<CycleTable> cycles_;
};

void prepare_cycles(const Job& job, const motion::MotionOptions& options, MeasuredPath& measured) {
  measured.cycles = std::make_unique<motion::Cycles>(measured.path.elements, machines_by_tool(job),
                                                     job.scene.tools.front(), options);
}

/// What is made of the cycles while they pass.
enum class Beside {
  kNothing,
  kSweeps,  ///< what cuts the measuring rays, where it is one sweep for each cycle
  kWhole    ///< contacts of links, fixtures and tools, and what each tool does
};

void interpolate(const Job& job, const motion::MotionOptions& options, const CutOptions& output,
                 Progress& progress, MeasuredPath& measured, Beside beside = Beside::kNothing) {
  const auto start = std::chrono::steady_clock::now();
  prepare_cycles(job, options, measured);
  Tables tables(job, *measured.cycles, output);
  std::optional<MachineContactCheck> contacts;
  std::optional<OperationMeter> operations;
  if (beside == Beside::kWhole) {
    contacts.emplace(job);
    operations.emplace(job, *measured.cycles);
  }
  std::optional<CycleSweeps> sweeps;
  if (beside == Beside::kSweeps && one_sweep_each_cycle(job))
    sweeps.emplace(measured.cycles->machines().front());
  if (output.outputs.page && !output.save_folder.empty()) measured.keys.emplace(job.machine.model.axes);
  measured.envelope = {job.machine.model.axes.size(), options.period_s};
  measured.motion =
      motion::interpolate(*measured.cycles, progress, [&](std::span<const motion::Cycle> window) {
        measured.envelope.add(window);
        if (measured.keys) measured.keys->add(window);
        if (contacts) contacts->add(window);
        if (operations) operations->add(window);
        if (sweeps) sweeps->add(window);
        tables.add(window);
      });
  if (measured.keys) measured.keys->finish();
  if (contacts) measured.contacts = contacts->finish();
  if (operations) measured.operations = operations->operations();
  if (sweeps) measured.rays = sweeps->take();
  tables.finish();
  measured.motion_seconds = seconds_since(start);
}

MeasuredPath plan_and_move(const Job& job, toolpath::Planner planner, const CarriedCutsPtr& carried,
                           Progress& progress) {
  MeasuredPath measured;
  measured.carried = carried;
  const auto start = std::chrono::steady_clock::now();
  Diagnostics diagnostics;
  measured.path = path_by(job, planner, diagnostics);
  measured.plan_seconds = seconds_since(start);
  interpolate(job, job.scene.motion, {}, progress, measured, Beside::kSweeps);
  return measured;
}

/// The path alone, and what was cut before it.
MeasuredPath planned_path(const Job& job, Progress& progress) {
  MeasuredPath measured;
  progress.begin("plan", 1, "paths");
  Diagnostics diagnostics;
  JobPath found = job_path(job, diagnostics);
  measured.path = std::move(found.path);
  measured.nc = std::move(found.nc);
  measured.carried = carried_cuts(job);
  check_starting_clamping(job, *measured.carried, diagnostics);
  diagnostics.throw_if_errors();
  measured.warnings = diagnostics.list();
  progress.end();
  return measured;
}

InputError path_misses_stock(const Job& job, const std::string& how) {
  return {"path-misses-stock",
          {job.scene.file},
          fmt::format("the path never meets the stock: {}", how),
          fmt::format("move {} to where the path is (both are in the work frame, mm)",
                      job.scene.stock.raw.spoken_key())};
}

/// What would bring the path to the stock where they lie apart: middle to middle, in Z the path's highest
/// place to the stock's upper face.
Vec3 shift_to_stock(const Box& path, const Box& stock, double radius) {
  Vec3 shift = Vec3::Zero();
  for (int i = 0; i < 3; ++i) {
    const double reach = i < 2 ? radius : 0.0;
    if (path.lower[i] - reach < stock.upper[i] && path.upper[i] + reach > stock.lower[i]) continue;
    shift[i] = i < 2 ? stock.centre()[i] - path.centre()[i] : stock.upper.z() - path.upper.z();
  }
  return shift;
}

/// Says where the feed moves are, and the offset that is missing.
InputError blocks_miss_stock(const Job& job, const toolpath::Elements& elements) {
  const toolpath::FeedWay way = toolpath::feed_way(elements);
  const Box& stock = job.scene.stock.box_W;
  if (way.feeds == 0)
    return {"path-misses-stock",
            {job.scene.file},
            "the path never meets the stock: the program has no feed move, and its rapids stay clear of it",
            "name the program that cuts"};
  double radius = 0.0;
  for (const cutter::Cutter& tool : job.scene.tools) radius = std::max(radius, tool.radius());
  const Vec3 shift = shift_to_stock(way.box_W, stock, radius);
  const std::string how = fmt::format("nothing was cut; its feed moves take the tip over {}, the stock is {}",
                                      spoken_box(way.box_W), spoken_box(stock));
  if (shift.isZero()) return path_misses_stock(job, how);
  return {
      "path-misses-stock",
      {job.scene.file},
      "the path never meets the stock: " + how,
      fmt::format("an offset of X {:.3f} Y {:.3f} Z {:.3f} mm brings the path there (setup.offsets of the "
                  "work offset that is used, or the tool length that was not called); or {} moves "
                  "by X {:.3f} Y {:.3f} Z {:.3f}",
                  shift.x(), shift.y(), shift.z(), job.scene.stock.raw.spoken_key(), 0.0 - shift.x(),
                  0.0 - shift.y(), 0.0 - shift.z())};
}

/// What the program was warned of may explain its fault.
InputError with_warnings(const std::vector<Diagnostic>& warnings, const InputError& error) {
  Diagnostics all;
  for (const Diagnostic& one : warnings) all.warning(one.code, one.where, one.text, one.fix);
  all.append(error.diagnostics);
  return InputError(all);
}

/// A path that stays a cutter's reach away from the stock is a wrong scene, not a clean run.
void require_contact(const Job& job, const motion::Cycles& cycles) {
  const stock::RawShape raw = job.scene.stock.body_W();
  const double reach = job.scene.tools.front().radius();
  double nearest = std::numeric_limits<double>::infinity();
  motion::CycleReader reader(cycles);
  for (size_t k = 0; k < cycles.size(); ++k) {
    const motion::ToolSample& sample = reader.at(k).sample;
    if (sample.kind != motion::SampleKind::kCutting) continue;
    nearest = std::min(nearest, std::max(0.0, raw.distance_mm(sample.contact_W)));
  }
  if (nearest <= reach) return;
  throw path_misses_stock(
      job, fmt::format("it stays {:.1f} mm away from {}", nearest, job.scene.stock.raw.spoken_key()));
}

ComparisonRow row_of(const std::string& name, const MeasuredPath& measured, bool used) {
  ComparisonRow row;
  row.name = name;
  row.passes = measured.path.passes;
  row.pass_length_mm = measured.path.pass_length_mm;
  row.link_length_mm = measured.path.link_length_mm;
  row.time_s = measured.motion.statistics.time_s;
  row.orientation_error_max_rad = measured.motion.statistics.orientation_error_max_rad;
  row.feed_error_max_rel = measured.motion.statistics.feed_error_max_rel;
  row.chord_error_max_mm = measured.motion.statistics.chord_error_max_mm;
  row.surface = measured.surface;
  row.used = used;
  return row;
}

/// Rows that do not depend on each other, two at a time: planning and interpolating keep one processor each.
/// `row_of_case(n)`: none where it is left out.
template <typename RowOfCase>
std::vector<ComparisonRow> rows_of(size_t count, Progress& progress, const RowOfCase& row_of_case) {
  std::vector<std::optional<ComparisonRow>> found(count);
  side_by_side(
      count, kComparedAtOnce,
      [&](size_t n) {
        if (!progress.stop_requested()) found[n] = row_of_case(n);
      },
      [&](size_t n) { progress.advance(static_cast<double>(n + 1)); });
  std::vector<ComparisonRow> rows;
  for (std::optional<ComparisonRow>& row : found)
    if (row) rows.push_back(std::move(*row));
  return rows;
}

void compare_planners(const Job& job, Progress& progress, Result& result) {
  using toolpath::Planner;
  const std::vector<Planner> planners{Planner::kIsoparametric, Planner::kLinKoren, Planner::kConstantScallop};
  progress.begin("compare planners", static_cast<double>(planners.size()), "planners");
  result.planners = rows_of(planners.size(), progress, [&](size_t n) -> std::optional<ComparisonRow> {
    const std::string name = toolpath::planner_name(planners[n]);
    if (planners[n] == job.scene.toolpath.planner) return row_of(name, result.main, true);
    if (!job.scene.compare_planners) return {};
    Progress silent;
    MeasuredPath other = plan_and_move(job, planners[n], result.main.carried, silent);
    cut_dexels(job, other, silent, nullptr, &result.main);
    measure_dexels(job, other);
    return row_of(name, other, false);
  });
  progress.end();
}

/// The paper's comparison: real-time interpolation against off-line segments, with and without look-ahead
/// (E19).
void compare_modes(const Job& job, Progress& progress, Result& result) {
  struct Case {
    const char* name;
    motion::Mode mode;
    bool look_ahead;
  };
  const std::vector<Case> cases{{"surface", motion::Mode::kSurface, false},
                                {"taylor1 (Eq. 5)", motion::Mode::kTaylor1, false},
                                {"offline, stop at each block", motion::Mode::kOffline, false},
                                {"offline, look-ahead", motion::Mode::kOffline, true}};
  progress.begin("compare interpolators", static_cast<double>(cases.size()), "modes");
  result.modes = rows_of(cases.size(), progress, [&](size_t n) -> std::optional<ComparisonRow> {
    const Case& one = cases[n];
    if (!job.scene.compare_planners) return {};
    const bool used = one.mode == job.scene.motion.mode &&
                      (one.mode != motion::Mode::kOffline || one.look_ahead == job.scene.motion.look_ahead);
    if (used) return row_of(one.name, result.main, true);
    motion::MotionOptions options = job.scene.motion;
    options.mode = one.mode;
    options.look_ahead = one.look_ahead;
    MeasuredPath other;
    other.path = result.main.path;
    other.carried = result.main.carried;
    Progress silent;
    interpolate(job, options, {}, silent, other, Beside::kSweeps);
    cut_dexels(job, other, silent, nullptr, &result.main);
    measure_dexels(job, other);
    return row_of(one.name, other, false);
  });
  progress.end();
}

/// Distances of a path's cutting cycles, and of the middles of their chords, from the exact passes.
void measure_positions(const Job& job, const MeasuredPath& exact, const MeasuredPath& measured,
                       DrivenRow& row) {
  std::vector<motion::ExactPath> passes;
  const kinematics::MachineModel machine = machines_by_tool(job).front();
  const kinematics::InverseKinematics inverse(machine);
  for (size_t i = 0; i < exact.path.elements.size(); ++i)
    if (const auto* pass = exact.path.elements.driven(i))
      passes.emplace_back(*pass, machine, inverse, job.scene.motion);
  const auto pass_of = [&](const motion::ToolSample& sample) {
    const auto element = static_cast<size_t>(sample.element);
    if (const auto* driven = measured.path.elements.driven(element)) return driven->pass;
    return measured.path.elements.hold_blocks() ? measured.path.elements.block(element).pass : -1;
  };
  double squares = 0.0;
  size_t count = 0;
  std::optional<motion::ToolSample> last;
  motion::CycleReader reader(*measured.cycles);
  for (size_t k = 0; k < measured.cycles->size(); ++k) {
    const motion::ToolSample sample = reader.at(k).sample;
    const int pass = sample.kind == motion::SampleKind::kCutting ? pass_of(sample) : -1;
    if (pass < 0) {
      last.reset();
      continue;
    }
    const auto see = [&](const Vec3& tip) {
      const double error = passes[static_cast<size_t>(pass)].distance(tip);
      row.position_error_max_mm = std::max(row.position_error_max_mm, error);
      squares += error * error;
      ++count;
    };
    if (last && pass_of(*last) == pass) see(0.5 * (last->pose.tip_W + sample.pose.tip_W));
    see(sample.pose.tip_W);
    last = sample;
  }
  row.position_error_rms_mm = count > 0 ? std::sqrt(squares / static_cast<double>(count)) : 0.0;
}

DrivenRow driven_row(const Job& job, const MeasuredPath& exact, const MeasuredPath& measured) {
  DrivenRow row;
  row.name = measured.path.planner;
  const toolpath::Elements& elements = measured.path.elements;
  row.blocks = elements.hold_blocks() ? elements.size() : 1;
  for (size_t i = 0; elements.hold_blocks() && i < elements.size(); ++i) {
    const Vec3 to = elements.block_end(i).tip_W;
    row.program_bytes +=
        fmt::formatted_size("N{} G1 X{:.4f} Y{:.4f} Z{:.4f}\n", i + 1, to.x(), to.y(), to.z());
  }
  const motion::MotionStatistics& statistics = measured.motion.statistics;
  row.time_s = statistics.time_s;
  row.feed_mean_mm_s =
      statistics.cycle.feed_s > 0.0 ? statistics.path_length_mm / statistics.cycle.feed_s : 0.0;
  row.feed_lowest_mm_s = statistics.feed_min_mm_s;
  row.surface = measured.surface;
  measure_positions(job, exact, measured, row);
  return row;
}

/// Kato et al.'s comparison: the surface itself, and what a CAM system makes of it.
void compare_driven(const Job& job, Progress& progress, Result& result) {
  const DrivenSettings& driven = *job.scene.driven;
  std::vector<double> tolerances = driven.compare_mm;
  tolerances.insert(tolerances.begin(), 0.0);
  const double used = driven.plan.cam_tolerance_mm;
  if (std::find(tolerances.begin(), tolerances.end(), used) == tolerances.end()) tolerances.push_back(used);
  progress.begin("compare with CAM paths", static_cast<double>(tolerances.size()), "paths");
  Progress silent;
  MeasuredPath exact;
  Diagnostics told;
  exact.path = driven_path(job, 0.0, told);
  const kinematics::MachineModel machine = machines_by_tool(job).front();
  const kinematics::InverseKinematics inverse(machine);
  result.driven = motion::check_driven(exact.path.elements, machine, inverse, job.scene.motion);
  for (const double tolerance : tolerances) {
    if (progress.stop_requested()) break;
    MeasuredPath other;
    if (tolerance != used) {
      other.path = driven_path(job, tolerance, told);
      other.carried = result.main.carried;
      interpolate(job, job.scene.motion, {}, silent, other);
      cut_dexels(job, other, silent, nullptr, &result.main);
      measure_dexels(job, other);
    }
    DrivenRow row = driven_row(job, exact, tolerance == used ? result.main : other);
    row.cam_tolerance_mm = tolerance;
    row.used = tolerance == used;
    result.driven_rows.push_back(std::move(row));
    progress.advance(static_cast<double>(result.driven_rows.size()));
  }
  progress.end();
}

/// Removed, by earlier set-ups too, and left add up to the raw stock. The level set rounds its edges too
/// while it is uncut, so what was removed is the difference of two volumes, and what is left the rest of the
/// exact body.
void measure_volume(const Job& job, Result& result) {
  const double removed = result.full_mm3 - result.volume_left_mm3;
  result.volume_left_mm3 = job.scene.stock.body_W().volume_mm3() - removed;
  if (!result.volume_range) result.volume_range = result.stock->volume_between(result.sweep_bound_mm);
  result.volume_error_bound_mm3 = std::max(result.volume_range->greatest - result.volume_left_mm3,
                                           result.volume_left_mm3 - result.volume_range->least);
}

void measure_part(const Job& job, Progress& progress, Result& result) {
  progress.begin("measure", 2, "steps");
  measure_dexels(job, result.main);
  raise_missing(job, result.main.surface);
  progress.advance(1);
  const RayCutters rays = ray_cutters(job, result.main);
  const measure::SweepCutters cutters(rays.solids, rays.solid_of);
  const double sweep_bound = result.sweep_bound_mm + result.main.rays.error_bound_mm;
  std::vector<measure::CrossCheck> checks;
  for (const stock::SurfaceDexels& dexels : result.main.dexels) {
    if (dexels.field().surface == nullptr) continue;  // its bound needs the curvature of a surface
    checks.push_back(
        measure::cross_check(*result.stock, dexels, result.main.rays.sweeps, cutters, sweep_bound));
  }
  result.cross_check = measure::combine(checks);
  progress.end();
}

/// Radius of the cutter's cylindrical flank, mm; none when its flank is no cylinder.
std::optional<double> flank_radius(const cutter::Cutter& cutter) {
  const std::optional<cutter::AptForm> form = cutter::apt_form(cutter);
  if (!form || form->beta != 0.0 || form->flank_end().y() <= form->flank_start().y()) return std::nullopt;
  return 0.5 * form->d;
}

void measure_flank(const Job& job, Progress& progress, Result& result) {
  if (job.scene.design.name != "ruled" || job.scene.tools.size() != 1) return;
  const std::optional<double> radius = flank_radius(job.scene.tools.front());
  if (!radius) return;
  progress.begin("flank error", 1, "surfaces");
  result.flank = measure::flank_error(*job.design.front(), *radius);
  progress.end();
}

}  // namespace

MeasuredPath plan_tool(const Job& job, Progress& progress) {
  MeasuredPath measured = planned_path(job, progress);
  prepare_cycles(job, job.scene.motion, measured);
  return measured;
}

namespace {

/// `run`: more than the motion will follow: contacts are looked at, and what the storyboard names is there.
MeasuredPath moved_tool(const Job& job, Progress& progress, const CutOptions& options, bool run) {
  MeasuredPath measured = planned_path(job, progress);
  const bool movie = run && options.outputs.pictures;
  if (movie) {
    require_shot_lines(job.scene.movie, measured.path.elements, job.scene.stock.box_W);
    require_still_shots(job.scene.stills, job.scene.stock.box_W,
                        job.design_mesh != nullptr || !job.design.empty());
  }
  interpolate(job, job.scene.motion, options, progress, measured, run ? Beside::kWhole : Beside::kNothing);
  if (movie && !measured.cycles->stopped()) require_shots(job.scene.movie, *measured.cycles);
  // Of blocks nobody knows the contact points before they cut.
  if (!measured.path.elements.hold_blocks() && !measured.cycles->stopped())
    require_contact(job, *measured.cycles);
  return measured;
}

}  // namespace

MeasuredPath move_tool(const Job& job, Progress& progress, const CutOptions& options) {
  return moved_tool(job, progress, options, false);
}

void serve_tiles(const Job& job, const CutOptions& options, Ranks& ranks, Progress& progress) {
  MeasuredPath measured;
  std::optional<CutParts> parts;
  try {
    // Blocks are swept as they are: who only cuts them needs no cycles.
    measured = job.scene.stock.cut_by == CutBy::kBlocks ? plan_tool(job, progress)
                                                        : moved_tool(job, progress, {}, false);
    parts.emplace(job, *measured.cycles, *measured.carried);
  } catch (const InputError& error) {
    refuse_tile_lead(ranks, error.what());
    return;
  }
  serve_tile_lead(ranks,
                  {job, *parts, measured, [&] { cut_ray_share(job, measured, share_of(ranks), [] {}); },
                   may_go_ahead(options), rank_limit_mb(job, options, ranks)});
}

namespace {

/// The memory of the run, told and refused where it is too much.
void predict(const Job& job, const CutOptions& options, Progress& progress, Result& result) {
  MemoryPrediction& memory = result.memory;
  result.main.mesh_rays = mesh_rays(job);
  memory = predict_memory(job, result.main, options.outputs, options.check_voxels ? 2 : 1);
  if (options.max_memory_mb > 0.0) memory.limit_mb = options.max_memory_mb;
  const int ranks = options.ranks != nullptr ? options.ranks->size() : 1;
  if (ranks == 1) {
    if (!options.spill) require_memory(job, memory);
    progress.note(fmt::format("memory: stock {:.0f} MB, whole run {:.0f} MB expected; limit {:.0f} MB",
                              memory.stock_mb, memory.peak_mb, memory.limit_mb));
    return;
  }
  memory.limit_mb = rank_limit_mb(job, options, *options.ranks);
  const double other_mb = other_rank_mb(job, memory, ranks);
  progress.note(fmt::format(
      "memory: stock {:.0f} MB, rank 0 {:.0f} MB, each of {} other ranks {:.0f} MB expected; limit "
      "{:.0f} MB for each",
      memory.stock_mb, memory.peak_mb, ranks - 1, other_mb, memory.limit_mb));
  MemoryPrediction most = memory;
  most.peak_mb = std::max(memory.peak_mb, other_mb);
  require_memory(job, most, ranks);
}

}  // namespace

Result simulate(const Job& job, const CutOptions& options, Progress& progress) {
  Result result;
  result.main = moved_tool(job, progress, options, true);
  if (result.main.cycles->stopped()) {
    leave_uncut(job, options, result);
    result.stopped = true;
    return result;
  }
  predict(job, options, progress, result);
  cut_stock(job, options, progress, result);
  measure_volume(job, result);
  result.stopped = progress.stop_requested();
  if (result.stopped) return result;
  const bool planned = !result.main.path.elements.hold_blocks();
  if (!planned && result.volume_removed_mm3 <= 0.0)
    throw with_warnings(result.main.warnings, blocks_miss_stock(job, result.main.path.elements));
  cut_dexels(job, result.main, progress, options.ranks);
  measure_part(job, progress, result);
  prove_part(job, options.ranks, progress, result);
  if (options.ranks != nullptr) dismiss_ranks(*options.ranks);  // they end while this one writes
  end_on_part(job, result.main);
  measure_flank(job, progress, result);
  if (job.scene.flank) result.flank_milling = flank_figures(job, result.main, progress);
  // A program of blocks is one path: there is nothing to compare it with.
  if (job.driven) {
    compare_driven(job, progress, result);
  } else if (planned) {
    compare_planners(job, progress, result);
    compare_modes(job, progress, result);
  }
  progress.begin("singularity", 1, "paths");
  result.singularity =
      motion::scan_singularity(result.main.path, machines_by_tool(job), job.scene.linearise_tolerance_mm);
  progress.end();
  result.stopped = progress.stop_requested();
  result.checks = judge(job, result);
  result.findings = find_faults(job, result);
  return result;
}

}  // namespace swarf::sim
