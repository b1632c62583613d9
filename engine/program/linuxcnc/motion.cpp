// Group 1: straight moves, arcs, and where the other motions begin.
#include <algorithm>
#include <cmath>

#include "program/linuxcnc/reader.h"

namespace swarf::program::nc::linuxcnc {
namespace {

constexpr double kSqrt2 = 1.4142135623730951;

}  // namespace

void LinuxCnc::motion() {
  const bool written = block_.has_g(kMotionGroup);
  const int tenths = written ? block_.g[kMotionGroup] : motion_;
  const bool in_series = motion_ >= 730 && motion_ != 800, same = motion_ == tenths;
  motion_ = tenths;
  if (tenths != 50) spline_tangent_.reset();
  if (tenths == 800 || tenths < 730) cycle_ = StickyCycle();
  if (tenths == 800) return;
  if (tenths >= 730) {
    check_cycle(tenths);
    keep_cycle_words(same);
    // The height that G98 returns to is that before the first of several cycles, whichever they are.
    if (!in_series) cycle_start_ = nc::position_xyz(control_)[axes_of(control_.modal.plane).normal];
    return cycle(tenths);
  }
  if (uses_axis_words()) return;
  if (tenths == 20 || tenths == 30) return arc(tenths);
  if (tenths >= 50) return spline(tenths);
  const Motion kind = tenths == 0 ? Motion::kRapid : Motion::kFeed;
  const bool machine = block_.has_g(kMachineGroup);
  const Target target = target_of(block_, incremental_, reader_, control_);
  if (!target.any()) return;
  if (machine)
    nc::machine_line(control_, kind, target);
  else
    nc::line(control_, kind, target);
}

void LinuxCnc::spline(int tenths) {
  if (tenths == 50) return cubic_spline();
  if (tenths == 51) return quadratic_spline();
  if (tenths == 52) return nurbs_point();
  close_nurbs();
  motion_ = -1;
}

void LinuxCnc::arc(int tenths) {
  const PlaneAxes axes = axes_of(control_.modal.plane);
  const Target target = target_of(block_, incremental_, reader_, control_);
  std::optional<ArcWords> words = arc_words(block_, target, arc_absolute_, reader_, control_);
  if (!words)
    control_.report.fail("bad-arc", g_column(kMotionGroup), "the arc has neither an end nor a centre",
                         "add X Y Z and I J K, or R");
  if (block_.has('P')) words->further_turns = whole(block_, 'P', 1, 100000, reader_, control_) - 1;
  if (words->centre) {
    const Vec3 out = *words->centre - nc::position_xyz(control_);
    // LinuxCNC's rule unless its INI file has another one: a thousandth of the radius, within these bounds.
    const double least = control_.modal.inches() ? 0.0508 * kSqrt2 : 0.02 * kSqrt2;
    words->radius_tolerance_mm =
        std::clamp(1e-3 * std::hypot(out[axes.first], out[axes.second]), least, 100.0 * least);
  }
  nc::arc(control_, tenths == 20 ? Motion::kClockwise : Motion::kCounterClockwise, target, *words);
}

}  // namespace swarf::program::nc::linuxcnc
