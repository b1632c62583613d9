// Motions of Siemens 840D blocks.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "program/control/corner.h"
#include "program/siemens/steps.h"

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

/// Coordinates in mm and rad; `machine`: of SUPA, G53, G153.
Target target_of(const Executor& executor, const BlockWords& words, bool machine) {
  Target target;
  for (size_t n = 0; n < words.axes.size(); ++n) {
    const Coordinate& word = words.axes[n];
    if (!word) continue;
    const bool rotary = n >= 3;
    const double value = rotary ? rad_from_deg(word.value)
                                : executor.control.modal.mm(word.value) *
                                      (machine ? 1.0 : executor.frames.stretch.factor[static_cast<long>(n)]);
    const bool incremental =
        word.way == Way::kIncremental || (word.way == Way::kModal && executor.modes.incremental);
    if (machine && incremental) {
      fail(executor.place, "words-conflict", word.offset,
           "machine coordinates are absolute, this word is incremental", "write G90, or AC()");
    }
    target.set(static_cast<int>(n), value, incremental);
    if (target.column == 0) target.column = column(executor.place, word.offset);
    if (rotary) {
      target.way[n - 3] = word.way == Way::kShortest   ? RotaryWay::kShortest
                          : word.way == Way::kPositive ? RotaryWay::kPositive
                          : word.way == Way::kNegative ? RotaryWay::kNegative
                                                       : RotaryWay::kAsWritten;
    }
  }
  return target;
}

Motion turned(nc::Control& control, const Frames& frames, Motion motion) {
  if (!mirrored(control, frames)) return motion;
  return motion == Motion::kClockwise ? Motion::kCounterClockwise : Motion::kClockwise;
}

/// A3= B3= C3= and A2= B2= C2=.
void orientation(BlockPlace& place, Frames& frames, const BlockWords& words, Target& target) {
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
  if (target.column == 0) target.column = column(place, given->offset);
  if (!frames.traori) {
    fail(place, "vector-without-tcp", given->offset, "an orientation is programmed while TRAORI is off",
         "write TRAORI before it");
  }
  if ((vector != nullptr && angles != nullptr) || (target.given & 0x38u) != 0) {
    fail(place, "words-conflict", given->offset, "the orientation is given in two ways in this block",
         "write rotary axes, or A3= B3= C3=, or A2= B2= C2=");
  }
  if (!frames.stretch.uniform()) {
    fail(place, "unsupported-word", given->offset,
         "an orientation while the axes are scaled differently is not supported", "SCALE all axes alike");
  }
  if (frames.reference == kOriMks && !frames.interpolation && !frames.programmed.linear().isIdentity(1e-12)) {
    fail(place, "unsupported-word", given->offset,
         "ORIMKS with an orientation in a rotated frame is not supported",
         "write ORIWKS, or give the rotary axes");
  }
  if (vector != nullptr) {
    const Vec3 axis(words.vector[0].value, words.vector[1].value, words.vector[2].value);
    target.axis_P = axis.cwiseProduct(frames.stretch.factor);
    return;
  }
  if (!frames.angles) {
    fail(place, "missing-word", given->offset,
         "A2= B2= C2= mean Euler or RPY angles by a setting of the machine",
         "write ORIEULER or ORIRPY before this block");
  }
  const auto turn = [](double deg, const Vec3& axis) { return Eigen::AngleAxisd(rad_from_deg(deg), axis); };
  const double a = words.angles[0].value, b = words.angles[1].value, c = words.angles[2].value;
  const Vec3 axis = *frames.angles == kOriEuler
                        ? Vec3(turn(a, Vec3::UnitZ()) * (turn(b, Vec3::UnitX()) * Vec3::UnitZ()))
                        : Vec3(turn(c, Vec3::UnitZ()) *
                               (turn(b, Vec3::UnitY()) * (turn(a, Vec3::UnitX()) * Vec3::UnitZ())));
  target.axis_P = axis.cwiseProduct(frames.stretch.factor);
}

void straight(nc::Control& control, PathWords& path, Motion motion, const Target& target) {
  const Vec3 from = nc::position_xyz(control);
  nc::line(control, motion, target);
  const Vec3 way = nc::position_xyz(control) - from;
  if (!(way.norm() > kSamePoint)) return;
  path.last.direction = way.normalized();
  path.last.valid = true;
}

/// Passes the arc on. Ends that miss the circle by less than the control's tolerance move its centre onto
/// the bisector of the chord, as the control does.
void send_arc(nc::Control& control, BlockPlace& place, PathWords& path, Motion motion, const Target& target,
              ArcWords& arc, size_t offset) {
  const Vec3 from = nc::position_xyz(control);
  const Vec3 to = end_of(target, from);
  const Vec3 normal =
      arc.normal ? arc.normal->normalized() : Vec3(Vec3::Unit(nc::axes_of(control.modal.plane).normal));
  const auto flat = [&](const Vec3& v) { return Vec3(v - v.dot(normal) * normal); };
  arc.column = column(place, offset);
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
  nc::arc(control, motion, target, arc);
  const Vec3 centre = arc.centre ? *arc.centre : Vec3::Constant(std::nan(""));
  const Vec3 spoke = flat(to - centre);
  const double sense = motion == Motion::kClockwise ? -1.0 : 1.0;
  path.last.direction = sense * normal.cross(spoke);
  path.last.valid = path.last.direction.norm() > kSamePoint;
}

/// AR= with the end (the radius follows from the chord) or with the centre (the end follows by turning).
void opened(nc::Control& control, BlockPlace& place, const BlockWords& words, ArcWords& arc, Target& target,
            const Vec3& from, Motion motion) {
  const double angle = rad_from_deg(words.opening.value);
  if (!(angle > 0.0) || !(angle < 2.0 * kPi) || words.radius) {
    fail(place, "bad-arc", words.opening.offset,
         "AR= is an angle between 0 and 360 degrees, and stands without CR=",
         "AR=90 with the end or the centre of the arc");
  }
  const Vec3 normal = Vec3::Unit(nc::axes_of(control.modal.plane).normal);
  const auto flat = [&](const Vec3& v) { return Vec3(v - v.dot(normal) * normal); };
  const Vec3 to = end_of(target, from);
  const bool ends = flat(to - from).norm() > kSamePoint;
  if (arc.centre && ends) {
    fail(place, "words-conflict", words.opening.offset, "the arc has a centre, an end and an angle",
         "leave one of them out");
  }
  if (!arc.centre) {
    const double radius = 0.5 * flat(to - from).norm() / std::sin(0.5 * angle);
    arc.radius = angle > kPi ? -radius : radius;
    return;
  }
  const double sense = motion == Motion::kClockwise ? -angle : angle;
  const Vec3 end = *arc.centre + Eigen::AngleAxisd(sense, normal) * (from - *arc.centre);
  const nc::PlaneAxes plane = nc::axes_of(control.modal.plane);
  target.set(plane.first, end[plane.first], false);
  target.set(plane.second, end[plane.second], false);
}

/// G2, G3 with I J K, CR= or AR=.
void circle(Executor& executor, const BlockWords& words, const Target& written) {
  Target target = written;
  const Motion motion = turned(executor.control, executor.frames,
                               executor.modes.motion == kG2 ? Motion::kClockwise : Motion::kCounterClockwise);
  const nc::PlaneAxes plane = nc::axes_of(executor.control.modal.plane);
  const Vec3 from = nc::position_xyz(executor.control);
  ArcWords arc;
  bool centred = false;
  Vec3 centre = from;
  for (int n = 0; n < 3; ++n) {
    const Coordinate& word = words.centre[static_cast<size_t>(n)];
    if (!word) continue;
    if (n == plane.normal) {
      fail(executor.place, "unexpected-word", word.offset,
           "this centre coordinate stands across the active plane", "G17 has I J, G18 has I K, G19 has J K");
    }
    centred = true;
    centre[n] = (word.way == Way::kAbsolute ? 0.0 : from[n]) +
                executor.control.modal.mm(word.value) * executor.frames.stretch.factor[n];
  }
  if (!centred && !words.radius && !words.opening && (words.polar_angle || words.polar_radius)) {
    centred = true;  // the pole is the centre
    centre = executor.path.pole.cwiseProduct(executor.frames.stretch.factor);
  }
  const int ways = (centred ? 1 : 0) + (words.radius ? 1 : 0);
  const size_t offset =
      words.radius ? words.radius.offset : executor.place.line->text.find_first_not_of(" \t");
  if (ways == 2) {
    fail(executor.place, "words-conflict", words.radius.offset, "the arc has a centre and a radius",
         "write I J K or CR=");
  }
  if (ways == 0 && !words.opening) {
    executor.control.report.fail("bad-arc", target.column, "the arc has neither a centre nor a radius",
                                 "write I J K, CR= or AR=");
  }
  if (words.turns) {
    const double turns = words.turns.value;
    if (turns != std::floor(turns) || turns < 0 || turns > 999) {
      fail(executor.place, "out-of-range", words.turns.offset, "TURN counts whole turns from 0 to 999",
           "TURN=2");
    }
    arc.further_turns = static_cast<int>(turns);
  }
  if (centred) arc.centre = centre;
  const double scale = arc_scale(executor.control, executor.place, executor.frames, offset);
  if (words.radius) arc.radius = executor.control.modal.mm(words.radius.value) * scale;
  if (words.opening) opened(executor.control, executor.place, words, arc, target, from, motion);
  send_arc(executor.control, executor.place, executor.path, motion, target, arc,
           words.opening ? words.opening.offset : offset);
  if (!arc.centre) executor.path.last.valid = false;
}

/// CIP: the circle through a point between, anywhere in space.
void circle_through(Executor& executor, const BlockWords& words, const Target& target) {
  const Vec3 from = nc::position_xyz(executor.control), to = end_of(target, from);
  Vec3 between = from;
  size_t offset = executor.place.line->text.find_first_not_of(" \t");
  bool given = false;
  for (int n = 0; n < 3; ++n) {
    const Coordinate& word = words.between[static_cast<size_t>(n)];
    if (!word) continue;
    given = true;
    offset = word.offset;
    const bool incremental =
        word.way == Way::kIncremental || (word.way == Way::kModal && executor.modes.incremental);
    between[n] = (incremental ? from[n] : 0.0) +
                 executor.control.modal.mm(word.value) * executor.frames.stretch.factor[n];
  }
  if (!executor.frames.stretch.uniform())
    arc_scale(executor.control, executor.place, executor.frames, offset);
  const Vec3 a = between - from, b = to - from, cross = a.cross(b);
  if (!given || !(cross.norm() > kParallel * a.norm() * b.norm()) || !(cross.norm() > 0.0)) {
    fail(executor.place, "bad-arc", offset, "CIP needs three points that are not on one line",
         "write I1= J1= K1= between start and end");
  }
  ArcWords arc;
  arc.normal = cross.normalized();
  arc.centre = from + (a.squaredNorm() * b.cross(cross) + b.squaredNorm() * cross.cross(a)) /
                          (2.0 * cross.squaredNorm());
  send_arc(executor.control, executor.place, executor.path, Motion::kCounterClockwise, target, arc, offset);
}

/// CT: an arc in the plane that goes on in the direction of the last move; a straight line where the end
/// lies ahead.
void circle_tangential(Executor& executor, const Target& target) {
  const size_t offset = executor.place.line->text.find_first_not_of(" \t");
  arc_scale(executor.control, executor.place, executor.frames, offset);
  if (!executor.path.last.valid) {
    fail(executor.place, "bad-arc", offset, "CT goes on in the direction of the last move, and there is none",
         "write G1 before it, or G2 with a centre");
  }
  const Vec3 normal = Vec3::Unit(nc::axes_of(executor.control.modal.plane).normal);
  const auto flat = [&](const Vec3& v) { return Vec3(v - v.dot(normal) * normal); };
  const Vec3 from = nc::position_xyz(executor.control);
  const Vec3 chord = flat(end_of(target, from) - from), along = flat(executor.path.last.direction);
  if (!(along.norm() > kParallel) || !(chord.norm() > kSamePoint)) {
    fail(executor.place, "bad-arc", offset, "CT has no direction or no way in the plane",
         "write the arc with its centre");
  }
  const Vec3 left = normal.cross(along.normalized());
  const double side = left.dot(chord.normalized());
  if (std::abs(side) < kParallel) {
    if (along.dot(chord) < 0.0)
      fail(executor.place, "bad-arc", offset, "the end lies straight behind: no arc leads there",
           "write the arc with its centre");
    straight(executor.control, executor.path, Motion::kFeed, target);
    return;
  }
  ArcWords arc;
  arc.centre = from + left * (chord.squaredNorm() / (2.0 * left.dot(chord)));
  send_arc(executor.control, executor.place, executor.path,
           side > 0.0 ? Motion::kCounterClockwise : Motion::kClockwise, target, arc, offset);
}

/// SUPA, G53, G153: without offsets and frames; the tool length stays as it is (D0 takes it out).
void machine_move(Executor& executor, const BlockWords& words) {
  const size_t offset = executor.place.line->text.find_first_not_of(" \t");
  if (executor.frames.traori) {
    fail(executor.place, "unsupported-word", offset, "machine coordinates under TRAORI are not supported",
         "write TRAFOOF before it");
  }
  if (executor.modes.motion != kG0 && executor.modes.motion != kG1) {
    fail(executor.place, "words-conflict", offset,
         "machine coordinates take G0 or G1, another motion is active", "write G0 in this block");
  }
  Target target = target_of(executor, words, true);
  orientation(executor.place, executor.frames, words, target);
  if (executor.control.tools.length_on) {
    const int normal = nc::axes_of(executor.control.modal.plane).normal;
    if (target.has(normal)) target.value[static_cast<size_t>(normal)] += executor.control.space.length();
  }
  nc::machine_line(executor.control, executor.modes.motion == kG0 ? Motion::kRapid : Motion::kFeed, target);
  executor.path.last.valid = false;
}

/// G4 F seconds, G4 S turns of the spindle.
void dwell(nc::Control& control, BlockPlace& place, const BlockWords& words) {
  if (words.moves()) {
    fail(place, "words-conflict", words.motion_offset, "G4 stands in a block with a motion",
         "write it in a block of its own");
  }
  if (static_cast<bool>(words.feed) == static_cast<bool>(words.speed)) {
    fail(place, "missing-word", words.motion_offset, "G4 needs F (seconds) or S (turns of the spindle)",
         "G4 F1.5");
  }
  const Amount& amount = words.feed ? words.feed : words.speed;
  if (!(amount.value >= 0.0)) fail(place, "out-of-range", amount.offset, "a dwell below zero", "G4 F1.5");
  const double rpm = control.modal.spindle == 0 ? 0.0 : control.modal.speed_rpm;
  if (words.speed && rpm <= 0.0) {
    fail(place, "feed-without-spindle", amount.offset, "G4 S counts turns of the spindle, which stands",
         "G4 F1.5");
  }
  nc::dwell(control.report, control.modal, words.feed ? amount.value : amount.value * 60.0 / rpm);
}

/// G74: the reference points (home); G75: the fixed point, which is where tools are changed.
void approach_point(Executor& executor, const BlockWords& words, int code) {
  const kinematics::MachineModel& machine = executor.control.setup.machine;
  if (code == kG75 && !machine.tool_change) {
    fail(executor.place, "unsupported-word", words.motion_offset,
         "G75 goes to a fixed point, which the machine file does not give",
         "add [tool_change] to the machine file, or write SUPA G0 with the position");
  }
  if (executor.frames.traori)
    fail(executor.place, "unsupported-word", words.motion_offset, "G74 and G75 under TRAORI",
         "write TRAFOOF before it");
  Target target;
  for (size_t n = 0; n < words.axes.size(); ++n) {
    if (!words.axes[n]) continue;
    const int word = static_cast<int>(n);
    const int axis = nc::require_axis(executor.control, static_cast<nc::AxisWord>(word),
                                      column(executor.place, words.axes[n].offset));
    const double home = machine.axes[static_cast<size_t>(axis)].home;
    target.set(word, code == kG74 ? home : (*machine.tool_change)[axis], false);
  }
  if (!target.any())
    fail(executor.place, "missing-word", words.motion_offset, "G74 and G75 name their axes",
         "G74 X1=0 Y1=0 Z1=0");
  nc::machine_line(executor.control, Motion::kRapid, target);
  executor.path.last.valid = false;
}

/// Words of motions in a block in which nothing moves.
void refuse_arc_words_at_rest(const BlockPlace& place, const BlockWords& words) {
  if (const Coefficients* divisor = first_polynomial(words)) {
    fail(place, "unexpected-word", divisor->offset, "PO[] stands without polynomials of axes",
         "PO[X]=(0,-10) PO[Y]=(10) PO[]=(2,1)");
  }
  for (const Amount* word : {&words.radius, &words.opening, &words.turns}) {
    if (*word)
      fail(place, "unexpected-word", word->offset, "this word belongs to an arc, and nothing moves here",
           "write the end of the arc");
  }
}

/// Words of arcs in a straight move.
void refuse_arc_words(const BlockPlace& place, const BlockWords& words) {
  for (const Coordinate* word : {&words.centre[0], &words.centre[1], &words.centre[2], &words.between[0],
                                 &words.between[1], &words.between[2]}) {
    if (*word)
      fail(place, "unexpected-word", word->offset, "the centre of an arc stands in a straight move",
           "write G2 or G3 in this block");
  }
  for (const Amount* word : {&words.radius, &words.opening, &words.turns}) {
    if (*word)
      fail(place, "unexpected-word", word->offset, "this word belongs to an arc, and the move is straight",
           "write G2 or G3 in this block");
  }
}

/// The motion that holds, to the target.
void move_by(Executor& executor, const BlockWords& words, const Target& target) {
  if (executor.modes.motion == kG0 || executor.modes.motion == kG1) {
    straight(executor.control, executor.path, executor.modes.motion == kG0 ? Motion::kRapid : Motion::kFeed,
             target);
  } else if (executor.modes.motion == kPoly) {
    nc::release_corner(executor.control);  // corners lie between lines and arcs
    if (first_polynomial(words) != nullptr) {
      polynomial(executor, words, target);
    } else {
      straight(executor.control, executor.path, Motion::kFeed, target);
    }
  } else if (executor.modes.motion == kCip) {
    circle_through(executor, words, target);
  } else if (executor.modes.motion == kCt) {
    circle_tangential(executor, target);
  } else {
    circle(executor, words, target);
  }
}

/// G4, G74, G75, G110 to G112.
void other_words(Executor& executor, const BlockWords& words, int code) {
  if (code == kG4) {
    dwell(executor.control, executor.place, words);
  } else if (code == kG110 || code == kG111 || code == kG112) {
    set_pole(executor, words, code);
  } else {
    approach_point(executor, words, code);
  }
}

}  // namespace

double arc_scale(nc::Control& control, const BlockPlace& place, const Frames& frames, size_t offset) {
  const std::optional<double> grown = frames.stretch.in_plane(nc::axes_of(control.modal.plane));
  if (!grown) {
    fail(place, "bad-arc", offset, "the axes of the plane are scaled differently: an arc would be an ellipse",
         "SCALE both axes of the plane alike");
  }
  return *grown;
}

Vec3 end_of(const Target& target, const Vec3& from) {
  Vec3 end = from;
  for (int n = 0; n < 3; ++n) {
    const double value = target.value[static_cast<size_t>(n)];
    if (target.has(n)) end[n] = target.is_incremental(n) ? from[n] + value : value;
  }
  return end;
}

/// One of the plane's axes runs the other way: arcs turn the other way, the cutter goes on the other side.
bool mirrored(nc::Control& control, const Frames& frames) {
  return frames.stretch.turns_over(nc::axes_of(control.modal.plane));
}

void motion_words(Executor& executor, const BlockWords& words) {
  corner_modes(executor.control, executor.place, executor.modes, words);
  cutter_words(executor, words);
  const std::optional<int> other = words.code(Group::kNoMotion);
  const bool polar = words.polar_angle || words.polar_radius;
  const int point = other.value_or(kG4);
  if (polar && (point == kG74 || point == kG75 || words.code(Group::kSuppress))) {
    fail(executor.place, "words-conflict",
         words.polar_angle ? words.polar_angle.offset : words.polar_radius.offset,
         "AP= and RP= stand in a block of machine coordinates", "write the axes");
  }
  if (other) {
    other_words(executor, words, *other);
    return;
  }
  const bool arc =
      executor.modes.motion != kG0 && executor.modes.motion != kG1 && executor.modes.motion != kPoly;
  check_polynomial(executor.control, executor.place, executor.modes, words);
  if (!words.moves()) {
    if (words.angle) return open_line(executor, words);
    refuse_arc_words_at_rest(executor.place, words);
    return;
  }
  if (words.code(Group::kSuppress)) {
    machine_move(executor, words);
    return;
  }
  if (!arc) refuse_arc_words(executor.place, words);
  Target target = target_of(executor, words, false);
  if (polar) polar_end(executor, words, target);
  angle_end(executor, words, target);
  orientation(executor.place, executor.frames, words, target);
  if (executor.frames.traori && target.rotary() && !executor.frames.reference &&
      !executor.frames.interpolation) {
    executor.control.report.warn_once(
        "orientation-assumed", target.column,
        "tool orientations change under TRAORI and the program says not how: ORIWKS (the "
        "great circle) is taken",
        "write ORIWKS, ORIAXES or ORIVECT");
  }
  ask_for_corner(executor.control, executor.place, executor.modes, executor.frames, words);
  move_by(executor, words, target);
  if (executor.calls.modal_cycle)
    drill(executor.control, executor.place, executor.path,
          drilling(executor.control, executor.place, executor.frames, *executor.calls.modal_cycle),
          *executor.calls.modal_cycle);
}

}  // namespace swarf::program::nc::siemens
