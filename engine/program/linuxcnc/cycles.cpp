// Canned cycles G73, G74, G81 to G89.
#include <fmt/format.h>

#include <algorithm>

#include "program/linuxcnc/steps.h"

namespace swarf::program::nc::linuxcnc {
namespace {

/// How far G73 and G83 draw back or stay above the last depth: 0.010 inch.
constexpr double kPeckClearanceMm = 0.254;

bool dwells(int tenths) {
  return tenths == G::kDrillDwell || tenths == G::kBoreStopOut || tenths == G::kBoreManualOut ||
         tenths == G::kBoreDwellOut;
}
bool pecks(int tenths) {
  return tenths == G::kDrillChipBreak || tenths == G::kDrillDeep;
}
bool taps(int tenths) {
  return tenths == G::kTapLeft || tenths == G::kTap;
}

double cycle_word(const Modes& modes, const LetterDialect& letters, const std::optional<double>& value,
                  char letter) {
  if (!value)
    letters.control.report.fail("missing-word", letters.reader.column_of(letters.block.first),
                                fmt::format("the cycle G{} needs the word {}", modes.motion / 10, letter),
                                fmt::format("add {}", letter));
  return *value;
}

/// Above the hole at the height that LinuxCNC keeps: not below the present one or R, under G98 not below that
/// before the series. It rises on the way there, and before it where R lies above the height of the series.
void above_hole(Modes& modes, Drilling& drilling, LetterDialect& letters, const Target& hole, double r) {
  const int normal = axes_of(letters.control.modal.plane).normal;
  Target height;
  height.column = hole.column;
  height.set(normal, r, false);
  if (drilling.cycle_start < r) nc::line(letters.control, Motion::kRapid, height);
  Target above = hole;
  const double now = nc::position_xyz(letters.control)[normal];
  above.set(normal, std::max({now, r, modes.retract_to_r ? r : drilling.cycle_start}), false);
  nc::line(letters.control, Motion::kRapid, above);
}

/// G87 as the RS274/NGC report of NIST (NISTIR 6556, 3.5.16.7) has it: in X Y, I and J are the way from the
/// axis of the hole to the place where the tool passes it, K is the height of the counterbore, under G91
/// above the bottom. The tool shifts at R, and feeds back down to the bottom before it leaves.
void back_bore(Modes& modes, Drilling& drilling, LetterDialect& letters, double approach, double bottom,
               double retract, const Target& hole) {
  const PlaneAxes axes = axes_of(letters.control.modal.plane);
  const auto word = [&](int axis) {
    return cycle_word(modes, letters, drilling.words.ijk[static_cast<size_t>(axis)], "IJK"[axis]);
  };
  DrillCycle bore;
  bore.bore = DrillCycle::Bore::kBack;
  bore.approach = bottom;
  bore.bottom = modes.incremental ? bottom + word(axes.normal) : word(axes.normal);
  bore.retract = retract;
  bore.aside[axes.first] = word(axes.first);
  bore.aside[axes.second] = word(axes.second);
  bore.feed_out = true;
  if (!(bottom < bore.bottom && bore.bottom <= approach))
    letters.control.report.fail(
        "bad-cycle", hole.column,
        fmt::format("back boring goes down to {:.4f} mm and bores up to {:.4f} mm, from an approach "
                    "height of {:.4f} mm",
                    bottom, bore.bottom, approach),
        "the height that it bores up to lies between the other two");
  letters.control.report.warn_once(
      "cycle-of-rs274", letters.reader.column_of(letters.block.first),
      "G87 bores from below as RS274/NGC has it; LinuxCNC itself leaves it undefined", "write the moves out");
  Target above = hole, height;
  above.given = static_cast<uint8_t>(hole.given & ~(1u << axes.normal));
  height.set(axes.normal, approach, false);
  if (nc::position_xyz(letters.control)[axes.normal] < approach)
    nc::line(letters.control, Motion::kRapid, height);
  if (above.any()) nc::line(letters.control, Motion::kRapid, above);
  nc::line(letters.control, Motion::kRapid, height);
  Target here;
  here.column = hole.column;
  nc::drill(letters.control, bore, here);
}

}  // namespace

/// "Canned cycle errors" of the reference, and the sense of the spindle that tapping and boring count on.
void check_cycle(const LetterDialect& letters, int tenths) {
  const int at = letters.reader.column_of(letters.block.first), number = tenths / 10;
  constexpr uint32_t kPlaces = 7u << ('X' - 'A');
  if ((letters.block.given & kPlaces) == 0)
    letters.control.report.fail("missing-word", at, fmt::format("G{} has no axis words", number),
                                "add the place of the hole, or G80 to end the cycle");
  for (const char letter : {'A', 'B', 'C'}) {
    if (letters.block.has(letter))
      letters.control.report.fail("bad-cycle", letters.column(letter),
                                  fmt::format("{} cannot turn during G{}", letter, number),
                                  "turn it in a block of its own");
  }
  if (!letters.control.path.started)
    letters.control.report.fail("start-unknown", at,
                                fmt::format("G{} starts, and the position is not known yet", number),
                                "position all axes with G0 before the cycle");
  if (letters.control.modal.feed_mode == FeedMode::kInverseTime)
    letters.control.report.fail("bad-cycle", at, fmt::format("G{} cannot run under G93", number),
                                "write G94 and a feed before it");
  if (letters.control.contour.side() != Compensation::kOff)
    letters.control.report.fail("compensation-active", at,
                                fmt::format("G{} while cutter radius compensation is on", number),
                                "switch it off first: G40");
  if (pecks(tenths) && letters.block.has('P'))
    letters.control.report.fail(
        "unsupported-word", letters.column('P'),
        fmt::format(
            "releases of LinuxCNC differ about P of G{}: newer ones take it as the clearance of a peck",
            number),
        "leave it out: the clearance is 0.254 mm");
  const bool boring = tenths == G::kBoreStopOut || tenths == G::kBackBore || tenths == G::kBoreManualOut;
  if ((boring || taps(tenths)) && letters.control.modal.spindle == 0)
    letters.control.report.fail("spindle-stands", at, fmt::format("G{} wants a turning spindle", number),
                                "start it before the cycle: S1000 M3");
  if (taps(tenths) && letters.control.modal.spindle != (tenths == G::kTap ? 1 : -1))
    letters.control.report.fail("bad-cycle", at,
                                tenths == G::kTap
                                    ? "G84 taps right-hand threads, and the spindle turns counter-clockwise"
                                    : "G74 taps left-hand threads, and the spindle turns clockwise",
                                tenths == G::kTap ? "write M3 before it" : "write M4 before it");
}

/// R stays for all cycles, the other words while the same one goes on.
void keep_cycle_words(Drilling& drilling, LetterDialect& letters, bool same) {
  if (!same) drilling.words = StickyCycle{{}, drilling.words.r, {}, {}, {}};
  const auto keep = [&](char letter, std::optional<double>& value) {
    if (letters.block.has(letter))
      value = letter == 'P' ? letters.block.get(letter) : letters.control.modal.mm(letters.block.get(letter));
  };
  keep("XYZ"[axes_of(letters.control.modal.plane).normal], drilling.words.depth);
  keep('R', drilling.words.r);
  keep('Q', drilling.words.q);
  keep('P', drilling.words.p);
  for (size_t i = 0; i < 3; ++i) keep("IJK"[i], drilling.words.ijk[i]);
}

/// Under G91 R counts from the height before the series and the depth from R, in each block of it (measured
/// on LinuxCNC 2.9).
void cycle(Modes& modes, Drilling& drilling, LetterDialect& letters, int tenths) {
  const PlaneAxes axes = axes_of(letters.control.modal.plane);
  const int at = letters.reader.column_of(letters.block.first);
  const double depth = cycle_word(modes, letters, drilling.words.depth, "XYZ"[axes.normal]),
               r = cycle_word(modes, letters, drilling.words.r, 'R');
  DrillCycle cycle;
  cycle.approach = modes.incremental ? drilling.cycle_start + r : r;
  cycle.bottom = modes.incremental ? cycle.approach + depth : depth;
  if (cycle.bottom > cycle.approach)
    letters.control.report.fail("bad-cycle", at,
                                fmt::format("the bottom {:.4f} mm lies above the approach height {:.4f} mm",
                                            cycle.bottom, cycle.approach),
                                "R must lie above the depth");
  cycle.retract = modes.retract_to_r ? cycle.approach : std::max(cycle.approach, drilling.cycle_start);
  if (pecks(tenths)) {
    cycle.peck = tenths == G::kDrillChipBreak ? DrillCycle::Peck::kChipBreak : DrillCycle::Peck::kFull;
    cycle.peck_mm = cycle_word(modes, letters, drilling.words.q, 'Q');
    cycle.clearance_mm = kPeckClearanceMm;
    if (!(cycle.peck_mm > 0.0))
      letters.control.report.fail("out-of-range", at,
                                  fmt::format("Q {:g} is no depth per peck", cycle.peck_mm),
                                  "write Q above zero");
  }
  if (dwells(tenths)) cycle.dwell_s = cycle_word(modes, letters, drilling.words.p, 'P');
  if (taps(tenths)) cycle.dwell_s = drilling.words.p.value_or(0.0);
  cycle.feed_out = taps(tenths) || tenths == G::kBoreFeedOut || tenths == G::kBoreDwellOut;
  cycle.feed_to_retract = tenths != G::kBoreFeedOut;  // G85 feeds to R and goes on in rapid
  cycle.stop_at_bottom = tenths == G::kBoreStopOut;
  cycle.manual_out = tenths == G::kBoreManualOut;
  cycle.reverse_at_bottom = taps(tenths);
  const int times =
      letters.block.has('L') ? whole(letters.block, 'L', 1, 100000, letters.reader, letters.control) : 1;
  const Target hole = target_of(letters.block, modes.incremental, letters.reader, letters.control);
  if (!modes.retract_known)
    letters.control.report.warn_once(
        "retract-mode", at,
        "neither G98 nor G99 stands before this cycle: the tool goes back to R (G99), with "
        "which LinuxCNC starts unless the startup code of its INI file says otherwise",
        "write G98 or G99 before it");
  if (tenths == G::kBoreManualOut)
    letters.control.report.warn_once(
        "cycle-of-rs274", at,
        "G88: RS274/NGC lets the operator retract by hand, LinuxCNC leaves it undefined; the tool is "
        "taken out straight",
        "write G86 or G89");
  Target here;
  here.column = hole.column;
  const Borrowed exact_stop(letters.control.modal.exact_stop);
  letters.control.modal.exact_stop = true;  // cycles run in exact path mode, whatever G64 says
  for (int i = 0; i < times; ++i) {
    if (tenths == G::kBackBore) {
      back_bore(modes, drilling, letters, cycle.approach, cycle.bottom, cycle.retract, hole);
    } else {
      above_hole(modes, drilling, letters, hole, cycle.approach);
      nc::drill(letters.control, cycle, here);
    }
  }
}

}  // namespace swarf::program::nc::linuxcnc
