// Group 1: straight moves, arcs, and where the other motions begin.
#include <algorithm>
#include <cmath>

#include "program/linuxcnc/steps.h"

namespace swarf::program::nc::linuxcnc {
namespace {

constexpr double kSqrt2 = 1.4142135623730951;

void spline(Modes& modes, Curves& curves, LetterDialect& letters, int tenths) {
  if (tenths == G::kCubicSpline) return cubic_spline(modes, curves, letters);
  if (tenths == G::kQuadraticSpline) return quadratic_spline(modes, letters);
  if (tenths == G::kNurbsPoint) return nurbs_point(modes, curves, letters);
  close_nurbs(curves, letters);
  modes.motion = -1;
}

void arc(Modes& modes, LetterDialect& letters, int tenths) {
  const PlaneAxes axes = axes_of(letters.control.modal.plane);
  const Target target = target_of(letters.block, modes.incremental, letters.reader, letters.control);
  std::optional<ArcWords> words =
      arc_words(letters.block, target, modes.arc_absolute, letters.reader, letters.control);
  if (!words)
    letters.control.report.fail("bad-arc", letters.g_column(kMotionGroup),
                                "the arc has neither an end nor a centre", "add X Y Z and I J K, or R");
  if (letters.block.has('P'))
    words->further_turns = whole(letters.block, 'P', 1, 100000, letters.reader, letters.control) - 1;
  if (words->centre) {
    const Vec3 out = *words->centre - nc::position_xyz(letters.control);
    // LinuxCNC's rule unless its INI file has another one: a thousandth of the radius, within these bounds.
    const double least = letters.control.modal.inches() ? 0.0508 * kSqrt2 : 0.02 * kSqrt2;
    words->radius_tolerance_mm =
        std::clamp(1e-3 * std::hypot(out[axes.first], out[axes.second]), least, 100.0 * least);
  }
  nc::arc(letters.control, tenths == G::kArcClockwise ? Motion::kClockwise : Motion::kCounterClockwise,
          target, *words);
}

}  // namespace

void motion(LinuxCnc& linuxcnc) {
  const bool written = linuxcnc.block.has_g(kMotionGroup);
  const int tenths = written ? linuxcnc.block.g[kMotionGroup] : linuxcnc.modes.motion;
  const bool in_series = linuxcnc.modes.motion >= G::kDrillChipBreak && linuxcnc.modes.motion != G::kCycleOff,
             same = linuxcnc.modes.motion == tenths;
  linuxcnc.modes.motion = tenths;
  if (tenths != G::kCubicSpline) linuxcnc.curves.spline_tangent.reset();
  if (tenths == G::kCycleOff || tenths < G::kDrillChipBreak) linuxcnc.drilling.words = StickyCycle();
  if (tenths == G::kCycleOff) return;
  if (tenths >= G::kDrillChipBreak) {
    check_cycle(linuxcnc, tenths);
    keep_cycle_words(linuxcnc.drilling, linuxcnc, same);
    // The height that G98 returns to is that before the first of several cycles, whichever they are.
    if (!in_series)
      linuxcnc.drilling.cycle_start =
          nc::position_xyz(linuxcnc.control)[axes_of(linuxcnc.control.modal.plane).normal];
    return cycle(linuxcnc.modes, linuxcnc.drilling, linuxcnc, tenths);
  }
  if (uses_axis_words(linuxcnc)) return;
  if (tenths == G::kArcClockwise || tenths == G::kArcCounterClockwise)
    return arc(linuxcnc.modes, linuxcnc, tenths);
  if (tenths >= G::kCubicSpline) return spline(linuxcnc.modes, linuxcnc.curves, linuxcnc, tenths);
  const Motion kind = tenths == 0 ? Motion::kRapid : Motion::kFeed;
  const bool machine = linuxcnc.block.has_g(kMachineGroup);
  const Target target =
      target_of(linuxcnc.block, linuxcnc.modes.incremental, linuxcnc.reader, linuxcnc.control);
  if (!target.any()) return;
  if (machine)
    nc::machine_line(linuxcnc.control, kind, target);
  else
    nc::line(linuxcnc.control, kind, target);
}

}  // namespace swarf::program::nc::linuxcnc
