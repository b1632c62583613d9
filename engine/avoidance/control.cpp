#include "avoidance/control.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angles.h"
#include "base/parallel.h"
#include "base/units.h"
#include "cutter/cutter.h"
#include "post/shipped.h"

namespace swarf::avoidance {
namespace {

using kinematics::AxisKind;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::string origin_key(const Vec3& origin) {
  return fmt::format("setup.work_origin_mm=[{:.6f}, {:.6f}, {:.6f}]", origin.x(), origin.y(), origin.z());
}

std::vector<Position> grid_positions(const sim::Job& job) {
  const sim::ClampingGrid& grid = job.scene.post->grid;
  const Vec3 middle = job.machine.model.X_MW.translation();
  std::vector<Position> positions;
  for (int k = 0; k < grid.count[2]; ++k)
    for (int j = 0; j < grid.count[1]; ++j)
      for (int i = 0; i < grid.count[0]; ++i) {
        const Vec3 cell(i - 0.5 * (grid.count[0] - 1), j - 0.5 * (grid.count[1] - 1),
                        k - 0.5 * (grid.count[2] - 1));
        Position position;
        position.origin_M = middle + cell.cwiseProduct(grid.step_mm);
        positions.push_back(position);
      }
  return positions;
}

/// The table's axis: the one that carries the work, where it may turn all the way round.
std::optional<int> turning_axis(const kinematics::MachineModel& machine) {
  for (auto at = machine.table_chain.rbegin(); at != machine.table_chain.rend(); ++at) {
    const kinematics::Axis& axis = machine.axes[static_cast<size_t>(*at)];
    if (axis.kind == AxisKind::kRotary && axis.max - axis.min >= kTurn && axis.home + kTurn <= axis.max)
      return *at;
  }
  return {};
}

}  // namespace

const char* state_name(PositionState state) {
  switch (state) {
    case PositionState::kUntried:
      return "untried";
    case PositionState::kOffTravel:
      return "off_travel";
    case PositionState::kNoFullTurn:
      return "no_full_turn";
    case PositionState::kCollides:
      return "collides";
    case PositionState::kWorse:
      return "worse";
    case PositionState::kValid:
      break;
  }
  return "valid";
}

namespace {

class Control {
 public:
  Control(const Task& task, Progress& progress)
      : task_(task), progress_(progress), settings_(*task.job->scene.post), format_(format_of(settings_)) {
    outcome_.extended_mm.assign(task.job->scene.tools.size(), 0.0);
    outcome_.preferred = preference_of(settings_, format_);
  }

  Outcome run() {
    while (!progress_.stop_requested()) {
      if (!free_of_material()) break;
      find_bounds();
      const std::optional<Remedy> next = search();
      if (outcome_.found) compare_routes();
      if (!next) break;
    }
    return std::move(outcome_);
  }

 private:
  sim::Job job_at(const Vec3& origin) const {
    const bool own = (origin - task_.job->machine.model.X_MW.translation()).norm() < 1e-9;
    sim::Job job = own ? *task_.job : task_.load({origin_key(origin)});
    extend(job, outcome_.extended_mm);
    return job;
  }

  /// B or B-; false: its reach ends here.
  bool reach_for(int tool, double step) {
    double& extended = outcome_.extended_mm.at(static_cast<size_t>(std::max(tool, 0)));
    const double next = extended + step;
    if (next > settings_.reach.most_mm + 1e-9 || next < settings_.reach.least_mm - 1e-9) return false;
    extended = next;
    return true;
  }

  /// 0. Tool parts against the material, whatever machine drives them.
  bool free_of_material() {
    while (true) {
      const sim::Job job = job_at(task_.job->machine.model.X_MW.translation());
      std::optional<Failure> failure = material_failure(job);
      if (!failure) return true;
      Attempt attempt;
      attempt.origin_M = job.machine.model.X_MW.translation();
      attempt.extended_mm = outcome_.extended_mm;
      const bool longer = reach_for(failure->tool, settings_.reach.step_mm);
      attempt.action =
          longer ? told_reach(failure->tool) : "nothing is left: the tool may not be pulled out further";
      attempt.failure = std::move(failure);
      outcome_.attempts.push_back(std::move(attempt));
      if (!longer) return false;
    }
  }

  std::string told_reach(int tool) const {
    const size_t at = static_cast<size_t>(std::max(tool, 0));
    return fmt::format("B: {} stands out {:+.3f} mm against the scene",
                       cutter::call_name(task_.job->scene.tools[at]), outcome_.extended_mm[at]);
  }

  /// 1. The least slide movements of each position.
  void find_bounds() {
    sim::Job job = job_at(task_.job->machine.model.X_MW.translation());
    outcome_.positions = grid_positions(*task_.job);
    std::vector<Position>& positions = outcome_.positions;
    if (positions.size() == 1) return;
    progress_.begin("slide movements", static_cast<double>(positions.size()), "clamping positions");
    parallel_chunks(positions.size(), 1, [&](size_t i, size_t) {
      sim::Job here = job;
      here.machine.model.X_MW.translation() = positions[i].origin_M;
      Trial trial(here, format_, nullptr);
      trial.follow_all(true);
      Progress silent;
      const Attempt attempt = trial.run(silent);
      // Where ways were given up, the least of the others bounds nothing.
      positions[i].bound_mm = trial.dropped() > 0 ? 0.0 : attempt.slides_mm;
      if (!attempt.failure) return;
      positions[i].bound_mm = kInfinity;
      positions[i].state = PositionState::kOffTravel;
      positions[i].why = attempt.failure->text;
      positions[i].line = attempt.failure->line;
      positions[i].tool = attempt.failure->tool;
      positions[i].remedies = attempt.failure->remedies;
    });
    progress_.end();
  }

  /// 2. and 3.; none: the search is over.
  std::optional<Remedy> search() {
    std::vector<size_t> order(outcome_.positions.size());
    for (size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
      return outcome_.positions[a].bound_mm < outcome_.positions[b].bound_mm;
    });
    progress_.begin("clamping positions", static_cast<double>(order.size()), "positions");
    std::optional<Failure> last;
    // Those without a full turn of the table, which the paper drops, only where nothing else is free.
    for (const bool without_turn : {false, true}) {
      if (outcome_.found || (without_turn && outcome_.positions.size() == 1)) break;
      if (!search_among(order, without_turn, last)) break;
    }
    progress_.end();
    if (outcome_.found || !last) {
      if (outcome_.found) keep_best_last();
      return {};
    }
    for (const Remedy remedy : {Remedy::kExtendTool, Remedy::kShortenTool}) {
      const bool may = std::count(last->remedies.begin(), last->remedies.end(), remedy) > 0;
      const double step = remedy == Remedy::kExtendTool ? settings_.reach.step_mm : -settings_.reach.step_mm;
      if (!may || !reach_for(last->tool, step)) continue;
      outcome_.attempts.back().action = told_reach(last->tool);
      return remedy;
    }
    return {};
  }

  /// False: no clamping position helps.
  bool search_among(const std::vector<size_t>& order, bool without_turn, std::optional<Failure>& last) {
    const PositionState wanted = without_turn ? PositionState::kNoFullTurn : PositionState::kUntried;
    double best = kInfinity;
    size_t done = 0;
    for (const size_t i : order) {
      Position& position = outcome_.positions[i];
      progress_.advance(static_cast<double>(done++));
      if (progress_.stop_requested()) return false;
      if (position.state == PositionState::kOffTravel && outcome_.positions.size() > 1)
        note_off_travel(position, last);
      if (position.state != wanted) continue;
      if (position.bound_mm >= best) {
        position.state = PositionState::kWorse;
        continue;
      }
      std::optional<Failure> failure = simulate(position, without_turn);
      if (!failure) {
        if (position.state == PositionState::kValid && position.slides_mm < best) {
          best = position.slides_mm;
          outcome_.best = i;
          outcome_.found = true;
        }
        continue;
      }
      const bool moves =
          std::count(failure->remedies.begin(), failure->remedies.end(), Remedy::kMoveClamping) > 0;
      if (!last || failure->line >= last->line) last = failure;
      if (!moves) return false;
      outcome_.attempts.back().action = outcome_.positions.size() > 1
                                            ? "A: the next clamping position"
                                            : "A: there is no other clamping position";
    }
    return true;
  }

  /// A limit that the search for bounds has met is a failure like another; the first one is told.
  void note_off_travel(const Position& position, std::optional<Failure>& last) {
    if (last) return;
    last = Failure{"travel", position.why, position.line, position.tool, position.remedies};
    Attempt attempt;
    attempt.origin_M = position.origin_M;
    attempt.extended_mm = outcome_.extended_mm;
    attempt.failure = last;
    attempt.action = "A: the next clamping position";
    outcome_.attempts.push_back(std::move(attempt));
  }

  /// Full turn, then the program; none: it is free, or the position was dropped.
  std::optional<Failure> simulate(Position& position, bool without_turn) {
    const sim::Job job = job_at(position.origin_M);
    CollisionJudge judge(job, settings_.clearance_mm);
    const bool several = outcome_.positions.size() > 1;
    position.why = several ? judge.inside_table() : "";
    if (!position.why.empty()) {
      position.state = PositionState::kCollides;
      return {};
    }
    if (const std::optional<int> axis = turning_axis(job.machine.model); axis && several && !without_turn) {
      if (const std::optional<Collision> hit = judge.full_turn(*axis)) {
        position.state = PositionState::kNoFullTurn;
        position.why = "no full turn of the table: " + hit->text;
        return {};
      }
    }
    Trial trial(job, format_, &judge);
    if (settings_.best_routes) trial.follow_all(false);
    Progress silent;
    Attempt attempt = trial.run(silent);
    ++outcome_.simulations;
    attempt.extended_mm = outcome_.extended_mm;
    outcome_.routes_dropped = trial.dropped();
    std::optional<Failure> failure = attempt.failure;
    position.state = failure ? PositionState::kCollides : PositionState::kValid;
    if (failure) {
      position.why = failure->text;
      position.line = failure->line;
      if (failure->code != "collision") position.state = PositionState::kOffTravel;
    }
    position.slides_mm = attempt.slides_mm;
    position.time_s = attempt.plan.time_s();
    outcome_.attempts.push_back(std::move(attempt));
    return failure;
  }

  void keep_best_last() {
    const Vec3 origin = outcome_.positions[outcome_.best].origin_M;
    const auto at = std::find_if(
        outcome_.attempts.rbegin(), outcome_.attempts.rend(),
        [&](const Attempt& one) { return !one.failure && (one.origin_M - origin).norm() < 1e-9; });
    std::rotate(at.base() - 1, at.base(), outcome_.attempts.end());
  }

  /// The other way of choosing, for the report.
  void compare_routes() {
    const sim::Job job = job_at(outcome_.positions[outcome_.best].origin_M);
    CollisionJudge judge(job, settings_.clearance_mm);
    Trial trial(job, format_, &judge);
    if (!settings_.best_routes) trial.follow_all(false);
    Progress silent;
    const Attempt other = trial.run(silent);
    const double taken = outcome_.attempts.back().plan.time_s(), others = other.plan.time_s();
    outcome_.backtrack_time_s = settings_.best_routes ? others : taken;
    outcome_.best_time_s = settings_.best_routes ? taken : others;
    outcome_.routes_dropped = std::max(outcome_.routes_dropped, trial.dropped());
  }

  const Task& task_;
  Progress& progress_;
  const sim::PostSettings& settings_;
  post::PostFormat format_;
  Outcome outcome_;
};

}  // namespace

namespace {

/// Without a tool in the spindle nobody knows what the program would hold: the machine's bare nose would be
/// looked at.
void require_tools(const sim::Job& job) {
  const auto bare = std::find_if(job.cl->moves.begin(), job.cl->moves.end(),
                                 [](const program::Move& move) { return move.tool < 0; });
  if (bare == job.cl->moves.end()) return;
  throw InputError("tool-not-loaded", {job.cl->file, bare->line, bare->column},
                   "the CL data move before they call a tool: a program has to say which one it holds",
                   "write LOADTL/1 (the tool's number) before the first motion");
}

}  // namespace

Outcome control(const Task& task, Progress& progress) {
  require_tools(*task.job);
  return Control(task, progress).run();
}

std::vector<std::string> overrides_of(const Outcome& outcome, const std::string& written,
                                      const std::string& dialect) {
  std::string extended;
  for (const double one : outcome.extended_mm)
    extended += fmt::format("{}{:.6f}", extended.empty() ? "" : ", ", one);
  return {fmt::format("post.written=\"{}\"", written), fmt::format("dialect=\"{}\"", dialect),
          origin_key(outcome.positions[outcome.best].origin_M),
          fmt::format("post.extended_mm=[{}]", extended)};
}

post::PostResult write_program(const Task& task, const Outcome& outcome, const post::PostFormat& format,
                               const post::Writer::Out& out, Progress& progress, Diagnostics& diagnostics) {
  sim::Job job = *task.job;
  job.machine.model.X_MW.translation() = outcome.positions[outcome.best].origin_M;
  extend(job, outcome.extended_mm);
  post::PostOptions options = options_of(job);
  options.tcp = job.scene.post->tcp;
  options.hooks.decided = &outcome.attempts.back().choices;
  return post::post(job.scene.program_file, job.machine.model, format, options, out, progress, diagnostics);
}

const Attempt* farthest_attempt(const Outcome& outcome) {
  const Attempt* farthest = nullptr;
  for (const Attempt& one : outcome.attempts)
    if (one.failure && (farthest == nullptr || one.failure->line > farthest->failure->line)) farthest = &one;
  return farthest;
}

Diagnostics diagnostics_of(const Outcome& outcome, const sim::Job& job) {
  Diagnostics told;
  const Attempt* const farthest = farthest_attempt(outcome);
  if (farthest != nullptr) {
    const Failure& failure = *farthest->failure;
    std::string fix;
    for (const Remedy remedy : failure.remedies)
      fix += (fix.empty() ? "" : "; ") + std::string(remedy_name(remedy));
    const Vec3& at = farthest->origin_M;
    told.error(
        "no-free-program", {job.scene.program_file, failure.line, 0},
        fmt::format("neither solution of the rotary axes is free here, with the work at ({:.3f}, {:.3f}, "
                    "{:.3f}) mm, which is as far as any clamping position came: {}",
                    at.x(), at.y(), at.z(), failure.text),
        fix.empty()
            ? "only another set-up (C) or another tool path (D) helps: swarf post --fix OUT.cl looks for "
              "the smallest change of the path"
            : fix + ": give [post.clamping] or [post.tool_reach] room for it");
  }
  constexpr size_t kTold = 20;
  size_t count = 0;
  for (const Position& position : outcome.positions) {
    if (position.why.empty() || outcome.positions.size() == 1 || ++count > kTold) continue;
    told.note("clamping-position", {job.scene.program_file, position.line, 0},
              fmt::format("({:.3f}, {:.3f}, {:.3f}) mm: {}: {}", position.origin_M.x(), position.origin_M.y(),
                          position.origin_M.z(), state_name(position.state), position.why));
  }
  return told;
}

}  // namespace swarf::avoidance
