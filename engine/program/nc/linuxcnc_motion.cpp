// Group 1: straight moves, arcs, canned cycles.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "program/nc/linuxcnc.h"

namespace swarf::program::nc {
namespace {

/// How far G73 and G83 draw back or stay above the last depth: 0.010 inch.
constexpr double kPeckClearanceMm = 0.254;

}  // namespace

void LinuxCnc::motion() {
  const bool written = block_.has_g(kMotionGroup);
  const int tenths = written ? block_.g[kMotionGroup] : motion_;
  const bool series = tenths == motion_ && tenths >= 730;
  motion_ = tenths;
  if (tenths == 800 || tenths < 730) cycle_ = StickyCycle();
  if (tenths == 800) return;
  if (tenths >= 730) {
    if (!series) cycle_start_ = control_.position_xyz()[axes_of(control_.plane()).normal];
    return cycle(tenths);
  }
  if (uses_axis_words()) return;
  if (tenths == 20 || tenths == 30) return arc(tenths);
  const Motion kind = tenths == 0 ? Motion::kRapid : Motion::kFeed;
  const bool machine = block_.has_g(kMachineGroup);
  const Target target = target_of(block_, incremental_ && !machine, reader_, control_);
  if (!target.any()) return;
  if (machine)
    control_.machine_line(kind, target);
  else
    control_.line(kind, target);
}

void LinuxCnc::arc(int tenths) {
  const PlaneAxes axes = axes_of(control_.plane());
  const Target target = target_of(block_, incremental_, reader_, control_);
  std::optional<ArcWords> words = arc_words(block_, target, arc_absolute_, reader_, control_);
  if (!words) return;
  if (block_.has('P')) words->further_turns = whole(block_, 'P', 1, 100000, reader_, control_) - 1;
  if (words->centre) {
    const Vec3 out = *words->centre - control_.position_xyz();
    // LinuxCNC's rule: 5 um, or a thousandth of the radius up to half a millimetre.
    words->radius_tolerance_mm =
        std::max(5e-3, std::min(0.5, 1e-3 * std::hypot(out[axes.first], out[axes.second])));
  }
  control_.arc(tenths == 20 ? Motion::kClockwise : Motion::kCounterClockwise, target, *words);
}

void LinuxCnc::cycle(int tenths) {
  const PlaneAxes axes = axes_of(control_.plane());
  const char depth_letter = "XYZ"[axes.normal];
  const int at = reader_.column_of(block_.first);
  const auto keep = [&](char letter, double& value, bool& has) {
    if (!block_.has(letter)) return;
    value = letter == 'P' ? block_.get(letter) : control_.mm(block_.get(letter));
    has = true;
  };
  keep(depth_letter, cycle_.z, cycle_.has_z);
  keep('R', cycle_.r, cycle_.has_r);
  keep('Q', cycle_.q, cycle_.has_q);
  keep('P', cycle_.p, cycle_.has_p);
  const auto want = [&](bool has, char letter) {
    if (!has)
      control_.fail("missing-word", at, fmt::format("the cycle G{} needs the word {}", tenths / 10, letter),
                    fmt::format("add {}", letter));
  };
  want(cycle_.has_z, depth_letter);
  want(cycle_.has_r, 'R');
  const bool pecks = tenths == 730 || tenths == 830;
  if (pecks) want(cycle_.has_q, 'Q');
  if (pecks && !(cycle_.q > 0.0))
    control_.fail("out-of-range", at, fmt::format("Q {:g} is no depth per peck", cycle_.q),
                  "write Q above zero");
  if (tenths == 820 || tenths == 860 || tenths == 890) want(cycle_.has_p, 'P');
  DrillCycle cycle;
  cycle.approach = incremental_ ? cycle_start_ + cycle_.r : cycle_.r;
  cycle.bottom = incremental_ ? cycle.approach + cycle_.z : cycle_.z;
  if (cycle.bottom > cycle.approach)
    control_.fail("bad-cycle", at,
                  fmt::format("the bottom {:.4f} mm lies above the approach height {:.4f} mm", cycle.bottom,
                              cycle.approach),
                  "R must lie above the depth");
  cycle.retract = retract_to_r_ ? cycle.approach : std::max(cycle.approach, cycle_start_);
  cycle.peck = tenths == 730   ? DrillCycle::Peck::kChipBreak
               : tenths == 830 ? DrillCycle::Peck::kFull
                               : DrillCycle::Peck::kNone;
  cycle.peck_mm = cycle_.q;
  cycle.clearance_mm = kPeckClearanceMm;
  cycle.dwell_s = tenths == 820 || tenths == 860 || tenths == 890 ? cycle_.p : 0.0;
  cycle.feed_out = tenths == 840 || tenths == 740 || tenths == 850 || tenths == 890;
  cycle.stop_at_bottom = tenths == 860;
  cycle.reverse_at_bottom = tenths == 840 || tenths == 740;
  const int times = block_.has('L') ? whole(block_, 'L', 1, 100000, reader_, control_) : 1;
  const Target hole = target_of(block_, incremental_, reader_, control_);
  for (int i = 0; i < times; ++i) control_.drill(cycle, hole);
}

}  // namespace swarf::program::nc
