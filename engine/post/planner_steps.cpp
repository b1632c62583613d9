// The steps of a stretch: lines, arcs that stay arcs, holes that stay cycles, and their times.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/units.h"
#include "post/planner.h"
#include "post/rounding.h"
#include "program/move_way.h"
#include "toolpath/element.h"

namespace swarf::post {
namespace {

using kinematics::AxisKind;
using kinematics::AxisValues;
using kinematics::Branch;
using kinematics::InverseOutcome;

/// Directions that differ by less are the same, and so are lengths in mm.
constexpr double kExact = 1e-9;
/// Arcs shorter than so many last digits, or whose ends are nearer, are written as lines: rounded ends could
/// turn them round.
constexpr double kArcDigits = 20.0;

void add_travel(const AxisValues& from, const AxisValues& to, PlanSummary& summary) {
  summary.travel += (to - from).cwiseAbs();
  summary.low = summary.low.cwiseMin(to);
  summary.high = summary.high.cwiseMax(to);
}

/// Program coordinates of the axes.
Vec3 axes_point(program::nc::WorkSpace& space, const AxisValues& q) {
  return space.program_from_linear(space.linear_of(q), space.rotary_of(q));
}

}  // namespace

PlanStep Planner::step_at(const program::Move& move, const ToolPose& pose, const AxisValues& q, StepKind kind,
                          bool tcp, const std::shared_ptr<const TiltedPlane>& tilt) const {
  PlanStep step;
  step.kind = kind;
  step.q = q;
  step.pose = pose;
  step.p = tilt ? Vec3(tilt->R.transpose() * pose.tip_W) : tcp ? pose.tip_W : axes_point(*space_, q);
  step.tilt = tilt;
  step.rotary = space_->rotary_of(q);
  step.feed_mm_s = move.feed_mm_s;
  step.spindle_rpm = move.spindle_rpm;
  step.tool = tool_;
  step.line = move.line;
  step.tcp = tcp && !tilt;
  return step;
}

void Planner::add_step(PlanStep step, double way_mm, Plan& plan) const {
  const kinematics::MachineModel& machine = follower_->machine;
  PlanSummary& summary = plan.summary;
  step.turns = greatest_turn(machine, plan.q, step.q) > kTurned;
  const bool rapid = step.kind == StepKind::kRapid;
  const double by_axes = axis_time(machine, plan.q, step.q, rapid);
  const double by_feed = rapid ? 0.0 : way_mm / step.feed_mm_s;
  step.duration_s = std::max(by_axes, by_feed);
  step.tip_mm = way_mm;
  if (!rapid && by_axes > by_feed * (1.0 + kExact)) ++summary.slowed;
  (rapid ? summary.rapid_s : summary.feed_s) += step.duration_s;
  summary.dwell_s += step.dwell_s;
  if (step.turns) {
    double squares = 0.0;
    for (size_t i = 0; i < machine.axes.size(); ++i) {
      const auto row = static_cast<long>(i);
      if (machine.axes[i].kind == AxisKind::kRotary) squares += std::pow(step.q[row] - plan.q[row], 2.0);
    }
    step.turn_deg = deg_from_rad(std::sqrt(squares));
  }
  step.way_mm =
      step.kind == StepKind::kArc ? way_mm : (space_->linear_of(step.q) - space_->linear_of(plan.q)).norm();
  const double digits = rounding_mm(*follower_, step.tcp || step.tilt, plan.q, step.q);
  step.deviation_mm += digits;
  summary.digits_mm = std::max(summary.digits_mm, digits);
  if (step.deviation_mm > summary.deviation_mm) {
    summary.deviation_mm = step.deviation_mm;
    summary.deviation_line = step.line;
  }
  summary.points += step.at_cl_point ? 1 : 0;
  summary.arcs += step.kind == StepKind::kArc ? 1 : 0;
  add_travel(plan.q, step.q, summary);
  plan.q = step.q;
  plan.stretch.steps.push_back(std::move(step));
}

void Planner::add_approach(const program::Move& move, const ToolPose& pose, const AxisValues& q, bool started,
                           Plan& plan) const {
  const kinematics::MachineModel& machine = follower_->machine;
  const int along = axis_along_tool(machine);
  PlanStep step = step_at(move, pose, q, StepKind::kApproach, setup_.rules.tcp, nullptr);
  step.axes_p = axes_point(*space_, q);
  step.feed_mm_s = 0.0;
  step.turns = true;
  step.at_cl_point = true;
  AxisValues up = plan.q, over = q;
  up[along] = over[along] = retracted(machine);
  // Before the first one nobody knows where the axes stand.
  if (started) {
    for (const auto& [from, to] : {std::pair{plan.q, up}, std::pair{up, over}, std::pair{over, q}}) {
      add_travel(from, to, plan.summary);
      step.duration_s += axis_time(machine, from, to, true);
    }
  } else {
    add_travel(over, q, plan.summary);
    step.duration_s = axis_time(machine, over, q, true);
  }
  plan.summary.rapid_s += step.duration_s;
  ++plan.summary.points;
  ++plan.summary.approaches;
  plan.q = q;
  plan.stretch.steps.push_back(std::move(step));
}

bool Planner::add_move(const program::Move& given, Plan& plan) const {
  program::Move move = given;
  if (plan.tilt) move.from.axis_W = move.to.axis_W = plan.tilt->R.col(2);
  if (move.arc && add_arc(move, plan)) return true;
  if (plan.fault) return false;
  std::vector<Waypoint> places;
  AxisValues q = plan.q;
  const FollowFault fault = follow(*follower_, move, plan.poles, q, places);
  plan.pole_steps.resize(plan.poles.left, plan.stretch.steps.size());
  if (!fault.code.empty()) {
    plan.fault = fault;
    plan.fault_line = move.line;
    return false;
  }
  const double way = program::way_mm(move);
  double share = 0.0;
  const bool lifted = plan.stretch.steps.empty() || plan.stretch.steps.back().kind == StepKind::kRapid ||
                      plan.stretch.steps.back().kind == StepKind::kApproach;
  for (const Waypoint& place : places) {
    // Before a cut that starts at the pole the axes turn as fast as they can.
    const bool turn_first = place.turns_at_rest && place.share == 0.0 && lifted;
    PlanStep step =
        step_at(move, place.pose, place.q, move.rapid || turn_first ? StepKind::kRapid : StepKind::kFeed,
                setup_.rules.tcp, plan.tilt);
    if (&place == &places.front()) step.dwell_s = move.dwell_s;
    step.deviation_mm = place.deviation_mm;
    step.at_cl_point = &place == &places.back();
    plan.summary.pole_turns += place.turns_at_rest ? 1 : 0;
    add_step(std::move(step), way * (place.share - share), plan);
    share = place.share;
  }
  return true;
}

namespace {

/// An arc as the linear axes see it while the rotary ones stand.
struct AxisArc {
  Vec3 centre, normal, from, to;  ///< linear axis values; counter-clockwise about the normal
};

/// False where an axis leaves its travel between the ends; `worst` is then the first.
bool stays_in_travel(const kinematics::MachineModel& machine, const AxisArc& arc, double sweep,
                     const std::array<int, 3>& axes) {
  const Vec3 flat = (arc.from - arc.centre) - (arc.from - arc.centre).dot(arc.normal) * arc.normal;
  const Vec3 across = arc.normal.cross(flat);
  for (int i = 0; i < 3; ++i) {
    const kinematics::Axis& axis = machine.axes[static_cast<size_t>(axes.at(static_cast<size_t>(i)))];
    const double reach = std::hypot(flat[i], across[i]);
    double top = std::atan2(across[i], flat[i]);
    if (top < 0.0) top += kTurn;
    const double bottom = top >= kPi ? top - kPi : top + kPi;
    // A helix adds its height, which lies between those of its ends.
    const double low = std::min(0.0, (arc.to - arc.from).dot(arc.normal) * arc.normal[i]);
    const double high = std::max(0.0, (arc.to - arc.from).dot(arc.normal) * arc.normal[i]);
    const double base = arc.from[i] - flat[i];
    if (top <= sweep && base + reach + high > axis.max + kExact) return false;
    if (bottom <= sweep && base - reach + low < axis.min - kExact) return false;
  }
  return true;
}

}  // namespace

bool Planner::add_arc(const program::Move& move, Plan& plan) const {
  const PostAbilities& can = setup_.abilities;
  const bool tcp = setup_.rules.tcp && !plan.tilt;
  const ToolPose to = snapped(*follower_, move.to);
  if (angle_between(snapped(*follower_, move.from).axis_W, to.axis_W) > 1e-12 || (tcp && !can.tcp_arcs))
    return false;
  toolpath::BlockMove block;
  block.from = move.from;
  block.to = move.to;
  block.arc = move.arc;
  const double sweep = toolpath::arc_angle(block);
  const Branch end = follower_->inverse.solve_nearest(to, plan.q);
  if (end.outcome != InverseOutcome::kOk && end.outcome != InverseOutcome::kSingular) return false;
  if (greatest_turn(follower_->machine, plan.q, end.q) > kTurned) return false;

  // Linear axis values are affine in the tip.
  const auto linear_at = [&](const Vec3& tip) {
    return space_->linear_of(follower_->inverse.solve_nearest({tip, to.axis_W}, end.q).q);
  };
  const Vec3 centre_W = move.arc->centre_W, zero = linear_at(centre_W);
  Mat3 M;
  for (int i = 0; i < 3; ++i) M.col(i) = linear_at(centre_W + Vec3::Unit(i)) - zero;
  const Vec3 normal_axes = (M.determinant() < 0.0 ? -1.0 : 1.0) * (M * move.arc->normal_W);
  const Vec3 normal = plan.tilt ? Vec3(plan.tilt->R.transpose() * move.arc->normal_W)
                      : tcp     ? move.arc->normal_W
                                : normal_axes;
  int k = 0;
  normal.cwiseAbs().maxCoeff(&k);
  const int plane = 2 - k;
  // The turns of a plane are rounded.
  const double square = plan.tilt ? std::max(kExact, 3.0 * setup_.rules.rotary_half) : kExact,
               off = (normal - normal[k] * Vec3::Unit(k)).norm();
  if (std::abs(normal[k]) < 1.0 - 1e-12 && off > square) return false;
  if (!can.planes.at(static_cast<size_t>(plane))) return false;

  const Vec3 up_W =
      plan.tilt ? Vec3(std::copysign(1.0, normal[k]) * plan.tilt->R.col(k)) : move.arc->normal_W;
  const double height = (move.to.tip_W - move.from.tip_W).dot(up_W);
  const Vec3 chord = (move.to.tip_W - move.from.tip_W) - height * up_W;
  const double radius = move.arc->normal_W.cross(move.from.tip_W - centre_W).norm();
  const double least = kArcDigits * can.arc_digit_mm;
  const bool closed = chord.norm() == 0.0;
  if (radius * sweep < least || radius < least || (!closed && chord.norm() < least)) return false;
  if (std::abs(height) > kExact && !can.helix) return false;
  const std::array<int, 3> axes{space_->axis_of(0), space_->axis_of(1), space_->axis_of(2)};
  if (!stays_in_travel(follower_->machine,
                       {zero, normal_axes.normalized(), space_->linear_of(plan.q), space_->linear_of(end.q)},
                       sweep, axes))
    return false;  // its chords find out where

  // An arc's centre counts from its start, which has to stand in the same coordinates (behind a cycle).
  if (plan.stretch.steps.empty() || plan.stretch.steps.back().tcp != tcp) stand(move, plan);
  PlanStep step = step_at(move, to, end.q, StepKind::kArc, tcp, plan.tilt);
  step.centre = plan.tilt ? Vec3(plan.tilt->R.transpose() * centre_W)
                : tcp     ? centre_W
                          : Vec3(step.p + (zero - space_->linear_of(end.q)));
  step.plane = plane;
  step.clockwise = normal[k] < 0.0;
  step.dwell_s = move.dwell_s;
  step.at_cl_point = true;
  if (std::abs(height) <= kExact && !plan.stretch.steps.empty() && plan.stretch.steps.back().tcp == tcp &&
      plan.stretch.steps.back().tilt == plan.tilt)
    step.p[k] = plan.stretch.steps.back().p[k];
  // Start, end and centre are rounded each.
  step.deviation_mm = 2.0 * (rounding_mm(*follower_, tcp || plan.tilt, plan.q, end.q) + radius * off);
  add_step(std::move(step), program::way_mm(move), plan);
  return true;
}

bool Planner::add_hole(const HoleSpan& span, Plan& plan) const {
  const program::ClHole& hole = span.hole;
  const program::Move& last = moves_[span.first + static_cast<size_t>(hole.moves) - 1];
  ToolPose at = snapped(*follower_, hole.at);
  if (plan.tilt) at.axis_W = plan.tilt->R.col(2);
  const auto reach = [&](double height) {
    const ToolPose pose{at.tip_W + height * at.axis_W, at.axis_W};
    const Branch branch = follower_->inverse.solve_nearest(pose, plan.q);
    const FollowFault fault = fault_of(*follower_, branch, pose);
    if (!fault.code.empty() && !plan.fault) plan.fault = fault, plan.fault_line = hole.line;
    return branch.q;
  };
  const AxisValues bottom = reach(-hole.cycle.depth_mm), top = reach(hole.cycle.retract_mm);
  if (plan.fault) return false;
  PlanStep step = step_at(last, last.to, top, StepKind::kHole, false, plan.tilt);
  step.feed_mm_s = hole.cycle.feed_mm_s;
  step.hole = static_cast<int>(plan.stretch.holes.size());
  step.at_cl_point = true;
  plan.stretch.holes.push_back(hole);
  ++plan.summary.holes;
  // Its time and ways are those of its single steps.
  for (size_t i = span.first; i < span.first + static_cast<size_t>(hole.moves); ++i) {
    const program::Move& move = moves_[i];
    const AxisValues from = follower_->inverse.solve_nearest(move.from, plan.q).q;
    const AxisValues to = follower_->inverse.solve_nearest(move.to, plan.q).q;
    const double seconds =
        move.rapid ? axis_time(follower_->machine, from, to, true) : program::way_mm(move) / move.feed_mm_s;
    (move.rapid ? plan.summary.rapid_s : plan.summary.feed_s) += seconds;
    plan.summary.dwell_s += move.dwell_s;
    step.duration_s += seconds + move.dwell_s;
  }
  step.deviation_mm = rounding_mm(*follower_, plan.tilt != nullptr, bottom, top);
  plan.summary.deviation_mm = std::max(plan.summary.deviation_mm, step.deviation_mm);
  plan.summary.digits_mm = std::max(plan.summary.digits_mm, step.deviation_mm);
  ++plan.summary.points;
  add_travel(plan.q, bottom, plan.summary);
  add_travel(bottom, top, plan.summary);
  plan.q = top;
  plan.stretch.steps.push_back(std::move(step));
  return true;
}

/// Controls drill their cycles along the machine's own axis: what only leads to a hole has no need of TCP
/// either.
void Planner::without_tcp(size_t first, Plan& plan) const {
  std::vector<PlanStep>& steps = plan.stretch.steps;
  for (size_t i = first; i < steps.size(); ++i) {
    PlanStep& step = steps[i];
    const bool leads = step.kind == StepKind::kApproach || (step.kind == StepKind::kRapid && !step.turns);
    if (!step.tcp || !leads) continue;
    step.tcp = false;
    step.p = axes_point(*space_, step.q);
  }
}

Planner::Plan Planner::plan_from(const State& state, const Entry& begin, RouteChoice way) const {
  Plan plan;
  plan.way = std::move(way);
  plan.poles.sides = plan.way.sides;
  const Start& start = plan.way.start;
  const bool approach = plan.way.lifted;
  plan.q = state.q;
  plan.summary = state.summary;
  if (setup_.abilities.plane.use != PlaneUse::kNever)
    plan.runs = plane_runs(*follower_, moves_, holes_, approach || state.tilt != nullptr);
  if (!approach) plan.tilt = state.tilt;
  std::vector<size_t> steps_before;  // by move
  size_t i = 0;
  if (approach) {
    add_approach(moves_.front(), begin.pose, start.q, state.started, plan);
    for (; i < begin.first; ++i) steps_before.push_back(0);
  }
  while (i < moves_.size() && !plan.fault) {
    if (i >= steps_before.size()) steps_before.push_back(plan.stretch.steps.size());
    change_plane(i, plan);
    // The arrival of a hole may have been the approach.
    const HoleSpan* hole = approach && i > 0 && i == begin.first ? hole_at(holes_, i - 1) : nullptr;
    if (hole == nullptr) hole = hole_at(holes_, i);
    if (hole != nullptr)
      i = add_span(*hole, i, steps_before, plan);
    else
      add_move(moves_[i++], plan);
  }
  plan.fault_step = plan.stretch.steps.size();
  for (const PlacedNote& note : notes_) {
    // What stands before the first move stands before its approach.
    const size_t before = note.before == 0                    ? 0
                          : note.before < steps_before.size() ? steps_before[note.before]
                                                              : plan.stretch.steps.size();
    plan.stretch.notes.push_back({before, note.note});
  }
  return plan;
}

}  // namespace swarf::post
