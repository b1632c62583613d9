// Pockets of Siemens 840D.
//
//   POCKET3(_RTP,_RFP,_SDIS,_DP,_LENG,_WID,_CRAD,_PA,_PO,_STA,_MID,_FAL,_FALD,_FFP1,_FFD,_CDIR,_VARI,_MIDA,
//           _AP1,_AP2,_AD,_RAD1,_DP1,_UMODE,_FS,_ZFS,_GMODE,_DMODE,_AMODE)
//   POCKET4(_RTP,_RFP,_SDIS,_DP,_PRAD,_PA,_PO,_MID,_FAL,_FALD,_FFP1,_FFD,_CDIR,_VARI,_MIDA,
//           _AP1,_AD,_RAD1,_DP1,_UMODE,_FS,_ZFS,_GMODE,_DMODE,_AMODE)
//   POCKET1(RTP,RFP,SDIS,DP,DPR,LENG,WID,CRAD,CPA,CPO,STA1,FFD,FFP1,MID,CDIR,FAL,VARI,MIDF,FFP2,SSF)
//   POCKET2(RTP,RFP,SDIS,DP,DPR,PRAD,CPA,CPO,FFD,FFP1,MID,CDIR,FAL,VARI,MIDF,FFP2,SSF), the older ones:
//   straight in at the centre; VARI 0 roughing, then the walls with MIDF, FFP2 and the speed SSF; 1, 2 one of
//   both
//
// Roughing: equal infeeds of at most _MID from RFP + SDIS to _DP + _FALD; each level is entered at the centre
// (straight, on a helix, or to and fro along the pocket) and milled from the inside out in equal steps of at
// most _MIDA (0: .8 of the tool) up to _FAL from the walls. Finishing: the walls, entered and left on a
// quadrant of 2 mm or _FAL, down to _DP + _FALD; then the floor, from its centre out.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "program/siemens/milling.h"

namespace swarf::program::nc::siemens {
namespace {

/// Of the quadrant onto the wall, mm.
constexpr double kQuadrant = 2.0;

enum class WayIn { kRapid, kStraight, kHelix, kSwing };

struct PocketCut : MillShape {
  MillHeights heights;
  double most_down = 0.0;  ///< MID
  size_t mid_at = 0, mida_at = 0;
  double wall = 0.0, floor = 0.0;  ///< FAL, FALD
  double feed = 0.0, feed_down = 0.0;
  int sense = 1;
  double step = 0.0;  ///< the widest between passes
  WayIn entry = WayIn::kRapid;
  double entry_size = 0.0;                          ///< radius of the helix, mm, or angle of the swing, rad
  double down_per_turn = 0.0;                       ///< of the helix
  bool finish = false, base = true, walls = false;  ///< walls: finished without an allowance too
};

/// The way of the tool's centre at `inset` within the pocket's walls, in the asked sense.
Outline wall_way(const PocketCut& cut, double inset) {
  const Outline outline =
      rounded_rectangle(cut.half_length - inset, cut.half_width - inset, std::max(0.0, cut.corner - inset));
  return cut.sense > 0 ? outline : reversed(outline);
}

class PocketMill {
 public:
  PocketMill(const MillCall& call, const PocketCut& cut)
      : call_(call), cut_(cut), motion_(call, cut.centre, cut.angle_deg), r_(call.tool_radius()) {}

  void rough() {
    const double from = cut_.heights.safe, to = cut_.heights.bottom + cut_.floor;
    above_centre();
    double height = from;
    for (const double next : infeeds(from, to, call_.steps(from - to, cut_.most_down, cut_.mid_at))) {
      if (height < from) back_to_centre(height);
      enter(height, next);
      clear_plane(cut_.wall + r_);
      height = next;
    }
    out();
  }

  void finish() {
    if (cut_.wall > 0.0 || cut_.walls) finish_walls();
    if (cut_.base && cut_.floor > 0.0) {
      above_centre();
      motion_.rapid_height(std::min(cut_.heights.safe, cut_.heights.bottom + cut_.floor + safety()));
      motion_.feed_height(cut_.heights.bottom, cut_.feed_down);
      clear_plane(r_);
      out();
    }
  }

 private:
  double safety() const { return cut_.heights.safe - call_.length(1, std::nullopt); }

  void above_centre() {
    motion_.rapid_height(cut_.heights.retract);
    motion_.rapid(Vec2::Zero());
    motion_.rapid_height(cut_.heights.safe);
  }

  void out() { motion_.rapid_height(cut_.heights.retract); }

  /// Clear of the floor that was cut at `height`, over the centre, and down to it again.
  void back_to_centre(double height) {
    motion_.rapid_height(std::min(cut_.heights.safe, height + std::max(safety(), 1e-3)));
    motion_.rapid(Vec2::Zero());
    motion_.rapid_height(height);
  }

  void enter(double from, double to) {
    const double way = from - to;
    switch (cut_.entry) {
      case WayIn::kRapid:
        return motion_.rapid_height(to);
      case WayIn::kStraight:
        return motion_.feed_height(to, cut_.feed_down);
      case WayIn::kHelix: {
        const Vec2 start(cut_.entry_size, 0.0);
        motion_.feed(start, cut_.feed_down);
        for (const double next : infeeds(from, to, call_.steps(way, cut_.down_per_turn, cut_.mid_at)))
          motion_.arc(start, Vec2::Zero(), cut_.sense, cut_.feed_down, next);
        return motion_.arc(start, Vec2::Zero(), cut_.sense, cut_.feed_down);
      }
      case WayIn::kSwing: {
        const double reach = cut_.half_length - cut_.wall - r_;
        double side = 1.0;
        motion_.feed(Vec2(reach, 0.0), cut_.feed_down);
        const int strokes = call_.steps(way, 2.0 * reach * std::tan(cut_.entry_size), cut_.mid_at);
        for (const double next : infeeds(from, to, strokes)) {
          side = -side;
          motion_.ramp(Vec2(side * reach, 0.0), next, cut_.feed_down);
        }
        return motion_.feed(Vec2(-side * reach, 0.0), cut_.feed_down);
      }
    }
  }

  /// From the pocket's middle line out to `inset` within its walls, at the height where the tool stands.
  void clear_plane(double inset) {
    const double narrow = std::min(cut_.half_length, cut_.half_width) - inset;
    const int passes = call_.steps(narrow, cut_.step, cut_.mida_at);
    for (int n = 0; n <= passes; ++n) {
      const double here = passes == 0 ? inset : inset + narrow * (passes - n) / passes;
      const Outline way = wall_way(cut_, here);
      motion_.feed(way.start, cut_.feed);
      motion_.follow(way, cut_.feed);
    }
  }

  void finish_walls() {
    const Outline way = wall_way(cut_, r_);
    const double space = std::min(cut_.half_length, cut_.half_width) - r_;
    const double q = std::min(std::max(kQuadrant, cut_.wall), space), s = cut_.sense;
    const Vec2 middle = way.start - Vec2(q, 0.0);
    const double from = cut_.heights.safe, to = cut_.heights.bottom + (cut_.base ? cut_.floor : 0.0);
    above_centre();
    for (const double next : infeeds(from, to, call_.steps(from - to, cut_.most_down, cut_.mid_at))) {
      motion_.rapid(Vec2::Zero());
      motion_.rapid_height(next);
      motion_.rapid(middle - Vec2(0.0, s * q));
      if (q > 1e-9) motion_.arc(way.start, middle, cut_.sense, cut_.feed);
      motion_.follow(way, cut_.feed);
      if (q > 1e-9) motion_.arc(middle + Vec2(0.0, s * q), middle, cut_.sense, cut_.feed);
    }
    motion_.rapid(Vec2::Zero());
    out();
  }

  const MillCall& call_;
  const PocketCut& cut_;
  MillMotion motion_;
  double r_;
};

/// Where the two cycles have the same arguments; `at`: index of _MID, `tail`: of _RAD1.
void read_pocket_cut(const MillCall& call, size_t at, size_t tail, PocketCut& cut) {
  cut.mid_at = at;
  cut.most_down = call.size(at, 0.0);
  cut.wall = call.size(at + 1, 0.0);
  cut.floor = call.size(at + 2, 0.0);
  cut.feed = call.feed(at + 3);
  cut.feed_down = call.feed(at + 4);
  cut.sense = call.sense(at + 5, false);
  const int kind = call.whole(at + 6, std::nullopt), how = kind % 10, entry = kind / 10;
  if (how != 1 && how != 2 && how != 4)
    call.fail(how == 5 ? "unsupported-word" : "out-of-range", at + 6,
              fmt::format("_VARI {} is no machining that is read (alarm 61002)", kind),
              "units: 1 roughing, 2 finishing, 4 walls alone; tens: 0 rapid, 1 straight, 2 helix, 3 swing");
  cut.finish = how != 1;
  cut.base = how == 2;
  if (entry > 3 || (entry == 3 && call.name() == "POCKET4"))
    call.fail("unsupported-word", at + 6, fmt::format("_VARI {}: this way in is not read", kind),
              "tens: 0 rapid, 1 straight, 2 helix, 3 (POCKET3) to and fro");
  cut.entry = static_cast<WayIn>(entry);
  cut.mida_at = at + 7;
  const bool percent = call.whole(tail + 7, 0.0) / 10 % 10 == 1;
  const double tool = 2.0 * call.tool_radius();
  const double step = percent ? 0.01 * call.number(at + 7, 0.0) * tool : call.size(at + 7, 0.0);
  if (!(step >= 0.0) || step > tool + 1e-9)
    call.fail("out-of-range", at + 7,
              fmt::format("the tool of {:g} mm leaves material between passes {:g} mm apart (alarm 61111)",
                          tool, step),
              "_MIDA is at most the tool's diameter; 0 takes .8 of it");
  cut.step = step > 0.0 ? step : kStepOfTool * tool;
}

/// _RAD1, _DP1 of the ways in; the dimensions of a blank.
void read_entry(const MillCall& call, size_t blank, size_t tail, PocketCut& cut) {
  const bool complete = call.whole(tail + 5, 0.0) / 10000 % 10 == 1;
  for (size_t n = blank; n < tail && !complete; ++n) {
    if (call.number(n, 0.0) != 0.0)
      call.fail("unsupported-word", n,
                "a pocket that was cast or milled before (_AP1, _AP2, _AD) is not read",
                "leave them out: the whole pocket is milled");
  }
  const double space = std::min(cut.half_length, cut.half_width) - cut.wall - call.tool_radius();
  if (!cut.finish && cut.entry == WayIn::kHelix) {
    cut.entry_size = call.size(tail, 0.0);
    cut.down_per_turn = call.size(tail + 1, 0.0);
    if (!(cut.entry_size > 0.0) || !(cut.down_per_turn > 0.0) || cut.entry_size > space + 1e-9)
      call.fail(
          "bad-cycle", tail,
          fmt::format("a helix of radius {:g} mm, {:g} mm down a turn, does not fit a pocket with {:g} mm "
                      "beside the tool (alarm 61108)",
                      cut.entry_size, cut.down_per_turn, space),
          "give _RAD1 and _DP1 above zero, _RAD1 within the pocket");
  } else if (!cut.finish && cut.entry == WayIn::kSwing) {
    const double angle = call.number(tail, 0.0), reach = cut.half_length - cut.wall - call.tool_radius();
    if (!(angle > 0.0) || !(angle < 90.0) || !(reach > 0.0))
      call.fail("bad-cycle", tail,
                fmt::format("the tool cannot swing down at {:g} degrees (alarm 61108)", angle),
                "_RAD1 is the steepest angle, above 0 and below 90 degrees");
    cut.entry_size = rad_from_deg(angle);
  }
  if (call.number(tail + 2, 0.0) != 0.0)
    call.fail("unsupported-word", tail + 2, "_UMODE chooses a variant, which is not read", "leave it out");
  call.plain_modes(tail + 5);
  call.only_zero_from(tail + 8);
}

void check_room(const MillCall& call, const PocketCut& cut, size_t size_at) {
  const double room = 2.0 * std::min(cut.half_length, cut.half_width), tool = 2.0 * call.tool_radius();
  const double need = tool + (cut.finish ? 0.0 : 2.0 * cut.wall);
  if (room < need - 1e-9)
    call.fail(
        "bad-tool", size_at,
        fmt::format("the pocket is {:g} mm wide{}, and the tool has {:g} mm (alarm 61105)", room,
                    cut.finish || cut.wall == 0.0 ? "" : fmt::format(" with {:g} mm on each wall", cut.wall),
                    tool),
        fmt::format("use a tool of at most {:g} mm", room - (need - tool)));
}

void warn_of_passes(const MillCall& call) {
  call.warn(
      "pocket-passes",
      "how a pocket's passes follow each other is the control's own: taken as rings from its middle line "
      "out, equal steps of at most _MIDA, joined on the positive longitudinal axis");
}

/// POCKET1 and POCKET2 from FFD on, the argument `at`.
void mill_old_pocket(const MillCall& call, size_t at, PocketCut& cut) {
  cut.feed_down = call.feed(at);
  cut.feed = call.feed(at + 1);
  cut.mid_at = at + 2;
  cut.most_down = call.size(at + 2, 0.0);
  if (const int way = call.whole(at + 3, std::nullopt); way != 2 && way != 3)
    call.fail("out-of-range", at + 3, fmt::format("{} is no direction of {}", way, call.name()),
              "2 G2, 3 G3");
  cut.sense = call.sense(at + 3, false);
  cut.wall = call.size(at + 4, 0.0);
  const int kind = call.whole(at + 5, 0.0);
  if (kind < 0 || kind > 2)
    call.fail("out-of-range", at + 5, fmt::format("VARI {} is no machining (alarm 61002)", kind),
              "0 all, 1 roughing, 2 finishing");
  cut.entry = WayIn::kStraight;
  cut.step = kStepOfTool * 2.0 * call.tool_radius();
  cut.mida_at = at + 2;
  cut.finish = kind == 2;
  check_room(call, cut, 5);
  warn_of_passes(call);
  if (kind != 2) PocketMill(call, cut).rough();
  if (kind == 1 || (kind == 0 && cut.wall == 0.0)) return;
  nc::ModalState& modal = call.executor().control.modal;
  const Borrowed<double> speed(modal.speed_rpm);
  if (const double finishing = call.size(at + 8, 0.0); finishing > 0.0) modal.speed_rpm = finishing;
  cut.most_down = call.size(at + 6, 0.0);
  cut.mid_at = at + 6;
  if (call.number(at + 7, 0.0) != 0.0) cut.feed = call.feed(at + 7);
  cut.finish = cut.walls = true;
  PocketMill(call, cut).finish();
}

void old_pocket(Executor& executor, const CycleCall& words) {
  const bool round = words.name == "POCKET2";
  const MillCall call(executor, words, round ? 17 : 20);
  PocketCut cut;
  cut.heights = mill_heights(call, true, words.arguments.size());
  static_cast<MillShape&>(cut) = round ? circle_at(call, 5, false) : rectangle_at(call, 5, "pocket");
  cut.corner = std::max(cut.corner, call.tool_radius());
  mill_old_pocket(call, round ? 8 : 11, cut);
}

}  // namespace

void pocket(Executor& executor, const CycleCall& words) {
  if (words.name == "POCKET1" || words.name == "POCKET2") return old_pocket(executor, words);
  const bool round = words.name == "POCKET4";
  const MillCall call(executor, words, round ? 25 : 29);
  PocketCut cut;
  const size_t mid = round ? 7 : 10, blank = mid + 8, tail = round ? 17 : 21;
  cut.heights = mill_heights(call, false, tail + 7);
  static_cast<MillShape&>(cut) = round ? circle_at(call, 4, false) : rectangle_at(call, 4, "pocket");
  // A corner narrower than the tool gets the tool's radius.
  cut.corner = std::max(cut.corner, call.tool_radius());
  read_pocket_cut(call, mid, tail, cut);
  read_entry(call, blank, tail, cut);
  check_room(call, cut, 4);
  warn_of_passes(call);
  PocketMill mill(call, cut);
  if (cut.finish)
    mill.finish();
  else
    mill.rough();
}

}  // namespace swarf::program::nc::siemens
