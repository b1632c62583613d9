#include "avoidance/trial.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/units.h"
#include "cutter/cutter.h"
#include "post/shipped.h"
#include "sim/run/cut_stage.h"
#include "sim/simulation.h"

namespace swarf::avoidance {
namespace {

using kinematics::AxisKind;

/// Lines alone: arcs and cycles are looked at as the moves that they stand for.
post::PostFormat plain(post::PostFormat format) {
  format.motion.clockwise = format.motion.counter_clockwise = {};
  format.cycle.drill = format.cycle.drill_dwell = format.cycle.deep = format.cycle.chip_break = {};
  format.cycle.bore = format.cycle.bore_dwell = format.cycle.tap = {};
  return format;
}

/// Stops where the caller does, and once enough has been seen.
class UntilEnough : public Progress {
 public:
  UntilEnough(const Progress& outer, const std::atomic<bool>& enough) : outer_(outer), enough_(enough) {}
  bool stop_requested() const override { return enough_ || outer_.stop_requested(); }

 private:
  const Progress& outer_;
  const std::atomic<bool>& enough_;
};

}  // namespace

post::PostOptions options_of(const sim::Job& job) {
  const sim::PostSettings& given = *job.scene.post;
  post::PostOptions options;
  options.tip_mm = given.tolerance_mm;
  options.axis_rad = given.axis_tolerance_rad;
  options.cl = job.scene.cl_options;
  if (!given.planes.empty()) options.planes = post::plane_use(given.planes);
  for (const cutter::Cutter& tool : job.scene.tools)
    options.tools.push_back({tool.number, tool.name, cutter::gauge_length(tool)});
  return options;
}

void extend(sim::Job& job, const std::vector<double>& extended_mm) {
  for (size_t i = 0; i < extended_mm.size(); ++i) {
    cutter::Cutter& tool = job.scene.tools[i];
    tool.length_mm += extended_mm[i];
    if (tool.gauge_length_mm) *tool.gauge_length_mm += extended_mm[i];
  }
}

std::optional<Failure> material_failure(const sim::Job& job) {
  sim::Result result;
  Progress silent;
  result.main = sim::move_tool(job, silent);
  sim::cut_stock(job, {}, silent, result);
  const auto& events = result.clearance.events;
  const auto hit = std::find_if(events.begin(), events.end(),
                                [](const sim::ContactEvent& event) { return event.part != "flutes"; });
  if (hit == events.end()) return {};
  Failure failure;
  failure.code = "collision";
  failure.line = result.main.path.elements.line(static_cast<size_t>(hit->first.element));
  failure.tool = hit->tool;
  failure.remedies = remedies_of(Part::kHolder, Part::kWork);
  failure.text = fmt::format("{} of {} goes {:.3f} mm into the material ({} such places)", hit->part,
                             cutter::call_name(job.scene.tools[static_cast<size_t>(hit->tool)]),
                             hit->depth_mm, events.size());
  return failure;
}

Trial::Trial(const sim::Job& job, const post::PostFormat& format, CollisionJudge* judge)
    : job_(job), format_(plain(format)), judge_(judge), options_(options_of(job)) {
  options_.tcp = false;
  options_.planes = post::PlaneUse::kNever;  // the same motion
  options_.hooks.faults_most = 1;
  if (judge_ != nullptr) {
    options_.hooks.judge = [this](const post::PlannedStretch& planned, const kinematics::AxisValues* from) {
      return object(planned, from);
    };
  }
  options_.hooks.tried = [this](const post::RouteTry& way) { add(way); };
  options_.hooks.planned = [this](std::span<const program::Move> moves) {
    if (judge_ != nullptr) judge_->cut(moves);
    failed_ = failed_ || !passed_;
    if (passed_) failures_.clear();
    passed_ = false;
    far_enough_ = !moves.empty() && moves.back().line >= last_line_;
  };
}

post::PostFormat format_of(const sim::PostSettings& settings) {
  post::PostFormat format = post::load_post(post::post_file(settings.post));
  return settings.unit.empty() ? format : post::in_unit(std::move(format), settings.unit == "inch");
}

post::Preference preference_of(const sim::PostSettings& settings, const post::PostFormat& format) {
  const std::optional<post::Preference> said = post::preference(settings.prefer);
  return said ? *said : format.prefer.value_or(post::Preference::kTime);
}

void Trial::follow_all(bool by_slides) {
  options_.hooks.routes_most = post::kRoutesMost;
  const post::Preference preferred =
      by_slides ? post::Preference::kTravel : preference_of(*job_.scene.post, format_);
  options_.hooks.cost = [this, preferred](const post::PlanSummary& plan) {
    return post::preference_cost(preferred, job_.machine.model, plan);
  };
}

Attempt Trial::run(Progress& progress) {
  Diagnostics diagnostics;
  UntilEnough until(progress, far_enough_);
  try {
    const post::PostResult result = post::post(
        job_.scene.program_file, job_.machine.model, format_, options_, [](std::string_view) {}, until,
        diagnostics);
    attempt_.plan = result.plan;
    attempt_.choices = result.choices;
    dropped_ = result.routes_dropped;
    attempt_.slides_mm = post::slides_of(job_.machine.model, result.plan);
  } catch (const InputError&) {
    if (!failed_ || failures_.empty()) throw;
    attempt_.failure = joined_failure();
  }
  attempt_.origin_M = job_.machine.model.X_MW.translation();
  return std::move(attempt_);
}

std::optional<post::Objection> Trial::object(const post::PlannedStretch& planned,
                                             const kinematics::AxisValues* from) {
  collision_ = judge_->look_at(planned, from);
  if (!collision_) return {};
  return post::Objection{collision_->step, {"collision", collision_->text, "", -1}};
}

void Trial::add(const post::RouteTry& way) {
  ++attempt_.tried;
  const bool good = way.fault.code.empty();
  passed_ = passed_ || good;
  if (!failed_ && attempt_.tries.size() < Attempt::kTriesMost)
    attempt_.tries.push_back({way.first_line, way.last_line, post::way_text(job_.machine.model, way.way),
                              way.fault.text, way.fault_line, way.time_s});
  if (!good && !failed_) failures_.push_back(failure_of(way));
}

Failure Trial::failure_of(const post::RouteTry& way) const {
  Failure failure{way.fault.code, way.fault.text, way.fault_line, -1, {}};
  if (way.fault.code == "collision") {
    failure.remedies = collision_->loading ? std::vector<Remedy>{Remedy::kMoveClamping}
                                           : remedies_of(collision_->part_a, collision_->part_b);
    failure.tool = collision_->tool;
  } else if (way.fault.axis >= 0) {
    const kinematics::Axis& axis = job_.machine.model.axes[static_cast<size_t>(way.fault.axis)];
    failure.remedies = remedies_of_limit(axis.kind == AxisKind::kLinear);
  }
  return failure;
}

/// The way that came farthest is told; what would free any of them may be tried.
Failure Trial::joined_failure() const {
  Failure worst = *std::max_element(failures_.begin(), failures_.end(),
                                    [](const Failure& a, const Failure& b) { return a.line < b.line; });
  std::vector<Remedy> all;
  for (const Remedy remedy : {Remedy::kMoveClamping, Remedy::kExtendTool, Remedy::kShortenTool})
    for (const Failure& one : failures_)
      if (std::count(one.remedies.begin(), one.remedies.end(), remedy) > 0 &&
          std::count(all.begin(), all.end(), remedy) == 0) {
        all.push_back(remedy);
        if (worst.tool < 0) worst.tool = one.tool;
      }
  worst.remedies = all;
  return worst;
}

}  // namespace swarf::avoidance
