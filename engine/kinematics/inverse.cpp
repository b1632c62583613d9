#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "base/angles.h"
#include "base/diagnostics.h"
#include "base/units.h"
#include "kinematics/chain.h"
#include "kinematics/lane_pair.h"
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

  /// Takes one of another's rotary solutions.
  void take(int lane, const Candidates& from, int which) {
    for (int slot = 0; slot < 2; ++slot) value[slot][lane] = from.value[slot][which];
    outer_free[lane] = from.outer_free[which];
  }
};

struct InverseKinematics::Targets {
  Vec3 tip_M[2], axis_M[2];
};

struct InverseKinematics::PairSines {
  Pair sine[2], cosine[2];  ///< of the outer and the inner axis, as Candidates::value
};

void InverseKinematics::set_target(const Vec3& tip_W, const Vec3& axis_W, int lane, Targets& targets) const {
  targets.tip_M[lane] = machine_.X_MW * tip_W;
  targets.axis_M[lane] = machine_.X_MW.linear() * axis_W;
}

namespace {

/// The values by whole turns nearest to the hint, or one turn from there where only that is inside the
/// travel.
Pair unwound(const Pair& turn, const Pair& hint, const Pair& least, const Pair& most) {
  // Adding and taking away 1.5 * 2^52 leaves the nearest whole number, without a call and without a branch.
  constexpr double kWhole = 6755399441055744.0;
  const Pair turns_away = (hint - turn) * (1.0 / kTurn);
  const Pair value = turn + kTurn * ((turns_away + kWhole) - kWhole);
  const Pair other = value < least ? value + kTurn : value - kTurn;
  const Pair inside = (other >= least) & (other <= most) ? other : value;
  return (value >= least) & (value <= most) ? value : inside;
}

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
        unwound(rotary_sense_[slot] * turn, before, both(rotary_min_[slot]), both(rotary_max_[slot]));
    // The free rotary stays where it is: its value does not matter to the tool axis, but it moves the tip.
    if (slot == 0 && found[0].outer_free) out.value[slot] = before;
    out.travel += distance(out.value[slot], before);
  }
  return count;
}

namespace {

inline const Vec3& same_for(const Vec3& origin, const Vec3&) {
  return origin;
}
inline Points same_for(const Vec3& origin, const Points&) {
  return both(origin);
}

/// Carries the work or tool point to the base; the linear axes are what is looked for.
/// `place` is where `of` holds an axis.
template <class Of, class Place, class Point>
inline void walk_to_base(const std::vector<LinkStep>& steps, const Of& of, const Place& place, Point& point) {
  for (const LinkStep& step : steps) {
    if (!step.rotary) continue;
    const Point origin = same_for(step.origin, point);
    point = origin + rotate(step.along, step.direction, step.sense * of.sine[place(step.axis)],
                            of.cosine[place(step.axis)], Point(point - origin));
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

void InverseKinematics::locate(const Targets& targets, const PairSines& of, Points& linear_values) const {
  if (!columns_constant_) {
    Vec3 values[2];
    for (int lane = 0; lane < 2; ++lane) {
      Sines one;
      for (const int i : rotary_) {
        one.sine[i] = of.sine[column_[i]][lane];
        one.cosine[i] = of.cosine[column_[i]][lane];
      }
      if (!locate_one(targets.tip_M[lane], one, values[lane]))
        values[lane].setConstant(std::numeric_limits<double>::quiet_NaN());
    }
    linear_values = side_by_side(values[0], values[1]);
    return;
  }
  Points work = side_by_side(targets.tip_M[0], targets.tip_M[1]), tool = both(machine_.tip_M);
  const auto slot = [&](int axis) { return column_[axis]; };
  walk_to_base(table_steps_, of, slot, work);
  walk_to_base(head_steps_, of, slot, tool);
  const Points gap = work - tool;
  const auto row = [&](int i) {
    return linear_inverse_(i, 0) * gap.x + linear_inverse_(i, 1) * gap.y + linear_inverse_(i, 2) * gap.z;
  };
  linear_values = {row(0), row(1), row(2)};
}

/// Of one solution alone; linear axes may ride on rotary ones.
bool InverseKinematics::locate_one(const Vec3& tip_M, const Sines& of, Vec3& linear_values) const {
  Vec3 work = tip_M, tool = machine_.tip_M;
  const auto itself = [](int axis) { return axis; };
  walk_to_base(table_steps_, of, itself, work);
  walk_to_base(head_steps_, of, itself, tool);
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

/// forward() without its last step, the turn into W, which changes no distance.
void InverseKinematics::prove(const Targets& targets, const PairSines& of, const Points& linear_values,
                              bool (&proven)[2]) const {
  const Pair linear[3] = {linear_values.x, linear_values.y, linear_values.z};
  Points tip = both(machine_.tip_M), axis = both(machine_.tool_axis_M);
  for (const LinkStep& step : tool_to_work_) {
    if (!step.rotary) {
      tip = tip + (step.sense * linear[column_[step.axis]]) * both(step.direction);
      continue;
    }
    const int slot = column_[step.axis];
    const Pair sine = step.sense * of.sine[slot], cosine = of.cosine[slot];
    const Points origin = both(step.origin);
    tip = origin + rotate(step.along, step.direction, sine, cosine, tip - origin);
    axis = rotate(step.along, step.direction, sine, cosine, axis);
  }
  const Pair tip_error = squared_norm(tip - side_by_side(targets.tip_M[0], targets.tip_M[1]));
  const Pair axis_error = squared_norm(axis - side_by_side(targets.axis_M[0], targets.axis_M[1]));
  for (int lane = 0; lane < 2; ++lane)
    proven[lane] = tip_error[lane] <= kTipTolerance * kTipTolerance &&
                   axis_error[lane] <= kAxisTolerance * kAxisTolerance;
}

// Fills its results in place: copying them would wait for the single values to reach the cache.
void InverseKinematics::complete(const Targets& targets, const Candidates& candidates,
                                 Branch (&branch)[2]) const {
  const double angle[4] = {candidates.value[0][0], candidates.value[0][1], candidates.value[1][0],
                           candidates.value[1][1]};
  double sine[4], cosine[4];
  lane_sines<4>(angle, sine, cosine);
  PairSines of;
  for (size_t slot = 0; slot < 2; ++slot) {
    of.sine[slot] = Pair{sine[2 * slot], sine[2 * slot + 1]};
    of.cosine[slot] = Pair{cosine[2 * slot], cosine[2 * slot + 1]};
  }
  Points linear_values;
  locate(targets, of, linear_values);
  bool proven[2];
  prove(targets, of, linear_values, proven);
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
    if (!proven[lane]) one = Branch();
  }
}

InverseSolutions InverseKinematics::solve(const ToolPose& pose_W, const AxisValues& hint) const {
  const Vec3 axis_W = unit(pose_W.axis_W);
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
  const Vec3 axis_W = unit(pose_W.axis_W);
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

void InverseKinematics::continued(const ToolPose (&poses_W)[2], const AxisValues (&before)[2],
                                  Branch (&found)[2]) const {
  Candidates chosen;
  Targets targets;
  int counts[2];
  for (int lane = 0; lane < 2; ++lane) {
    const Vec3 axis_W = unit(poses_W[lane].axis_W);
    Candidates own;
    const int count = counts[lane] = candidates(axis_W, before[lane], own);
    AxisValues q[2] = {AxisValues::Zero(), AxisValues::Zero()};
    for (size_t slot = 0; slot < rotary_.size(); ++slot) {
      q[0][rotary_[slot]] = own.value[slot][0];
      q[1][rotary_[slot]] = own.value[slot][1];
    }
    const double first = turn_to(before[lane], q[0]), second = turn_to(before[lane], q[1]);
    chosen.take(lane, own, count == 2 && second < first ? 1 : 0);
    set_target(poses_W[lane].tip_W, axis_W, lane, targets);
  }
  complete(targets, chosen, found);
  for (int lane = 0; lane < 2; ++lane) {
    // The other branch may be proven where the nearest is not.
    if (counts[lane] == 0 || found[lane].outcome == InverseOutcome::kUnreachable) {
      found[lane] = continued(poses_W[lane], before[lane]);
    } else {
      turn_to(before[lane], found[lane].q);
    }
  }
}

double InverseKinematics::pole_distance(const Vec3& axis_W) const {
  if (rotary_.size() < 2) return std::numeric_limits<double>::infinity();
  return pair_.pole_distance(axis_W);
}

}  // namespace swarf::kinematics
