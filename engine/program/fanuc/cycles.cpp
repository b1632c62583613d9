// Canned cycles of group 9: what their words mean; the control expands them into moves (drill_cycle.h).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "program/fanuc/steps.h"

namespace swarf::program::nc::fanuc {
namespace {

/// How far G73 draws back and G83 stays above the last depth (parameters 5114, 5115; 0.5 mm as delivered
/// here).
constexpr double kPeckClearanceMm = 0.5;

bool pecks(int tenths) {
  return tenths == G::kDrillChipBreak || tenths == G::kDrillDeep;
}
/// G76 and G87 shift by Q (or I J) with the spindle oriented.
bool bores(int tenths) {
  return tenths == G::kFineBore || tenths == G::kBackBore;
}

void keep_cycle_words(Fanuc& fanuc, char depth_letter) {
  Modes& modes = fanuc.modes;
  Drilling& drilling = fanuc.drilling;
  LetterDialect& letters = fanuc;
  const auto keep = [&](char letter, double& value, bool& has) {
    if (!letters.block.has(letter)) return;
    value = letters.control.modal.mm(letters.block.get(letter));
    has = true;
  };
  keep(depth_letter, drilling.words.z, drilling.words.has_z);
  keep('R', drilling.words.r, drilling.words.has_r);
  keep('Q', drilling.words.q, drilling.words.has_q);
  if (letters.block.has(depth_letter)) drilling.words.z_incremental = modes.incremental;
  if (letters.block.has('R')) drilling.words.r_incremental = modes.incremental;
  keep('I', drilling.words.i, drilling.words.has_i);
  keep('J', drilling.words.j, drilling.words.has_j);
  if (letters.block.has('P')) drilling.words.p = seconds_of_p(fanuc);
}

void check_cycle_words(Modes& modes, Drilling& drilling, LetterDialect& letters, int tenths,
                       char depth_letter) {
  const int at = letters.reader.column_of(letters.block.first);
  const bool shift = drilling.words.has_q || drilling.words.has_i || drilling.words.has_j;
  const char missing = !drilling.words.has_z                                                   ? depth_letter
                       : !drilling.words.has_r                                                 ? 'R'
                       : (pecks(tenths) && !drilling.words.has_q) || (bores(tenths) && !shift) ? 'Q'
                                                                                               : '\0';
  if (missing != '\0')
    letters.control.report.fail(
        "missing-word", at, fmt::format("the cycle G{} needs the word {}", tenths / 10, missing), "add it");
  if (pecks(tenths) && !(drilling.words.q > 0.0))
    letters.control.report.fail("out-of-range", at,
                                fmt::format("Q {:g} is no depth per peck", drilling.words.q),
                                "write Q above zero");
  if (bores(tenths) && drilling.words.has_q && (drilling.words.has_i || drilling.words.has_j))
    letters.control.report.fail("modal-conflict", at, "the shift of this cycle is given by Q and by I J",
                                "write Q, or I and J; G80 before the cycle forgets earlier ones");
  if ((letters.block.has('I') || letters.block.has('J')) && letters.control.modal.plane != Plane::kXY)
    letters.control.report.fail("unsupported-word", letters.column(letters.block.has('I') ? 'I' : 'J'),
                                "the shift by I J K is read in G17 only: K counts repeats",
                                "write the shift as Q");
  if (tenths == G::kBackBore && modes.retract_to_r)
    letters.control.report.fail("modal-conflict", at, "G87 goes back to the initial level only",
                                "write G98 before it");
}

/// Q carries no direction: the machine's parameter 5148 (5101 on older controls) does. As delivered it is the
/// plane's first axis, positive.
Vec3 bore_shift(Drilling& drilling, LetterDialect& letters) {
  if (drilling.words.has_i || drilling.words.has_j) return {drilling.words.i, drilling.words.j, 0.0};
  const int first = axes_of(letters.control.modal.plane).first;
  letters.control.report.warn_once(
      "shift-direction", letters.reader.column_of(letters.block.first),
      fmt::format("G76 and G87 shift by Q along +{} here: the direction stands in parameter "
                  "5148 of the machine, which the program does not say",
                  kAxisLetters[first]),
      "write the shift as I and J where the machine shifts another way");
  return std::abs(drilling.words.q) * Vec3::Unit(first);
}

DrillCycle drill_cycle(Fanuc& fanuc, int tenths) {
  DrillCycle cycle;
  // Scaling moves R and Z; depths per peck and shifts stay as written.
  const Stretch& map = fanuc.mapping.stretch;
  const int normal = axes_of(fanuc.control.modal.plane).normal;
  if (map.factor[normal] < 0.0)
    fanuc.control.report.fail("modal-conflict", fanuc.reader.column_of(fanuc.block.first),
                              "a cycle drills along a mirrored axis",
                              "end the mirror image of the drilling axis before it");
  const double r = map.along(normal, fanuc.drilling.words.r, fanuc.drilling.words.r_incremental),
               z = map.along(normal, fanuc.drilling.words.z, fanuc.drilling.words.z_incremental);
  cycle.approach = fanuc.drilling.words.r_incremental ? fanuc.drilling.cycle_start + r : r;
  cycle.bottom = fanuc.drilling.words.z_incremental ? cycle.approach + z : z;
  const bool back = tenths == G::kBackBore;
  if (back ? cycle.bottom < cycle.approach : cycle.bottom > cycle.approach)
    fanuc.control.report.fail(
        "bad-cycle", fanuc.reader.column_of(fanuc.block.first),
        fmt::format("the bottom {:.4f} mm lies {} the approach height {:.4f} mm", cycle.bottom,
                    back ? "below" : "above", cycle.approach),
        back ? "G87 cuts upwards: R lies below the face, Z on it" : "R must lie above the depth");
  cycle.retract = back                       ? fanuc.drilling.cycle_start
                  : fanuc.modes.retract_to_r ? cycle.approach
                                             : std::max(cycle.approach, fanuc.drilling.cycle_start);
  cycle.peck = tenths == G::kDrillChipBreak ? DrillCycle::Peck::kChipBreak
               : tenths == G::kDrillDeep    ? DrillCycle::Peck::kFull
                                            : DrillCycle::Peck::kNone;
  cycle.peck_mm = fanuc.drilling.words.q;
  cycle.clearance_mm = kPeckClearanceMm;
  const bool taps = tenths == G::kTap || tenths == G::kTapLeft;
  cycle.dwell_s = taps || bores(tenths) || tenths == G::kDrillDwell || tenths == G::kBoreManualOut ||
                          tenths == G::kBoreDwellOut
                      ? fanuc.drilling.words.p
                      : 0.0;
  cycle.dwell_out_s = taps ? fanuc.drilling.words.p : 0.0;
  cycle.feed_out = taps || tenths == G::kBoreFeedOut || tenths == G::kBoreDwellOut;
  cycle.stop_at_bottom = tenths == G::kBoreStopOut;
  cycle.reverse_at_bottom = taps;
  if (taps) cycle.dwell_out_s = fanuc.drilling.words.p;
  cycle.manual_out = tenths == G::kBoreManualOut;
  if (bores(tenths)) {
    cycle.bore = back ? DrillCycle::Bore::kBack : DrillCycle::Bore::kFine;
    cycle.aside = bore_shift(fanuc.drilling, fanuc);
  }
  return cycle;
}

}  // namespace

void cycle(Fanuc& fanuc, int tenths) {
  const char depth_letter = "XYZ"[axes_of(fanuc.control.modal.plane).normal];
  keep_cycle_words(fanuc, depth_letter);
  const Target hole = words(fanuc.modes, fanuc.mapping, fanuc);
  if (!hole.any() && !fanuc.block.has_g(kFanucCycle)) return;
  check_cycle_words(fanuc.modes, fanuc.drilling, fanuc, tenths, depth_letter);
  const DrillCycle cycle = drill_cycle(fanuc, tenths);
  int times = 1;
  for (const char repeat : fanuc.rules.repeats) {
    if (!fanuc.block.has(repeat)) continue;
    times = whole(fanuc.block, repeat, 0, 9999, fanuc.reader, fanuc.control);
    break;
  }
  fanuc.modes.moved = times > 0;
  // Each repeat reads its words again: an incremental polar angle goes on.
  for (int i = 0; i < times; ++i)
    nc::drill(fanuc.control, cycle, i == 0 ? hole : words(fanuc.modes, fanuc.mapping, fanuc));
}

void drill_holes(Fanuc& fanuc, std::span<const Vec2> holes) {
  const int tenths = fanuc.modes.cycle;
  const PlaneAxes axes = axes_of(fanuc.control.modal.plane);
  if (tenths == G::kCycleOff)
    fanuc.control.report.fail(
        "modal-conflict", fanuc.g_column(kFanucOneShot),
        fmt::format("{} drills {} times, and no cycle is on", fanuc.g_name(kFanucOneShot), holes.size()),
        "write the cycle before it: G81 G98 Z-10. R2. F200. L0");
  refuse_mapped(fanuc.mapping, fanuc, fanuc.g_column(kFanucOneShot), "a pattern of holes is drilled", true);
  check_cycle_words(fanuc.modes, fanuc.drilling, fanuc, tenths, "XYZ"[axes.normal]);
  const DrillCycle cycle = drill_cycle(fanuc, tenths);
  fanuc.modes.moved = !holes.empty();
  for (const Vec2& hole : holes) {
    Target at;
    at.column = fanuc.g_column(kFanucOneShot);
    at.set(axes.first, hole.x(), false);
    at.set(axes.second, hole.y(), false);
    nc::drill(fanuc.control, cycle, at);
  }
}

}  // namespace swarf::program::nc::fanuc
