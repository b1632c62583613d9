#include "sim/job/flank_clearance.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/progress.h"
#include "base/units.h"
#include "collision/path_check.h"
#include "motion/cycles/cycles.h"
#include "sim/job/flank_job.h"
#include "sim/job/tool_bodies.h"

namespace swarf::sim {
namespace {

using collision::Body;
using collision::BodyKind;

/// Between a part of the tool and a fixture, over the whole motion.
struct Gap {
  double lower_mm = 0.0;  ///< proven
  std::string parts;      ///< "holder and hub"; "": none is nearer than what is asked
  ToolPose pose;          ///< about where
};

/// A move of all passes.
struct Shift {
  double slide_mm = 0.0, lift_low_mm = 0.0, lift_high_mm = 0.0;
};

std::vector<Body> obstacle_bodies(const Job& job) {
  std::vector<Body> bodies;
  for (Body& body : collision::link_bodies(job.machine)) {
    if (!job.machine.links[static_cast<size_t>(body.link)].fixture) continue;
    body.kind = BodyKind::kFixture;
    bodies.push_back(std::move(body));
  }
  return bodies;
}

Gap gap_of(const collision::PathFindings& findings, const std::vector<Body>& bodies,
           const toolpath::Elements& elements, double asked_mm) {
  Gap gap{asked_mm, "", {}};
  const auto take = [&](const collision::PairFindings& pair, double lower, int element) {
    if (!gap.parts.empty() && lower >= gap.lower_mm) return;
    gap = {lower, bodies[pair.a].name + " and " + bodies[pair.b].name,
           elements.block_end(static_cast<size_t>(element))};
  };
  for (const collision::PairFindings& pair : findings.pairs) {
    const bool tool =
        bodies[pair.a].kind == BodyKind::kToolPart || bodies[pair.b].kind == BodyKind::kToolPart;
    if (!tool) continue;
    if (!pair.contacts.empty())
      take(pair, 0.0, pair.contacts.front().first_element);
    else if (pair.near_miss.within)
      take(pair, std::max(0.0, pair.near_miss.lower), pair.near_miss.place.element);
  }
  return gap;
}

Gap least_gap(const Job& job, const std::vector<flank::FlankPass>& passes, double asked_mm) {
  std::vector<Body> bodies = obstacle_bodies(job);
  for (Body& body : tool_bodies(job)) bodies.push_back(std::move(body));
  collision::PathCheckOptions options;
  options.near_miss_mm = asked_mm;
  Diagnostics told;
  collision::PathCheck check(job.machine, std::move(bodies), options, told);
  const toolpath::ToolPath path = flank::flank_path(passes, flank_rule(job));
  const std::vector<kinematics::MachineModel> machines = machines_by_tool(job);
  motion::Cycles cycles(path.elements, machines, job.scene.tools.front(), job.scene.motion);
  Progress silent;
  cycles.walk([&](std::span<const motion::Cycle> window) { check.add(window); }, silent);
  const collision::PathFindings findings = check.finish();
  return gap_of(findings, check.bodies(), path.elements, asked_mm);
}

std::vector<flank::FlankPass> shifted(const Job& job, const Shift& shift) {
  std::vector<flank::FlankPass> passes = job.flank;
  for (flank::FlankPass& pass : passes) {
    pass.task.tip_below_mm -= shift.slide_mm;
    pass.task.lift_low_mm = shift.lift_low_mm;
    pass.task.lift_high_mm = shift.lift_high_mm;
    flank::plan_pass(pass);
  }
  return passes;
}

double worst_mm(const std::vector<flank::FlankPass>& passes) {
  double worst = 0.0;
  for (const flank::FlankPass& pass : passes)
    worst = std::max(worst, std::abs(flank::worst_error(pass.task).mm));
  return worst;
}

/// Tries moves one after the other until one is clear.
class ClearanceSearch {
 public:
  explicit ClearanceSearch(Job& job) : job_(job), asked_(*job.scene.flank->clearance_mm) {
    found_.asked_mm = asked_;
    nearest_ = least_gap(job_, job_.flank, asked_);
    found_.before_mm = best_mm_ = nearest_.lower_mm;
    found_.before_parts = nearest_.parts;
    clear_ = nearest_.parts.empty();
  }
  bool clear() const { return clear_; }
  const Gap& nearest() const { return nearest_; }
  const FlankClearance& found() const { return found_; }

  void try_shift(const Shift& shift) {
    if (clear_) return;
    std::vector<flank::FlankPass> passes = shifted(job_, shift);
    const double limit = job_.scene.flank->motion.limit_mm;
    if (limit > 0.0 && worst_mm(passes) >= limit) return;
    const Gap gap = least_gap(job_, passes, asked_);
    if (gap.parts.empty() || gap.lower_mm > best_mm_) nearest_ = gap, best_mm_ = gap.lower_mm;
    clear_ = gap.parts.empty();
    if (!clear_) return;
    job_.flank = std::move(passes);
    found_.slide_mm = shift.slide_mm;
    found_.lift_low_mm = shift.lift_low_mm;
    found_.lift_high_mm = shift.lift_high_mm;
  }

 private:
  Job& job_;
  double asked_, best_mm_ = 0.0;
  Gap nearest_;  ///< of the best move so far
  bool clear_ = false;
  FlankClearance found_;
};

void search_shifts(const Job& job, ClearanceSearch& search) {
  constexpr int kSlides = 8;
  const FlankSettings& settings = *job.scene.flank;
  const double room = settings.tip_below_mm - job.flank.front().task.profile.low;
  for (int i = 1; i <= kSlides; ++i) search.try_shift({room * i / kSlides, 0.0, 0.0});
  // Without a limit nobody says how much may stay on the surface.
  if (settings.motion.limit_mm <= 0.0 || search.clear()) return;
  constexpr double kWithin = 0.98;  // the lifted error stays below the limit
  const double lift = kWithin * (settings.motion.limit_mm - worst_mm(job.flank));
  search.try_shift({room, 0.0, lift});
  search.try_shift({room, lift, 0.0});
  search.try_shift({room, lift, lift});
}

}  // namespace

void keep_clear(Job& job, Diagnostics& diagnostics) {
  const FlankSettings& settings = *job.scene.flank;
  if (obstacle_bodies(job).empty()) {
    diagnostics.error("no-obstacle", settings.where,
                      "flank.clearance_mm asks for a distance from fixtures, and the scene has none",
                      "give the neighbouring blade and the hub as [[fixture]], or take the key out");
    return;
  }
  ClearanceSearch search(job);
  search_shifts(job, search);
  if (search.clear()) {
    job.flank_clearance = search.found();
    return;
  }
  const Gap& gap = search.nearest();
  const Vec3& p = gap.pose.tip_W;
  diagnostics.error(
      "flank-too-near", settings.where,
      fmt::format("{} come within {:.4f} mm of each other near the tip at ({:.3f}, {:.3f}, {:.3f}) mm, "
                  "whatever the axis is moved by within flank.limit_um; {:g} mm are asked for",
                  gap.parts, gap.lower_mm, p.x(), p.y(), p.z(), *settings.clearance_mm),
      "a thinner or longer tool, a larger flank.limit_um, or a smaller flank.clearance_mm");
}

}  // namespace swarf::sim
