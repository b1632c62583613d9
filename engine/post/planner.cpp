// Stretches: where one begins, which start it takes, what is told when none will do.
#include "post/planner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "motion/blocks/pole_turn.h"

namespace swarf::post {
namespace {

using kinematics::AxisKind;
using kinematics::AxisValues;

AxisValues home_of(const kinematics::MachineModel& machine) {
  AxisValues home = AxisValues::Zero();
  for (size_t i = 0; i < machine.axes.size(); ++i) home[static_cast<long>(i)] = machine.axes[i].home;
  return home;
}

bool in_travel(const kinematics::MachineModel& machine, const AxisValues& q) {
  for (size_t i = 0; i < machine.axes.size(); ++i) {
    const auto row = static_cast<long>(i);
    if (q[row] < machine.axes[i].min || q[row] > machine.axes[i].max) return false;
  }
  return true;
}

}  // namespace

int axis_along_tool(const kinematics::MachineModel& machine) {
  for (size_t i = 0; i < machine.axes.size(); ++i) {
    const kinematics::Axis& axis = machine.axes[i];
    if (axis.kind == AxisKind::kLinear && axis.direction_M.cross(machine.tool_axis_M).norm() < 1e-9)
      return static_cast<int>(i);
  }
  throw InputError(
      "approach-axis", {machine.name},
      "no linear axis of the machine runs along the tool when all axes are at zero: it cannot be "
      "retracted for a tool change",
      "write the program for a machine whose spindle stands along X, Y or Z at zero");
}

double retracted(const kinematics::MachineModel& machine) {
  const int axis = axis_along_tool(machine);
  return machine.tool_change ? (*machine.tool_change)[axis] : machine.axes[static_cast<size_t>(axis)].home;
}

Planner::Planner(const PlannerSetup& setup, std::string file, StretchSink sink, Diagnostics& diagnostics)
    : setup_(setup), file_(std::move(file)), sink_(std::move(sink)), diagnostics_(diagnostics) {
  axis_along_tool(setup_.machine);
  routes_.emplace_back();
  routes_.front().state.q = home_of(setup_.machine);
}

void Planner::move(const program::Move& move) {
  const bool changes_tool = move.tool != cl_tool_;
  const bool opens = move.rapid && last_rapid_ && in_hole_ == 0;
  const bool enough = moves_.size() >= kMovesAhead && in_hole_ == 0;
  if (changes_tool || opens || enough) plan_stretch();
  if (changes_tool) use_tool(move.tool);
  if (next_hole_) {
    in_hole_ = next_hole_->moves;
    holes_.push_back({moves_.size(), *next_hole_, move.spindle_rpm});
    next_hole_.reset();
  }
  if (in_hole_ > 0) --in_hole_;
  moves_.push_back(move);
  last_rapid_ = move.rapid;
}

void Planner::hole(const program::ClHole& hole) {
  next_hole_ = hole;
}

void Planner::note(program::ClNote note) {
  notes_.push_back({moves_.size(), std::move(note)});
}

void Planner::finish() {
  plan_stretch();
  for (const auto& stretch : routes_.front().stretches) sink_(*stretch);
  PlannedStretch rest;
  rest.notes = std::move(notes_);
  if (!rest.notes.empty()) sink_(rest);
}

void Planner::use_tool(int tool) {
  cl_tool_ = tool;
  tool_ = tool_of ? tool_of(tool) : tool;
  const double length = tool_ < 0 ? 0.0 : setup_.tools[static_cast<size_t>(tool_)].length_mm;
  follower_.emplace(kinematics::with_tool(setup_.machine, length), setup_.rules);
  space_.emplace(setup_.machine);
  space_->set_length(length);
  for (Route& route : routes_) route.state.approach_next = route.state.tool_changed = true;
}

void Planner::tell(const FollowFault& fault, int line) {
  if (++faults_ > setup_.hooks.faults_most) return;
  diagnostics_.error(fault.code, {file_, line, 0}, fault.text, fault.fix);
  if (faults_ == setup_.hooks.faults_most)
    diagnostics_.note("more-faults", {file_, line, 0}, "further faults of this kind are not listed");
}

void Planner::plan_stretch() {
  if (moves_.empty()) return;
  // What stands behind the last move belongs to the next one.
  const auto behind = std::find_if(notes_.begin(), notes_.end(),
                                   [&](const PlacedNote& one) { return one.before == moves_.size(); });
  std::vector<PlacedNote> kept(std::make_move_iterator(behind), std::make_move_iterator(notes_.end()));
  notes_.erase(behind, notes_.end());
  plan_moves();
  moves_.clear();
  holes_.clear();
  for (PlacedNote& one : kept) one.before = 0;
  notes_ = std::move(kept);
}

void Planner::plan_moves() {
  if (faults_ >= setup_.hooks.faults_most) return;
  std::vector<Route> routes;
  std::optional<Plan> failed;
  const bool first_will_do = setup_.hooks.routes_most <= 1;
  for (Route& route : routes_) {
    const State state = route.state;
    std::optional<Plan> fault = each_plan(state, [&](Plan plan) {
      go_on(first_will_do ? std::move(route) : route, std::move(plan), routes);
      return first_will_do;
    });
    if (!failed) failed = std::move(fault);
  }
  if (setup_.hooks.planned) setup_.hooks.planned(moves_);
  if (!routes.empty()) {
    keep_best(routes);
    return;
  }
  tell(*failed->fault, failed->fault_line);
  for (Route& route : routes_) {
    route.state.approach_next = true;
    route.state.q = failed->q;
  }
}

namespace {

/// Feeds of a stretch that turns are inverse times.
void time_stretch(bool tcp, PlannedStretch& stretch) {
  if (tcp) return;
  const bool turns = std::any_of(stretch.steps.begin(), stretch.steps.end(), [](const PlanStep& one) {
    return one.kind == StepKind::kFeed && one.turns;
  });
  for (PlanStep& step : stretch.steps)
    step.timed = turns && !step.tilt && (step.kind == StepKind::kFeed || step.kind == StepKind::kArc);
}

double cost(const PlannerHooks& hooks, const PlanSummary& plan) {
  return hooks.cost ? hooks.cost(plan) : plan.time_s();
}

/// Where a program has come to, and at what cost.
struct Reached {
  const PlanSummary& summary;
  const AxisValues& q;
};

/// `by` comes to where the other one ends at no higher cost, and what follows begins with the tool lifted:
/// whatever goes on from there goes on from here.
bool is_beaten(const PlannerHooks& hooks, const kinematics::MachineModel& machine, const Reached& one,
               const Reached& by) {
  PlanSummary over = by.summary;
  over.travel += (one.q - by.q).cwiseAbs();
  over.rapid_s += axis_time(machine, by.q, one.q, true);
  return cost(hooks, over) <= cost(hooks, one.summary) * (1.0 + 1e-12);
}

}  // namespace

/// The route with this stretch, unless another one beats it.
void Planner::go_on(Route longer, Plan plan, std::vector<Route>& routes) const {
  time_stretch(setup_.rules.tcp, plan.stretch);
  longer.state = {plan.q, true, false, false, plan.summary, plan.tilt};
  longer.choices.push_back(std::move(plan.way));
  longer.state.summary.steps += static_cast<long>(plan.stretch.steps.size());
  longer.stretches.push_back(std::make_shared<const PlannedStretch>(std::move(plan.stretch)));
  const auto beats = [&](const Route& a, const Route& b) {
    return is_beaten(setup_.hooks, follower_->machine, {b.state.summary, b.state.q},
                     {a.state.summary, a.state.q});
  };
  if (std::any_of(routes.begin(), routes.end(), [&](const Route& one) { return beats(one, longer); })) return;
  std::erase_if(routes, [&](const Route& one) { return beats(longer, one); });
  routes.push_back(std::move(longer));
}

void Planner::keep_best(std::vector<Route>& routes) {
  std::stable_sort(routes.begin(), routes.end(), [&](const Route& a, const Route& b) {
    return cost(setup_.hooks, a.state.summary) < cost(setup_.hooks, b.state.summary);
  });
  if (routes.size() > setup_.hooks.routes_most) {
    routes_dropped_ += static_cast<long>(routes.size() - setup_.hooks.routes_most);
    routes.resize(setup_.hooks.routes_most);
  }
  routes_ = std::move(routes);
  if (setup_.hooks.routes_most > 1) return;
  sink_(*routes_.front().stretches.front());
  routes_.front().stretches.clear();
}

Planner::Entry Planner::entry(const State& state) const {
  const program::Move& first = moves_.front();
  const bool to_its_end = first.rapid && (!state.approach_next || (state.tool_changed && state.started));
  return {snapped(*follower_, to_its_end ? first.to : first.from), to_its_end ? size_t{1} : size_t{0},
          state.approach_next};
}

namespace {

/// At the pole the outer axis is free: it stands where the first move that tilts the tool wants it.
AxisValues turned_for_tilt(const Follower& follower, std::span<const program::Move> moves,
                           const ToolPose& pose, const AxisValues& q) {
  for (const program::Move& move : moves) {
    const ToolPose to = snapped(follower, move.to);
    if (angle_between(to.axis_W, pose.axis_W) < 1e-6) continue;
    toolpath::BlockMove leaving;
    leaving.from = pose;
    leaving.to = {pose.tip_W, to.axis_W};
    return motion::leaving_pole(follower.inverse, leaving, q);
  }
  return q;
}

}  // namespace

std::vector<Start> Planner::candidates(const State& state, const Entry& entry) const {
  const kinematics::MachineModel& machine = follower_->machine;
  std::vector<Start> all;
  const auto add = [&](const AxisValues& q) {
    const bool known = std::any_of(all.begin(), all.end(),
                                   [&](const Start& one) { return rotary_way(machine, one.q, q) < kTurned; });
    if (!known && in_travel(machine, q)) all.push_back({q, false});
  };
  const kinematics::Branch nearest = follower_->inverse.solve_nearest(entry.pose, state.q);
  const kinematics::InverseSolutions both = follower_->inverse.solve(entry.pose, state.q);
  for (int i = 0; i < both.count; ++i) {
    const AxisValues at = both.branch[i].q;
    const AxisValues ready = entry.approach ? turned_for_tilt(*follower_, moves_, entry.pose, at) : at;
    const bool pole = both.branch[i].outcome == kinematics::InverseOutcome::kSingular;
    for (size_t k = 0; k <= machine.axes.size(); ++k) {
      for (const double turn : {0.0, kTurn, -kTurn, 0.5 * kTurn, -0.5 * kTurn}) {
        AxisValues q = ready;
        const bool half = std::abs(turn) == 0.5 * kTurn;
        if (k == machine.axes.size() ? turn != 0.0 : machine.axes[k].kind != AxisKind::kRotary) continue;
        if (half && !(pole && static_cast<int>(k) == follower_->poles.outer)) continue;
        if (k < machine.axes.size()) q[static_cast<long>(k)] += turn;
        const kinematics::Branch solved = follower_->inverse.solve_nearest(entry.pose, q);
        add(half || turn == 0.0 ? solved.q : q);
      }
    }
  }
  std::stable_sort(all.begin(), all.end(), [&](const Start& a, const Start& b) {
    return rotary_way(machine, state.q, a.q) < rotary_way(machine, state.q, b.q);
  });
  for (Start& one : all) {
    one.continuous = !entry.approach && nearest.outcome != kinematics::InverseOutcome::kUnreachable &&
                     rotary_way(machine, nearest.q, one.q) < kTurned;
  }
  return all;
}

Planner::Plan Planner::judged_plan(const State& state, const Entry& entry, RouteChoice way) const {
  Plan plan = plan_from(state, entry, std::move(way));
  if (!plan.fault && setup_.hooks.judge) {
    if (std::optional<Objection> against =
            setup_.hooks.judge(plan.stretch, state.started ? &state.q : nullptr)) {
      plan.fault = std::move(against->fault);
      plan.fault_step = against->step;
      plan.fault_line = plan.stretch.steps.at(against->step).line;
    }
  }
  tell_tried(state, plan);
  return plan;
}

void Planner::tell_tried(const State& state, const Plan& plan) const {
  if (!setup_.hooks.tried) return;
  setup_.hooks.tried({moves_.front().line, moves_.back().line, plan.way,
                      plan.summary.time_s() - state.summary.time_s(), plan.fault.value_or(FollowFault{}),
                      plan.fault_line});
}

namespace {

/// Every rotary axis stands where the other's does, or whole turns away.
bool whole_turns_apart(const kinematics::MachineModel& machine, const AxisValues& a, const AxisValues& b) {
  for (size_t i = 0; i < machine.axes.size(); ++i) {
    const auto row = static_cast<long>(i);
    if (machine.axes[i].kind == AxisKind::kRotary &&
        std::abs(std::remainder(a[row] - b[row], kTurn)) > kTurned)
      return false;
  }
  return true;
}

/// The next sides to try: what stands before the last pole that may turn is kept. Empty: there is none.
std::vector<PoleSide> backtracked(std::vector<PoleSide> sides, size_t poles) {
  sides.resize(poles, PoleSide::kContinuous);
  while (!sides.empty() && sides.back() == PoleSide::kOther) sides.pop_back();
  if (!sides.empty()) sides.back() = PoleSide::kOther;
  return sides;
}

}  // namespace

/// Hands over every way through the stretch that can be driven, in the order of the file's head, until one is
/// taken. The first one that cannot, where none was handed over.
std::optional<Planner::Plan> Planner::each_plan(const State& state, const TakePlan& take) const {
  constexpr int kTriesMost = 64;  // of the sides of one start: six poles one after the other, each way
  const Entry begin = entry(state);
  if (setup_.hooks.decided != nullptr) {
    Plan plan = judged_plan(state, begin, setup_.hooks.decided->at(routes_.front().choices.size()));
    if (plan.fault) return plan;
    take(std::move(plan));
    return {};
  }
  std::vector<Start> starts = candidates(state, begin);
  if (setup_.hooks.choice) setup_.hooks.choice(moves_, starts);
  std::optional<Plan> failed;
  bool handed = false, any = false, done = false;
  // Poles before the fault, or all of a plan without one.
  const auto offer = [&](Plan plan) {
    const auto poles =
        plan.fault ? static_cast<size_t>(std::count_if(plan.pole_steps.begin(), plan.pole_steps.end(),
                                                       [&](size_t step) { return step <= plan.fault_step; }))
                   : plan.poles.left;
    if (!plan.fault) {
      handed = true;
      done = take(std::move(plan));
    } else if (!failed) {
      failed = std::move(plan);
    }
    return poles;
  };
  struct Way {
    Start start;
    bool approach = false, skipped = false;
    size_t poles = 0;
  };
  std::vector<Way> ways;
  // A feed leaves no room to lift the tool.
  const bool may_lift = begin.approach || begin.first == 1;
  for (const Start& start : starts) {
    if (start.continuous) ways.push_back({start, false, false, 0});
    if (may_lift) ways.push_back({start, true, false, 0});
  }
  // Where another turn of an axis has been driven already, this one would only have to turn back.
  std::vector<const Way*> driven;
  const auto is_turn_of_driven = [&](const Way& way) {
    return std::any_of(driven.begin(), driven.end(), [&](const Way* one) {
      return one->approach == way.approach &&
             whole_turns_apart(follower_->machine, one->start.q, way.start.q);
    });
  };
  for (size_t i = 0; i < ways.size() && !done; ++i) {
    ways[i].skipped = is_turn_of_driven(ways[i]);
    if (ways[i].skipped) continue;
    handed = false;
    ways[i].poles = offer(judged_plan(state, begin, {ways[i].start, ways[i].approach, {}}));
    if (handed) driven.push_back(&ways[i]);
    any = any || handed;
  }
  for (size_t i = 0; i < ways.size() && !done && !follower_->poles.at.empty(); ++i) {
    if (ways[i].skipped) continue;
    std::vector<PoleSide> sides = backtracked({}, ways[i].poles);
    for (int tries = 0; tries < kTriesMost && !sides.empty() && !done; ++tries) {
      const size_t poles = offer(judged_plan(state, begin, {ways[i].start, ways[i].approach, sides}));
      sides = backtracked(std::move(sides), poles);
    }
    any = any || handed;
  }
  if (any) return {};
  if (failed) return failed;
  failed = no_start(state, begin);
  tell_tried(state, *failed);
  return failed;
}

Planner::Plan Planner::no_start(const State& state, const Entry& entry) const {
  Plan none;
  const kinematics::Branch at = follower_->inverse.solve_nearest(entry.pose, state.q);
  none.q = state.q;
  none.summary = state.summary;
  none.fault = fault_of(*follower_, at, entry.pose);
  none.fault_line = moves_.front().line;
  if (none.fault->code.empty())
    none.fault = FollowFault{"no-start", "none of the solutions of the inverse may be taken here",
                             "leave at least one candidate in BranchChoice", -1};
  return none;
}

}  // namespace swarf::post
