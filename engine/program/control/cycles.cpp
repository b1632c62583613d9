// Drilling cycles, curves and tilted planes: what expands into several moves.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "kinematics/model_check.h"
#include "kinematics/reach.h"
#include "program/control/control.h"

namespace swarf::program::nc {
namespace {

using kinematics::AxisValues;

/// A cycle with more pecks than this is a slip of the depth per peck.
constexpr double kPecksMax = 100'000.0;

}  // namespace

// --- Drilling
// ------------------------------------------------------------------------------------------------

void Control::go(Motion motion, int normal, double height) {
  Target target;
  target.set(normal, height, false);
  line(motion, target);
}

void Control::check_cycle(const DrillCycle& cycle, const Target& hole) {
  if (!started_) {
    fail("start-unknown", hole.column, "a cycle starts, and the position is not known yet",
         fmt::format("position all axes with {} before the cycle", words_.rapid));
  }
  if (cycle.peck != DrillCycle::Peck::kNone &&
      !(std::abs(cycle.bottom - cycle.approach) <= kPecksMax * cycle.peck_mm)) {
    fail("bad-cycle", hole.column, fmt::format("the depth per peck is {:g} mm", cycle.peck_mm),
         "give a depth per peck above zero");
  }
  if (!(cycle.dwell_s >= 0.0)) {
    fail("out-of-range", hole.column, fmt::format("the cycle dwells {:g} s", cycle.dwell_s),
         "write a time of zero or more");
  }
  if (cycle.bore != DrillCycle::Bore::kPlain) {
    warn_once("oriented-tool", hole.column,
              "the tool passes the bore beside its axis with the spindle stopped at a known angle; the "
              "simulated tool is a body of revolution, so it may cut there what the oriented edge does not",
              "judge gouges and cuts without spindle of this cycle by the shape of the boring bar");
  }
  if (cycle.manual_out) {
    warn_once("manual-retract", hole.column,
              "this cycle waits at the bottom until the tool is drawn out by hand; simulated as a straight "
              "rapid move to the approach height",
              "add the time that the operator takes");
  }
}

void Control::drill(const DrillCycle& cycle, const Target& hole) {
  const PlaneAxes axes = axes_of(plane_);
  const double sign = cycle.bottom <= cycle.approach ? 1.0 : -1.0;  // +1: drills against the normal
  Target above = hole;
  above.given = static_cast<uint8_t>(hole.given & ~(1u << axes.normal));
  check_cycle(cycle, hole);
  if (cycle.bore == DrillCycle::Bore::kBack) return bore_back(cycle, above);
  if (sign * (position_xyz()[axes.normal] - cycle.approach) < 0.0)
    go(Motion::kRapid, axes.normal, cycle.approach);
  if (above.any()) line(Motion::kRapid, above);
  go(Motion::kRapid, axes.normal, cycle.approach);
  const double feed = feed_, feed_unit_mm = feed_unit_mm_;
  const FeedMode mode = feed_mode_;
  if (cycle.pitch_mm > 0.0) {
    if (speed_rpm_ <= 0.0) {
      fail("feed-without-spindle", hole.column, "tapping without a spindle speed",
           "write S before the cycle");
    }
    feed_mode_ = FeedMode::kPerMinute;
    feed_ = cycle.pitch_mm * speed_rpm_;
    feed_unit_mm_ = 1.0;
  }
  peck_down(cycle, axes.normal, sign);
  if (cycle.dwell_s > 0.0) pending_dwell_s_ += cycle.dwell_s;
  draw_out(cycle, axes.normal);
  feed_ = feed;
  feed_unit_mm_ = feed_unit_mm;
  feed_mode_ = mode;
}

void Control::draw_out(const DrillCycle& cycle, int normal) {
  const int spindle_down = spindle_;
  if (cycle.bore == DrillCycle::Bore::kFine) return leave_aside(cycle, normal);
  if (cycle.stop_at_bottom || cycle.manual_out) spindle_ = 0;
  if (cycle.reverse_at_bottom) spindle_ = -spindle_;
  if (cycle.feed_out) {
    feed_fresh_ = true;
    go(Motion::kFeed, normal, cycle.feed_to_retract ? cycle.retract : cycle.approach);
    pending_dwell_s_ += cycle.dwell_out_s;
  }
  if (cycle.manual_out) {
    go(Motion::kRapid, normal, cycle.approach);
    spindle_ = spindle_down;
  }
  go(Motion::kRapid, normal, cycle.retract);
  spindle_ = spindle_down;
}

void Control::step_aside(const Vec3& by) {
  Target target;
  for (int i = 0; i < 3; ++i) {
    if (by[i] != 0.0) target.set(i, by[i], true);
  }
  if (target.any()) line(Motion::kRapid, target);
}

void Control::leave_aside(const DrillCycle& cycle, int normal) {
  const int turning = spindle_;
  spindle_ = 0;
  step_aside(cycle.aside);
  go(Motion::kRapid, normal, cycle.retract);
  step_aside(-cycle.aside);
  spindle_ = turning;
}

void Control::bore_back(const DrillCycle& cycle, const Target& above) {
  const int normal = axes_of(plane_).normal, turning = spindle_;
  if (above.any()) line(Motion::kRapid, above);
  spindle_ = 0;
  step_aside(cycle.aside);
  go(Motion::kRapid, normal, cycle.approach);
  step_aside(-cycle.aside);
  spindle_ = turning;
  go(Motion::kFeed, normal, cycle.bottom);
  if (cycle.dwell_s > 0.0) pending_dwell_s_ += cycle.dwell_s;
  if (cycle.feed_out) go(Motion::kFeed, normal, cycle.approach);
  leave_aside(cycle, normal);
}

void Control::peck_down(const DrillCycle& cycle, int normal, double sign) {
  double depth = cycle.approach;
  const bool pecks = cycle.peck != DrillCycle::Peck::kNone;
  const bool fresh = feed_fresh_;
  double peck = cycle.first_peck_mm > 0.0 ? cycle.first_peck_mm : cycle.peck_mm;
  for (;; peck = cycle.peck_mm) {
    const double next = depth - sign * peck;
    const bool last = !pecks || sign * (next - cycle.bottom) <= 1e-9;
    feed_fresh_ = fresh || cycle.pitch_mm > 0.0;
    go(Motion::kFeed, normal, last ? cycle.bottom : next);
    if (last) return;
    depth = next;
    if (cycle.peck == DrillCycle::Peck::kChipBreak) {
      go(Motion::kRapid, normal, depth + sign * cycle.clearance_mm);
    } else {
      go(Motion::kRapid, normal, cycle.approach);
      const double down = depth + sign * cycle.clearance_mm;
      if (sign * (cycle.approach - down) > 0.0) go(Motion::kRapid, normal, down);
    }
  }
}

// --- Curves
// --------------------------------------------------------------------------------------------------

void Control::curve(const Curve& curve, double tolerance_mm) {
  const std::vector<double> ends = chord_ends(curve, tolerance_mm);
  std::vector<CurvePoint> points;
  double way = 0.0;
  Vec3 before = curve.at(0.0).tip;
  for (const double u : ends) {
    points.push_back(curve.at(u));
    way += (points.back().tip - before).norm();
    before = points.back().tip;
  }
  const double whole_feed = feed_;
  const bool inverse = feed_mode_ == FeedMode::kInverseTime;
  const bool fresh = feed_fresh_;
  // The block comes to rest at its end, its chords do not.
  const bool exact_stop = exact_stop_, once = exact_stop_once_;
  for (const CurvePoint& point : points) {
    const bool last = &point == &points.back();
    exact_stop_ = last && exact_stop;
    exact_stop_once_ = last && once;
    Target target;
    const Vec3 here = position_xyz();
    for (int i = 0; i < 3; ++i) {
      target.set(i, point.tip[i], false);
      const auto& rotary = point.rotary[static_cast<size_t>(i)];
      if (rotary) target.set(i + 3, *rotary, false);
    }
    target.axis_P = point.axis;
    // The time of a G93 block is shared out by way.
    if (inverse && way > 0.0) feed_ = whole_feed * way / std::max((point.tip - here).norm(), 1e-12 * way);
    feed_fresh_ = fresh;
    line(Motion::kFeed, target);
  }
  feed_ = whole_feed;
}

// --- Tilted planes
// -------------------------------------------------------------------------------------------

/// Both branches for the gauge line where it stands, inside the travel or not.
kinematics::InverseSolutions Control::tilt_branches(const Vec3& axis_P) const {
  const Vec3 axis_W = (space_.frame().linear() * axis_P).normalized();
  const Vec3 tip_W = kinematics::forward(kinematics::with_tool(setup_.machine, 0.0), q_).tip_W;
  return space_.inverse().solve({tip_W, axis_W}, q_);
}

std::vector<AxisValues> Control::tilt_solutions(const Vec3& axis_P) const {
  const kinematics::InverseSolutions found = tilt_branches(axis_P);
  std::vector<AxisValues> solutions;
  const auto inside = [&](const AxisValues& q) {
    for (int word = 3; word < kAxisWords; ++word) {
      const int i = axis_of(static_cast<AxisWord>(word));
      if (i < 0) continue;
      const kinematics::Axis& axis = setup_.machine.axes[static_cast<size_t>(i)];
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
      const int i = axis_of(static_cast<AxisWord>(word));
      if (i >= 0) sum += std::abs(q[i] - q_[i]);
    }
    return sum;
  };
  std::stable_sort(solutions.begin(), solutions.end(),
                   [&](const AxisValues& a, const AxisValues& b) { return travel(a) < travel(b); });
  return solutions;
}

AxisValues Control::tilt_solution(const Vec3& axis_P, const TiltPreference& preference, int column) const {
  const std::vector<AxisValues> solutions = tilt_solutions(axis_P);
  int axis = preference.axis >= 0 ? axis_of(static_cast<AxisWord>(preference.axis)) : -1;
  const std::vector<int> order = kinematics::rotary_order(setup_.machine);
  if (axis < 0 && !order.empty()) axis = order.back();
  for (const AxisValues& q : solutions) {
    const double value = axis >= 0 ? q[axis] : 0.0;
    const bool fits = preference.choice == TiltPreference::Choice::kNearest || std::abs(value) <= 1e-9 ||
                      (value > 0.0) == (preference.choice == TiltPreference::Choice::kPositive);
    if (fits) return q;
  }
  fail_tilt(axis_P, preference, axis, column);
}

void Control::fail_tilt(const Vec3& axis_P, const TiltPreference& preference, int axis, int column) const {
  const kinematics::InverseSolutions found = tilt_branches(axis_P);
  const Vec3 axis_W = (space_.frame().linear() * axis_P).normalized();
  if (found.count == 0) {
    const kinematics::MachineModel bare = kinematics::with_tool(setup_.machine, 0.0);
    const auto [text, fix] =
        kinematics::unreachable_text(bare, {kinematics::forward(bare, q_).tip_W, axis_W});
    fail("unreachable-orientation", column, text, fix);
  }
  std::string text;
  for (int i = 0; i < found.count; ++i) {
    text += i == 0 ? ": " : "; or ";
    std::string beyond;
    for (const int one : kinematics::rotary_order(setup_.machine)) {
      const kinematics::Axis& rotary = setup_.machine.axes[static_cast<size_t>(one)];
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
    text += fmt::format("; {} is asked to be {}", setup_.machine.axes[static_cast<size_t>(axis)].name,
                        preference.choice == TiltPreference::Choice::kPositive ? "positive" : "negative");
  }
  fail("unreachable-orientation", column,
       fmt::format("the rotary axes cannot point the tool along ({:.6f}, {:.6f}, {:.6f}) in W{}", axis_W.x(),
                   axis_W.y(), axis_W.z(), text),
       chosen ? "ask for the other solution, or change the angles of the plane"
              : "change the angles of the plane, or the machine");
}

void Control::turn_rotaries(Motion motion, const AxisValues& q, bool tip_stands) {
  flush();
  if (!started_) {
    fail("start-unknown", 0, "the rotary axes turn, and the position is not known yet",
         fmt::format("give the start position in the scene, or position all axes with {} before it",
                     words_.rapid));
  }
  const std::array<double, 3> rotary = space_.rotary_of(q);
  Vec3 linear = space_.linear_of(q_);
  if (tip_stands) {
    const LinearMap now = space_.compensated(space_.rotary_of(q_));
    const LinearMap& then = space_.compensated(rotary);
    linear = then.inverse * (now.base_W + now.columns_W * linear - then.base_W);
  }
  Segment segment;
  prepare(motion, Target(), segment);
  segment.machine = true;
  segment.law = tip_stands ? BlockLaw::kTcpAxes : BlockLaw::kJoint;
  segment.from = space_.linear_of(q_);
  segment.to = linear;
  segment.rotary_from = space_.rotary_of(q_);
  segment.rotary_to = rotary;
  segment.turns_rotaries = rotary != segment.rotary_from;
  if (tip_stands) segment.from = segment.to;  // no way of the tip: the feed counts degrees
  emit(segment);
  position_valid_ = false;
}

}  // namespace swarf::program::nc
