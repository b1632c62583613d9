#include "program/control/tilt.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "kinematics/model_check.h"
#include "kinematics/reach.h"
#include "program/control/emit.h"
#include "program/control/path.h"

namespace swarf::program::nc {
namespace {

using kinematics::AxisValues;

/// Both branches for the gauge line where it stands, inside the travel or not.
kinematics::InverseSolutions tilt_branches(const Control& control, const Vec3& axis_P) {
  const Vec3 axis_W = (control.space.frame().linear() * axis_P).normalized();
  const Vec3 tip_W =
      kinematics::forward(kinematics::with_tool(control.setup.machine, 0.0), control.path.q).tip_W;
  return control.space.inverse().solve({tip_W, axis_W}, control.path.q);
}

[[noreturn]] void fail_tilt(const Control& control, const Vec3& axis_P, const TiltPreference& preference,
                            int axis, int column) {
  const kinematics::InverseSolutions found = tilt_branches(control, axis_P);
  const Vec3 axis_W = (control.space.frame().linear() * axis_P).normalized();
  if (found.count == 0) {
    const kinematics::MachineModel bare = kinematics::with_tool(control.setup.machine, 0.0);
    const auto [text, fix] =
        kinematics::unreachable_text(bare, {kinematics::forward(bare, control.path.q).tip_W, axis_W});
    control.report.fail("unreachable-orientation", column, text, fix);
  }
  std::string text;
  for (int i = 0; i < found.count; ++i) {
    text += i == 0 ? ": " : "; or ";
    std::string beyond;
    for (const int one : kinematics::rotary_order(control.setup.machine)) {
      const kinematics::Axis& rotary = control.setup.machine.axes[static_cast<size_t>(one)];
      const double value = found.branch[i].q[one], excess = kinematics::travel_excess(rotary, value);
      text += fmt::format("{}{:.3f} ", rotary.name, deg_from_rad(value));
      if (std::abs(excess) > kinematics::kAxisTolerance)
        beyond += fmt::format(", {:.4g} deg are missing in the travel of {}", deg_from_rad(std::abs(excess)),
                              rotary.name);
    }
    text += "deg" + beyond;
  }
  const bool chosen = preference.choice != TiltPreference::Choice::kNearest && axis >= 0;
  if (chosen) {
    text += fmt::format("; {} is asked to be {}", control.setup.machine.axes[static_cast<size_t>(axis)].name,
                        preference.choice == TiltPreference::Choice::kPositive ? "positive" : "negative");
  }
  control.report.fail(
      "unreachable-orientation", column,
      fmt::format("the rotary axes cannot point the tool along ({:.6f}, {:.6f}, {:.6f}) in W{}", axis_W.x(),
                  axis_W.y(), axis_W.z(), text),
      chosen ? "ask for the other solution, or change the angles of the plane"
             : "change the angles of the plane, or the machine");
}

}  // namespace

std::vector<AxisValues> tilt_solutions(const Control& control, const Vec3& axis_P) {
  const kinematics::InverseSolutions found = tilt_branches(control, axis_P);
  std::vector<AxisValues> solutions;
  const auto inside = [&](const AxisValues& q) {
    for (int word = 3; word < kAxisWords; ++word) {
      const int i = control.space.axis_of(static_cast<AxisWord>(word));
      if (i < 0) continue;
      const kinematics::Axis& axis = control.setup.machine.axes[static_cast<size_t>(i)];
      if (q[i] < axis.min - kinematics::kAxisTolerance || q[i] > axis.max + kinematics::kAxisTolerance)
        return false;
    }
    return true;
  };
  for (int i = 0; i < found.count; ++i) {
    if (inside(found.branch[i].q)) solutions.push_back(found.branch[i].q);
  }
  const auto travel = [&](const AxisValues& q) {
    double sum = 0.0;
    for (int word = 3; word < kAxisWords; ++word) {
      const int i = control.space.axis_of(static_cast<AxisWord>(word));
      if (i >= 0) sum += std::abs(q[i] - control.path.q[i]);
    }
    return sum;
  };
  std::stable_sort(solutions.begin(), solutions.end(),
                   [&](const AxisValues& a, const AxisValues& b) { return travel(a) < travel(b); });
  return solutions;
}

AxisValues tilt_solution(const Control& control, const Vec3& axis_P, const TiltPreference& preference,
                         int column) {
  const std::vector<AxisValues> solutions = tilt_solutions(control, axis_P);
  int axis = preference.axis >= 0 ? control.space.axis_of(static_cast<AxisWord>(preference.axis)) : -1;
  const std::vector<int> order = kinematics::rotary_order(control.setup.machine);
  if (axis < 0 && !order.empty()) axis = order.back();
  for (const AxisValues& q : solutions) {
    const double value = axis >= 0 ? q[axis] : 0.0;
    const bool fits = preference.choice == TiltPreference::Choice::kNearest || std::abs(value) <= 1e-9 ||
                      (value > 0.0) == (preference.choice == TiltPreference::Choice::kPositive);
    if (fits) return q;
  }
  fail_tilt(control, axis_P, preference, axis, column);
}

void turn_rotaries(Control& control, Motion motion, const AxisValues& q, bool tip_stands) {
  flush(control);
  if (!control.path.started) {
    control.report.fail("start-unknown", 0, "the rotary axes turn, and the position is not known yet",
                        fmt::format("give the start position (start in [setup] of the scene, swarf check "
                                    "--home), or position all axes with {} before it",
                                    control.report.words.rapid));
  }
  const std::array<double, 3> rotary = control.space.rotary_of(q);
  Vec3 linear = control.space.linear_of(control.path.q);
  if (tip_stands) {
    const LinearMap now = control.space.compensated(control.space.rotary_of(control.path.q));
    const LinearMap& then = control.space.compensated(rotary);
    linear = then.inverse * (now.base_W + now.columns_W * linear - then.base_W);
  }
  Segment segment;
  prepare(control.report, control.modal, motion, Target(), segment);
  segment.machine = true;
  segment.law = tip_stands ? BlockLaw::kTcpAxes : BlockLaw::kJoint;
  segment.from = control.space.linear_of(control.path.q);
  segment.to = linear;
  segment.rotary_from = control.space.rotary_of(control.path.q);
  segment.rotary_to = rotary;
  segment.turns_rotaries = rotary != segment.rotary_from;
  if (tip_stands) segment.from = segment.to;  // no way of the tip: the feed counts degrees
  emit(control, segment);
  control.path.position_valid = false;
}

}  // namespace swarf::program::nc
