#include "sim/job/flank_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/units.h"
#include "flank/extended_surface.h"
#include "flank/flank_check.h"
#include "kinematics/machine_model.h"
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
void check_limit(const FlankSettings& settings, const flank::FlankPass& pass, Diagnostics& diagnostics) {
  const flank::FlankTask& task = pass.task;
  const double limit = settings.motion.limit_mm;
  if (limit <= 0.0) return;
  const flank::WorstError worst = flank::worst_error(task);
  if (std::abs(worst.mm) + pass.motion.chord_mm < limit) return;
  flank::FlankTask best = task;
  best.placement = flank::Placement::kMinimax;
  diagnostics.error(
      "limit-unreachable", pass.where,
      fmt::format(
          "flank.limit_um = {:g} cannot be kept by any feed: the {} placement alone errs by {:.3f} um "
          "at u = {:.4f}, v = {:.3f}, and blocks may stray by {:g} um from it",
          um_from_mm(limit), flank::placement_name(task.placement), um_from_mm(worst.mm), worst.u, worst.v,
          um_from_mm(pass.motion.chord_mm)),
      fmt::format("placement = \"minimax\" errs by {:.3f} um; a smaller cutter errs less",
                  um_from_mm(std::abs(flank::worst_error(best).mm))));
}

/// What is milled, and how fast: a surface of the design.
struct Cut {
  size_t surface = 0;
  flank::FlankMotion motion;
  SourceLocation where;
};

/// Between two cycles every axis of the scene's machine goes evenly.
flank::ChordMiddle chord_middle(const Job& job) {
  struct Machine {
    kinematics::MachineModel model;
    kinematics::InverseKinematics inverse;
    explicit Machine(const kinematics::MachineModel& own) : model(own), inverse(model) {}
  };
  const auto machine = std::make_shared<const Machine>(machines_by_tool(job).front());
  kinematics::AxisValues home = kinematics::AxisValues::Zero();
  for (size_t i = 0; i < machine->model.axes.size(); ++i)
    home[static_cast<Eigen::Index>(i)] = machine->model.axes[i].home;
  return [machine, home](const ToolPose& from, const ToolPose& to) {
    const kinematics::Branch a = machine->inverse.solve_nearest(from, home);
    const kinematics::Branch b = machine->inverse.solve_nearest(to, a.q);
    const bool reached = a.outcome != kinematics::InverseOutcome::kUnreachable &&
                         b.outcome != kinematics::InverseOutcome::kUnreachable;
    return reached ? kinematics::forward(machine->model, 0.5 * (a.q + b.q)) : flank::between(from, to);
  };
}

flank::FlankMotion scene_motion(const Job& job) {
  flank::FlankMotion motion = job.scene.flank->motion;
  motion.period_s = job.scene.motion.period_s;
  motion.law = job.scene.block_law;
  motion.middle = chord_middle(job);
  return motion;
}

std::vector<Cut> cuts_of(const Job& job) {
  std::vector<Cut> cuts;
  const flank::FlankMotion motion = scene_motion(job);
  if (job.program.operations.empty())
    for (size_t s = 0; s < job.design.size(); ++s) cuts.push_back({s, motion, job.scene.flank->where});
  for (const program::Operation& operation : job.program.operations) {
    Cut cut{static_cast<size_t>(operation.surface), motion, operation.where};
    cut.motion.feed_mm_s = operation.feed_mm_s;
    cut.motion.chord_mm = operation.chord_tolerance_mm;
    cut.motion.spindle_rpm = operation.spindle_rpm;
    cuts.push_back(cut);
  }
  return cuts;
}

void add_passes(const Job& job, const Cut& cut, const flank::FlankProfile& profile,
                std::vector<flank::FlankPass>& passes) {
  const FlankSettings& settings = *job.scene.flank;
  const surface::SurfacePtr& surface = job.design[cut.surface];
  const double step = longest_ruling(*surface) / settings.depth_passes;
  const surface::SurfacePtr on = flank::extended(surface);
  const double before = settings.motion.overrun_mm / on->derivatives(0.0, 0.5).Su.norm();
  const double behind = settings.motion.overrun_mm / on->derivatives(1.0, 0.5).Su.norm();
  for (int k = settings.depth_passes - 1; k >= 0; --k) {
    flank::FlankPass pass;
    pass.task.surface = on;
    pass.task.profile = profile;
    pass.task.placement = settings.placement;
    pass.task.tip_below_mm = settings.tip_below_mm - k * step;
    pass.task.u_low = -before;
    pass.task.u_high = 1.0 + behind;
    pass.motion = cut.motion;
    pass.where = cut.where;
    pass.surface = cut.surface;
    passes.push_back(std::move(pass));
  }
}

/// The program's operations are all G06.5, or none of them is (its reader sees to it).
void check_operations(const Job& job, Diagnostics& diagnostics) {
  if (job.program.operations.empty()) return;
  const program::Operation& first = job.program.operations.front();
  if (first.kind == program::OperationKind::kFlank) return;
  diagnostics.error("flank-needs-g065", first.where,
                    "the scene has [flank], and its program mills with the end of the tool",
                    "write G06.5 for the side of the tool, or take [flank] out of the scene");
}

void check_ruled(const Job& job, Diagnostics& diagnostics) {
  bool ruled = !job.design.empty() && !job.design_mesh;
  for (const surface::SurfacePtr& surface : job.design) ruled = ruled && measure::is_ruled(*surface);
  if (!ruled)
    diagnostics.error(
        "flank-needs-ruled", job.scene.flank->where,
        "only ruled surfaces are milled by the flank, and the design is none",
        "[design] kind = \"ruled\", kind = \"nurbs\" of degree 1 along v, kind = \"ruled_faces\" of a "
        "CAD file, or a surface file of such");
}

/// The passes of one cutter, or what is wrong with it.
std::vector<flank::FlankPass> passes_of(const Job& job, const cutter::Cutter& cutter,
                                        Diagnostics& diagnostics) {
  const FlankSettings& settings = *job.scene.flank;
  std::vector<flank::FlankPass> passes;
  const std::optional<flank::FlankProfile> profile = flank::flank_profile(cutter);
  if (!profile) {
    diagnostics.error("no-flank", settings.where,
                      fmt::format("{} has no flank that could mill: {}", cutter::call_name(cutter),
                                  cutter::describe(cutter)),
                      "a cylinder, a taper or a barrel has one");
    return passes;
  }
  check_lower_end(settings, *profile, diagnostics);
  if (diagnostics.has_errors()) return passes;
  for (const Cut& cut : cuts_of(job)) add_passes(job, cut, *profile, passes);
  for (const flank::FlankPass& pass : passes) {
    flank::check_task(pass.task, pass.where, diagnostics);
    if (!diagnostics.has_errors()) check_limit(settings, pass, diagnostics);
    if (diagnostics.has_errors()) break;
  }
  return passes;
}

flank::WorstError worst_of(const std::vector<flank::FlankPass>& passes) {
  flank::WorstError worst;
  for (const flank::FlankPass& pass : passes) {
    const flank::WorstError own = flank::worst_error(pass.task);
    if (std::abs(own.mm) > std::abs(worst.mm)) worst = own;
  }
  return worst;
}

std::string reasons(const std::vector<FlankTool>& tools) {
  std::string all;
  for (const FlankTool& tool : tools)
    all += fmt::format("{}{}: {}", all.empty() ? "" : "; ", tool.name, tool.refused);
  return all;
}

/// Every tool is planned; the one that errs least stays.
void choose_tool(Job& job, Diagnostics& diagnostics) {
  std::optional<size_t> best;
  for (const cutter::Cutter& cutter : job.scene.tools) {
    FlankTool tool{cutter::call_name(cutter), "", {}, false};
    Diagnostics own;
    const std::vector<flank::FlankPass> passes = passes_of(job, cutter, own);
    if (own.has_errors()) {
      tool.refused = own.list().front().text;
    } else {
      tool.worst = worst_of(passes);
      const bool less = !best || std::abs(tool.worst.mm) < std::abs(job.flank_tools[*best].worst.mm);
      if (less) best = job.flank_tools.size();
    }
    job.flank_tools.push_back(tool);
  }
  if (!best) {
    diagnostics.error("no-tool-fits", job.scene.flank->where,
                      "no tool of the scene can mill the design by its flank: " + reasons(job.flank_tools),
                      "a tool that fits, or a larger flank.limit_um");
    return;
  }
  job.flank_tools[*best].used = true;
  job.scene.tools = {cutter::Cutter(job.scene.tools[*best])};
}

}  // namespace

void load_flank(Job& job, Diagnostics& diagnostics) {
  const auto start = std::chrono::steady_clock::now();
  check_operations(job, diagnostics);
  check_ruled(job, diagnostics);
  if (diagnostics.has_errors()) return;
  if (job.scene.flank->best_tool) choose_tool(job, diagnostics);
  if (diagnostics.has_errors()) return;
  job.flank = passes_of(job, job.scene.tools.front(), diagnostics);
  if (diagnostics.has_errors()) return;
  for (flank::FlankPass& pass : job.flank) flank::plan_pass(pass);
  job.flank_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

flank::FeedRule flank_rule(const Job& job) {
  return job.scene.flank->motion.limit_mm > 0.0 ? flank::FeedRule::kBisected : flank::FeedRule::kProgrammed;
}

}  // namespace swarf::sim
