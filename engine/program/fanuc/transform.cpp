// What is done to the words of moves before the frame: polar coordinates (G16), mirror images (G51.1),
// scaling (G51), in the manual's order. Each axis by itself: p' = factor p + shift.
#include <fmt/format.h>

#include <cmath>

#include "program/fanuc/reader.h"

namespace swarf::program::nc::fanuc {

double Fanuc::AxisMap::factor() const {
  return mirrored ? -scale : scale;
}

double Fanuc::AxisMap::shift() const {
  return (mirrored ? 2.0 * scale * mirror_at : 0.0) + (1.0 - scale) * centre;
}

double Fanuc::AxisMap::at(double value, bool is_incremental) const {
  return is_incremental ? factor() * value : factor() * value + shift();
}

bool Fanuc::mapped() const {
  return scaled_ || mirrored_;
}

/// The plane's sense of rotation is reversed.
bool Fanuc::reversed() const {
  const PlaneAxes axes = axes_of(control_.modal.plane);
  return map_[static_cast<size_t>(axes.first)].mirrors() != map_[static_cast<size_t>(axes.second)].mirrors();
}

Target Fanuc::words() {
  Target target = target_of(block_, incremental_, reader_, control_);
  if (polar_.on) polar_words(target);
  if (mapped()) {
    for (int i = 0; i < 3; ++i) {
      if (target.has(i)) {
        double& value = target.value[static_cast<size_t>(i)];
        value = map_[static_cast<size_t>(i)].at(value, target.is_incremental(i));
      }
    }
  }
  return target;
}

/// The plane's first word is the radius from the program's zero, the second the angle from the first axis.
void Fanuc::polar_words(Target& target) {
  const PlaneAxes axes = axes_of(control_.modal.plane);
  const char radius = "XYZ"[axes.first], angle = "XYZ"[axes.second];
  if (!block_.has(radius) && !block_.has(angle)) return;
  if (block_.has(radius)) {
    if (incremental_)
      control_.report.fail("unsupported-word", column(radius),
                           "an incremental radius (G91) counts from the present position, and is not read",
                           "write the radius under G90, or the point in X Y Z under G15");
    polar_.radius_mm = control_.modal.mm(block_.get(radius));
  }
  if (block_.has(angle))
    polar_.angle_deg = incremental_ ? polar_.angle_deg + block_.get(angle) : block_.get(angle);
  if (!std::isfinite(polar_.radius_mm) || !std::isfinite(polar_.angle_deg))
    control_.report.fail(
        "missing-word", target.column,
        fmt::format("the first polar point needs the radius {} and the angle {} under G90", radius, angle),
        "write both");
  std::string why;
  target.set(axes.first, polar_.radius_mm * *nc::apply(Function::kCos, polar_.angle_deg, why), false);
  target.set(axes.second, polar_.radius_mm * *nc::apply(Function::kSin, polar_.angle_deg, why), false);
  target.incremental = static_cast<uint8_t>(target.incremental & ~(1u << axes.first | 1u << axes.second));
}

/// The circle as it stands after the transformations.
void Fanuc::map_arc(ArcWords& arc) {
  if (polar_.on && arc.centre)
    control_.report.fail("unsupported-word", arc.column, "the centre of an arc in polar coordinates",
                         "give its radius R");
  if (!mapped()) return;
  const PlaneAxes axes = axes_of(control_.modal.plane);
  const double first = map_[static_cast<size_t>(axes.first)].factor(),
               second = map_[static_cast<size_t>(axes.second)].factor();
  if (std::abs(first) != std::abs(second))
    control_.report.fail(
        "bad-arc", arc.column,
        fmt::format("the arc is scaled by {:g} and {:g}: it would be no circle", first, second),
        "scale both axes of the plane alike");
  arc.radius *= std::abs(first);
  if (!arc.centre) return;
  const Vec3 here = nc::position_xyz(control_);
  for (const int i : {axes.first, axes.second})
    (*arc.centre)[i] = here[i] + map_[static_cast<size_t>(i)].factor() * ((*arc.centre)[i] - here[i]);
}

/// Fails while scaling, mirror images or polar coordinates are on.
void Fanuc::refuse_mapped(int column, const char* what, bool polar_too) {
  if (!mapped() && !(polar_too && polar_.on)) return;
  control_.report.fail("modal-conflict", column,
                       fmt::format("{} while {} is on", what,
                                   scaled_     ? "scaling (G51)"
                                   : mirrored_ ? "a mirror image (G51.1)"
                                               : "the polar coordinate mode (G16)"),
                       "switch it off first: G50, G50.1, G15");
}

void Fanuc::check_transform(int column) {
  if (turned_.on || tcp_ != Tcp::kOff || control_.contour.side() != Compensation::kOff)
    control_.report.fail(
        "modal-conflict", column,
        "mirror images and scaling change while a rotated frame, TCP or cutter compensation is on",
        "write it before them, and switch it off after them");
}

/// G50.1 X Y Z ends the mirror images of these axes, G51.1 X Y Z mirrors at these coordinates.
void Fanuc::mirror(int tenths) {
  const int at = g_column(kFanucMirror);
  only_words("XYZ", tenths == 511 ? "G51.1" : "G50.1");
  const Target axes = target_of(block_, false, reader_, control_);
  if (tenths == 501 && !mirrored_) return;
  if (!axes.any())
    control_.report.fail("missing-word", at, "the mirror image names no axis",
                         "write its axes: G51.1 X0, G50.1 X0");
  if (scaled_)
    control_.report.fail("modal-conflict", at, "a mirror image changes while scaling is on",
                         "write G51.1 before G51, and G50.1 after G50");
  if (tenths == 511 && incremental_)
    control_.report.fail("unsupported-word", at, "G51.1 under G91", "write G90 before it");
  check_transform(at);
  for (size_t i = 0; i < 3; ++i) {
    if (!axes.has(static_cast<int>(i))) continue;
    map_[i].mirrored = tenths == 511;
    map_[i].mirror_at = axes.value[i];
  }
  mirrored_ = map_[0].mirrored || map_[1].mirrored || map_[2].mirrored;
}

/// A magnification. Whole numbers count 0.001 or 0.00001 by the machine's parameter 5400, points say it.
double Fanuc::magnification(char letter) {
  if (without_point(letter))
    control_.report.fail(
        "unsupported-word", column(letter),
        fmt::format("{} without a decimal point counts 0.001 or 0.00001 as the machine is set", letter),
        fmt::format("write the magnification with a point: {}1.5", letter));
  const double value = block_.get(letter);
  if (value == 0.0 || !std::isfinite(value))
    control_.report.fail("out-of-range", column(letter), fmt::format("{} is no magnification", letter),
                         "write a number that is not zero");
  return value;
}

/// G51 X Y Z P or I J K about the centre, by default the present position; G50.
void Fanuc::scale(int tenths) {
  const int at = g_column(kFanucScale);
  if (tenths == 500) {
    if (scaled_) check_transform(at);
    for (AxisMap& axis : map_) axis.scale = 1.0, axis.centre = 0.0;
    scaled_ = false;
    return;
  }
  only_words("XYZPIJK", "G51");
  check_transform(at);
  const bool each = block_.has('I') || block_.has('J') || block_.has('K');
  if (each == block_.has('P'))
    control_.report.fail(
        each ? "modal-conflict" : "missing-word", at,
        each ? "P and I J K stand in one G51" : "G51 without P takes the parameter of the machine",
        "write P for all axes, or I, J and K");
  if (each) {
    for (const char letter : {'I', 'J', 'K'}) need(letter, "G51 with I J K");
  }
  const Target centre = target_of(block_, false, reader_, control_);
  const Vec3 here = nc::position_xyz(control_);
  std::array<AxisMap, 3> map = map_;
  for (size_t i = 0; i < 3; ++i) {
    map[i].scale = magnification(each ? "IJK"[i] : 'P');
    map[i].centre = centre.has(static_cast<int>(i)) ? centre.value[i] : here[static_cast<long>(i)];
    if (!std::isfinite(map[i].centre))
      control_.report.fail("start-unknown", at,
                           "G51 scales about the present position, which is not known yet",
                           "give its centre in X, Y and Z");
  }
  map_ = map;
  scaled_ = true;
}

void Fanuc::polar(int tenths) {
  const int at = g_column(kFanucPolar);
  if (tenths == 160 && incremental_)
    control_.report.fail("unsupported-word", at,
                         "G91 G16 counts radii from the present position, and is not read", "write G90 G16");
  polar_ = Polar();
  polar_.on = tenths == 160;
}

}  // namespace swarf::program::nc::fanuc
