#include "program/control/cycles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "program/control/path.h"

namespace swarf::program::nc {
namespace {

/// A cycle with more pecks than this is a slip of the depth per peck.
constexpr double kPecksMax = 100'000.0;

void go(Control& control, Motion motion, int normal, double height) {
  Target target;
  target.set(normal, height, false);
  line(control, motion, target);
}

double least_peck(const DrillCycle& cycle) {
  return cycle.degression_mm > 0.0 ? std::min(cycle.peck_mm, cycle.degression_mm) : cycle.peck_mm;
}

void check_cycle(Report& report, PathState& path, const DrillCycle& cycle, const Target& hole) {
  if (!path.started) {
    report.fail("start-unknown", hole.column, "a cycle starts, and the position is not known yet",
                fmt::format("position all axes with {} before the cycle", report.words.rapid));
  }
  if (cycle.peck != DrillCycle::Peck::kNone &&
      !(std::abs(cycle.bottom - cycle.approach) <= kPecksMax * least_peck(cycle))) {
    report.fail("bad-cycle", hole.column, fmt::format("the depth per peck is {:g} mm", cycle.peck_mm),
                "give a depth per peck above zero");
  }
  if (!(cycle.dwell_s >= 0.0)) {
    report.fail("out-of-range", hole.column, fmt::format("the cycle dwells {:g} s", cycle.dwell_s),
                "write a time of zero or more");
  }
  if (cycle.bore != DrillCycle::Bore::kPlain) {
    report.warn_once(
        "oriented-tool", hole.column,
        "the tool passes the bore beside its axis with the spindle stopped at a known angle; the "
        "simulated tool is a body of revolution, so it may cut there what the oriented edge does not",
        "judge gouges and cuts without spindle of this cycle by the shape of the boring bar");
  }
  if (cycle.manual_out) {
    report.warn_once(
        "manual-retract", hole.column,
        "this cycle waits at the bottom until the tool is drawn out by hand; simulated as a straight "
        "rapid move to the approach height",
        "add the time that the operator takes");
  }
}

void step_aside(Control& control, const Vec3& by) {
  Target target;
  for (int i = 0; i < 3; ++i) {
    if (by[i] != 0.0) target.set(i, by[i], true);
  }
  if (target.any()) line(control, Motion::kRapid, target);
}

void leave_aside(Control& control, const DrillCycle& cycle, int normal) {
  const int turning = control.modal.spindle;
  control.modal.spindle = 0;
  step_aside(control, cycle.aside);
  go(control, Motion::kRapid, normal, cycle.retract);
  step_aside(control, -cycle.aside);
  control.modal.spindle = turning;
}

void draw_out(Control& control, const DrillCycle& cycle, int normal) {
  const int spindle_down = control.modal.spindle;
  if (cycle.bore == DrillCycle::Bore::kFine) return leave_aside(control, cycle, normal);
  if (cycle.stop_at_bottom || cycle.manual_out) control.modal.spindle = 0;
  if (cycle.reverse_at_bottom) control.modal.spindle = -control.modal.spindle;
  if (cycle.feed_out) {
    control.modal.feed_fresh = true;
    go(control, Motion::kFeed, normal, cycle.feed_to_retract ? cycle.retract : cycle.approach);
    control.modal.pending_dwell_s += cycle.dwell_out_s;
  }
  if (cycle.manual_out) {
    go(control, Motion::kRapid, normal, cycle.approach);
    control.modal.spindle = spindle_down;
  }
  go(control, Motion::kRapid, normal, cycle.retract);
  control.modal.spindle = spindle_down;
}

void bore_back(Control& control, const DrillCycle& cycle, const Target& above) {
  const int normal = axes_of(control.modal.plane).normal, turning = control.modal.spindle;
  if (above.any()) line(control, Motion::kRapid, above);
  control.modal.spindle = 0;
  step_aside(control, cycle.aside);
  go(control, Motion::kRapid, normal, cycle.approach);
  step_aside(control, -cycle.aside);
  control.modal.spindle = turning;
  go(control, Motion::kFeed, normal, cycle.bottom);
  if (cycle.dwell_s > 0.0) control.modal.pending_dwell_s += cycle.dwell_s;
  if (cycle.feed_out) go(control, Motion::kFeed, normal, cycle.approach);
  leave_aside(control, cycle, normal);
}

/// Of the peck behind one of `before`, with `left` to drill, which is above zero.
double next_peck(const DrillCycle& cycle, double before, double left) {
  const double least = cycle.degression_mm;
  if (!(least > 0.0)) return cycle.peck_mm;
  const double peck = before - least;
  if (peck > least) return peck;
  return left > 2.0 * least + 1e-9 || left < least + 1e-9 ? least : 0.5 * left;
}

void peck_down(Control& control, const DrillCycle& cycle, int normal, double sign) {
  double depth = cycle.approach;
  const bool pecks = cycle.peck != DrillCycle::Peck::kNone;
  const bool fresh = control.modal.feed_fresh;
  double peck = cycle.peck_mm, way = cycle.first_peck_mm > 0.0 ? cycle.first_peck_mm : peck;
  for (;; way = peck = next_peck(cycle, peck, sign * (depth - cycle.bottom))) {
    const double next = depth - sign * way;
    const bool last = !pecks || sign * (next - cycle.bottom) <= 1e-9;
    control.modal.feed_fresh = fresh || cycle.pitch_mm > 0.0;
    go(control, Motion::kFeed, normal, last ? cycle.bottom : next);
    if (last) return;
    depth = next;
    if (cycle.peck == DrillCycle::Peck::kChipBreak) {
      go(control, Motion::kRapid, normal, depth + sign * cycle.clearance_mm);
    } else {
      go(control, Motion::kRapid, normal, cycle.approach);
      const double down = depth + sign * cycle.clearance_mm;
      if (sign * (cycle.approach - down) > 0.0) go(control, Motion::kRapid, normal, down);
    }
  }
}

}  // namespace

void drill(Control& control, const DrillCycle& cycle, const Target& hole) {
  const PlaneAxes axes = axes_of(control.modal.plane);
  const double sign = cycle.bottom <= cycle.approach ? 1.0 : -1.0;  // +1: drills against the normal
  Target above = hole;
  above.given = static_cast<uint8_t>(hole.given & ~(1u << axes.normal));
  check_cycle(control.report, control.path, cycle, hole);
  if (cycle.bore == DrillCycle::Bore::kBack) return bore_back(control, cycle, above);
  if (sign * (position_xyz(control)[axes.normal] - cycle.approach) < 0.0)
    go(control, Motion::kRapid, axes.normal, cycle.approach);
  if (above.any()) line(control, Motion::kRapid, above);
  go(control, Motion::kRapid, axes.normal, cycle.approach);
  const Borrowed feed(control.modal.feed), feed_unit(control.modal.feed_unit_mm);
  const Borrowed mode(control.modal.feed_mode);
  if (cycle.pitch_mm > 0.0) {
    if (control.modal.speed_rpm <= 0.0) {
      control.report.fail("feed-without-spindle", hole.column, "tapping without a spindle speed",
                          "write S before the cycle");
    }
    control.modal.feed_mode = FeedMode::kPerMinute;
    control.modal.feed = cycle.pitch_mm * control.modal.speed_rpm;
    control.modal.feed_unit_mm = 1.0;
  }
  peck_down(control, cycle, axes.normal, sign);
  if (cycle.dwell_s > 0.0) control.modal.pending_dwell_s += cycle.dwell_s;
  draw_out(control, cycle, axes.normal);
}

void curve(Control& control, const Curve& curve, double tolerance_mm) {
  const std::vector<double> ends = chord_ends(curve, tolerance_mm);
  std::vector<CurvePoint> points;
  double way = 0.0;
  Vec3 before = curve.at(0.0).tip;
  for (const double u : ends) {
    points.push_back(curve.at(u));
    way += (points.back().tip - before).norm();
    before = points.back().tip;
  }
  const Borrowed whole_feed(control.modal.feed);
  const bool inverse = control.modal.feed_mode == FeedMode::kInverseTime;
  const bool fresh = control.modal.feed_fresh;
  // The block comes to rest at its end, its chords do not.
  const bool exact_stop = control.modal.exact_stop, once = control.modal.exact_stop_once;
  for (const CurvePoint& point : points) {
    const bool last = &point == &points.back();
    control.modal.exact_stop = last && exact_stop;
    control.modal.exact_stop_once = last && once;
    Target target;
    const Vec3 here = position_xyz(control);
    for (int i = 0; i < 3; ++i) {
      target.set(i, point.tip[i], false);
      const auto& rotary = point.rotary[static_cast<size_t>(i)];
      if (rotary) target.set(i + 3, *rotary, false);
    }
    target.axis_P = point.axis;
    // The time of a G93 block is shared out by way.
    if (inverse && way > 0.0)
      control.modal.feed = whole_feed.kept() * way / std::max((point.tip - here).norm(), 1e-12 * way);
    control.modal.feed_fresh = fresh;
    line(control, Motion::kFeed, target);
  }
}

}  // namespace swarf::program::nc
