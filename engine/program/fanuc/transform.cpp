// What is done to the words of moves before the frame: polar coordinates (G16), mirror images (G51.1),
// scaling (G51), in the manual's order. Each axis by itself: p' = factor p + shift.
#include <fmt/format.h>

#include <cmath>

#include "program/fanuc/steps.h"

namespace swarf::program::nc::fanuc {
namespace {

/// The plane's first word is the radius from the program's zero, the second the angle from the first axis.
void polar_words(Modes& modes, Mapping& mapping, LetterDialect& letters, Target& target) {
  const PlaneAxes axes = axes_of(letters.control.modal.plane);
  const char radius = "XYZ"[axes.first], angle = "XYZ"[axes.second];
  if (!letters.block.has(radius) && !letters.block.has(angle)) return;
  if (letters.block.has(radius)) {
    if (modes.incremental)
      letters.control.report.fail(
          "unsupported-word", letters.column(radius),
          "an incremental radius (G91) counts from the present position, and is not read",
          "write the radius under G90, or the point in X Y Z under G15");
    mapping.polar.radius_mm = letters.control.modal.mm(letters.block.get(radius));
  }
  if (letters.block.has(angle))
    mapping.polar.angle_deg =
        modes.incremental ? mapping.polar.angle_deg + letters.block.get(angle) : letters.block.get(angle);
  if (!std::isfinite(mapping.polar.radius_mm) || !std::isfinite(mapping.polar.angle_deg))
    letters.control.report.fail(
        "missing-word", target.column,
        fmt::format("the first polar point needs the radius {} and the angle {} under G90", radius, angle),
        "write both");
  std::string why;
  target.set(axes.first, mapping.polar.radius_mm * *nc::apply(Function::kCos, mapping.polar.angle_deg, why),
             false);
  target.set(axes.second, mapping.polar.radius_mm * *nc::apply(Function::kSin, mapping.polar.angle_deg, why),
             false);
  target.incremental = static_cast<uint8_t>(target.incremental & ~(1u << axes.first | 1u << axes.second));
}

void check_transform(Modes& modes, Planes& planes, LetterDialect& letters, int column) {
  if (planes.turned.on || modes.tcp != Tcp::kOff || letters.control.contour.side() != Compensation::kOff)
    letters.control.report.fail(
        "modal-conflict", column,
        "mirror images and scaling change while a rotated frame, TCP or cutter compensation is on",
        "write it before them, and switch it off after them");
}

/// A magnification. Whole numbers count 0.001 or 0.00001 by the machine's parameter 5400, points say it.
double magnification(LetterDialect& letters, char letter) {
  if (without_point(letters, letter))
    letters.control.report.fail(
        "unsupported-word", letters.column(letter),
        fmt::format("{} without a decimal point counts 0.001 or 0.00001 as the machine is set", letter),
        fmt::format("write the magnification with a point: {}1.5", letter));
  const double value = letters.block.get(letter);
  if (value == 0.0 || !std::isfinite(value))
    letters.control.report.fail("out-of-range", letters.column(letter),
                                fmt::format("{} is no magnification", letter),
                                "write a number that is not zero");
  return value;
}

void update_stretch(Mapping& mapping) {
  for (size_t i = 0; i < 3; ++i) {
    mapping.stretch.factor[static_cast<long>(i)] = mapping.axis[i].factor();
    mapping.stretch.offset[static_cast<long>(i)] = mapping.axis[i].shift();
  }
}

}  // namespace

double AxisMap::factor() const {
  return mirrored ? -scale : scale;
}

double AxisMap::shift() const {
  return (mirrored ? 2.0 * scale * mirror_at : 0.0) + (1.0 - scale) * centre;
}

bool mapped(const Mapping& mapping) {
  return mapping.scaled || mapping.mirrored;
}

/// The plane's sense of rotation is reversed.
bool reversed(const Mapping& mapping, const LetterDialect& letters) {
  return mapping.stretch.turns_over(axes_of(letters.control.modal.plane));
}

Target words(Modes& modes, Mapping& mapping, LetterDialect& letters) {
  Target target = target_of(letters.block, modes.incremental, letters.reader, letters.control);
  if (mapping.polar.on) polar_words(modes, mapping, letters, target);
  if (mapped(mapping)) {
    for (int i = 0; i < 3; ++i) {
      if (target.has(i)) {
        double& value = target.value[static_cast<size_t>(i)];
        value = mapping.stretch.along(i, value, target.is_incremental(i));
      }
    }
  }
  return target;
}

/// The circle as it stands after the transformations.
void map_arc(Mapping& mapping, LetterDialect& letters, ArcWords& arc) {
  if (mapping.polar.on && arc.centre)
    letters.control.report.fail("unsupported-word", arc.column, "the centre of an arc in polar coordinates",
                                "give its radius R");
  if (!mapped(mapping)) return;
  const PlaneAxes axes = axes_of(letters.control.modal.plane);
  const double first = mapping.stretch.factor[axes.first], second = mapping.stretch.factor[axes.second];
  const std::optional<double> grown = mapping.stretch.in_plane(axes);
  if (!grown)
    letters.control.report.fail(
        "bad-arc", arc.column,
        fmt::format("the arc is scaled by {:g} and {:g}: it would be no circle", first, second),
        "scale both axes of the plane alike");
  arc.radius *= *grown;
  if (!arc.centre) return;
  const Vec3 here = nc::position_xyz(letters.control);
  for (const int i : {axes.first, axes.second})
    (*arc.centre)[i] = here[i] + mapping.stretch.along(i, (*arc.centre)[i] - here[i], true);
}

/// Fails while scaling, mirror images or polar coordinates are on.
void refuse_mapped(Mapping& mapping, LetterDialect& letters, int column, const char* what, bool polar_too) {
  if (!mapped(mapping) && !(polar_too && mapping.polar.on)) return;
  letters.control.report.fail("modal-conflict", column,
                              fmt::format("{} while {} is on", what,
                                          mapping.scaled     ? "scaling (G51)"
                                          : mapping.mirrored ? "a mirror image (G51.1)"
                                                             : "the polar coordinate mode (G16)"),
                              "switch it off first: G50, G50.1, G15");
}

/// G50.1 X Y Z ends the mirror images of these axes, G51.1 X Y Z mirrors at these coordinates.
void mirror(Fanuc& fanuc, int tenths) {
  const int at = fanuc.g_column(kFanucMirror);
  only_words(fanuc, "XYZ", tenths == G::kMirrorOn ? "G51.1" : "G50.1");
  const Target axes = target_of(fanuc.block, false, fanuc.reader, fanuc.control);
  if (tenths == G::kMirrorOff && !fanuc.mapping.mirrored) return;
  if (!axes.any())
    fanuc.control.report.fail("missing-word", at, "the mirror image names no axis",
                              "write its axes: G51.1 X0, G50.1 X0");
  if (fanuc.mapping.scaled)
    fanuc.control.report.fail("modal-conflict", at, "a mirror image changes while scaling is on",
                              "write G51.1 before G51, and G50.1 after G50");
  if (tenths == G::kMirrorOn && fanuc.modes.incremental)
    fanuc.control.report.fail("unsupported-word", at, "G51.1 under G91", "write G90 before it");
  check_transform(fanuc.modes, fanuc.planes, fanuc, at);
  for (size_t i = 0; i < 3; ++i) {
    if (!axes.has(static_cast<int>(i))) continue;
    if (fanuc.rules.mirror_at_zero && axes.value[i] != 0.0)
      fanuc.control.report.fail("unsupported-word", fanuc.column("XYZ"[i]),
                                fanuc.g_name(kFanucMirror) + " mirrors at the program's zero",
                                "write X0, Y0 or Z0 of the axes to mirror");
    fanuc.mapping.axis[i].mirrored = tenths == G::kMirrorOn;
    fanuc.mapping.axis[i].mirror_at = axes.value[i];
  }
  fanuc.mapping.mirrored =
      fanuc.mapping.axis[0].mirrored || fanuc.mapping.axis[1].mirrored || fanuc.mapping.axis[2].mirrored;
  update_stretch(fanuc.mapping);
}

/// G51 X Y Z P or I J K about the centre, by default the present position; G50.
void scale(Fanuc& fanuc, int tenths) {
  const int at = fanuc.g_column(kFanucScale);
  if (tenths == G::kScaleOff) {
    if (fanuc.mapping.scaled) check_transform(fanuc.modes, fanuc.planes, fanuc, at);
    for (AxisMap& axis : fanuc.mapping.axis) axis.scale = 1.0, axis.centre = 0.0;
    fanuc.mapping.scaled = false;
    update_stretch(fanuc.mapping);
    return;
  }
  only_words(fanuc, "XYZPIJK", "G51");
  check_transform(fanuc.modes, fanuc.planes, fanuc, at);
  const bool each = fanuc.block.has('I') || fanuc.block.has('J') || fanuc.block.has('K');
  if (each == fanuc.block.has('P'))
    fanuc.control.report.fail(
        each ? "modal-conflict" : "missing-word", at,
        each ? "P and I J K stand in one G51" : "G51 without P takes the parameter of the machine",
        "write P for all axes, or I, J and K");
  if (each) {
    for (const char letter : {'I', 'J', 'K'}) fanuc.need(letter, "G51 with I J K");
  }
  const Target centre = target_of(fanuc.block, false, fanuc.reader, fanuc.control);
  const Vec3 here = nc::position_xyz(fanuc.control);
  std::array<AxisMap, 3> map = fanuc.mapping.axis;
  for (size_t i = 0; i < 3; ++i) {
    map[i].scale = magnification(fanuc, each ? "IJK"[i] : 'P');
    map[i].centre = centre.has(static_cast<int>(i)) ? centre.value[i] : here[static_cast<long>(i)];
    if (!std::isfinite(map[i].centre))
      fanuc.control.report.fail("start-unknown", at,
                                "G51 scales about the present position, which is not known yet",
                                "give its centre in X, Y and Z");
  }
  fanuc.mapping.axis = map;
  fanuc.mapping.scaled = true;
  update_stretch(fanuc.mapping);
}

void polar(Modes& modes, Mapping& mapping, LetterDialect& letters, int tenths) {
  const int at = letters.g_column(kFanucPolar);
  if (tenths == G::kPolarOn && modes.incremental)
    letters.control.report.fail("unsupported-word", at,
                                "G91 G16 counts radii from the present position, and is not read",
                                "write G90 G16");
  mapping.polar = Polar();
  mapping.polar.on = tenths == G::kPolarOn;
}

}  // namespace swarf::program::nc::fanuc
