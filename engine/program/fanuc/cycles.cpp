// Canned cycles of group 9: what their words mean; the control expands them into moves (drill_cycle.h).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "program/fanuc/reader.h"

namespace swarf::program::nc::fanuc {
namespace {

/// How far G73 draws back and G83 stays above the last depth (parameters 5114, 5115; 0.5 mm as delivered
/// here).
constexpr double kPeckClearanceMm = 0.5;

bool pecks(int tenths) {
  return tenths == 730 || tenths == 830;
}
/// G76 and G87 shift by Q (or I J) with the spindle oriented.
bool bores(int tenths) {
  return tenths == 760 || tenths == 870;
}

}  // namespace

void Fanuc::keep_cycle_words(char depth_letter) {
  const auto keep = [&](char letter, double& value, bool& has) {
    if (!block_.has(letter)) return;
    value = control_.modal.mm(block_.get(letter));
    has = true;
  };
  keep(depth_letter, sticky_.z, sticky_.has_z);
  keep('R', sticky_.r, sticky_.has_r);
  keep('Q', sticky_.q, sticky_.has_q);
  if (block_.has(depth_letter)) sticky_.z_incremental = incremental_;
  if (block_.has('R')) sticky_.r_incremental = incremental_;
  keep('I', sticky_.i, sticky_.has_i);
  keep('J', sticky_.j, sticky_.has_j);
  if (block_.has('P')) sticky_.p = 1e-3 * block_.get('P');
}

void Fanuc::check_cycle_words(int tenths, char depth_letter) {
  const int at = reader_.column_of(block_.first);
  const bool shift = sticky_.has_q || sticky_.has_i || sticky_.has_j;
  const char missing = !sticky_.has_z                                                   ? depth_letter
                       : !sticky_.has_r                                                 ? 'R'
                       : (pecks(tenths) && !sticky_.has_q) || (bores(tenths) && !shift) ? 'Q'
                                                                                        : '\0';
  if (missing != '\0')
    control_.report.fail("missing-word", at,
                         fmt::format("the cycle G{} needs the word {}", tenths / 10, missing), "add it");
  if (pecks(tenths) && !(sticky_.q > 0.0))
    control_.report.fail("out-of-range", at, fmt::format("Q {:g} is no depth per peck", sticky_.q),
                         "write Q above zero");
  if (bores(tenths) && sticky_.has_q && (sticky_.has_i || sticky_.has_j))
    control_.report.fail("modal-conflict", at, "the shift of this cycle is given by Q and by I J",
                         "write Q, or I and J; G80 before the cycle forgets earlier ones");
  if ((block_.has('I') || block_.has('J')) && control_.modal.plane != Plane::kXY)
    control_.report.fail("unsupported-word", column(block_.has('I') ? 'I' : 'J'),
                         "the shift by I J K is read in G17 only: K counts repeats", "write the shift as Q");
  if (tenths == 870 && retract_to_r_)
    control_.report.fail("modal-conflict", at, "G87 goes back to the initial level only",
                         "write G98 before it");
}

/// Q carries no direction: the machine's parameter 5148 (5101 on older controls) does. As delivered it is the
/// plane's first axis, positive.
Vec3 Fanuc::bore_shift() {
  if (sticky_.has_i || sticky_.has_j) return {sticky_.i, sticky_.j, 0.0};
  const int first = axes_of(control_.modal.plane).first;
  control_.report.warn_once(
      "shift-direction", reader_.column_of(block_.first),
      fmt::format("G76 and G87 shift by Q along +{} here: the direction stands in parameter "
                  "5148 of the machine, which the program does not say",
                  kAxisLetters[first]),
      "write the shift as I and J where the machine shifts another way");
  return std::abs(sticky_.q) * Vec3::Unit(first);
}

DrillCycle Fanuc::drill_cycle(int tenths) {
  DrillCycle cycle;
  // Scaling moves R and Z; depths per peck and shifts stay as written.
  const AxisMap& map = map_[static_cast<size_t>(axes_of(control_.modal.plane).normal)];
  if (map.mirrors())
    control_.report.fail("modal-conflict", reader_.column_of(block_.first),
                         "a cycle drills along a mirrored axis",
                         "end the mirror image of the drilling axis before it");
  const double r = map.at(sticky_.r, sticky_.r_incremental), z = map.at(sticky_.z, sticky_.z_incremental);
  cycle.approach = sticky_.r_incremental ? cycle_start_ + r : r;
  cycle.bottom = sticky_.z_incremental ? cycle.approach + z : z;
  const bool back = tenths == 870;
  if (back ? cycle.bottom < cycle.approach : cycle.bottom > cycle.approach)
    control_.report.fail(
        "bad-cycle", reader_.column_of(block_.first),
        fmt::format("the bottom {:.4f} mm lies {} the approach height {:.4f} mm", cycle.bottom,
                    back ? "below" : "above", cycle.approach),
        back ? "G87 cuts upwards: R lies below the face, Z on it" : "R must lie above the depth");
  cycle.retract = back            ? cycle_start_
                  : retract_to_r_ ? cycle.approach
                                  : std::max(cycle.approach, cycle_start_);
  cycle.peck = tenths == 730   ? DrillCycle::Peck::kChipBreak
               : tenths == 830 ? DrillCycle::Peck::kFull
                               : DrillCycle::Peck::kNone;
  cycle.peck_mm = sticky_.q;
  cycle.clearance_mm = kPeckClearanceMm;
  const bool taps = tenths == 840 || tenths == 740;
  cycle.dwell_s = taps || bores(tenths) || tenths == 820 || tenths == 880 || tenths == 890 ? sticky_.p : 0.0;
  cycle.dwell_out_s = taps ? sticky_.p : 0.0;
  cycle.feed_out = taps || tenths == 850 || tenths == 890;
  cycle.stop_at_bottom = tenths == 860;
  cycle.reverse_at_bottom = taps;
  if (taps) cycle.dwell_out_s = sticky_.p;
  cycle.manual_out = tenths == 880;
  if (bores(tenths)) {
    cycle.bore = back ? DrillCycle::Bore::kBack : DrillCycle::Bore::kFine;
    cycle.aside = bore_shift();
  }
  return cycle;
}

void Fanuc::cycle(int tenths) {
  const char depth_letter = "XYZ"[axes_of(control_.modal.plane).normal];
  keep_cycle_words(depth_letter);
  const Target hole = words();
  if (!hole.any() && !block_.has_g(kFanucCycle)) return;
  check_cycle_words(tenths, depth_letter);
  const DrillCycle cycle = drill_cycle(tenths);
  const char repeat = block_.has('K') ? 'K' : 'L';
  const int times = block_.has(repeat) ? whole(block_, repeat, 0, 9999, reader_, control_) : 1;
  moved_ = times > 0;
  // Each repeat reads its words again: an incremental polar angle goes on.
  for (int i = 0; i < times; ++i) nc::drill(control_, cycle, i == 0 ? hole : words());
}

}  // namespace swarf::program::nc::fanuc
