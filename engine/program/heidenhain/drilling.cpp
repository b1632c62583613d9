// The moves of drilling cycles. Depths count from the surface Q203, unlike pecks of RS274 cycles, which
// count from where the feed starts.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "program/heidenhain/executor.h"

namespace swarf::program::nc::heidenhain {

using nc::Motion;
using nc::Target;

namespace {
constexpr double kPecksMax = 100000.0;
}

double Executor::q(int number) const {
  const auto found = cycle_->q.find(number);
  return found == cycle_->q.end() ? 0.0 : found->second;
}

/// A length of the cycle in mm: scaling (cycle 11) changes these too.
double Executor::length(int number) const {
  return control_.modal.mm(q(number)) * level().scale;
}

double Executor::surface() const {
  return stretch_.along(nc::axes_of(control_.modal.plane).normal, control_.modal.mm(q(203)) + raised_, false);
}

void Executor::go(Motion motion, double height, double feed) {
  Target target;
  target.column = control_.report.place.column;
  target.set(nc::axes_of(control_.modal.plane).normal, height, false);
  if (motion == Motion::kFeed) set_feed(feed, false);
  nc::line(control_, motion, target);
}

void Executor::run_cycle(BlockReader& reader, size_t offset) {
  if (!cycle_)
    reader.fail("no-cycle", offset, "no drilling cycle is defined before this call",
                "write CYCL DEF before it");
  if (!control_.path.started)
    reader.fail("start-unknown", offset, "a cycle starts, and the position is not known yet",
                "position all axes before it");
  const nc::Place place = reader.place_of(offset);
  control_.report.at(place.file, place.line, place.column);
  // Cycles 1 and 2 start where the tool stands, at the set-up clearance.
  if (cycle_->number <= 2)
    cycle_->q[203] = nc::position_xyz(control_)[nc::axes_of(control_.modal.plane).normal] /
                         (control_.modal.mm(1.0) * level().scale) -
                     q(200);
  for (const auto& [number, value] : cycle_->q) {
    if (number >= 200 && cycle_->number >= 200 && parameters_.find_q(number).value_or(value) != value)
      control_.report.fail(
          "bad-cycle", 0,
          fmt::format("Q{} is {:g} since CYCL DEF {} gave it {:g}: which one holds depends on the control",
                      number, *parameters_.find_q(number), cycle_->number, value),
          "write CYCL DEF again with the new value");
  }
  execute_cycle();
}

/// Where the tool stands; the cycle is defined.
void Executor::execute_cycle() {
  check_cycle();
  tangent_.reset();
  switch (cycle_->number) {
    case 2:
    case 201:
    case 206:
    case 207:
      return drill_once();
    case 202:
      return bore();
    case 204:
      return back_bore();
    case 208:
      return mill_bore();
    case 241:
      return drill_deep();
    default:
      return drill_pecking();
  }
}

/// What no cycle can do, or is not done here.
void Executor::check_cycle() const {
  const int number = cycle_->number;
  for (const int part : {200, 201, 206}) {
    if (number > 2 || cycle_->q.count(part) > 0) continue;
    control_.report.fail("missing-word", 0,
                         fmt::format("cycle {} is called, and not all of its parts are given", number),
                         "write SET UP, DEPTH and F");
  }
  for (const int least_zero : {200, 204, 205, 208, 210, 211, 212, 213, 252, 255, 256, 257, 258, 259, 342}) {
    if (q(least_zero) < 0.0)
      control_.report.fail("bad-cycle", 0, fmt::format("Q{} of cycle {} is below zero", least_zero, number),
                           fmt::format("Q{}=+0", least_zero));
  }
  if (level().scales_axes())
    control_.report.fail("unsupported-word", 0, "a cycle while cycle 26 scales axes is not supported",
                         "reset it before the call: CYCL DEF 26.1 X1 Y1");
  if (level().scales() && (number == 2 || number == 206 || number == 207))
    control_.report.fail("unsupported-word", 0, "tapping while cycle 11 scales is not supported",
                         "reset it before the call: CYCL DEF 11.1 SCL1");
  if (number != 204 && q(201) == 0.0)
    control_.report.fail("bad-cycle", 0, "the depth of the cycle is zero: it would do nothing", "Q201=-20");
  if (q(201) > 0.0)
    control_.report.fail("unsupported-word", 0, "drilling upwards (a depth above zero) is not supported",
                         "give the depth with a minus sign");
  if (number != 207 && number != 204 && !(q(206) > 0.0))
    control_.report.fail("bad-feed", 0, fmt::format("the feed Q206 of cycle {} is {:g}", number, q(206)),
                         "Q206=+150");
  check_values();
}

/// Values whose effect is not executed here.
void Executor::check_values() const {
  const int number = cycle_->number;
  const auto refuse = [&](bool meant, std::string text, const char* fix) {
    if (meant) control_.report.fail("unsupported-word", 0, std::move(text), fix);
  };
  refuse(q(395) != 0.0 || q(379) != 0.0, "Q395 and Q379 other than 0 are not supported",
         "give the depth of the tip, from the surface");
  refuse(q(258) != q(259), "Q258 and Q259 that differ are not supported", "give both the same value");
  refuse(number == 201 && q(208) != 0.0 && q(208) != q(206),
         "reaming with a feed of its own on the way out is not supported", "give Q208=0");
  refuse(number == 207 && !(q(239) > 0.0),
         fmt::format("the pitch Q239 is {:g}: left-hand threads are not supported", q(239)),
         "give a pitch above zero");
  refuse(number == 240 && (q(343) != 0.0 || q(342) != 0.0),
         "centring by diameter needs the point angle of the tool, which the tool table here does not have",
         "give the depth: Q343=+0, Q201, and Q342=+0");
  const bool pecks = q(202) > 0.0 && q(202)<-q(201), part = cycle_->q.count(401)> 0 && q(401) != 100.0;
  refuse(number == 241 && (q(435) != 0.0 || pecks || part),
         "cycle 241 is supported in one stroke, without dwell depth and without a feed factor",
         "give Q435=+0, Q401=+100 and Q202=+0");
}

/// 201 reaming, 206, 207 and 2 tapping.
void Executor::drill_once() {
  nc::DrillCycle cycle;
  const double surface = this->surface();
  cycle.approach = surface + length(200);
  cycle.bottom = surface + length(201);
  cycle.retract = surface + std::max(length(200), length(204));
  cycle.dwell_s = q(211);
  cycle.feed_out = true;
  cycle.reverse_at_bottom = cycle_->number != 201;
  if (cycle_->number == 207) {
    cycle.pitch_mm = control_.modal.mm(q(239));
  } else {
    set_feed(q(206), false);
  }
  nc::drill(control_, cycle, Target());
}

/// 241 in one stroke: in at the entry speed, down at the drilling speed, out at Q208.
void Executor::drill_deep() {
  const double start = surface() + length(200), out = q(208) > 0.0 ? q(208) : q(206),
               speed = control_.modal.speed_rpm;
  const int spindle = control_.modal.spindle;
  go(Motion::kRapid, start, 0.0);
  if (cycle_->q.count(426) > 0) control_.modal.spindle = q(426) == 4.0 ? -1 : 1;
  if (q(428) > 0.0) control_.modal.speed_rpm = q(428);
  go(Motion::kFeed, surface() + length(201), q(206));
  if (q(211) > 0.0) nc::dwell(control_.report, control_.modal, q(211));
  if (q(427) > 0.0) control_.modal.speed_rpm = q(427);
  go(out == kRapidFeed ? Motion::kRapid : Motion::kFeed, start, out);
  if (q(204) > q(200)) go(Motion::kRapid, surface() + length(204), 0.0);
  control_.modal.speed_rpm = speed;
  control_.modal.spindle = spindle;
}

/// The way in which a pecking cycle leaves the hole: FMAX (200, 1, where no Q208 is given), or Q208, which
/// counts as Q206 when it is 0.
double Executor::feed_out() const {
  if (cycle_->q.count(208) == 0) return kRapidFeed;
  return q(208) == 0.0 ? q(206) : q(208);
}

/// 200, 203, 205, 1: down in pecks. Q213 (203): chip breaks before a retreat out of the hole; Q257 (205): way
/// between two chip breaks within a peck.
void Executor::drill_pecking() {
  const int normal = nc::axes_of(control_.modal.plane).normal;
  const double surface = this->surface(), clearance = length(200), depth = -length(201);
  const double start = surface + clearance, feed = q(206);
  const double out_feed = feed_out();
  const Motion out = out_feed == kRapidFeed ? Motion::kRapid : Motion::kFeed;
  double peck = cycle_->q.count(202) ? length(202) : depth;
  if (!(peck > 0.0) || depth / peck > kPecksMax)
    control_.report.fail("bad-cycle", 0, fmt::format("the depth per peck is {:g} mm", peck), "Q202=5");
  const double least = q(205) > 0.0 ? length(205) : peck;
  const double smaller = length(212);
  if (smaller > 0.0 && !(depth / least <= kPecksMax && q(205) > 0.0))
    control_.report.fail("bad-cycle", 0, "Q212 makes pecks smaller, and Q205 gives no smallest one",
                         "Q205=1");
  const double chip = length(257);
  if (chip > 0.0 && depth / chip > kPecksMax)
    control_.report.fail("bad-cycle", 0, fmt::format("chips break each {:g} mm", chip), "Q257=5");
  // Above the last depth after a retreat: the set-up clearance (200, 203), Q258 (205), its own rule (1).
  double above = clearance;
  if (cycle_->number == 205) above = length(258);
  if (cycle_->number == 1) above = depth <= 30.0 ? 0.6 : std::min(7.0, depth / 50.0);
  const double back = q(256) > 0.0 ? length(256) : 0.2;
  const double breaks = q(213);
  double broken = 0.0;
  if (nc::position_xyz(control_)[normal] != start) go(Motion::kRapid, start, 0.0);
  double done = 0.0;
  for (;;) {
    const double next = std::min(depth, done + peck) > depth - 1e-9 ? depth : done + peck;
    for (double at = done + chip; chip > 0.0 && at < next - 1e-9; at += chip) {
      go(Motion::kFeed, surface - at, feed);
      go(Motion::kRapid, surface - at + back, 0.0);
    }
    go(Motion::kFeed, surface - next, feed);
    done = next;
    if (done >= depth) break;
    if (broken < breaks) {
      ++broken;
      go(Motion::kRapid, surface - done + back, 0.0);
    } else {
      broken = 0.0;
      go(out, start, out_feed);
      if (q(210) > 0.0) nc::dwell(control_.report, control_.modal, q(210));
      if (surface - done + above < start) go(Motion::kRapid, surface - done + above, 0.0);
    }
    peck = std::max(std::min(peck, least), peck - smaller);
  }
  if (q(211) > 0.0) nc::dwell(control_.report, control_.modal, q(211));
  go(out, start, out_feed);
  if (q(204) > q(200)) go(Motion::kRapid, surface + length(204), 0.0);
}

}  // namespace swarf::program::nc::heidenhain
