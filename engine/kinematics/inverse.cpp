#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angles.h"
#include "base/diagnostics.h"
#include "base/units.h"
#include "kinematics/chain.h"
#include "kinematics/lanes.h"
#include "kinematics/machine_model.h"
#include "kinematics/model_check.h"

namespace swarf::kinematics {
namespace {

/// A direction that a machine with fewer than two rotary axes cannot reach differs by more than this from
/// those that it can, rad. Wider than rounding: forward() has the last word.
constexpr double kReachTolerance = 1e-11;

/// A squared length this close to 1 is a unit vector up to rounding.
constexpr double kUnitRounding = 1e-15;

/// The tool axis of most poses is unit already: then nothing waits for a root and three divisions.
Vec3 unit(const Vec3& axis) {
  const double squared = axis.squaredNorm();
  if (std::abs(squared - 1.0) <= kUnitRounding) return axis;
  return axis / std::sqrt(squared);
}

double sense(const Axis& axis) {
  return axis.reversed ? -1.0 : 1.0;
}

}  // namespace

InverseKinematics::InverseKinematics(const MachineModel& machine) : machine_(machine) {
  Diagnostics diagnostics;
  for (const ModelProblem& problem : check_model(machine)) {
    diagnostics.error(problem.code, {machine.name}, problem.text, problem.fix);
  }
  diagnostics.throw_if_errors();
  rotary_ = rotary_order(machine);
  for (int i = 0; i < static_cast<int>(machine.axes.size()); ++i) {
    const Axis& axis = machine.axes[i];
    const bool linear = axis.kind == AxisKind::kLinear;
    // What the proof lets pass as rounding is not held against a pose at the very end of the travel.
    const double rounding = linear ? kTipTolerance : kAxisTolerance;
    travel_min_[i] = axis.min - rounding;
    travel_max_[i] = axis.max + rounding;
    if (!linear) continue;
    column_[i] = static_cast<int>(linear_.size());
    linear_.push_back(i);
  }
  prepare_steps();
  prepare_pair();
}

void InverseKinematics::prepare_steps() {
  const auto steps_to_base = [&](const std::vector<int>& chain) {
    std::vector<LinkStep> steps;
    bool linear_met = false;
    for (auto axis = chain.rbegin(); axis != chain.rend(); ++axis) {
      LinkStep step = link_step(machine_, *axis, 1.0);
      // A linear step counts in the loop equation: by which way the axis value moves the tool, not the link.
      if (!step.rotary) step.sense = sense(machine_.axes[*axis]);
      if (step.rotary && linear_met) columns_constant_ = false;
      linear_met = linear_met || !step.rotary;
      steps.push_back(step);
    }
    return steps;
  };
  table_steps_ = steps_to_base(machine_.table_chain);
  head_steps_ = steps_to_base(machine_.head_chain);
  from_tool_to_work(machine_, [&](const LinkStep& step) { tool_to_work_.push_back(step); });
  Mat3 columns;
  for (int i = 0; i < 3; ++i) {
    columns.col(i) = sense(machine_.axes[linear_[i]]) * machine_.axes[linear_[i]].direction_M;
  }
  linear_inverse_ = columns.inverse();
}

void InverseKinematics::prepare_pair() {
  const Mat3 R_WM = machine_.X_MW.linear().transpose();
  const auto direction_W = [&](int axis) -> Vec3 {
    return (R_WM * machine_.axes[axis].direction_M).normalized();
  };
  tool_W_ = (R_WM * machine_.tool_axis_M).normalized();
  if (rotary_.size() == 2) {
    pair_ = RotaryPair(direction_W(rotary_[0]), direction_W(rotary_[1]), tool_W_);
  } else if (rotary_.size() == 1) {
    single_direction_W_ = direction_W(rotary_[0]);
    single_along_ = single_direction_W_.dot(tool_W_);
    single_basis_W_[0] = (tool_W_ - single_along_ * single_direction_W_).normalized();
    single_basis_W_[1] = single_direction_W_.cross(single_basis_W_[0]);
  }
}

int InverseKinematics::turns(const Vec3& axis_W, TurnPair out[2]) const {
  if (rotary_.size() == 2) return pair_.solve(axis_W, out);
  out[0] = {0.0, 0.0, false};
  if (rotary_.empty()) return (axis_W - tool_W_).norm() <= kReachTolerance ? 1 : 0;
  if (!(std::abs(single_direction_W_.dot(axis_W) - single_along_) <= kReachTolerance)) return 0;
  out[0].outer = std::atan2(single_basis_W_[1].dot(axis_W), single_basis_W_[0].dot(axis_W));
  return 1;
}

InverseKinematics::Target InverseKinematics::target(const Vec3& tip_W, const Vec3& axis_W) const {
  return {machine_.X_MW * tip_W, machine_.X_MW.linear() * axis_W};
}

double InverseKinematics::unwound(int slot, double turn, const AxisValues& hint) const {
  // Adding and taking away 1.5 * 2^52 leaves the nearest whole number, without a call and without a branch.
  constexpr double kWhole = 6755399441055744.0;
  const Axis& limits = machine_.axes[rotary_[slot]];
  double value = sense(limits) * turn;
  const double turns_away = (hint[rotary_[slot]] - value) * (1.0 / kTurn);
  value += kTurn * ((turns_away + kWhole) - kWhole);
  if (value >= limits.min && value <= limits.max) return value;
  const double other = value < limits.min ? value + kTurn : value - kTurn;
  return other >= limits.min && other <= limits.max ? other : value;
}

int InverseKinematics::candidates(const Vec3& axis_W, const AxisValues& hint, Candidate out[2]) const {
  TurnPair found[2];
  const int count = turns(axis_W, found);
  const size_t rotaries = rotary_.size();
  for (int i = 0; i < count; ++i) {
    Candidate& one = out[i];
    one = {{0.0, 0.0}, 0.0, found[i].outer_free};
    for (size_t slot = 0; slot < rotaries; ++slot) {
      const double before = hint[rotary_[slot]];
      const double turn = slot == 0 ? found[i].outer : found[i].inner;
      // The free rotary stays where it is: its value does not matter to the tool axis, but it moves the tip.
      one.value[slot] = slot == 0 && one.outer_free ? before : unwound(slot, turn, hint);
      one.travel += std::abs(one.value[slot] - before);
    }
  }
  return count;
}

namespace {

/// Carries the work or tool point to the base; the linear axes are what is looked for.
inline void walk_to_base(const std::vector<LinkStep>& steps, const Sines& of, Vec3& point) {
  for (const LinkStep& step : steps) {
    if (!step.rotary) continue;
    point = step.origin + rotate(step.along, step.direction, step.sense * of.sine[step.axis],
                                 of.cosine[step.axis], point - step.origin);
  }
}

/// The directions in which the linear axes of one side move the tool, after the rotary axes below them.
void turn_columns(const std::vector<LinkStep>& steps, const int (&column)[kMaxAxes], const Sines& of,
                  Mat3& columns) {
  bool met[3] = {false, false, false};
  for (const LinkStep& step : steps) {
    if (!step.rotary) {
      met[column[step.axis]] = true;
      columns.col(column[step.axis]) = step.sense * step.direction;
    }
    for (int i = 0; step.rotary && i < 3; ++i) {
      if (!met[i]) continue;
      columns.col(i) = rotate(step.along, step.direction, step.sense * of.sine[step.axis],
                              of.cosine[step.axis], columns.col(i));
    }
  }
}

}  // namespace

bool InverseKinematics::locate(const Vec3& tip_M, const Sines& of, Vec3& linear_values) const {
  Vec3 work = tip_M, tool = machine_.tip_M;
  walk_to_base(table_steps_, of, work);
  walk_to_base(head_steps_, of, tool);
  if (columns_constant_) {
    linear_values = linear_inverse_ * (work - tool);
    return true;
  }
  Mat3 columns;
  turn_columns(table_steps_, column_, of, columns);
  turn_columns(head_steps_, column_, of, columns);
  if (!(std::abs(columns.determinant()) >= kParallelTolerance)) return false;
  linear_values = columns.inverse() * (work - tool);
  return true;
}

int InverseKinematics::first_out_of_travel(const AxisValues& q) const {
  for (int i = 0; i < kMaxAxes; ++i) {
    if (!(q[i] >= travel_min_[i] && q[i] <= travel_max_[i])) return i;
  }
  return -1;
}

// Fills its result in place: copying it would wait for the single values to reach the cache.
void InverseKinematics::complete(const Target& target, const Candidate& candidate, const Sines& of,
                                 Branch& branch) const {
  for (size_t slot = 0; slot < rotary_.size(); ++slot) branch.q[rotary_[slot]] = candidate.value[slot];
  Vec3 linear_values;
  if (!locate(target.tip_M, of, linear_values)) return;
  for (int i = 0; i < 3; ++i) branch.q[linear_[i]] = linear_values[i];

  // forward() without its last step, the turn into W, which changes no distance.
  Vec3 back_tip_M = machine_.tip_M, back_axis_M = machine_.tool_axis_M;
  for (const LinkStep& step : tool_to_work_) carry(step, branch.q, of, back_tip_M, back_axis_M);
  const bool proven = (back_tip_M - target.tip_M).squaredNorm() <= kTipTolerance * kTipTolerance &&
                      (back_axis_M - target.axis_M).squaredNorm() <= kAxisTolerance * kAxisTolerance;
  if (!proven) return;
  branch.out_of_travel_axis = first_out_of_travel(branch.q);
  branch.outcome = branch.out_of_travel_axis >= 0 ? InverseOutcome::kOutOfTravel
                   : candidate.outer_free         ? InverseOutcome::kSingular
                                                  : InverseOutcome::kOk;
}

namespace {

void set(Sines& of, const std::vector<int>& rotary, const double* sine, const double* cosine) {
  for (size_t slot = 0; slot < rotary.size(); ++slot) {
    of.sine[rotary[slot]] = sine[slot];
    of.cosine[rotary[slot]] = cosine[slot];
  }
}

}  // namespace

Sines InverseKinematics::sines_of(const Candidate& one) const {
  double sine[2], cosine[2];
  lane_sines<2>(one.value, sine, cosine);
  Sines of;
  set(of, rotary_, sine, cosine);
  return of;
}

void InverseKinematics::sines_of(const Candidate (&both)[2], Sines (&of)[2]) const {
  const double angle[4] = {both[0].value[0], both[0].value[1], both[1].value[0], both[1].value[1]};
  double sine[4], cosine[4];
  lane_sines<4>(angle, sine, cosine);
  set(of[0], rotary_, sine, cosine);
  set(of[1], rotary_, sine + 2, cosine + 2);
}

InverseSolutions InverseKinematics::solve(const ToolPose& pose_W, const AxisValues& hint) const {
  const Vec3 axis_W = unit(pose_W.axis_W);
  Candidate found[2]{};
  const int count = candidates(axis_W, hint, found);
  Sines of[2];
  sines_of(found, of);
  const Target pose_M = target(pose_W.tip_W, axis_W);
  InverseSolutions solutions;
  for (int i = 0; i < count; ++i) {
    Branch& branch = solutions.branch[solutions.count];
    branch = Branch();
    complete(pose_M, found[i], of[i], branch);
    if (branch.outcome != InverseOutcome::kUnreachable) ++solutions.count;
  }
  return solutions;
}

Branch InverseKinematics::solve_nearest(const ToolPose& pose_W, const AxisValues& hint) const {
  const Vec3 axis_W = unit(pose_W.axis_W);
  Candidate found[2];
  const int count = candidates(axis_W, hint, found);
  Branch best;
  if (count == 0) return best;
  const Target pose_M = target(pose_W.tip_W, axis_W);
  const int near = count == 2 && found[1].travel < found[0].travel ? 1 : 0;
  complete(pose_M, found[near], sines_of(found[near]), best);
  if (count == 1 || best.outcome == InverseOutcome::kOk) return best;
  Branch other;
  complete(pose_M, found[1 - near], sines_of(found[1 - near]), other);
  if (other.outcome == InverseOutcome::kOk || best.outcome == InverseOutcome::kUnreachable) best = other;
  return best;
}

double InverseKinematics::pole_distance(const Vec3& axis_W) const {
  if (rotary_.size() < 2) return std::numeric_limits<double>::infinity();
  return pair_.pole_distance(axis_W);
}

}  // namespace swarf::kinematics
