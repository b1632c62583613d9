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
  refuse(q(drilling, 395) != 0.0 || q(drilling, 379) != 0.0, "Q395 and Q379 other than 0 are not supported",
         "give the depth of the tip, from the surface");
  refuse(q(drilling, 258) != q(drilling, 259), "Q258 and Q259 that differ are not supported",
         "give both the same value");
  refuse(number == 201 && q(drilling, 208) != 0.0 && q(drilling, 208) != q(drilling, 206),
         "reaming with a feed of its own on the way out is not supported", "give Q208=0");
  refuse(number == 207 && !(q(drilling, 239) > 0.0),
         fmt::format("the pitch Q239 is {:g}: left-hand threads are not supported", q(drilling, 239)),
         "give a pitch above zero");
  refuse(number == 240 && (q(drilling, 343) != 0.0 || q(drilling, 342) != 0.0),
         "centring by diameter needs the point angle of the tool, which the tool table here does not have",
         "give the depth: Q343=+0, Q201, and Q342=+0");
  const bool pecks = q(drilling, 202) > 0.0 &&
                     q(drilling, 202)<-q(drilling, 201), part = drilling.cycle->q.count(401)> 0 &&
                     q(drilling, 401) != 100.0;
  refuse(number == 241 && (q(drilling, 435) != 0.0 || pecks || part),
         "cycle 241 is supported in one stroke, without dwell depth and without a feed factor",
         "give Q435=+0, Q401=+100 and Q202=+0");
}

/// What no cycle can do, or is not done here.
void check_cycle(const Executor& executor) {
  const int number = executor.drilling.cycle->number;
  for (const int part : {200, 201, 206}) {
    if (number > 2 || executor.drilling.cycle->q.count(part) > 0) continue;
    executor.control.report.fail(
        "missing-word", 0, fmt::format("cycle {} is called, and not all of its parts are given", number),
        "write SET UP, DEPTH and F");
  }
  for (const int least_zero : {200, 204, 205, 208, 210, 211, 212, 213, 252, 255, 256, 257, 258, 259, 342}) {
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
  if (number != 204 && q(executor.drilling, 201) == 0.0)
    executor.control.report.fail("bad-cycle", 0, "the depth of the cycle is zero: it would do nothing",
                                 "Q201=-20");
  if (q(executor.drilling, 201) > 0.0)
    executor.control.report.fail("unsupported-word", 0,
                                 "drilling upwards (a depth above zero) is not supported",
                                 "give the depth with a minus sign");
  if (number != 207 && number != 204 && !(q(executor.drilling, 206) > 0.0))
    executor.control.report.fail(
        "bad-feed", 0, fmt::format("the feed Q206 of cycle {} is {:g}", number, q(executor.drilling, 206)),
        "Q206=+150");
  check_values(executor.control, executor.drilling);
}

/// 201 reaming, 206, 207 and 2 tapping.
void drill_once(Executor& executor) {
  nc::DrillCycle cycle;
  const double surface = cycle_surface(executor.control, executor.drilling, executor.frames);
  cycle.approach = surface + length(executor, 200);
  cycle.bottom = surface + length(executor, 201);
  cycle.retract = surface + std::max(length(executor, 200), length(executor, 204));
  cycle.dwell_s = q(executor.drilling, 211);
  cycle.feed_out = true;
  cycle.reverse_at_bottom = executor.drilling.cycle->number != 201;
  if (executor.drilling.cycle->number == 207) {
    cycle.pitch_mm = executor.control.modal.mm(q(executor.drilling, 239));
  } else {
    set_feed(executor.control, q(executor.drilling, 206), false);
  }
  nc::drill(executor.control, cycle, Target());
}

/// 241 in one stroke: in at the entry speed, down at the drilling speed, out at Q208.
void drill_deep(Executor& executor) {
  const double start = cycle_surface(executor.control, executor.drilling, executor.frames) +
                       length(executor, 200),
               out = q(executor.drilling, 208) > 0.0 ? q(executor.drilling, 208) : q(executor.drilling, 206),
               speed = executor.control.modal.speed_rpm;
  const int spindle = executor.control.modal.spindle;
  go(executor.control, Motion::kRapid, start, 0.0);
  if (executor.drilling.cycle->q.count(426) > 0)
    executor.control.modal.spindle = q(executor.drilling, 426) == 4.0 ? -1 : 1;
  if (q(executor.drilling, 428) > 0.0) executor.control.modal.speed_rpm = q(executor.drilling, 428);
  go(executor.control, Motion::kFeed,
     cycle_surface(executor.control, executor.drilling, executor.frames) + length(executor, 201),
     q(executor.drilling, 206));
  if (q(executor.drilling, 211) > 0.0)
    nc::dwell(executor.control.report, executor.control.modal, q(executor.drilling, 211));
  if (q(executor.drilling, 427) > 0.0) executor.control.modal.speed_rpm = q(executor.drilling, 427);
  go(executor.control, out == kRapidFeed ? Motion::kRapid : Motion::kFeed, start, out);
  if (q(executor.drilling, 204) > q(executor.drilling, 200))
    go(executor.control, Motion::kRapid,
       cycle_surface(executor.control, executor.drilling, executor.frames) + length(executor, 204), 0.0);
  executor.control.modal.speed_rpm = speed;
  executor.control.modal.spindle = spindle;
}

/// The way in which a pecking cycle leaves the hole: FMAX (200, 1, where no Q208 is given), or Q208, which
/// counts as Q206 when it is 0.
double feed_out(const Drilling& drilling) {
  if (drilling.cycle->q.count(208) == 0) return kRapidFeed;
  return q(drilling, 208) == 0.0 ? q(drilling, 206) : q(drilling, 208);
}

/// 200, 203, 205, 1: down in pecks. Q213 (203): chip breaks before a retreat out of the hole; Q257 (205): way
/// between two chip breaks within a peck.
void drill_pecking(Executor& executor) {
  const int normal = nc::axes_of(executor.control.modal.plane).normal;
  const double surface = cycle_surface(executor.control, executor.drilling, executor.frames),
               clearance = length(executor, 200), depth = -length(executor, 201);
  const double start = surface + clearance, feed = q(executor.drilling, 206);
  const double out_feed = feed_out(executor.drilling);
  const Motion out = out_feed == kRapidFeed ? Motion::kRapid : Motion::kFeed;
  double peck = executor.drilling.cycle->q.count(202) ? length(executor, 202) : depth;
  if (!(peck > 0.0) || depth / peck > kPecksMax)
    executor.control.report.fail("bad-cycle", 0, fmt::format("the depth per peck is {:g} mm", peck),
                                 "Q202=5");
  const double least = q(executor.drilling, 205) > 0.0 ? length(executor, 205) : peck;
  const double smaller = length(executor, 212);
  if (smaller > 0.0 && !(depth / least <= kPecksMax && q(executor.drilling, 205) > 0.0))
    executor.control.report.fail("bad-cycle", 0, "Q212 makes pecks smaller, and Q205 gives no smallest one",
                                 "Q205=1");
  const double chip = length(executor, 257);
  if (chip > 0.0 && depth / chip > kPecksMax)
    executor.control.report.fail("bad-cycle", 0, fmt::format("chips break each {:g} mm", chip), "Q257=5");
  // Above the last depth after a retreat: the set-up clearance (200, 203), Q258 (205), its own rule (1).
  double above = clearance;
  if (executor.drilling.cycle->number == 205) above = length(executor, 258);
  if (executor.drilling.cycle->number == 1) above = depth <= 30.0 ? 0.6 : std::min(7.0, depth / 50.0);
  const double back = q(executor.drilling, 256) > 0.0 ? length(executor, 256) : 0.2;
  const double breaks = q(executor.drilling, 213);
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
      if (q(executor.drilling, 210) > 0.0)
        nc::dwell(executor.control.report, executor.control.modal, q(executor.drilling, 210));
      if (surface - done + above < start) go(executor.control, Motion::kRapid, surface - done + above, 0.0);
    }
    peck = std::max(std::min(peck, least), peck - smaller);
  }
  if (q(executor.drilling, 211) > 0.0)
    nc::dwell(executor.control.report, executor.control.modal, q(executor.drilling, 211));
  go(executor.control, out, start, out_feed);
  if (q(executor.drilling, 204) > q(executor.drilling, 200))
    go(executor.control, Motion::kRapid, surface + length(executor, 204), 0.0);
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
                              control.modal.mm(q(drilling, 203)) + drilling.raised, false);
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
    executor.drilling.cycle->q[203] =
        nc::position_xyz(executor.control)[nc::axes_of(executor.control.modal.plane).normal] /
            (executor.control.modal.mm(1.0) * level(executor.orientation, executor.frames).scale) -
        q(executor.drilling, 200);
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
