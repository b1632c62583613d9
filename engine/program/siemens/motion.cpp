// Motions of Siemens 840D blocks.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "program/siemens/executor.h"

namespace swarf::program::nc::siemens {

using nc::ArcWords;
using nc::Motion;
using nc::RotaryWay;
using nc::Target;

namespace {

/// MD21000 CIRCLE_ERROR_CONST (mm) and MD21010 CIRCLE_ERROR_FACTOR of a control as it is delivered.
constexpr double kCircleError = 0.01, kCircleErrorFactor = 1e-3;
/// Points nearer than this are one, mm; directions more alike than this are parallel.
constexpr double kSamePoint = 1e-9, kParallel = 1e-9;

}  // namespace

/// Coordinates in mm and rad; `machine`: of SUPA, G53, G153.
Target Executor::target_of(const BlockWords& words, bool machine) const {
  Target target;
  for (size_t n = 0; n < words.axes.size(); ++n) {
    const Coordinate& word = words.axes[n];
    if (!word) continue;
    const bool rotary = n >= 3;
    const double value = rotary
                             ? rad_from_deg(word.value)
                             : control_.modal.mm(word.value) * (machine ? 1.0 : shape_[static_cast<long>(n)]);
    const bool incremental = word.way == Way::kIncremental || (word.way == Way::kModal && incremental_);
    if (machine && incremental) {
      fail("words-conflict", word.offset, "machine coordinates are absolute, this word is incremental",
           "write G90, or AC()");
    }
    target.set(static_cast<int>(n), value, incremental);
    if (target.column == 0) target.column = column(word.offset);
    if (rotary) {
      target.way[n - 3] = word.way == Way::kShortest   ? RotaryWay::kShortest
                          : word.way == Way::kPositive ? RotaryWay::kPositive
                          : word.way == Way::kNegative ? RotaryWay::kNegative
                                                       : RotaryWay::kAsWritten;
    }
  }
  return target;
}

/// What the radius of an arc in the plane is multiplied by.
double Executor::arc_scale(size_t offset) const {
  const nc::PlaneAxes plane = nc::axes_of(control_.modal.plane);
  const double one = std::abs(shape_[plane.first]), other = std::abs(shape_[plane.second]);
  if (one != other) {
    fail("bad-arc", offset, "the axes of the plane are scaled differently: an arc would be an ellipse",
         "SCALE both axes of the plane alike");
  }
  return one;
}

/// One of the plane's axes runs the other way: arcs turn the other way, the cutter goes on the other side.
bool Executor::mirrored() const {
  const nc::PlaneAxes plane = nc::axes_of(control_.modal.plane);
  return shape_[plane.first] * shape_[plane.second] < 0.0;
}

Motion Executor::turned(Motion motion) const {
  if (!mirrored()) return motion;
  return motion == Motion::kClockwise ? Motion::kCounterClockwise : Motion::kClockwise;
}

/// A3= B3= C3= and A2= B2= C2=.
void Executor::orientation(const BlockWords& words, Target& target) {
  const auto first = [](const std::array<Amount, 3>& three) -> const Amount* {
    for (const Amount& one : three) {
      if (one) return &one;
    }
    return nullptr;
  };
  const Amount* vector = first(words.vector);
  const Amount* angles = first(words.angles);
  const Amount* given = vector != nullptr ? vector : angles;
  if (given == nullptr) return;
  if (target.column == 0) target.column = column(given->offset);
  if (!traori_) {
    fail("vector-without-tcp", given->offset, "an orientation is programmed while TRAORI is off",
         "write TRAORI before it");
  }
  if ((vector != nullptr && angles != nullptr) || (target.given & 0x38u) != 0) {
    fail("words-conflict", given->offset, "the orientation is given in two ways in this block",
         "write rotary axes, or A3= B3= C3=, or A2= B2= C2=");
  }
  if (shape_.cwiseAbs() != Vec3(Vec3::Constant(std::abs(shape_[0])))) {
    fail("unsupported-word", given->offset,
         "an orientation while the axes are scaled differently is not supported", "SCALE all axes alike");
  }
  if (reference_ == kOriMks && !interpolation_ && !programmed_.linear().isIdentity(1e-12)) {
    fail("unsupported-word", given->offset, "ORIMKS with an orientation in a rotated frame is not supported",
         "write ORIWKS, or give the rotary axes");
  }
  if (vector != nullptr) {
    const Vec3 axis(words.vector[0].value, words.vector[1].value, words.vector[2].value);
    target.axis_P = axis.cwiseProduct(shape_);
    return;
  }
  if (!angles_) {
    fail("missing-word", given->offset, "A2= B2= C2= mean Euler or RPY angles by a setting of the machine",
         "write ORIEULER or ORIRPY before this block");
  }
  const auto turn = [](double deg, const Vec3& axis) { return Eigen::AngleAxisd(rad_from_deg(deg), axis); };
  const double a = words.angles[0].value, b = words.angles[1].value, c = words.angles[2].value;
  const Vec3 axis = *angles_ == kOriEuler
                        ? Vec3(turn(a, Vec3::UnitZ()) * (turn(b, Vec3::UnitX()) * Vec3::UnitZ()))
                        : Vec3(turn(c, Vec3::UnitZ()) *
                               (turn(b, Vec3::UnitY()) * (turn(a, Vec3::UnitX()) * Vec3::UnitZ())));
  target.axis_P = axis.cwiseProduct(shape_);
}

void Executor::motion_words(const BlockWords& words) {
  cutter_words(words);
  const std::optional<int> other = words.code(Group::kNoMotion);
  const bool polar = words.polar_angle || words.polar_radius;
  const int point = other.value_or(kG4);
  if (polar && (point == kG74 || point == kG75 || words.code(Group::kSuppress))) {
    fail("words-conflict", words.polar_angle ? words.polar_angle.offset : words.polar_radius.offset,
         "AP= and RP= stand in a block of machine coordinates", "write the axes");
  }
  if (other) {
    if (*other == kG4) {
      dwell(words);
    } else if (*other == kG110 || *other == kG111 || *other == kG112) {
      set_pole(words, *other);
    } else {
      approach_point(words, *other);
    }
    return;
  }
  const bool arc = motion_ != kG0 && motion_ != kG1 && motion_ != kPoly;
  check_polynomial(words);
  if (!words.moves()) {
    if (const Coefficients* divisor = first_polynomial(words)) {
      fail("unexpected-word", divisor->offset, "PO[] stands without polynomials of axes",
           "PO[X]=(0,-10) PO[Y]=(10) PO[]=(2,1)");
    }
    for (const Amount* word : {&words.radius, &words.opening, &words.turns}) {
      if (*word)
        fail("unexpected-word", word->offset, "this word belongs to an arc, and nothing moves here",
             "write the end of the arc");
    }
    return;
  }
  if (words.code(Group::kSuppress)) {
    machine_move(words);
    return;
  }
  if (!arc) {
    for (const Coordinate* word : {&words.centre[0], &words.centre[1], &words.centre[2], &words.between[0],
                                   &words.between[1], &words.between[2]}) {
      if (*word)
        fail("unexpected-word", word->offset, "the centre of an arc stands in a straight move",
             "write G2 or G3 in this block");
    }
    for (const Amount* word : {&words.radius, &words.opening, &words.turns}) {
      if (*word)
        fail("unexpected-word", word->offset, "this word belongs to an arc, and the move is straight",
             "write G2 or G3 in this block");
    }
  }
  Target target = target_of(words, false);
  if (polar) polar_end(words, target);
  orientation(words, target);
  if (traori_ && target.rotary() && !reference_ && !interpolation_) {
    control_.report.warn_once(
        "orientation-assumed", target.column,
        "tool orientations change under TRAORI and the program says not how: ORIWKS (the "
        "great circle) is taken",
        "write ORIWKS, ORIAXES or ORIVECT");
  }
  if (motion_ == kG0 || motion_ == kG1) {
    straight(motion_ == kG0 ? Motion::kRapid : Motion::kFeed, target);
  } else if (motion_ == kPoly) {
    if (first_polynomial(words) != nullptr) {
      polynomial(words, target);
    } else {
      straight(Motion::kFeed, target);
    }
  } else if (motion_ == kCip) {
    circle_through(words, target);
  } else if (motion_ == kCt) {
    circle_tangential(target);
  } else {
    circle(words, target);
  }
  if (modal_cycle_) drill(drilling(*modal_cycle_), *modal_cycle_);
}

void Executor::straight(Motion motion, const Target& target) {
  const Vec3 from = nc::position_xyz(control_);
  nc::line(control_, motion, target);
  const Vec3 way = nc::position_xyz(control_) - from;
  if (!(way.norm() > kSamePoint)) return;
  last_.direction = way.normalized();
  last_.valid = true;
}

/// The programmed end of a motion from `from`.
Vec3 Executor::end_of(const Target& target, const Vec3& from) const {
  Vec3 end = from;
  for (int n = 0; n < 3; ++n) {
    const double value = target.value[static_cast<size_t>(n)];
    if (target.has(n)) end[n] = target.is_incremental(n) ? from[n] + value : value;
  }
  return end;
}

/// Passes the arc on. Ends that miss the circle by less than the control's tolerance move its centre onto
/// the bisector of the chord, as the control does.
void Executor::send_arc(Motion motion, const Target& target, ArcWords& arc, size_t offset) {
  const Vec3 from = nc::position_xyz(control_);
  const Vec3 to = end_of(target, from);
  const Vec3 normal =
      arc.normal ? arc.normal->normalized() : Vec3(Vec3::Unit(nc::axes_of(control_.modal.plane).normal));
  const auto flat = [&](const Vec3& v) { return Vec3(v - v.dot(normal) * normal); };
  arc.column = column(offset);
  if (arc.centre) {
    const double radius = flat(from - *arc.centre).norm(),
                 miss = std::abs(flat(to - *arc.centre).norm() - radius);
    arc.radius_tolerance_mm = std::max(kCircleError, kCircleErrorFactor * radius);
    const Vec3 chord = flat(to - from);
    if (miss > kArcTolerance && miss <= arc.radius_tolerance_mm && chord.norm() > radius) {
      const Vec3 along = chord.normalized();
      *arc.centre -= (*arc.centre - 0.5 * (from + to)).dot(along) * along;
    }
  }
  nc::arc(control_, motion, target, arc);
  const Vec3 centre = arc.centre ? *arc.centre : Vec3::Constant(std::nan(""));
  const Vec3 spoke = flat(to - centre);
  const double sense = motion == Motion::kClockwise ? -1.0 : 1.0;
  last_.direction = sense * normal.cross(spoke);
  last_.valid = last_.direction.norm() > kSamePoint;
}

/// G2, G3 with I J K, CR= or AR=.
void Executor::circle(const BlockWords& words, const Target& written) {
  Target target = written;
  const Motion motion = turned(motion_ == kG2 ? Motion::kClockwise : Motion::kCounterClockwise);
  const nc::PlaneAxes plane = nc::axes_of(control_.modal.plane);
  const Vec3 from = nc::position_xyz(control_);
  ArcWords arc;
  bool centred = false;
  Vec3 centre = from;
  for (int n = 0; n < 3; ++n) {
    const Coordinate& word = words.centre[static_cast<size_t>(n)];
    if (!word) continue;
    if (n == plane.normal) {
      fail("unexpected-word", word.offset, "this centre coordinate stands across the active plane",
           "G17 has I J, G18 has I K, G19 has J K");
    }
    centred = true;
    centre[n] = (word.way == Way::kAbsolute ? 0.0 : from[n]) + control_.modal.mm(word.value) * shape_[n];
  }
  if (!centred && !words.radius && !words.opening && (words.polar_angle || words.polar_radius)) {
    centred = true;  // the pole is the centre
    centre = pole_.cwiseProduct(shape_);
  }
  const int ways = (centred ? 1 : 0) + (words.radius ? 1 : 0);
  const size_t offset = words.radius ? words.radius.offset : line_->text.find_first_not_of(" \t");
  if (ways == 2) {
    fail("words-conflict", words.radius.offset, "the arc has a centre and a radius", "write I J K or CR=");
  }
  if (ways == 0 && !words.opening) {
    control_.report.fail("bad-arc", target.column, "the arc has neither a centre nor a radius",
                         "write I J K, CR= or AR=");
  }
  if (words.turns) {
    const double turns = words.turns.value;
    if (turns != std::floor(turns) || turns < 0 || turns > 999) {
      fail("out-of-range", words.turns.offset, "TURN counts whole turns from 0 to 999", "TURN=2");
    }
    arc.further_turns = static_cast<int>(turns);
  }
  if (centred) arc.centre = centre;
  const double scale = arc_scale(offset);
  if (words.radius) arc.radius = control_.modal.mm(words.radius.value) * scale;
  if (words.opening) opened(words, arc, target, from, motion);
  send_arc(motion, target, arc, words.opening ? words.opening.offset : offset);
  if (!arc.centre) last_.valid = false;
}

/// AR= with the end (the radius follows from the chord) or with the centre (the end follows by turning).
void Executor::opened(const BlockWords& words, ArcWords& arc, Target& target, const Vec3& from,
                      Motion motion) {
  const double angle = rad_from_deg(words.opening.value);
  if (!(angle > 0.0) || !(angle < 2.0 * kPi) || words.radius) {
    fail("bad-arc", words.opening.offset, "AR= is an angle between 0 and 360 degrees, and stands without CR=",
         "AR=90 with the end or the centre of the arc");
  }
  const Vec3 normal = Vec3::Unit(nc::axes_of(control_.modal.plane).normal);
  const auto flat = [&](const Vec3& v) { return Vec3(v - v.dot(normal) * normal); };
  const Vec3 to = end_of(target, from);
  const bool ends = flat(to - from).norm() > kSamePoint;
  if (arc.centre && ends) {
    fail("words-conflict", words.opening.offset, "the arc has a centre, an end and an angle",
         "leave one of them out");
  }
  if (!arc.centre) {
    const double radius = 0.5 * flat(to - from).norm() / std::sin(0.5 * angle);
    arc.radius = angle > kPi ? -radius : radius;
    return;
  }
  const double sense = motion == Motion::kClockwise ? -angle : angle;
  const Vec3 end = *arc.centre + Eigen::AngleAxisd(sense, normal) * (from - *arc.centre);
  const nc::PlaneAxes plane = nc::axes_of(control_.modal.plane);
  target.set(plane.first, end[plane.first], false);
  target.set(plane.second, end[plane.second], false);
}

/// CIP: the circle through a point between, anywhere in space.
void Executor::circle_through(const BlockWords& words, const Target& target) {
  const Vec3 from = nc::position_xyz(control_), to = end_of(target, from);
  Vec3 between = from;
  size_t offset = line_->text.find_first_not_of(" \t");
  bool given = false;
  for (int n = 0; n < 3; ++n) {
    const Coordinate& word = words.between[static_cast<size_t>(n)];
    if (!word) continue;
    given = true;
    offset = word.offset;
    const bool incremental = word.way == Way::kIncremental || (word.way == Way::kModal && incremental_);
    between[n] = (incremental ? from[n] : 0.0) + control_.modal.mm(word.value) * shape_[n];
  }
  if (shape_.cwiseAbs() != Vec3(Vec3::Constant(std::abs(shape_[0])))) arc_scale(offset);
  const Vec3 a = between - from, b = to - from, cross = a.cross(b);
  if (!given || !(cross.norm() > kParallel * a.norm() * b.norm()) || !(cross.norm() > 0.0)) {
    fail("bad-arc", offset, "CIP needs three points that are not on one line",
         "write I1= J1= K1= between start and end");
  }
  ArcWords arc;
  arc.normal = cross.normalized();
  arc.centre = from + (a.squaredNorm() * b.cross(cross) + b.squaredNorm() * cross.cross(a)) /
                          (2.0 * cross.squaredNorm());
  send_arc(Motion::kCounterClockwise, target, arc, offset);
}

/// CT: an arc in the plane that goes on in the direction of the last move; a straight line where the end
/// lies ahead.
void Executor::circle_tangential(const Target& target) {
  const size_t offset = line_->text.find_first_not_of(" \t");
  arc_scale(offset);
  if (!last_.valid) {
    fail("bad-arc", offset, "CT goes on in the direction of the last move, and there is none",
         "write G1 before it, or G2 with a centre");
  }
  const Vec3 normal = Vec3::Unit(nc::axes_of(control_.modal.plane).normal);
  const auto flat = [&](const Vec3& v) { return Vec3(v - v.dot(normal) * normal); };
  const Vec3 from = nc::position_xyz(control_);
  const Vec3 chord = flat(end_of(target, from) - from), along = flat(last_.direction);
  if (!(along.norm() > kParallel) || !(chord.norm() > kSamePoint)) {
    fail("bad-arc", offset, "CT has no direction or no way in the plane", "write the arc with its centre");
  }
  const Vec3 left = normal.cross(along.normalized());
  const double side = left.dot(chord.normalized());
  if (std::abs(side) < kParallel) {
    if (along.dot(chord) < 0.0)
      fail("bad-arc", offset, "the end lies straight behind: no arc leads there",
           "write the arc with its centre");
    straight(Motion::kFeed, target);
    return;
  }
  ArcWords arc;
  arc.centre = from + left * (chord.squaredNorm() / (2.0 * left.dot(chord)));
  send_arc(side > 0.0 ? Motion::kCounterClockwise : Motion::kClockwise, target, arc, offset);
}

/// SUPA, G53, G153: without offsets and frames; the tool length stays as it is (D0 takes it out).
void Executor::machine_move(const BlockWords& words) {
  const size_t offset = line_->text.find_first_not_of(" \t");
  if (traori_) {
    fail("unsupported-word", offset, "machine coordinates under TRAORI are not supported",
         "write TRAFOOF before it");
  }
  if (motion_ != kG0 && motion_ != kG1) {
    fail("words-conflict", offset, "machine coordinates take G0 or G1, another motion is active",
         "write G0 in this block");
  }
  Target target = target_of(words, true);
  orientation(words, target);
  if (control_.tools.length_on) {
    const int normal = nc::axes_of(control_.modal.plane).normal;
    if (target.has(normal)) target.value[static_cast<size_t>(normal)] += control_.space.length();
  }
  nc::machine_line(control_, motion_ == kG0 ? Motion::kRapid : Motion::kFeed, target);
  last_.valid = false;
}

/// G4 F seconds, G4 S turns of the spindle.
void Executor::dwell(const BlockWords& words) {
  if (words.moves()) {
    fail("words-conflict", words.motion_offset, "G4 stands in a block with a motion",
         "write it in a block of its own");
  }
  if (static_cast<bool>(words.feed) == static_cast<bool>(words.speed)) {
    fail("missing-word", words.motion_offset, "G4 needs F (seconds) or S (turns of the spindle)", "G4 F1.5");
  }
  const Amount& amount = words.feed ? words.feed : words.speed;
  if (!(amount.value >= 0.0)) fail("out-of-range", amount.offset, "a dwell below zero", "G4 F1.5");
  const double rpm = control_.modal.spindle == 0 ? 0.0 : control_.modal.speed_rpm;
  if (words.speed && rpm <= 0.0) {
    fail("feed-without-spindle", amount.offset, "G4 S counts turns of the spindle, which stands", "G4 F1.5");
  }
  nc::dwell(control_.report, control_.modal, words.feed ? amount.value : amount.value * 60.0 / rpm);
}

/// G74: the reference points (home); G75: the fixed point, which is where tools are changed.
void Executor::approach_point(const BlockWords& words, int code) {
  const kinematics::MachineModel& machine = control_.setup.machine;
  if (code == kG75 && !machine.tool_change) {
    fail("unsupported-word", words.motion_offset,
         "G75 goes to a fixed point, which the machine file does not give",
         "add [tool_change] to the machine file, or write SUPA G0 with the position");
  }
  if (traori_)
    fail("unsupported-word", words.motion_offset, "G74 and G75 under TRAORI", "write TRAFOOF before it");
  Target target;
  for (size_t n = 0; n < words.axes.size(); ++n) {
    if (!words.axes[n]) continue;
    const int word = static_cast<int>(n);
    const int axis =
        nc::require_axis(control_, static_cast<nc::AxisWord>(word), column(words.axes[n].offset));
    const double home = machine.axes[static_cast<size_t>(axis)].home;
    target.set(word, code == kG74 ? home : (*machine.tool_change)[axis], false);
  }
  if (!target.any())
    fail("missing-word", words.motion_offset, "G74 and G75 name their axes", "G74 X1=0 Y1=0 Z1=0");
  nc::machine_line(control_, Motion::kRapid, target);
  last_.valid = false;
}

}  // namespace swarf::program::nc::siemens
