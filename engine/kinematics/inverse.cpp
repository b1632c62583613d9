#include <algorithm>
#include <cmath>
#include <limits>

#include "base/diagnostics.h"
#include "base/units.h"
#include "kinematics/machine_model.h"
#include "kinematics/model_check.h"
#include "kinematics/rotation.h"

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
  for (int i = 0; i < static_cast<int>(machine.axes.size()); ++i) {
    if (machine.axes[i].kind == AxisKind::kLinear) linear_.push_back(i);
  }
  const auto step = [&](int index, double side) {
    const Axis& axis = machine.axes[index];
    const std::vector<int>& peers = axis.kind == AxisKind::kLinear ? linear_ : rotary_;
    const int slot = static_cast<int>(std::find(peers.begin(), peers.end(), index) - peers.begin());
    return Step{axis.kind, slot, axis.kind == AxisKind::kLinear ? sense(axis) : side, axis.direction_M,
                axis.origin_M};
  };
  for (auto it = machine.table_chain.rbegin(); it != machine.table_chain.rend(); ++it)
    table_steps_.push_back(step(*it, -1.0));
  for (auto it = machine.head_chain.rbegin(); it != machine.head_chain.rend(); ++it)
    head_steps_.push_back(step(*it, 1.0));
  for (const auto* steps : {&table_steps_, &head_steps_}) {
    bool linear_met = false;
    for (const Step& one : *steps) {
      if (one.kind == AxisKind::kLinear) linear_met = true;
      if (one.kind == AxisKind::kRotary && linear_met) columns_constant_ = false;
    }
  }
  Mat3 columns;
  for (int i = 0; i < 3; ++i) {
    columns.col(i) = sense(machine.axes[linear_[i]]) * machine.axes[linear_[i]].direction_M;
  }
  linear_inverse_ = columns.inverse();

  const Vec3& tool = machine.tool_axis_M;
  if (rotary_.size() == 2) {
    pair_ = RotaryPair(machine.axes[rotary_[0]].direction_M, machine.axes[rotary_[1]].direction_M, tool);
  } else if (rotary_.size() == 1) {
    const Vec3& e = machine.axes[rotary_[0]].direction_M;
    single_along_ = e.dot(tool);
    single_basis_[0] = tool - single_along_ * e;
    single_across_ = single_basis_[0].norm();
    single_basis_[0] /= single_across_;
    single_basis_[1] = e.cross(single_basis_[0]);
  }
}

int InverseKinematics::turns(const Vec3& axis_M, TurnPair out[2]) const {
  if (rotary_.size() == 2) return pair_.solve(axis_M, out);
  out[0] = TurnPair();
  if (rotary_.empty()) return (axis_M - machine_.tool_axis_M).norm() <= kReachTolerance ? 1 : 0;
  if (!(std::abs(machine_.axes[rotary_[0]].direction_M.dot(axis_M) - single_along_) <= kReachTolerance))
    return 0;
  const double a = single_basis_[0].dot(axis_M), b = single_basis_[1].dot(axis_M);
  out[0].outer = {std::atan2(b, a), b / single_across_, a / single_across_};
  return 1;
}

double InverseKinematics::unwound(int axis, double turn, const AxisValues& hint) const {
  constexpr double kTurn = 2.0 * kPi;
  const Axis& limits = machine_.axes[axis];
  const double value = sense(limits) * turn;
  const double nearest = value + kTurn * std::nearbyint((hint[axis] - value) * (1.0 / kTurn));
  if (nearest >= limits.min && nearest <= limits.max) return nearest;
  const double other = nearest < limits.min ? nearest + kTurn : nearest - kTurn;
  return other >= limits.min && other <= limits.max ? other : nearest;
}

int InverseKinematics::candidates(const Vec3& axis_M, const AxisValues& hint, Candidate out[2]) const {
  TurnPair found[2];
  const int count = turns(axis_M, found);
  for (int i = 0; i < count; ++i) {
    Candidate& one = out[i];
    one.turns = found[i];
    one.travel = 0.0;
    for (size_t slot = 0; slot < rotary_.size(); ++slot) {
      const int axis = rotary_[slot];
      if (slot == 0 && one.turns.outer_free) {
        // The free rotary stays where it is; its value cannot matter to the tool axis, but it moves the tip.
        const double turn = sense(machine_.axes[axis]) * hint[axis];
        one.value[0] = hint[axis];
        one.turns.outer = {turn, std::sin(turn), std::cos(turn)};
        continue;
      }
      one.value[slot] = unwound(axis, slot == 0 ? one.turns.outer.angle : one.turns.inner.angle, hint);
      one.travel += std::abs(one.value[slot] - hint[axis]);
    }
  }
  return count;
}

Vec3 InverseKinematics::walk(const std::vector<Step>& steps, Vec3 point, const TurnPair& turns,
                             Mat3* columns) const {
  bool met[3] = {false, false, false};
  for (const Step& step : steps) {
    if (step.kind == AxisKind::kLinear) {
      if (columns != nullptr) columns->col(step.slot) = step.sense * step.direction;
      met[step.slot] = true;
      continue;
    }
    const Turn& turn = step.slot == 0 ? turns.outer : turns.inner;
    const double sine = step.sense * turn.sine;
    point = step.origin + rotate(step.direction, sine, turn.cosine, point - step.origin);
    for (int i = 0; columns != nullptr && i < 3; ++i) {
      if (met[i]) columns->col(i) = rotate(step.direction, sine, turn.cosine, columns->col(i));
    }
  }
  return point;
}

bool InverseKinematics::locate(const Vec3& tip_M, const TurnPair& turns, Vec3& linear_values) const {
  Mat3 columns = Mat3::Identity();
  Mat3* varying = columns_constant_ ? nullptr : &columns;
  const Vec3 gap =
      walk(table_steps_, tip_M, turns, varying) - walk(head_steps_, machine_.tip_M, turns, varying);
  if (columns_constant_) {
    linear_values = linear_inverse_ * gap;
    return true;
  }
  if (!(std::abs(columns.determinant()) >= kParallelTolerance)) return false;
  linear_values = columns.inverse() * gap;
  return true;
}

int InverseKinematics::first_out_of_travel(const AxisValues& q) const {
  for (int i = 0; i < static_cast<int>(machine_.axes.size()); ++i) {
    const Axis& axis = machine_.axes[i];
    // What the proof lets pass as rounding is not held against a pose at the very end of the travel.
    const double rounding = axis.kind == AxisKind::kLinear ? kTipTolerance : kAxisTolerance;
    if (!(q[i] >= axis.min - rounding && q[i] <= axis.max + rounding)) return i;
  }
  return -1;
}

Branch InverseKinematics::complete(const ToolPose& unit_W, const Vec3& tip_M,
                                   const Candidate& candidate) const {
  Branch branch;
  Vec3 linear_values;
  if (!locate(tip_M, candidate.turns, linear_values)) return branch;
  for (size_t slot = 0; slot < rotary_.size(); ++slot) branch.q[rotary_[slot]] = candidate.value[slot];
  for (int i = 0; i < 3; ++i) branch.q[linear_[i]] = linear_values[i];

  const ToolPose back = forward(machine_, branch.q);
  const bool proven = (back.tip_W - unit_W.tip_W).squaredNorm() <= kTipTolerance * kTipTolerance &&
                      (back.axis_W - unit_W.axis_W).squaredNorm() <= kAxisTolerance * kAxisTolerance;
  if (!proven) return branch;
  branch.out_of_travel_axis = first_out_of_travel(branch.q);
  branch.outcome = branch.out_of_travel_axis >= 0 ? InverseOutcome::kOutOfTravel
                   : candidate.turns.outer_free   ? InverseOutcome::kSingular
                                                  : InverseOutcome::kOk;
  return branch;
}

InverseSolutions InverseKinematics::solve(const ToolPose& pose_W, const AxisValues& hint) const {
  const ToolPose unit_W{pose_W.tip_W, pose_W.axis_W.normalized()};
  const Vec3 tip_M = machine_.X_MW * unit_W.tip_W;
  Candidate found[2];
  const int count = candidates(machine_.X_MW.linear() * unit_W.axis_W, hint, found);
  InverseSolutions solutions;
  for (int i = 0; i < count; ++i) {
    const Branch branch = complete(unit_W, tip_M, found[i]);
    if (branch.outcome != InverseOutcome::kUnreachable) solutions.branch[solutions.count++] = branch;
  }
  return solutions;
}

Branch InverseKinematics::solve_nearest(const ToolPose& pose_W, const AxisValues& hint) const {
  const ToolPose unit_W{pose_W.tip_W, pose_W.axis_W.normalized()};
  const Vec3 tip_M = machine_.X_MW * unit_W.tip_W;
  Candidate found[2];
  const int count = candidates(machine_.X_MW.linear() * unit_W.axis_W, hint, found);
  if (count == 0) return {};
  const int near = count == 2 && found[1].travel < found[0].travel ? 1 : 0;
  const Branch first = complete(unit_W, tip_M, found[near]);
  if (count == 1 || first.outcome == InverseOutcome::kOk) return first;
  const Branch second = complete(unit_W, tip_M, found[1 - near]);
  const bool better = second.outcome == InverseOutcome::kOk || first.outcome == InverseOutcome::kUnreachable;
  return better ? second : first;
}

double InverseKinematics::pole_distance(const Vec3& axis_W) const {
  if (rotary_.size() < 2) return std::numeric_limits<double>::infinity();
  return pair_.pole_distance(machine_.X_MW.linear() * axis_W);
}

}  // namespace swarf::kinematics
