// The moves of drilling cycles. Depths count from the surface Q203, unlike pecks of RS274 cycles, which
// count from where the feed starts.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "program/nc/heidenhain_executor.h"

namespace swarf::program::heidenhain {

using nc::Motion;
using nc::Target;

namespace {
constexpr double kPecksMax = 100000.0;
}

double Executor::q(int number) const {
  const auto found = cycle_->q.find(number);
  return found == cycle_->q.end() ? 0.0 : found->second;
}

void Executor::go(Motion motion, double height, double feed) {
  Target target;
  target.column = control_.place().column;
  target.set(nc::axes_of(control_.plane()).normal, height, false);
  if (motion == Motion::kFeed) set_feed(feed, false);
  control_.line(motion, target);
}

void Executor::run_cycle(BlockReader& reader, size_t offset) {
  if (!cycle_)
    reader.fail("no-cycle", offset, "no drilling cycle is defined before this call",
                "write CYCL DEF before it");
  if (!control_.started())
    reader.fail("start-unknown", offset, "a cycle starts, and the position is not known yet",
                "position all axes before it");
  const nc::Place place = reader.place_of(offset);
  control_.at(place.file, place.line, place.column);
  // Cycles 1 and 2 start where the tool stands, at the set-up clearance.
  if (cycle_->number <= 2)
    cycle_->q[203] =
        control_.position_xyz()[nc::axes_of(control_.plane()).normal] / control_.mm(1.0) - q(200);
  check_cycle();
  tangent_.reset();
  const int number = cycle_->number;
  if (number == 2 || number == 201 || number == 206 || number == 207) {
    drill_once();
  } else {
    drill_pecking();
  }
}

/// What no cycle can do, or is not done here.
void Executor::check_cycle() const {
  const int number = cycle_->number;
  for (const int part : {200, 201, 206}) {
    if (part == 206 && number == 207) continue;
    if (cycle_->q.count(part) == 0)
      control_.fail("missing-word", 0,
                    fmt::format("cycle {} is called, and not all of its parts are given", number),
                    "write SET UP, DEPTH and F");
  }
  for (const int least_zero : {200, 204, 205, 208, 210, 211, 212, 213, 256, 257, 258, 259}) {
    if (q(least_zero) < 0.0)
      control_.fail("bad-cycle", 0, fmt::format("Q{} of cycle {} is below zero", least_zero, number),
                    fmt::format("Q{}=+0", least_zero));
  }
  if (q(201) == 0.0)
    control_.fail("bad-cycle", 0, "the depth of the cycle is zero: it would do nothing", "Q201=-20");
  if (q(201) > 0.0)
    control_.fail("unsupported-word", 0, "drilling upwards (a depth above zero) is not supported",
                  "give the depth with a minus sign");
  if (number != 207 && !(q(206) > 0.0))
    control_.fail("bad-feed", 0, fmt::format("the feed Q206 of cycle {} is {:g}", number, q(206)),
                  "Q206=+150");
  if (q(395) != 0.0 || q(379) != 0.0)
    control_.fail("unsupported-word", 0, "Q395 and Q379 other than 0 are not supported",
                  "give the depth of the tip, from the surface");
  if (q(258) != q(259))
    control_.fail("unsupported-word", 0, "Q258 and Q259 that differ are not supported",
                  "give both the same value");
  if (number == 201 && q(208) != 0.0 && q(208) != q(206))
    control_.fail("unsupported-word", 0, "reaming with a feed of its own on the way out is not supported",
                  "give Q208=0");
  if (number == 207 && !(q(239) > 0.0))
    control_.fail("unsupported-word", 0,
                  fmt::format("the pitch Q239 is {:g}: left-hand threads are not supported", q(239)),
                  "give a pitch above zero");
}

/// 201 reaming, 206, 207 and 2 tapping.
void Executor::drill_once() {
  nc::DrillCycle cycle;
  const double surface = control_.mm(q(203));
  cycle.approach = surface + control_.mm(q(200));
  cycle.bottom = surface + control_.mm(q(201));
  cycle.retract = surface + control_.mm(std::max(q(200), q(204)));
  cycle.dwell_s = q(211);
  cycle.feed_out = true;
  cycle.reverse_at_bottom = cycle_->number != 201;
  if (cycle_->number == 207) {
    cycle.pitch_mm = control_.mm(q(239));
  } else {
    set_feed(q(206), false);
  }
  control_.drill(cycle, Target());
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
  const int normal = nc::axes_of(control_.plane()).normal;
  const double surface = control_.mm(q(203)), clearance = control_.mm(q(200)), depth = -control_.mm(q(201));
  const double start = surface + clearance, feed = q(206);
  const double out_feed = feed_out();
  const Motion out = out_feed == kRapidFeed ? Motion::kRapid : Motion::kFeed;
  double peck = cycle_->q.count(202) ? control_.mm(q(202)) : depth;
  if (!(peck > 0.0) || depth / peck > kPecksMax)
    control_.fail("bad-cycle", 0, fmt::format("the depth per peck is {:g} mm", peck), "Q202=5");
  const double least = q(205) > 0.0 ? control_.mm(q(205)) : peck;
  const double smaller = control_.mm(q(212));
  if (smaller > 0.0 && !(depth / least <= kPecksMax && q(205) > 0.0))
    control_.fail("bad-cycle", 0, "Q212 makes pecks smaller, and Q205 gives no smallest one", "Q205=1");
  const double chip = control_.mm(q(257));
  if (chip > 0.0 && depth / chip > kPecksMax)
    control_.fail("bad-cycle", 0, fmt::format("chips break each {:g} mm", chip), "Q257=5");
  // Above the last depth after a retreat: the set-up clearance (200, 203), Q258 (205), its own rule (1).
  double above = clearance;
  if (cycle_->number == 205) above = control_.mm(q(258));
  if (cycle_->number == 1) above = depth <= 30.0 ? 0.6 : std::min(7.0, depth / 50.0);
  const double back = q(256) > 0.0 ? control_.mm(q(256)) : 0.2;
  const double breaks = q(213);
  double broken = 0.0;
  if (control_.position_xyz()[normal] != start) go(Motion::kRapid, start, 0.0);
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
      if (q(210) > 0.0) control_.dwell(q(210));
      if (surface - done + above < start) go(Motion::kRapid, surface - done + above, 0.0);
    }
    peck = std::max(std::min(peck, least), peck - smaller);
  }
  if (q(211) > 0.0) control_.dwell(q(211));
  go(out, start, out_feed);
  if (q(204) > q(200)) go(Motion::kRapid, surface + control_.mm(q(204)), 0.0);
}

}  // namespace swarf::program::heidenhain
