// Slots on a circle of Siemens 840D.
//
//   LONGHOLE(RTP,RFP,SDIS,DP,DPR,NUM,LENG,CPA,CPO,RAD,STA1,INDA,FFD,FFP1,MID)
//   SLOT1(RTP,RFP,SDIS,DP,DPR,NUM,LENG,WID,CPA,CPO,RAD,STA1,INDA,FFD,FFP1,MID,CDIR,FAL,VARI,MIDF,FFP2,SSF,
//         _FALD,_STA2)
//   SLOT2(RTP,RFP,SDIS,DP,DPR,NUM,AFSL,WID,CPA,CPO,RAD,STA1,INDA,FFD,FFP1,MID,CDIR,FAL,VARI,MIDF,FFP2,SSF)
//
// LONGHOLE and SLOT1 lie along radii, SLOT2 along the circle. A long hole is as wide as the tool, which goes
// to and fro and down at each end; a slot is milled once around at each depth, so that the tool has at least
// half of its width. Where RAD, LENG and AFSL end the manual shows by a figure alone:
// ControlSetup::slot_ends.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "base/units.h"
#include "program/siemens/milling.h"

namespace swarf::program::nc::siemens {
namespace {

constexpr int kSlotsMax = 10'000;

/// A circle of slots, mm and degrees.
struct SlotRow {
  int count = 1;
  Vec2 centre = Vec2::Zero();
  double radius = 0.0, first_deg = 0.0, step_deg = 0.0;
};

SlotRow read_row(const MillCall& call, size_t centre_at) {
  SlotRow row;
  row.count = call.whole(5, std::nullopt);
  if (row.count < 1 || row.count > kSlotsMax)
    call.fail("out-of-range", 5, fmt::format("{} slots are no row (alarm 61103)", row.count),
              fmt::format("1 to {}", kSlotsMax));
  row.centre = Vec2(call.length(centre_at, std::nullopt), call.length(centre_at + 1, std::nullopt));
  row.radius = call.size(centre_at + 2, std::nullopt);
  row.first_deg = call.number(centre_at + 3, 0.0);
  row.step_deg = call.number(centre_at + 4, 0.0);
  if (row.step_deg == 0.0) row.step_deg = 360.0 / row.count;
  return row;
}

SlotEnds ends_of(const MillCall& call) {
  const auto& ends = call.executor().control.setup.slot_ends;
  if (ends) return *ends;
  call.fail(
      "slot-ends", call.name() == "LONGHOLE" ? 9 : 10,
      fmt::format("where RAD of {} ends (at the slot's edge, or at the middle of its round end) the manual "
                  "shows by a figure alone",
                  call.name()),
      "say it: slot_ends = \"edge\" or \"centre\" in the scene, --slot-ends");
}

/// The middles of a radial slot's round ends, from the circle's centre; `width` of the slot.
std::pair<double, double> radial_ends(const MillCall& call, const SlotRow& row, double length, double width,
                                      size_t length_at) {
  if (length < width - 1e-9)
    call.fail("bad-cycle", length_at,
              fmt::format("a slot {:g} mm long is shorter than its width, {:g} mm", length, width),
              "LENG is the whole length");
  const double inner = row.radius + (ends_of(call) == SlotEnds::kEdge ? 0.5 * width : 0.0);
  return {inner, inner + std::max(0.0, length - width)};
}

/// Neighbours that run into each other (alarm 61104). `inner`: middle of the inner round end.
void check_neighbours(const MillCall& call, const SlotRow& row, double inner, double width) {
  if (row.count < 2) return;
  double apart = std::abs(std::remainder(row.step_deg, 360.0));
  const double around = std::abs(std::remainder(row.step_deg * (row.count - 1), 360.0));
  if (row.count > 2) apart = std::min(apart, around);
  const double turn = rad_from_deg(apart);
  const double clear = apart < 90.0 ? inner * std::sin(turn) : 2.0 * inner * std::sin(0.5 * turn);
  if (clear < width - 1e-9)
    call.fail(
        "bad-cycle", 5,
        fmt::format("the slots are {:g} mm apart where they are nearest, and {:g} mm wide (alarm 61104)",
                    clear, width),
        "fewer or narrower slots, or a larger RAD");
}

/// To and fro along each hole, down at its ends; the next one begins at its nearer end.
void long_holes(const MillCall& call) {
  const MillHeights heights = mill_heights(call, true, 99);
  const SlotRow row = read_row(call, 7);
  const double width = 2.0 * call.tool_radius();
  const auto [inner, outer] = radial_ends(call, row, call.way(6), width, 6);
  check_neighbours(call, row, inner, width);
  const double down = call.feed(12), along = call.feed(13);
  const int count = call.steps(heights.safe - heights.bottom, call.size(14, 0.0), 14);
  MillMotion motion(call, row.centre, 0.0);
  motion.rapid_height(heights.retract);
  const nc::PlaneAxes plane = nc::axes_of(call.executor().control.modal.plane);
  const Vec3 now = nc::position_xyz(call.executor().control);
  Vec2 here = Vec2(now[plane.first], now[plane.second]) - row.centre;
  for (int n = 0; n < row.count; ++n) {
    const double angle = rad_from_deg(row.first_deg + n * row.step_deg);
    const Vec2 radial(std::cos(angle), std::sin(angle));
    Vec2 start = inner * radial, end = outer * radial;
    if ((end - here).norm() < (start - here).norm()) std::swap(start, end);
    motion.rapid(start);
    motion.rapid_height(heights.safe);
    for (const double height : infeeds(heights.safe, heights.bottom, count)) {
      motion.feed_height(height, down);
      motion.feed(end, along);
      std::swap(start, end);
    }
    motion.rapid_height(heights.retract);
    here = start;
  }
}

struct SlotCut {
  MillHeights heights;
  double width = 0.0, wall = 0.0, floor = 0.0;
  double down = 0.0, feed = 0.0, finish_feed = 0.0, finish_speed = 0.0;
  int rough_steps = 0, finish_steps = 0, sense = 1;
  double swing_rad = 0.0;  ///< 0: straight down
  bool rapid_down = false, rough = true, finish = true;
};

SlotCut read_slot(const MillCall& call) {
  SlotCut cut;
  cut.heights = mill_heights(call, true, 99);
  cut.width = call.way(7);
  cut.down = call.feed(13);
  cut.feed = call.feed(14);
  cut.sense = call.sense(16, false);
  cut.wall = call.size(17, 0.0);
  cut.floor = call.name() == "SLOT1" ? call.size(22, 0.0) : 0.0;
  const int kind = call.whole(18, 0.0), way_in = kind / 10;
  const bool swings = way_in == 3 && call.name() == "SLOT1";
  if (kind < 0 || kind % 10 > 2 || (way_in > 1 && !swings))
    call.fail("unsupported-word", 18, fmt::format("VARI {} is not read (alarm 61002)", kind),
              "units: 0 all, 1 roughing, 2 finishing; tens: 0 rapid, 1 straight, 3 (SLOT1) to and fro");
  cut.rough = kind % 10 != 2;
  cut.finish = kind % 10 == 2 || (kind % 10 == 0 && (cut.wall > 0.0 || cut.floor > 0.0));
  cut.rapid_down = way_in == 0;
  if (swings && cut.rough) {
    const double angle = call.number(23, 0.0);
    if (!(angle > 0.0) || !(angle < 90.0))
      call.fail("bad-cycle", 23, fmt::format("the tool cannot swing down at {:g} degrees", angle),
                "_STA2 is the steepest angle, above 0 and below 90 degrees");
    cut.swing_rad = rad_from_deg(angle);
  }
  const double most = call.size(15, 0.0), most_finish = call.given(19) ? call.size(19, 0.0) : 0.0;
  cut.rough_steps = call.steps(cut.heights.safe - cut.heights.bottom - cut.floor, most, 15);
  cut.finish_steps =
      call.steps(cut.heights.safe - cut.heights.bottom, most_finish > 0.0 ? most_finish : most, 19);
  cut.finish_feed = call.number(20, 0.0) > 0.0 ? call.feed(20) : cut.feed;
  cut.finish_speed = call.number(21, 0.0);
  if (!(cut.finish_speed >= 0.0)) call.fail("out-of-range", 21, "SSF is below zero", "SSF is in rpm");
  call.only_zero_from(call.name() == "SLOT1" ? 24 : 22);
  const double tool = 2.0 * call.tool_radius(), left = cut.width - (cut.rough ? 2.0 * cut.wall : 0.0);
  if (tool > left + 1e-9)
    call.fail("bad-tool", 7,
              fmt::format("a tool of {:g} mm does not fit a slot of {:g} mm (alarm 61105)", tool, left),
              fmt::format("use a tool of at most {:g} mm", left));
  if (cut.rough && 2.0 * tool < left - 1e-9)
    call.fail(
        "bad-tool", 7,
        fmt::format("a tool of {:g} mm, once around, leaves the middle of a slot of {:g} mm (alarm 61006)",
                    tool, left),
        fmt::format("use a tool of at least {:g} mm", 0.5 * left));
  return cut;
}

/// The way of the tool's centre at a distance from the middle line of a slot along x.
Outline straight_way(double half_width, double inner, double outer) {
  const double half = 0.5 * (outer - inner);
  Outline way = rounded_rectangle(half + half_width, half_width, half_width);
  const Vec2 middle(0.5 * (inner + outer), 0.0);
  way.start += middle;
  for (OutlinePiece& piece : way.pieces) {
    piece.to += middle;
    piece.centre += middle;
  }
  return way;
}

/// One slot in its own frame: once around at each depth, from `in`, where the tool goes down.
class SlotMill {
 public:
  SlotMill(const MillCall& call, const SlotCut& cut, MillMotion& motion, const Vec2& in, const Vec2& far)
      : call_(call), cut_(cut), motion_(motion), in_(in), far_(far) {}

  void rough(const Outline& way) {
    const double from = cut_.heights.safe, to = cut_.heights.bottom + cut_.floor;
    double height = from;
    for (const double next : infeeds(from, to, cut_.rough_steps)) {
      if (cut_.swing_rad > 0.0)
        swing(height, next);
      else if (cut_.rapid_down)
        motion_.rapid_height(next);
      else
        motion_.feed_height(next, cut_.down);
      around(way, cut_.feed);
      height = next;
    }
  }

  void finish(const Outline& way) {
    nc::ModalState& modal = call_.executor().control.modal;
    const Borrowed speed(modal.speed_rpm);
    if (cut_.finish_speed > 0.0) modal.speed_rpm = cut_.finish_speed;
    for (const double next : infeeds(cut_.heights.safe, cut_.heights.bottom, cut_.finish_steps)) {
      motion_.feed_height(next, cut_.down);
      around(way, cut_.finish_feed);
    }
  }

 private:
  void around(const Outline& way, double feed) {
    motion_.feed(way.start, feed);
    motion_.follow(way, feed);
    motion_.feed(in_, feed);
  }

  /// To and fro along the middle line, and once more level, back at `in`.
  void swing(double from, double to) {
    const double reach = (far_ - in_).norm();
    if (!(reach > 1e-9)) call_.fail("bad-cycle", 6, "a round slot leaves no way to swing", "VARI 11");
    const int strokes = call_.steps(from - to, reach * std::tan(cut_.swing_rad), 23);
    bool away = false;
    for (const double next : infeeds(from, to, strokes)) {
      away = !away;
      motion_.ramp(away ? far_ : in_, next, cut_.down);
    }
    motion_.feed(away ? in_ : far_, cut_.down);
    if (!away) motion_.feed(in_, cut_.down);
  }

  const MillCall& call_;
  const SlotCut& cut_;
  MillMotion& motion_;
  Vec2 in_, far_;
};

void check_arc(const MillCall& call, const SlotRow& row, double from_deg, double to_deg, double width) {
  const double round_deg = deg_from_rad(2.0 * std::asin(std::min(1.0, 0.5 * width / row.radius)));
  const double needs = to_deg - from_deg + round_deg;
  const double step = std::abs(row.step_deg);
  const double left = row.count > 1 ? std::min(step, 360.0 - step * (row.count - 1)) : 360.0;
  if (!(to_deg >= from_deg) || needs > left + 1e-9)
    call.fail("bad-cycle", 6,
              fmt::format("a slot takes {:g} degrees, and {:g} are there for it (alarm 61104)", needs, left),
              "AFSL is the slot's angle, INDA that from one to the next");
}

/// Both round ends' middles as angles, relative to STA1.
std::pair<double, double> arc_ends(const MillCall& call, const SlotRow& row, double width) {
  const double angle = call.number(6, std::nullopt);
  if (!(angle > 0.0) || !(angle < 360.0) || row.radius < 0.5 * width)
    call.fail("bad-cycle", 6,
              fmt::format("a slot of {:g} degrees on a radius of {:g} mm is none", angle, row.radius),
              "AFSL is above 0 and below 360 degrees, RAD more than half of WID");
  const double round_deg = deg_from_rad(2.0 * std::asin(0.25 * width / row.radius));
  const double off = ends_of(call) == SlotEnds::kEdge ? round_deg : 0.0;
  return {off, angle - off};
}

void milled_slots(const MillCall& call) {
  const SlotCut cut = read_slot(call);
  const SlotRow row = read_row(call, 8);
  const bool arc = call.name() == "SLOT2";
  const double r = call.tool_radius();
  double from = 0.0, to = 0.0;
  if (arc) {
    std::tie(from, to) = arc_ends(call, row, cut.width);
    check_arc(call, row, from, to, cut.width);
  } else {
    std::tie(from, to) = radial_ends(call, row, call.way(6), cut.width, 6);
    check_neighbours(call, row, from, cut.width);
  }
  const auto point = [&](double end) {
    const double angle = rad_from_deg(end);
    return arc ? Vec2(row.radius * std::cos(angle), row.radius * std::sin(angle)) : Vec2(end, 0.0);
  };
  const auto way = [&](double inset) {
    const double half = 0.5 * cut.width - inset;
    const Outline outline = arc ? round_band(row.radius, half, rad_from_deg(from), rad_from_deg(to))
                                : straight_way(half, from, to);
    return cut.sense > 0 ? outline : reversed(outline);
  };
  call.warn(
      "slot-passes",
      "where in a slot the tool goes down, and how it comes to its contour, the manual shows by a figure "
      "alone: taken in the middle of one round end (SLOT1: the outer one, SLOT2: the first), straight");
  const Vec2 in = arc ? point(from) : point(to), far = arc ? point(to) : point(from);
  for (int n = 0; n < row.count; ++n) {
    MillMotion motion(call, row.centre, row.first_deg + n * row.step_deg);
    motion.rapid_height(cut.heights.retract);
    motion.rapid(in);
    motion.rapid_height(cut.heights.safe);
    SlotMill mill(call, cut, motion, in, far);
    if (cut.rough) mill.rough(way(cut.wall + r));
    if (cut.rough && cut.finish) motion.rapid_height(cut.heights.safe);
    if (cut.finish) mill.finish(way(r));
    motion.rapid_height(cut.heights.retract);
  }
}

}  // namespace

void slots(Executor& executor, const CycleCall& words) {
  const MillCall call(executor, words, words.name == "LONGHOLE" ? 15 : 30);
  if (words.name == "LONGHOLE")
    long_holes(call);
  else
    milled_slots(call);
}

}  // namespace swarf::program::nc::siemens
