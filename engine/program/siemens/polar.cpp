// Polar coordinates of Siemens 840D.
//
//   pole: G110 from the last programmed point, G111 from the zero of the coordinates, G112 from the last
//   pole;
//         given with X Y (G17) or AP RP, the same under G90 and G91; zero before one is set
//   end = pole + RP (cos AP, sin AP) in the plane; the third axis is given beside them
//   AP holds until another pole or plane, RP until another RP
#include <fmt/format.h>

#include "program/siemens/functions.h"
#include "program/siemens/steps.h"

namespace swarf::program::nc::siemens {

using nc::Target;

namespace {

/// RP at the angle AP in the active plane, mm.
Vec3 polar_way(nc::Control& control, const BlockPlace& place, double angle_deg, double radius_mm) {
  const nc::PlaneAxes plane = nc::axes_of(control.modal.plane);
  const std::vector<Value> angle = {Value::real(angle_deg)};
  Vec3 way = Vec3::Zero();
  way[plane.first] = radius_mm * call_function("COS", angle, *place.line, 0).number;
  way[plane.second] = radius_mm * call_function("SIN", angle, *place.line, 0).number;
  return way;
}

/// RP= of the block, mm.
double polar_radius(nc::Control& control, const BlockPlace& place, const Coordinate& word) {
  if (word.way == Way::kIncremental || !(word.value >= 0.0)) {
    fail(place, "out-of-range", word.offset, "RP is a distance from the pole, zero or more", "RP=20");
  }
  return control.modal.mm(word.value);
}

}  // namespace

/// G110, G111, G112.
void set_pole(Executor& executor, const BlockWords& words, int code) {
  const nc::PlaneAxes plane = nc::axes_of(executor.control.modal.plane);
  Vec3 pole = code == kG112 ? executor.path.pole : Vec3(Vec3::Zero());
  if (code == kG110) {
    if (!executor.control.path.started) {
      fail(executor.place, "start-unknown", words.motion_offset,
           "G110 counts from the last position, which is not known yet",
           "write G111 with the pole from the zero of the workpiece");
    }
    pole = nc::position_xyz(executor.control).cwiseQuotient(executor.frames.stretch.factor);
  }
  const bool polar = words.polar_angle || words.polar_radius;
  if (polar) {
    const Coordinate& angle = words.polar_angle;
    if (!angle || !words.polar_radius || words.any_axis() || angle.way == Way::kIncremental) {
      fail(executor.place, "words-conflict", words.motion_offset,
           "a pole is given with the axes of the plane, or with both AP= and RP=", "G111 X10 Y20");
    }
    pole += polar_way(executor.control, executor.place, angle.value,
                      polar_radius(executor.control, executor.place, words.polar_radius));
  }
  bool given = polar;
  for (int n = 0; n < nc::kAxisWords; ++n) {
    const Coordinate& word = words.axes[static_cast<size_t>(n)];
    if (!word) continue;
    if ((n != plane.first && n != plane.second) || word.way != Way::kModal) {
      fail(executor.place, "words-conflict", word.offset,
           "a pole lies in the active plane, and its words take no AC and IC",
           "G17 has X Y, G18 has Z X, G19 has Y Z");
    }
    pole[n] += executor.control.modal.mm(word.value);
    given = true;
  }
  if (!given)
    fail(executor.place, "missing-word", words.motion_offset, "this block gives no pole", "G111 X10 Y20");
  executor.path.pole = pole;
  executor.path.polar_angle.reset();
}

/// AP= and RP= of a motion become the end in the plane.
void polar_end(Executor& executor, const BlockWords& words, Target& target) {
  const Coordinate &angle = words.polar_angle, &radius = words.polar_radius;
  const size_t offset = angle ? angle.offset : radius.offset;
  const nc::PlaneAxes plane = nc::axes_of(executor.control.modal.plane);
  if (target.has(plane.first) || target.has(plane.second)) {
    fail(executor.place, "words-conflict", offset,
         "the end is given with AP= and RP= and with axes of the plane", "write AP= RP=, or the axes");
  }
  if (angle) {
    const bool adds = angle.way == Way::kIncremental;
    if (angle.way == Way::kModal && executor.modes.incremental) {
      fail(executor.place, "words-conflict", angle.offset, "AP= under G91 may be an angle or a turn",
           "AP=AC(30) or AP=IC(30)");
    }
    if (adds && !executor.path.polar_angle) {
      fail(executor.place, "missing-word", angle.offset,
           "AP=IC() adds to the last angle, and this pole and plane have none yet", "AP=30");
    }
    executor.path.polar_angle = angle.value + (adds ? *executor.path.polar_angle : 0.0);
  }
  if (radius) executor.path.polar_radius = polar_radius(executor.control, executor.place, radius);
  if (!executor.path.polar_angle || !executor.path.polar_radius) {
    fail(executor.place, "missing-word", offset,
         fmt::format("{} has no value yet for this pole and plane", executor.path.polar_angle ? "RP" : "AP"),
         "write AP= and RP=");
  }
  const Vec3 end = executor.path.pole + polar_way(executor.control, executor.place,
                                                  *executor.path.polar_angle, *executor.path.polar_radius);
  for (const int n : {plane.first, plane.second})
    target.set(n, end[n] * executor.frames.stretch.factor[n], false);
  if (target.column == 0) target.column = column(executor.place, offset);
}

}  // namespace swarf::program::nc::siemens
