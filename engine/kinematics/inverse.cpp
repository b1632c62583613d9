#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "base/angles.h"
#include "base/diagnostics.h"
#include "base/units.h"
#include "kinematics/chain.h"
#include "kinematics/lane_kernel.h"
#include "kinematics/lane_pair.h"
#include "kinematics/machine_model.h"
#include "kinematics/model_check.h"

namespace swarf::kinematics {
namespace {

/// A direction that a machine with fewer than two rotary axes cannot reach differs by more than this from
/// those that it can, rad. Wider than rounding: forward() has the last word.
constexpr double kReachTolerance = 1e-11;

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
  for (size_t slot = 0; slot < rotary_.size(); ++slot) {
    const Axis& axis = machine.axes[rotary_[slot]];
    rotary_min_[slot] = axis.min;
    rotary_max_[slot] = axis.max;
    rotary_sense_[slot] = sense(axis);
    column_[rotary_[slot]] = static_cast<int>(slot);
  }
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

struct InverseKinematics::Candidates {
  Pair value[2] = {};  ///< of the outer and the inner axis, unwound; 0 for those that the machine lacks
  Pair travel = {};    ///< sum of the distances to the hint
  bool outer_free[2] = {false, false};
};

struct InverseKinematics::Targets {
  Vec3 tip_M[2], axis_M[2];
};

void InverseKinematics::set_target(const Vec3& tip_W, const Vec3& axis_W, int lane, Targets& targets) const {
  targets.tip_M[lane] = machine_.X_MW * tip_W;
  targets.axis_M[lane] = machine_.X_MW.linear() * axis_W;
}

namespace {

Pair distance(const Pair& a, const Pair& b) {
  const Pair change = a - b;
  return change < 0.0 ? -change : change;
}

}  // namespace

/// Where there is one solution, both places hold it.
int InverseKinematics::candidates(const Vec3& axis_W, const AxisValues& hint, Candidates& out) const {
  TurnPair found[2];
  const int count = turns(axis_W, found);
  if (count == 0) return 0;
  if (count == 1) found[1] = found[0];
  out.outer_free[0] = found[0].outer_free;
  out.outer_free[1] = found[1].outer_free;
  for (size_t slot = 0; slot < rotary_.size(); ++slot) {
    const Pair before = both(hint[rotary_[slot]]);
    const Pair turn = slot == 0 ? Pair{found[0].outer, found[1].outer} : Pair{found[0].inner, found[1].inner};
    out.value[slot] =
        LaneKernel::unwound<Pair>(rotary_sense_[slot] * turn, before, rotary_min_[slot], rotary_max_[slot]);
    // The free rotary stays where it is: its value does not matter to the tool axis, but it moves the tip.
    if (slot == 0 && found[0].outer_free) out.value[slot] = before;
    out.travel += distance(out.value[slot], before);
  }
  return count;
}

namespace {

/// Carries the work or tool point to the base; the linear axes are what is looked for.
void walk_to_base(const std::vector<LinkStep>& steps, const Sines& of, Vec3& point) {
  for (const LinkStep& step : steps) {
    if (!step.rotary) continue;
    point = step.origin + rotate(step.along, step.direction, step.sense * of.sine[step.axis],
                                 of.cosine[step.axis], Vec3(point - step.origin));
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

/// Of one solution alone; linear axes may ride on rotary ones.
bool InverseKinematics::locate_one(const Vec3& tip_M, const Sines& of, Vec3& linear_values) const {
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

/// The first axis outside, or -1.
int InverseKinematics::first_out_of_travel(const AxisValues& q) const {
  unsigned outside = 0;
  for (int i = 0; i < kMaxAxes; ++i)
    outside |= static_cast<unsigned>(!(q[i] >= travel_min_[i] && q[i] <= travel_max_[i])) << i;
  return outside == 0 ? -1 : std::countr_zero(outside);
}

/// Where linear axes ride on rotary ones; not a number where they have become dependent.
Points InverseKinematics::located_apart(const Targets& targets, const double (&sine)[4],
                                        const double (&cosine)[4]) const {
  Vec3 values[2];
  for (int lane = 0; lane < 2; ++lane) {
    Sines one;
    for (const int i : rotary_) {
      one.sine[i] = sine[2 * column_[i] + lane];
      one.cosine[i] = cosine[2 * column_[i] + lane];
    }
    if (!locate_one(targets.tip_M[lane], one, values[lane]))
      values[lane].setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return side_by_side(values[0], values[1]);
}

// Fills its results in place: copying them would wait for the single values to reach the cache.
void InverseKinematics::complete(const Targets& targets, const Candidates& candidates,
                                 Branch (&branch)[2]) const {
  const double angle[4] = {candidates.value[0][0], candidates.value[0][1], candidates.value[1][0],
                           candidates.value[1][1]};
  double sine[4], cosine[4];
  lane_sines<4>(angle, sine, cosine);
  LaneSines<2> of;
  for (size_t slot = 0; slot < 2; ++slot) {
    of.sine[slot] = Pair{sine[2 * slot], sine[2 * slot + 1]};
    of.cosine[slot] = Pair{cosine[2 * slot], cosine[2 * slot + 1]};
  }
  const Points tip_M = side_by_side(targets.tip_M[0], targets.tip_M[1]);
  const Points axis_M = side_by_side(targets.axis_M[0], targets.axis_M[1]);
  const Points linear_values =
      columns_constant_ ? LaneKernel::locate<2>(*this, tip_M, of) : located_apart(targets, sine, cosine);
  const Pair disproven = LaneKernel::disprove<2>(*this, tip_M, axis_M, of, linear_values);
  for (int lane = 0; lane < 2; ++lane) {
    Branch& one = branch[lane];
    one.q.setZero();
    for (size_t slot = 0; slot < rotary_.size(); ++slot) one.q[rotary_[slot]] = candidates.value[slot][lane];
    one.q[linear_[0]] = linear_values.x[lane];
    one.q[linear_[1]] = linear_values.y[lane];
    one.q[linear_[2]] = linear_values.z[lane];
    one.out_of_travel_axis = first_out_of_travel(one.q);
    one.outcome = one.out_of_travel_axis >= 0   ? InverseOutcome::kOutOfTravel
                  : candidates.outer_free[lane] ? InverseOutcome::kSingular
                                                : InverseOutcome::kOk;
    if (disproven[lane] != 0.0) one = Branch();
  }
}

InverseSolutions InverseKinematics::solve(const ToolPose& pose_W, const AxisValues& hint) const {
  const Vec3 axis_W = unit_axis(pose_W.axis_W);
  Candidates found;
  InverseSolutions solutions;
  const int count = candidates(axis_W, hint, found);
  if (count == 0) return solutions;
  Targets targets;
  set_target(pose_W.tip_W, axis_W, 0, targets);
  set_target(pose_W.tip_W, axis_W, 1, targets);
  complete(targets, found, solutions.branch);
  const bool first = solutions.branch[0].outcome != InverseOutcome::kUnreachable;
  const bool second = count == 2 && solutions.branch[1].outcome != InverseOutcome::kUnreachable;
  if (!first && second) solutions.branch[0] = solutions.branch[1];
  if (!(first && second)) solutions.branch[1] = Branch();
  solutions.count = static_cast<int>(first) + static_cast<int>(second);
  return solutions;
}

// Most often the nearest alone is looked at: walking one is cheaper than two side by side.
Branch InverseKinematics::solve_nearest(const ToolPose& pose_W, const AxisValues& hint) const {
  const Vec3 axis_W = unit_axis(pose_W.axis_W);
  Candidates found;
  const int count = candidates(axis_W, hint, found);
  Branch best;
  if (count == 0) return best;
  const Vec3 tip_M = machine_.X_MW * pose_W.tip_W, axis_M = machine_.X_MW.linear() * axis_W;
  const auto complete_one = [&](int which, Branch& branch) {
    const double value[2] = {found.value[0][which], found.value[1][which]};
    double sine[2], cosine[2];
    lane_sines<2>(value, sine, cosine);
    Sines of;
    for (size_t slot = 0; slot < rotary_.size(); ++slot) {
      branch.q[rotary_[slot]] = value[slot];
      of.sine[rotary_[slot]] = sine[slot];
      of.cosine[rotary_[slot]] = cosine[slot];
    }
    Vec3 linear_values;
    if (!locate_one(tip_M, of, linear_values)) return;
    for (int i = 0; i < 3; ++i) branch.q[linear_[i]] = linear_values[i];
    Vec3 tip = machine_.tip_M, axis = machine_.tool_axis_M;
    for (const LinkStep& step : tool_to_work_) carry(step, branch.q, of, tip, axis);
    const bool proven = (tip - tip_M).squaredNorm() <= kTipTolerance * kTipTolerance &&
                        (axis - axis_M).squaredNorm() <= kAxisTolerance * kAxisTolerance;
    if (!proven) return;
    branch.out_of_travel_axis = first_out_of_travel(branch.q);
    branch.outcome = branch.out_of_travel_axis >= 0 ? InverseOutcome::kOutOfTravel
                     : found.outer_free[which]      ? InverseOutcome::kSingular
                                                    : InverseOutcome::kOk;
  };
  const int near = count == 2 && found.travel[1] < found.travel[0] ? 1 : 0;
  complete_one(near, best);
  if (count == 1 || best.outcome == InverseOutcome::kOk) return best;
  Branch other;
  complete_one(1 - near, other);
  if (other.outcome == InverseOutcome::kOk || best.outcome == InverseOutcome::kUnreachable) best = other;
  return best;
}

/// Turns the rotary values by whole turns to those nearest to the ones before; returns the sum of what is
/// left of the way.
double InverseKinematics::turn_to(const AxisValues& before, AxisValues& q) const {
  double turn = 0.0;
  for (const int i : rotary_) {
    q[i] += kTurn * std::nearbyint((before[i] - q[i]) / kTurn);
    turn += std::abs(q[i] - before[i]);
  }
  return turn;
}

Branch InverseKinematics::continued(const ToolPose& pose_W, const AxisValues& before) const {
  InverseSolutions solutions = solve(pose_W, before);
  const double first = turn_to(before, solutions.branch[0].q);
  if (solutions.count < 2) return solutions.branch[0];
  return solutions.branch[turn_to(before, solutions.branch[1].q) < first ? 1 : 0];
}

double InverseKinematics::pole_distance(const Vec3& axis_W) const {
  if (rotary_.size() < 2) return std::numeric_limits<double>::infinity();
  return pair_.pole_distance(axis_W);
}

}  // namespace swarf::kinematics
