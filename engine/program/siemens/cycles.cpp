// Calls of Siemens 840D: drilling cycles, the high-speed settings, messages.
#include <fmt/format.h>

#include <cmath>

#include "program/siemens/functions.h"
#include "program/siemens/milling.h"
#include "program/siemens/steps.h"

namespace swarf::program::nc::siemens {

using nc::DrillCycle;

namespace {

/// The first arguments of every drilling cycle.
enum Drill { kRtp, kRfp, kSdis, kDp, kDpr };
/// CYCLE83 goes back down to this above the last depth (holes up to 30 mm), and retreats by kChipBreak, mm.
constexpr double kAhead = 0.6, kChipBreak = 1.0;

/// CYCLE832(tolerance, machining type, ...): continuous path with this corner tolerance. CYCLE832() and type
/// 0 go back to what held before.
void high_speed(nc::Control& control, BlockPlace& place, Modes& modes, const CycleCall& call) {
  const double tolerance = control.modal.mm(argument(call, 0, *place.line, 0.0));
  const int type = whole_argument(call, 1, *place.line, call.arguments.empty() ? 0.0 : 1.0);
  if (!(tolerance >= 0.0))
    fail(place, "out-of-range", call.offsets[0], "the tolerance of CYCLE832 is below zero",
         "CYCLE832(0.02,1,1)");
  if (type < 0 || type % 10 > 4) {
    fail(place, "out-of-range", call.offsets[1], fmt::format("{} is not a type of machining", type),
         "0 off, 1 finishing, 2 pre-finishing, 3 roughing");
  }
  const bool on = type % 10 != 0;
  if (on && !has_argument(call, 0))
    fail(place, "missing-argument", call.offset, "CYCLE832 needs its tolerance", "CYCLE832(0.02,1,1)");
  if (on && !modes.before) modes.before = Corner{modes.corner, modes.tolerance_mm};
  if (on) {
    modes.corner = kG642;
    modes.tolerance_mm = tolerance;
  } else if (modes.before) {
    modes.corner = modes.before->code;
    modes.tolerance_mm = modes.before->tolerance_mm;
    modes.before.reset();
  }
  apply_corner(control, modes);
}

/// DP or DPR; both where the units digit of _AMODE says which one counts (1: DPR, 2: DP).
double depth_of(const BlockPlace& place, const CycleCall& call, double reference) {
  const bool simple = call.name == "CYCLE81" || call.name == "CYCLE82";
  const int mode = simple ? whole_argument(call, 8, *place.line, 0.0) % 10 : 0;
  const bool both = has_argument(call, kDp) && has_argument(call, kDpr);
  if ((both && mode == 0) || (!has_argument(call, kDp) && !has_argument(call, kDpr))) {
    fail(place, "wrong-arguments", call.offset,
         fmt::format("{} takes the depth once, as DP or as DPR", call.name),
         "CYCLE81(10,0,2,-20) or CYCLE81(10,0,2,,20)");
  }
  const bool absolute = both ? mode == 2 : has_argument(call, kDp);
  return absolute ? argument(call, kDp, *place.line, 0.0)
                  : reference - std::abs(argument(call, kDpr, *place.line, 0.0));
}

/// _GMODE, _DMODE, _AMODE: no centring by diameter, the active plane (units of _DMODE: 1 G17, 2 G18, 3 G19),
/// the depth as above, the dwell in seconds (tens of _AMODE: 2 would be turns).
void modes(nc::Control& control, const BlockPlace& place, const CycleCall& call, size_t first) {
  only_zero(place, call, first, first);
  const int plane = whole_argument(call, first + 1, *place.line, 0.0) % 10;
  const int active = control.modal.plane == nc::Plane::kXY   ? 1
                     : control.modal.plane == nc::Plane::kZX ? 2
                                                             : 3;
  if (plane != 0 && plane != active) {
    fail(place, "words-conflict", call.offsets[first + 1],
         fmt::format("_DMODE {} names another plane than the active one", plane),
         "write G17, G18 or G19 before it");
  }
  const int mode = whole_argument(call, first + 2, *place.line, 0.0);
  bool turns = mode < 0 || mode % 10 > 2;
  // CYCLE83 has a digit for its first depth before those of its dwells.
  for (int digits = mode / (call.name == "CYCLE83" ? 100 : 10); digits > 0; digits /= 10)
    turns = turns || digits % 10 > 1;
  if (turns) {
    fail(place, "unsupported-word", call.offsets[first + 2], fmt::format("_AMODE {} is not supported", mode),
         "the units are 0 to 2 (depth), the digits of dwells 0 or 1 (seconds)");
  }
  only_zero(place, call, first + 3, call.arguments.size());
}

/// CYCLE81 and CYCLE82 (.., DTB), CYCLE85 (.., DTB, FFR, RFF), CYCLE86 (.., DTB, SDIR, RPA, RPO, RPAP, POSS).
void boring(nc::Control& control, const BlockPlace& place, const CycleCall& call, DrillCycle& cycle) {
  cycle.feed_out = call.name == "CYCLE85";
  cycle.stop_at_bottom = call.name == "CYCLE86";
  if (cycle.stop_at_bottom) {
    only_zero(place, call, 7, 9);  // lifting off
    const int turns = whole_argument(call, 6, *place.line, control.modal.spindle < 0 ? 4.0 : 3.0);
    if (turns != (control.modal.spindle < 0 ? 4 : 3)) {
      fail(place, "unsupported-word", call.offsets[6],
           "CYCLE86 that turns the spindle the other way is not supported",
           "write M3 or M4 before the cycle and the same SDIR, 3 or 4");
    }
    modes(control, place, call, 11);
  } else if (cycle.feed_out) {
    if (has_argument(call, 6) || has_argument(call, 7)) {
      fail(place, "unsupported-word", call.offset,
           "CYCLE85 with feeds of its own (FFR, RFF) is not supported",
           "write the feed as F before the cycle");
    }
    modes(control, place, call, 8);
  } else {
    modes(control, place, call, 6);
  }
}

/// The bottom cuts a peck short before two of DAM and less are left: the manual does not say whether the last
/// two are shared out then too.
void warn_of_last_peck(nc::Control& control, const BlockPlace& place, const CycleCall& call, double first,
                       double left) {
  const double degression = argument(call, 7, *place.line, 0.0);
  double peck = first;
  for (left -= peck; left > 0.0 && peck - degression > degression; left -= peck) peck -= degression;
  const bool in_one = peck == first && left <= 0.0,
             shared = left >= degression - 1e-9 || std::abs(left) < 1e-9;
  if (in_one || shared) return;
  control.report.warn_once(
      "last-peck", column(place, call.offsets[7]),
      "the last peck of CYCLE83 is cut short by the bottom before two of DAM are left, for "
      "which the manual gives no rule: what is left is drilled at once",
      "depth and shape of the hole do not depend on it");
}

/// CYCLE83(RTP,RFP,SDIS,DP,DPR,FDEP,FDPR,DAM,DTB,DTS,FRF,VARI)
void pecking(nc::Control& control, const BlockPlace& place, const CycleCall& call, double reference,
             DrillCycle& cycle) {
  if (has_argument(call, 5) == has_argument(call, 6)) {
    fail(place, "wrong-arguments", call.offset, "CYCLE83 takes the first depth once, as FDEP or as FDPR",
         "CYCLE83(10,0,2,-20,,,5,0,0,0,1,0)");
  }
  const double first = has_argument(call, 5) ? std::abs(reference - argument(call, 5, *place.line, 0.0))
                                             : std::abs(argument(call, 6, *place.line, 0.0));
  const double degression = argument(call, 7, *place.line, 0.0);
  if (degression < 0.0) {
    fail(place, "unsupported-word", call.offsets[7],
         "CYCLE83 with depths that become smaller by a factor (DAM below 0) is not supported",
         "give DAM in mm, 0 or more");
  }
  cycle.degression_mm = control.modal.mm(degression);
  if (degression > 0.0)
    warn_of_last_peck(control, place, call, first, std::abs(depth_of(place, call, reference) - reference));
  const double share = argument(call, 10, *place.line, 1.0);
  if (share != 1.0) {
    fail(place, "unsupported-word", call.offsets[10],
         "CYCLE83 with a slower first peck (FRF) is not supported", "give FRF as 1");
  }
  const int kind = whole_argument(call, 11, *place.line, 0.0);
  if (kind != 0 && kind != 1)
    fail(place, "out-of-range", call.offsets[11], "VARI is 0 (chip breaking) or 1 (swarf removal)", "0 or 1");
  if (!(first > 0.0))
    fail(place, "bad-cycle", call.offset, "the first depth of CYCLE83 is zero", "give FDPR above zero");
  cycle.peck = kind == 1 ? DrillCycle::Peck::kFull : DrillCycle::Peck::kChipBreak;
  cycle.peck_mm = control.modal.mm(first);
  // The first depth counts from the reference plane, the cycle starts SDIS above it.
  cycle.first_peck_mm = control.modal.mm(first + std::abs(argument(call, kSdis, *place.line, 0.0)));
  const double given = argument(call, kind == 1 ? 16 : 14, *place.line, 0.0);  // _DIS1, _VRT
  if (!(given >= 0.0))
    fail(place, "out-of-range", call.offset, "_VRT and _DIS1 are distances", "give 0 or more");
  cycle.clearance_mm = given > 0.0 ? control.modal.mm(given) : kind == 1 ? kAhead : kChipBreak;
  const int axis = whole_argument(call, 12, *place.line, 0.0);
  if (axis != 0 && axis != 3) {
    fail(place, "unsupported-word", call.offsets[12],
         "CYCLE83 along another axis than that of the plane is not supported", "_AXN 3, or left out");
  }
  only_zero(place, call, 15, 15);
  modes(control, place, call, 17);
  if (argument(call, 9, *place.line, 0.0) != 0.0) {
    control.report.warn_once("dwell-left-out", column(place, call.offsets[9]),
                             "the dwell of CYCLE83 above the hole (DTS) is not simulated",
                             "times are that much shorter");
  }
  cycle.dwell_s = argument(call, 8, *place.line, 0.0);
}

/// CYCLE84(RTP,RFP,SDIS,DP,DPR,DTB,SDAC,MPIT,PIT,POSS,SST,SST1)
void tapping(nc::Control& control, const BlockPlace& place, const CycleCall& call, DrillCycle& cycle) {
  if (has_argument(call, 7)) {
    fail(place, "unsupported-word", call.offsets[7], "thread sizes (MPIT) are not looked up",
         "give the pitch, PIT, in mm");
  }
  const double pitch = argument(call, 8, *place.line, std::nullopt);
  if (pitch == 0.0)
    fail(place, "bad-cycle", call.offsets[8], "the pitch is zero",
         "give the pitch in mm, below zero for left-hand threads");
  const double out = argument(call, 11, *place.line, 0.0);
  if (out != 0.0 && out != argument(call, 10, *place.line, 0.0)) {
    fail(place, "unsupported-word", call.offsets[11],
         "CYCLE84 with another speed on the way out (SST1) is not supported", "give SST1 as SST");
  }
  const int axis = whole_argument(call, 12, *place.line, 0.0);
  if (axis != 0 && axis != 3) {
    fail(place, "unsupported-word", call.offsets[12],
         "CYCLE84 along another axis than that of the plane is not supported", "_AXN 3, or left out");
  }
  only_zero(place, call, 13, call.arguments.size());
  cycle.pitch_mm = control.modal.mm(std::abs(pitch));
  cycle.dwell_s = argument(call, 5, *place.line, 0.0);
  cycle.reverse_at_bottom = true;
  cycle.feed_out = true;
}

}  // namespace

bool has_argument(const CycleCall& call, size_t index) {
  return index < call.arguments.size() && call.arguments[index].has_value();
}

double argument(const CycleCall& call, size_t index, const LineRef& line, std::optional<double> fallback) {
  if (has_argument(call, index)) {
    return converted(*call.arguments[index], Type::kReal, line, call.offsets[index]).number;
  }
  if (fallback) return *fallback;
  refuse(line, call.offset, "missing-argument", fmt::format("{} needs its argument {}", call.name, index + 1),
         "give the value; arguments that are left out keep their comma");
}

int whole_argument(const CycleCall& call, size_t index, const LineRef& line, std::optional<double> fallback) {
  const double value = argument(call, index, line, fallback);
  if (value != std::floor(value) || std::abs(value) > 1e9) {
    refuse(line, call.offsets[index], "not-whole-number",
           fmt::format("argument {} of {} is a whole number", index + 1, call.name),
           "write it without a fraction");
  }
  return static_cast<int>(value);
}

void run_call(Executor& executor, const CycleCall& call) {
  if (call.name == "CYCLE800") {
    swivel(executor, call);
  } else if (call.name == "CYCLE832") {
    high_speed(executor.control, executor.place, executor.modes, call);
  } else if (call.name == "CYCLE801" || call.name.starts_with("HOLES")) {
    pattern(executor, call);
  } else if (call.name == "FGROUP") {
    feed_group(executor, call);
  } else if (call.name == "SETMS") {
    if (has_argument(call, 0) && argument(call, 0, *executor.place.line, 1.0) != 1.0) {
      fail(executor.place, "unsupported-word", call.offset, "another master spindle is not simulated",
           "SETMS(1)");
    }
    executor.control.report.without_effect(call.name);
  } else if (call.name.starts_with("POCKET")) {
    pocket(executor, call);
  } else if (call.name.starts_with("SLOT") || call.name == "LONGHOLE") {
    slots(executor, call);
  } else if (call.name == "CYCLE76" || call.name == "CYCLE77") {
    spigot(executor, call);
  } else if (call.name == "CYCLE72") {
    begin_contour(executor, call);
  } else if (call.name == "CYCLE61" || call.name == "CYCLE71") {
    face(executor, call);
  } else if (call.name.starts_with("CYCLE8")) {
    const DrillCycle cycle = drilling(executor.control, executor.place, executor.frames, call);
    drill(executor.control, executor.place, executor.path, cycle, call);
  } else if (call.name == "POLYPATH") {
    polynomial_path(executor.place, call);
  } else {
    std::string text;
    for (const auto& one : call.arguments)
      text += (text.empty() ? "" : ", ") + (one ? as_text(*one) : std::string());
    executor.control.report.without_effect(call.name);
    executor.control.report.note(call.name, text);
  }
}

/// Arguments from `first` to `last` that this version does not know: left out, or 0.
void only_zero(const BlockPlace& place, const CycleCall& call, size_t first, size_t last) {
  for (size_t n = first; n <= last && n < call.arguments.size(); ++n) {
    const std::optional<Value>& value = call.arguments[n];
    if (!value || (value->type == Type::kString ? value->text.empty() : value->number == 0.0)) continue;
    fail(place, "unsupported-word", call.offsets[n],
         fmt::format("argument {} of {} chooses a variant, which is not supported", n + 1, call.name),
         "leave it out, or write the moves as blocks");
  }
}

/// The cycle's heights along the plane's normal, and what it does at the bottom.
DrillCycle drilling(nc::Control& control, const BlockPlace& place, const Frames& frames,
                    const CycleCall& call) {
  if (frames.stretch.factor[nc::axes_of(control.modal.plane).normal] != 1.0) {
    fail(place, "unsupported-word", call.offset,
         "drilling cycles along a mirrored or scaled axis are not supported",
         "write the cycle outside of the frame, or its moves as blocks");
  }
  const double reference = argument(call, kRfp, *place.line, std::nullopt);
  const double safety = std::abs(argument(call, kSdis, *place.line, 0.0));
  const double bottom = depth_of(place, call, reference);
  const double sign = bottom <= reference ? 1.0 : -1.0;
  DrillCycle cycle;
  cycle.retract = control.modal.mm(argument(call, kRtp, *place.line, std::nullopt));
  cycle.approach = control.modal.mm(reference + sign * safety);
  cycle.bottom = control.modal.mm(bottom);
  // RTP of RFP + SDIS is right, whatever the last bit of the sum.
  constexpr double kSumRounding = 1e-9;
  if (sign * (cycle.retract - cycle.approach) < -kSumRounding) {
    fail(place, "bad-cycle", call.offset,
         fmt::format("the retraction plane {:g} mm lies below the start of drilling {:g} mm", cycle.retract,
                     cycle.approach),
         "RTP lies above RFP by SDIS or more");
  }
  if (call.name == "CYCLE83") {
    pecking(control, place, call, reference, cycle);
  } else if (call.name == "CYCLE84") {
    tapping(control, place, call, cycle);
  } else {
    cycle.dwell_s = argument(call, 5, *place.line, 0.0);
    boring(control, place, call, cycle);
  }
  if (!(cycle.dwell_s >= 0.0))
    fail(place, "unsupported-word", call.offsets[5], "a dwell below zero counts turns", "give seconds");
  return cycle;
}

void drill(nc::Control& control, BlockPlace& place, PathWords& path, const DrillCycle& cycle,
           const CycleCall& call) {
  if (call.name == "CYCLE84") {
    const double speed = argument(call, 10, *place.line, std::nullopt);
    if (!(speed > 0.0))
      fail(place, "out-of-range", call.offsets[10], "the speed of tapping (SST) is not above zero",
           "SST is in rpm");
    control.modal.speed_rpm = speed;
    control.modal.spindle = argument(call, 8, *place.line, std::nullopt) > 0.0 ? 1 : -1;
  }
  nc::drill(control, cycle, nc::Target());
  path.last.valid = false;
  if (call.name != "CYCLE84") return;
  const int after = whole_argument(call, 6, *place.line, 5.0);
  if (after != 3 && after != 4 && after != 5) {
    fail(place, "out-of-range", call.offsets[6], "SDAC is 3, 4 or 5: the spindle after the cycle",
         "5 stops it");
  }
  control.modal.spindle = after == 3 ? 1 : after == 4 ? -1 : 0;
}

}  // namespace swarf::program::nc::siemens
