// Canned cycles G73, G74, G81 to G89.
#include <fmt/format.h>

#include <algorithm>

#include "program/linuxcnc/reader.h"

namespace swarf::program::nc::linuxcnc {
namespace {

/// How far G73 and G83 draw back or stay above the last depth: 0.010 inch.
constexpr double kPeckClearanceMm = 0.254;

bool dwells(int tenths) {
  return tenths == 820 || tenths == 860 || tenths == 880 || tenths == 890;
}
bool pecks(int tenths) {
  return tenths == 730 || tenths == 830;
}
bool taps(int tenths) {
  return tenths == 740 || tenths == 840;
}

}  // namespace

/// "Canned cycle errors" of the reference, and the sense of the spindle that tapping and boring count on.
void LinuxCnc::check_cycle(int tenths) const {
  const int at = reader_.column_of(block_.first), number = tenths / 10;
  constexpr uint32_t kPlaces = 7u << ('X' - 'A');
  if ((block_.given & kPlaces) == 0)
    control_.report.fail("missing-word", at, fmt::format("G{} has no axis words", number),
                         "add the place of the hole, or G80 to end the cycle");
  for (const char letter : {'A', 'B', 'C'}) {
    if (block_.has(letter))
      control_.report.fail("bad-cycle", column(letter),
                           fmt::format("{} cannot turn during G{}", letter, number),
                           "turn it in a block of its own");
  }
  if (!control_.path.started)
    control_.report.fail("start-unknown", at,
                         fmt::format("G{} starts, and the position is not known yet", number),
                         "position all axes with G0 before the cycle");
  if (control_.modal.feed_mode == FeedMode::kInverseTime)
    control_.report.fail("bad-cycle", at, fmt::format("G{} cannot run under G93", number),
                         "write G94 and a feed before it");
  if (control_.contour.side() != Compensation::kOff)
    control_.report.fail("compensation-active", at,
                         fmt::format("G{} while cutter radius compensation is on", number),
                         "switch it off first: G40");
  if (pecks(tenths) && block_.has('P'))
    control_.report.fail(
        "unsupported-word", column('P'),
        fmt::format(
            "releases of LinuxCNC differ about P of G{}: newer ones take it as the clearance of a peck",
            number),
        "leave it out: the clearance is 0.254 mm");
  const bool boring = tenths == 860 || tenths == 870 || tenths == 880;
  if ((boring || taps(tenths)) && control_.modal.spindle == 0)
    control_.report.fail("spindle-stands", at, fmt::format("G{} wants a turning spindle", number),
                         "start it before the cycle: S1000 M3");
  if (taps(tenths) && control_.modal.spindle != (tenths == 840 ? 1 : -1))
    control_.report.fail("bad-cycle", at,
                         tenths == 840
                             ? "G84 taps right-hand threads, and the spindle turns counter-clockwise"
                             : "G74 taps left-hand threads, and the spindle turns clockwise",
                         tenths == 840 ? "write M3 before it" : "write M4 before it");
}

/// R stays for all cycles, the other words while the same one goes on.
void LinuxCnc::keep_cycle_words(bool same) {
  if (!same) cycle_ = StickyCycle{{}, cycle_.r, {}, {}, {}};
  const auto keep = [&](char letter, std::optional<double>& value) {
    if (block_.has(letter))
      value = letter == 'P' ? block_.get(letter) : control_.modal.mm(block_.get(letter));
  };
  keep("XYZ"[axes_of(control_.modal.plane).normal], cycle_.depth);
  keep('R', cycle_.r);
  keep('Q', cycle_.q);
  keep('P', cycle_.p);
  for (size_t i = 0; i < 3; ++i) keep("IJK"[i], cycle_.ijk[i]);
}

double LinuxCnc::cycle_word(const std::optional<double>& value, char letter) const {
  if (!value)
    control_.report.fail("missing-word", reader_.column_of(block_.first),
                         fmt::format("the cycle G{} needs the word {}", motion_ / 10, letter),
                         fmt::format("add {}", letter));
  return *value;
}

/// Above the hole at the height that LinuxCNC keeps: not below the present one or R, under G98 not below that
/// before the series. It rises on the way there, and before it where R lies above the height of the series.
void LinuxCnc::above_hole(const Target& hole, double r) {
  const int normal = axes_of(control_.modal.plane).normal;
  Target height;
  height.column = hole.column;
  height.set(normal, r, false);
  if (cycle_start_ < r) nc::line(control_, Motion::kRapid, height);
  Target above = hole;
  const double now = nc::position_xyz(control_)[normal];
  above.set(normal, std::max({now, r, retract_to_r_ ? r : cycle_start_}), false);
  nc::line(control_, Motion::kRapid, above);
}

/// Under G91 R counts from the height before the series and the depth from R, in each block of it (measured
/// on LinuxCNC 2.9).
void LinuxCnc::cycle(int tenths) {
  const PlaneAxes axes = axes_of(control_.modal.plane);
  const int at = reader_.column_of(block_.first);
  const double depth = cycle_word(cycle_.depth, "XYZ"[axes.normal]), r = cycle_word(cycle_.r, 'R');
  DrillCycle cycle;
  cycle.approach = incremental_ ? cycle_start_ + r : r;
  cycle.bottom = incremental_ ? cycle.approach + depth : depth;
  if (cycle.bottom > cycle.approach)
    control_.report.fail("bad-cycle", at,
                         fmt::format("the bottom {:.4f} mm lies above the approach height {:.4f} mm",
                                     cycle.bottom, cycle.approach),
                         "R must lie above the depth");
  cycle.retract = retract_to_r_ ? cycle.approach : std::max(cycle.approach, cycle_start_);
  if (pecks(tenths)) {
    cycle.peck = tenths == 730 ? DrillCycle::Peck::kChipBreak : DrillCycle::Peck::kFull;
    cycle.peck_mm = cycle_word(cycle_.q, 'Q');
    cycle.clearance_mm = kPeckClearanceMm;
    if (!(cycle.peck_mm > 0.0))
      control_.report.fail("out-of-range", at, fmt::format("Q {:g} is no depth per peck", cycle.peck_mm),
                           "write Q above zero");
  }
  if (dwells(tenths)) cycle.dwell_s = cycle_word(cycle_.p, 'P');
  if (taps(tenths)) cycle.dwell_s = cycle_.p.value_or(0.0);
  cycle.feed_out = taps(tenths) || tenths == 850 || tenths == 890;
  cycle.feed_to_retract = tenths != 850;  // G85 feeds to R and goes on in rapid
  cycle.stop_at_bottom = tenths == 860;
  cycle.manual_out = tenths == 880;
  cycle.reverse_at_bottom = taps(tenths);
  const int times = block_.has('L') ? whole(block_, 'L', 1, 100000, reader_, control_) : 1;
  const Target hole = target_of(block_, incremental_, reader_, control_);
  if (!retract_known_)
    control_.report.warn_once(
        "retract-mode", at,
        "neither G98 nor G99 stands before this cycle: the tool goes back to R (G99), with "
        "which LinuxCNC starts unless the startup code of its INI file says otherwise",
        "write G98 or G99 before it");
  if (tenths == 880)
    control_.report.warn_once(
        "cycle-of-rs274", at,
        "G88: RS274/NGC lets the operator retract by hand, LinuxCNC leaves it undefined; the tool is "
        "taken out straight",
        "write G86 or G89");
  Target here;
  here.column = hole.column;
  const Borrowed exact_stop(control_.modal.exact_stop);
  control_.modal.exact_stop = true;  // cycles run in exact path mode, whatever G64 says
  for (int i = 0; i < times; ++i) {
    if (tenths == 870) {
      back_bore(cycle.approach, cycle.bottom, cycle.retract, hole);
    } else {
      above_hole(hole, cycle.approach);
      nc::drill(control_, cycle, here);
    }
  }
}

/// G87 as the RS274/NGC report of NIST (NISTIR 6556, 3.5.16.7) has it: in X Y, I and J are the way from the
/// axis of the hole to the place where the tool passes it, K is the height of the counterbore, under G91
/// above the bottom. The tool shifts at R, and feeds back down to the bottom before it leaves.
void LinuxCnc::back_bore(double approach, double bottom, double retract, const Target& hole) {
  const PlaneAxes axes = axes_of(control_.modal.plane);
  const auto word = [&](int axis) { return cycle_word(cycle_.ijk[static_cast<size_t>(axis)], "IJK"[axis]); };
  DrillCycle bore;
  bore.bore = DrillCycle::Bore::kBack;
  bore.approach = bottom;
  bore.bottom = incremental_ ? bottom + word(axes.normal) : word(axes.normal);
  bore.retract = retract;
  bore.aside[axes.first] = word(axes.first);
  bore.aside[axes.second] = word(axes.second);
  bore.feed_out = true;
  if (!(bottom < bore.bottom && bore.bottom <= approach))
    control_.report.fail(
        "bad-cycle", hole.column,
        fmt::format("back boring goes down to {:.4f} mm and bores up to {:.4f} mm, from an approach "
                    "height of {:.4f} mm",
                    bottom, bore.bottom, approach),
        "the height that it bores up to lies between the other two");
  control_.report.warn_once("cycle-of-rs274", reader_.column_of(block_.first),
                            "G87 bores from below as RS274/NGC has it; LinuxCNC itself leaves it undefined",
                            "write the moves out");
  Target above = hole, height;
  above.given = static_cast<uint8_t>(hole.given & ~(1u << axes.normal));
  height.set(axes.normal, approach, false);
  if (nc::position_xyz(control_)[axes.normal] < approach) nc::line(control_, Motion::kRapid, height);
  if (above.any()) nc::line(control_, Motion::kRapid, above);
  nc::line(control_, Motion::kRapid, height);
  Target here;
  here.column = hole.column;
  nc::drill(control_, bore, here);
}

}  // namespace swarf::program::nc::linuxcnc
