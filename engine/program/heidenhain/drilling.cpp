// The moves of drilling cycles. Depths count from the surface Q203, unlike pecks of RS274 cycles, which
// count from where the feed starts.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "program/heidenhain/steps.h"

namespace swarf::program::nc::heidenhain {

using nc::Motion;

using nc::Target;

namespace {

constexpr double kPecksMax = 100000.0;

/// Values whose effect is not executed here.
void check_values(nc::Control& control, const Drilling& drilling) {
  const int number = drilling.cycle->number;
  const auto refuse = [&](bool meant, std::string text, const char* fix) {
    if (meant) control.report.fail("unsupported-word", 0, std::move(text), fix);
  };
  refuse(q(drilling, Q::kDepthReference) != 0.0,
         "Q395 other than 0 counts the depth from the full diameter, which needs the point angle of the tool",
         "give the depth of the tip: Q395=+0");
  refuse(q(drilling, Q::kStartPoint) != 0.0 && number != 241, "Q379 other than 0 is not supported",
         "give the depth from the surface: Q379=+0");
  refuse(q(drilling, Q::kStartPoint) < 0.0, "the lowered starting point Q379 is below zero", "Q379=+20");
  refuse(q(drilling, Q::kStopAboveFirst) != q(drilling, Q::kStopAboveLast),
         "Q258 and Q259 that differ are not supported", "give both the same value");
  refuse(
      number == 201 && q(drilling, Q::kFeedOut) != 0.0 && q(drilling, Q::kFeedOut) != q(drilling, Q::kFeed),
      "reaming with a feed of its own on the way out is not supported", "give Q208=0");
  refuse(number == 207 && !(q(drilling, Q::kPitch) > 0.0),
         fmt::format("the pitch Q239 is {:g}: left-hand threads are not supported", q(drilling, Q::kPitch)),
         "give a pitch above zero");
  refuse(number == 240 && (q(drilling, Q::kByDiameter) != 0.0 || q(drilling, Q::kRoughDiameter) != 0.0),
         "centring by diameter needs the point angle of the tool, which the tool table here does not have",
         "give the depth: Q343=+0, Q201, and Q342=+0");
  const bool pecks =
      q(drilling, Q::kPeck) > 0.0 &&
      q(drilling, Q::kPeck)<-q(drilling, Q::kDepth), part = drilling.cycle->q.count(Q::kFeedFactor)> 0 &&
      q(drilling, Q::kFeedFactor) != 100.0;
  refuse(number == 241 && (q(drilling, Q::kDwellDepth) != 0.0 || pecks || part),
         "cycle 241 is supported in one stroke, without dwell depth and without a feed factor",
         "give Q435=+0, Q401=+100 and Q202=+0");
}

/// What no cycle can do, or is not done here.
void check_cycle(const Executor& executor) {
  const int number = executor.drilling.cycle->number;
  for (const int part : {Q::kClearance, Q::kDepth, Q::kFeed}) {
    if (number > 2 || executor.drilling.cycle->q.count(part) > 0) continue;
    executor.control.report.fail(
        "missing-word", 0, fmt::format("cycle {} is called, and not all of its parts are given", number),
        "write SET UP, DEPTH and F");
  }
  for (const int least_zero :
       {Q::kClearance, Q::kSecondClearance, Q::kPeckMin, Q::kFeedOut, Q::kDwellAbove, Q::kDwellBelow,
        Q::kPeckLess, Q::kBreaks, Q::kEdgeHeight, Q::kDwellCounterbore, Q::kChipBreakBack, Q::kChipBreakDepth,
        Q::kStopAboveFirst, Q::kStopAboveLast, Q::kRoughDiameter}) {
    if (q(executor.drilling, least_zero) < 0.0)
      executor.control.report.fail("bad-cycle", 0,
                                   fmt::format("Q{} of cycle {} is below zero", least_zero, number),
                                   fmt::format("Q{}=+0", least_zero));
  }
  if (level(executor.orientation, executor.frames).scales_axes())
    executor.control.report.fail("unsupported-word", 0, "a cycle while cycle 26 scales axes is not supported",
                                 "reset it before the call: CYCL DEF 26.1 X1 Y1");
  if (level(executor.orientation, executor.frames).scales() &&
      (number == 2 || number == 206 || number == 207))
    executor.control.report.fail("unsupported-word", 0, "tapping while cycle 11 scales is not supported",
                                 "reset it before the call: CYCL DEF 11.1 SCL1");
  if (number != 204 && q(executor.drilling, Q::kDepth) == 0.0)
    executor.control.report.fail("bad-cycle", 0, "the depth of the cycle is zero: it would do nothing",
                                 "Q201=-20");
  if (q(executor.drilling, Q::kDepth) > 0.0)
    executor.control.report.fail("unsupported-word", 0,
                                 "drilling upwards (a depth above zero) is not supported",
                                 "give the depth with a minus sign");
  if (number != 207 && number != 204 && !(q(executor.drilling, Q::kFeed) > 0.0))
    executor.control.report.fail(
        "bad-feed", 0,
        fmt::format("the feed Q206 of cycle {} is {:g}", number, q(executor.drilling, Q::kFeed)),
        "Q206=+150");
  check_values(executor.control, executor.drilling);
}

/// 201 reaming, 206, 207 and 2 tapping.
void drill_once(Executor& executor) {
  nc::DrillCycle cycle;
  const double surface = cycle_surface(executor.control, executor.drilling, executor.frames);
  cycle.approach = surface + length(executor, Q::kClearance);
  cycle.bottom = surface + length(executor, Q::kDepth);
  cycle.retract = surface + std::max(length(executor, Q::kClearance), length(executor, Q::kSecondClearance));
  cycle.dwell_s = q(executor.drilling, Q::kDwellBelow);
  cycle.feed_out = true;
  cycle.reverse_at_bottom = executor.drilling.cycle->number != 201;
  if (executor.drilling.cycle->number == 207) {
    cycle.pitch_mm = executor.control.modal.mm(q(executor.drilling, Q::kPitch));
  } else {
    set_feed(executor.control, q(executor.drilling, Q::kFeed), false);
  }
  nc::drill(executor.control, cycle, Target());
}

/// Q379 of 241: down the pilot hole at Q253 to where drilling begins, a fifth of Q379 above the lowered
/// point, at most the set-up clearance.
void enter_pilot_hole(Executor& executor) {
  const double lowered = length(executor, Q::kStartPoint);
  if (lowered == 0.0) return;
  const double feed = q(executor.drilling, Q::kFeedPilot);
  if (!(feed > 0.0))
    executor.control.report.fail("missing-feed", 0, "Q379 enters a pilot hole, and Q253 gives no feed for it",
                                 "Q253=750");
  const double surface = cycle_surface(executor.control, executor.drilling, executor.frames),
               above = std::min(0.2 * lowered, length(executor, Q::kClearance));
  go(executor.control, feed == kRapidFeed ? Motion::kRapid : Motion::kFeed, surface - lowered + above, feed);
}

/// 241 in one stroke: in at the entry speed, down at the drilling speed, out at Q208.
void drill_deep(Executor& executor) {
  const double start = cycle_surface(executor.control, executor.drilling, executor.frames) +
                       length(executor, Q::kClearance),
               out = q(executor.drilling, Q::kFeedOut) > 0.0 ? q(executor.drilling, Q::kFeedOut)
                                                             : q(executor.drilling, Q::kFeed),
               speed = executor.control.modal.speed_rpm;
  const int spindle = executor.control.modal.spindle;
  go(executor.control, Motion::kRapid, start, 0.0);
  if (executor.drilling.cycle->q.count(Q::kEntrySense) > 0)
    executor.control.modal.spindle = q(executor.drilling, Q::kEntrySense) == 4.0 ? -1 : 1;
  if (q(executor.drilling, Q::kEntrySpeed) > 0.0 && q(executor.drilling, Q::kStartPoint) > 0.0)
    executor.control.modal.speed_rpm = q(executor.drilling, Q::kEntrySpeed);
  enter_pilot_hole(executor);
  if (q(executor.drilling, Q::kDrillingSpeed) > 0.0)
    executor.control.modal.speed_rpm = q(executor.drilling, Q::kDrillingSpeed);
  go(executor.control, Motion::kFeed,
     cycle_surface(executor.control, executor.drilling, executor.frames) + length(executor, Q::kDepth),
     q(executor.drilling, Q::kFeed));
  if (q(executor.drilling, Q::kDwellBelow) > 0.0)
    nc::dwell(executor.control.report, executor.control.modal, q(executor.drilling, Q::kDwellBelow));
  if (q(executor.drilling, Q::kEntrySpeed) > 0.0)
    executor.control.modal.speed_rpm = q(executor.drilling, Q::kEntrySpeed);
  go(executor.control, out == kRapidFeed ? Motion::kRapid : Motion::kFeed, start, out);
  if (q(executor.drilling, Q::kSecondClearance) > q(executor.drilling, Q::kClearance))
    go(executor.control, Motion::kRapid,
       cycle_surface(executor.control, executor.drilling, executor.frames) +
           length(executor, Q::kSecondClearance),
       0.0);
  executor.control.modal.speed_rpm = speed;
  executor.control.modal.spindle = spindle;
}

/// The way in which a pecking cycle leaves the hole: FMAX (200, 1, where no Q208 is given), or Q208, which
/// counts as Q206 when it is 0.
double feed_out(const Drilling& drilling) {
  if (drilling.cycle->q.count(Q::kFeedOut) == 0) return kRapidFeed;
  return q(drilling, Q::kFeedOut) == 0.0 ? q(drilling, Q::kFeed) : q(drilling, Q::kFeedOut);
}

/// 200, 203, 205, 1: down in pecks. Q213 (203): chip breaks before a retreat out of the hole; Q257 (205): way
/// between two chip breaks within a peck.
void drill_pecking(Executor& executor) {
  const int normal = nc::axes_of(executor.control.modal.plane).normal;
  const double surface = cycle_surface(executor.control, executor.drilling, executor.frames),
               clearance = length(executor, Q::kClearance), depth = -length(executor, Q::kDepth);
  const double start = surface + clearance, feed = q(executor.drilling, Q::kFeed);
  const double out_feed = feed_out(executor.drilling);
  const Motion out = out_feed == kRapidFeed ? Motion::kRapid : Motion::kFeed;
  double peck = executor.drilling.cycle->q.count(Q::kPeck) ? length(executor, Q::kPeck) : depth;
  if (!(peck > 0.0) || depth / peck > kPecksMax)
    executor.control.report.fail("bad-cycle", 0, fmt::format("the depth per peck is {:g} mm", peck),
                                 "Q202=5");
  const double least = q(executor.drilling, Q::kPeckMin) > 0.0 ? length(executor, Q::kPeckMin) : peck;
  const double smaller = length(executor, Q::kPeckLess);
  if (smaller > 0.0 && !(depth / least <= kPecksMax && q(executor.drilling, Q::kPeckMin) > 0.0))
    executor.control.report.fail("bad-cycle", 0, "Q212 makes pecks smaller, and Q205 gives no smallest one",
                                 "Q205=1");
  const double chip = length(executor, Q::kChipBreakDepth);
  if (chip > 0.0 && depth / chip > kPecksMax)
    executor.control.report.fail("bad-cycle", 0, fmt::format("chips break each {:g} mm", chip), "Q257=5");
  // Above the last depth after a retreat: the set-up clearance (200, 203), Q258 (205), its own rule (1).
  double above = clearance;
  if (executor.drilling.cycle->number == 205) above = length(executor, Q::kStopAboveFirst);
  if (executor.drilling.cycle->number == 1) above = depth <= 30.0 ? 0.6 : std::min(7.0, depth / 50.0);
  const double back =
      q(executor.drilling, Q::kChipBreakBack) > 0.0 ? length(executor, Q::kChipBreakBack) : 0.2;
  const double breaks = q(executor.drilling, Q::kBreaks);
  double broken = 0.0;
  if (nc::position_xyz(executor.control)[normal] != start) go(executor.control, Motion::kRapid, start, 0.0);
  double done = 0.0;
  for (;;) {
    const double next = std::min(depth, done + peck) > depth - 1e-9 ? depth : done + peck;
    for (double at = done + chip; chip > 0.0 && at < next - 1e-9; at += chip) {
      go(executor.control, Motion::kFeed, surface - at, feed);
      go(executor.control, Motion::kRapid, surface - at + back, 0.0);
    }
    go(executor.control, Motion::kFeed, surface - next, feed);
    done = next;
    if (done >= depth) break;
    if (broken < breaks) {
      ++broken;
      go(executor.control, Motion::kRapid, surface - done + back, 0.0);
    } else {
      broken = 0.0;
      go(executor.control, out, start, out_feed);
      if (q(executor.drilling, Q::kDwellAbove) > 0.0)
        nc::dwell(executor.control.report, executor.control.modal, q(executor.drilling, Q::kDwellAbove));
      if (surface - done + above < start) go(executor.control, Motion::kRapid, surface - done + above, 0.0);
    }
    peck = std::max(std::min(peck, least), peck - smaller);
  }
  if (q(executor.drilling, Q::kDwellBelow) > 0.0)
    nc::dwell(executor.control.report, executor.control.modal, q(executor.drilling, Q::kDwellBelow));
  go(executor.control, out, start, out_feed);
  if (q(executor.drilling, Q::kSecondClearance) > q(executor.drilling, Q::kClearance))
    go(executor.control, Motion::kRapid, surface + length(executor, Q::kSecondClearance), 0.0);
}

}  // namespace

double q(const Drilling& drilling, int number) {
  const auto found = drilling.cycle->q.find(number);
  return found == drilling.cycle->q.end() ? 0.0 : found->second;
}

/// A length of the cycle in mm: scaling (cycle 11) changes these too.
double length(const Executor& executor, int number) {
  return executor.control.modal.mm(q(executor.drilling, number)) *
         level(executor.orientation, executor.frames).scale;
}

double cycle_surface(nc::Control& control, const Drilling& drilling, const Frames& frames) {
  return frames.stretch.along(nc::axes_of(control.modal.plane).normal,
                              control.modal.mm(q(drilling, Q::kSurface)) + drilling.raised, false);
}

void go(nc::Control& control, Motion motion, double height, double feed) {
  Target target;
  target.column = control.report.place.column;
  target.set(nc::axes_of(control.modal.plane).normal, height, false);
  if (motion == Motion::kFeed) set_feed(control, feed, false);
  nc::line(control, motion, target);
}

void run_cycle(Executor& executor, BlockReader& reader, size_t offset) {
  if (!executor.drilling.cycle)
    reader.fail("no-cycle", offset, "no drilling cycle is defined before this call",
                "write CYCL DEF before it");
  if (!executor.control.path.started)
    reader.fail("start-unknown", offset, "a cycle starts, and the position is not known yet",
                "position all axes before it");
  const nc::Place place = reader.place_of(offset);
  executor.control.report.at(place.file, place.line, place.column);
  // Cycles 1 and 2 start where the tool stands, at the set-up clearance.
  if (executor.drilling.cycle->number <= 2)
    executor.drilling.cycle->q[Q::kSurface] =
        nc::position_xyz(executor.control)[nc::axes_of(executor.control.modal.plane).normal] /
            (executor.control.modal.mm(1.0) * level(executor.orientation, executor.frames).scale) -
        q(executor.drilling, Q::kClearance);
  for (const auto& [number, value] : executor.drilling.cycle->q) {
    if (number >= 200 && executor.drilling.cycle->number >= 200 &&
        executor.parameters.find_q(number).value_or(value) != value)
      executor.control.report.fail(
          "bad-cycle", 0,
          fmt::format("Q{} is {:g} since CYCL DEF {} gave it {:g}: which one holds depends on the control",
                      number, *executor.parameters.find_q(number), executor.drilling.cycle->number, value),
          "write CYCL DEF again with the new value");
  }
  execute_cycle(executor);
}

/// Where the tool stands; the cycle is defined.
void execute_cycle(Executor& executor) {
  check_cycle(executor);
  executor.path.tangent.reset();
  switch (executor.drilling.cycle->number) {
    case 2:
    case 201:
    case 206:
    case 207:
      return drill_once(executor);
    case 202:
      return bore(executor);
    case 204:
      return back_bore(executor);
    case 208:
      return mill_bore(executor);
    case 241:
      return drill_deep(executor);
    default:
      return drill_pecking(executor);
  }
}

}  // namespace swarf::program::nc::heidenhain
