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
  q_ = home_of(setup_.machine);
}

void Planner::move(const program::Move& move) {
  const bool changes_tool = move.tool != cl_tool_;
  const bool opens = move.rapid && last_rapid_ && in_hole_ == 0;
  const bool enough = moves_.size() >= kMovesAhead && in_hole_ == 0;
  if (changes_tool || opens || enough) plan_stretch();
  if (changes_tool) use_tool(move.tool);
  if (next_hole_) {
    in_hole_ = next_hole_->moves;
    holes_.push_back({moves_.size(), *next_hole_});
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
  approach_next_ = tool_changed_ = true;
}

void Planner::tell(const FollowFault& fault, int line) {
  if (++faults_ > setup_.faults_most) return;
  diagnostics_.error(fault.code, {file_, line, 0}, fault.text, fault.fix);
  if (faults_ == setup_.faults_most)
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
  if (faults_ >= setup_.faults_most) return;
  Plan plan = best_plan();
  if (plan.fault) {
    tell(*plan.fault, plan.fault_line);
    approach_next_ = true;
    q_ = plan.q;
    return;
  }
  deliver(std::move(plan));
}

void Planner::deliver(Plan plan) {
  time_stretch(plan);
  q_ = plan.q;
  started_ = true;
  approach_next_ = tool_changed_ = false;
  summary_ = plan.summary;
  summary_.steps += static_cast<long>(plan.stretch.steps.size());
  sink_(plan.stretch);
}

Planner::Entry Planner::entry() const {
  const program::Move& first = moves_.front();
  const bool to_its_end = first.rapid && (!approach_next_ || (tool_changed_ && started_));
  return {snapped(*follower_, to_its_end ? first.to : first.from), to_its_end ? size_t{1} : size_t{0},
          approach_next_};
}

/// At the pole the outer axis is free: it stands where the first move that tilts the tool wants it.
AxisValues Planner::turned_for_tilt(const ToolPose& pose, const AxisValues& q) const {
  for (const program::Move& move : moves_) {
    const ToolPose to = snapped(*follower_, move.to);
    if (angle_between(to.axis_W, pose.axis_W) < 1e-6) continue;
    toolpath::BlockMove leaving;
    leaving.from = pose;
    leaving.to = {pose.tip_W, to.axis_W};
    return motion::leaving_pole(follower_->inverse, leaving, q);
  }
  return q;
}

std::vector<Start> Planner::candidates(const Entry& entry) const {
  const kinematics::MachineModel& machine = follower_->machine;
  std::vector<Start> all;
  const auto add = [&](const AxisValues& q) {
    const bool known = std::any_of(all.begin(), all.end(),
                                   [&](const Start& one) { return rotary_way(machine, one.q, q) < kTurned; });
    if (!known && in_travel(machine, q)) all.push_back({q, false});
  };
  const kinematics::Branch nearest = follower_->inverse.solve_nearest(entry.pose, q_);
  const kinematics::InverseSolutions both = follower_->inverse.solve(entry.pose, q_);
  for (int i = 0; i < both.count; ++i) {
    const AxisValues at = both.branch[i].q;
    const AxisValues ready = entry.approach ? turned_for_tilt(entry.pose, at) : at;
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
    return rotary_way(machine, q_, a.q) < rotary_way(machine, q_, b.q);
  });
  for (Start& one : all) {
    one.continuous = !entry.approach && nearest.outcome != kinematics::InverseOutcome::kUnreachable &&
                     rotary_way(machine, nearest.q, one.q) < kTurned;
  }
  return all;
}

Planner::Plan Planner::best_plan() const {
  const Entry begin = entry();
  std::vector<Start> starts = candidates(begin);
  if (setup_.choice) setup_.choice(moves_, starts);
  Plan first;
  bool tried = false;
  const auto better = [&](Plan plan) {
    const bool good = !plan.fault;
    if (good || !tried) first = std::move(plan);
    tried = true;
    return good;
  };
  // A feed leaves no room to lift the tool.
  const bool may_lift = begin.approach || begin.first == 1;
  for (const PoleSide side : {PoleSide::kContinuous, PoleSide::kOther}) {
    if (side == PoleSide::kOther && follower_->poles.at.empty()) break;
    for (const Start& start : starts) {
      if (start.continuous && better(plan_from(begin, start, false, side))) return first;
      if (may_lift && better(plan_from(begin, start, true, side))) return first;
    }
  }
  if (!tried) {
    const kinematics::Branch at = follower_->inverse.solve_nearest(begin.pose, q_);
    first.q = q_;
    first.summary = summary_;
    first.fault = fault_of(*follower_, at, begin.pose);
    first.fault_line = moves_.front().line;
    if (first.fault->code.empty())
      first.fault = FollowFault{"no-start", "none of the solutions of the inverse may be taken here",
                                "leave at least one candidate in BranchChoice"};
  }
  return first;
}

}  // namespace swarf::post
