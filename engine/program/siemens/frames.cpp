// Frames, TRAORI and the swivel cycle of Siemens 840D.
//
//   F = swivelled (CYCLE800) * programmed (TRANS, ROT ...), on top of the work offset
//   ROT X Y Z, AROT X Y Z:   R = Rz(Z) Ry(Y) Rx(X)             (RPY, MD10600 = 1)
//   CYCLE800, axis by axis:  T(X0 Y0 Z0) R1(_A) R2(_B) R3(_C) T(X1 Y1 Z1), each about the axes turned before
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angles.h"
#include "base/units.h"
#include "program/siemens/functions.h"
#include "program/siemens/steps.h"

namespace swarf::program::nc::siemens {

using nc::Motion;

using nc::Target;

namespace {

/// Arguments of CYCLE800 in their order.
enum Swivel {
  kFr,
  kTc,
  kSt,
  kMode,
  kX0,
  kY0,
  kZ0,
  kA,
  kB,
  kC,
  kX1,
  kY1,
  kZ1,
  kDir,
  kFrI,
  kDMode,
  kSwivelArguments
};

/// Rotation by an angle in degrees about X, Y or Z; exact at multiples of 90 degrees.
Mat3 rotation_about(int axis, double angle_deg) {
  const LineRef nowhere;
  const double s = call_function("SIN", {Value::real(angle_deg)}, nowhere, 0).number;
  const double c = call_function("COS", {Value::real(angle_deg)}, nowhere, 0).number;
  return axis_rotation(axis, s, c);
}

Pose pose_of(const Mat3& R, const Vec3& t) {
  Pose X = Pose::Identity();
  X.linear() = R;
  X.translation() = t;
  return X;
}

void set_frame(nc::Control& control, Frames& frames, PathWords& path) {
  nc::set_frame(control, frames.swivelled * frames.programmed);
  path.last.valid = false;
}

Mat3 rotation_of(nc::Control& control, const BlockPlace& place, const BlockWords& words) {
  if (words.plane_turn) {
    if (words.any_axis()) {
      fail(place, "words-conflict", words.plane_turn.offset, "ROT takes RPL= or angles about X Y Z, not both",
           "ROT RPL=45");
    }
    return rotation_about(nc::axes_of(control.modal.plane).normal, words.plane_turn.value);
  }
  const auto angle = [&](size_t n) { return words.axes[n] ? words.axes[n].value : 0.0; };
  return rotation_about(2, angle(2)) * rotation_about(1, angle(1)) * rotation_about(0, angle(0));
}

/// SCALE X2 Y2, MIRROR X0: factors of the axes, from the zero of the frame.
void scale_words(BlockPlace& place, Frames& frames, const BlockWords& words, bool mirrors) {
  for (int n = 0; n < 3; ++n) {
    const Coordinate& word = words.axes[static_cast<size_t>(n)];
    if (!word) continue;
    if (mirrors && word.value != 0.0) {
      fail(place, "out-of-range", word.offset, "MIRROR names its axes with the value 0", "MIRROR X0");
    }
    if (!mirrors && !(word.value > 0.0 && word.value <= 1e6)) {
      fail(place, "out-of-range", word.offset, fmt::format("{:g} is no factor of SCALE", word.value),
           "SCALE X1.5 Y1.5");
    }
    frames.stretch.factor[n] *= mirrors ? -1.0 : word.value;
  }
}

/// CYCLE800(): no swivelled plane; the programmable frame goes with it.
void swivel_off(nc::Control& control, Frames& frames, PathWords& path) {
  frames.swivelled = frames.programmed = Pose::Identity();
  frames.stretch.factor = Vec3::Ones();
  set_frame(control, frames, path);
  if (frames.swivel_on && !frames.traori) nc::set_coordinates(control, nc::Coordinates::kAxes);
  frames.swivel_on = false;
}

/// Axis by axis: bits 0-1, 2-3, 4-5 of _MODE name the axes of the first, second and third turn (1 X, 2 Y,
/// 3 Z), bits 6-7 are zero. Solid angles (bit 6): Rz(_A) Ry(_B), the second on top of the first.
Pose swivel_plane(nc::Control& control, BlockPlace& place, const CycleCall& call) {
  const int mode = whole_argument(call, kMode, *place.line, 57);
  if (mode < 0 || mode > 255)
    fail(place, "out-of-range", call.offsets[kMode], fmt::format("_MODE {} has more than 8 bits", mode),
         "57 turns about X, Y, Z");
  const auto angle = [&](int turn) {
    return argument(call, static_cast<size_t>(kA + turn), *place.line, 0.0);
  };
  if ((mode & 0xC0) > 0x40) {
    fail(place, "unsupported-word", call.offsets[kMode],
         fmt::format("CYCLE800 by {} is not supported",
                     (mode & 0xC0) == 0x80 ? "projection angles" : "rotary axes directly"),
         "swivel axis by axis, _MODE 57 (X Y Z), 27 (Z Y X), 39 (Z X Y) ..., or by solid angles, _MODE 64");
  }
  Mat3 R = Mat3::Identity();
  const bool solid = (mode & 0x40) != 0;
  if (solid && angle(2) != 0.0) {
    fail(place, "out-of-range", call.offsets[kC], "solid angles are two: about Z, then about Y",
         "leave _C out");
  }
  if (solid) R = rotation_about(2, angle(0)) * rotation_about(1, angle(1));
  for (int turn = 0; turn < 3 && !solid; ++turn) {
    const int axis = (mode >> (2 * turn)) & 3;
    if (axis == 0 && angle(turn) != 0.0) {
      fail(place, "out-of-range", call.offsets[kMode],
           fmt::format("_MODE {} names no axis for turn {}", mode, turn + 1), "57 turns about X, Y, Z");
    }
    if (axis != 0) R = R * rotation_about(axis - 1, angle(turn));
  }
  const auto point = [&](size_t first) {
    Vec3 p;
    for (int n = 0; n < 3; ++n)
      p[n] = control.modal.mm(argument(call, first + static_cast<size_t>(n), *place.line, 0.0));
    return p;
  };
  return pose_of(R, point(kX0)) * pose_of(Mat3::Identity(), point(kX1));
}

/// How far the linear axes can still go along the tool, mm.
double travel_along_tool(nc::Control& control, const BlockPlace& place, const CycleCall& call) {
  const kinematics::MachineModel& machine = control.setup.machine;
  const Vec3 here = control.space.linear_of(control.path.q);
  double distance = std::numeric_limits<double>::infinity();
  for (int n = 0; n < 3; ++n) {
    const double along = machine.tool_axis_M[n];
    if (std::abs(along) < 1e-12) continue;
    const kinematics::Axis& axis =
        machine.axes[static_cast<size_t>(control.space.axis_of(static_cast<nc::AxisWord>(n)))];
    distance = std::min(distance, ((along > 0.0 ? axis.max : axis.min) - here[n]) / along);
  }
  if (std::isfinite(distance) && control.path.started) return std::max(0.0, distance);
  fail(place, "unsupported-word", call.offset,
       "_FR 4 goes to the end of travel, which this machine or the start does not say",
       "give the travel of the axes and the start, or _FR 5 with _FR_I");
}

/// _FR: 0 stays; 4 and 5 along the tool, to the end of travel or by _FR_I; 1 Z, 2 Z then XY to where tools
/// are changed (home where the machine file gives no such place); 5 by _FR_I along the tool.
void retract(nc::Control& control, BlockPlace& place, const CycleCall& call, int how) {
  if (how == 0) return;
  if (how != 1 && how != 2 && how != 4 && how != 5) {
    fail(place, "unsupported-word", call.offsets[kFr],
         fmt::format("CYCLE800 with _FR {} is not supported", how),
         "0 (none), 1 (Z), 2 (Z, XY), 4 (along the tool to the end of travel) and 5 (along the tool by "
         "_FR_I) are");
  }
  if (how == 4 || how == 5) {
    Target away;
    const double distance = how == 4 ? travel_along_tool(control, place, call)
                                     : control.modal.mm(argument(call, kFrI, *place.line, std::nullopt));
    const Vec3 way = distance * control.setup.machine.tool_axis_M;
    for (int n = 0; n < 3; ++n) away.set(n, control.space.linear_of(control.path.q)[n] + way[n], false);
    nc::machine_line(control, Motion::kRapid, away);
    return;
  }
  const kinematics::MachineModel& machine = control.setup.machine;
  const auto go = [&](std::initializer_list<nc::AxisWord> words) {
    Target target;
    for (const nc::AxisWord word : words) {
      const int axis = nc::require_axis(control, word, 0);
      target.set(
          word,
          machine.tool_change ? (*machine.tool_change)[axis] : machine.axes[static_cast<size_t>(axis)].home,
          false);
    }
    nc::machine_line(control, Motion::kRapid, target);
  };
  go({nc::kZ});
  if (how == 2) go({nc::kX, nc::kY});
}

}  // namespace

/// TRANS and ROT replace the programmable frame as a whole, ATRANS and AROT build on it.
void frame_words(Executor& executor, const BlockWords& words) {
  for (size_t n = 0; n < words.axes.size(); ++n) {
    const Coordinate& word = words.axes[n];
    if (!word) continue;
    if (n >= 3) {
      fail(executor.place, "unsupported-word", word.offset,
           "frames shift and turn X Y Z; rotary axes in frames are not supported",
           "put the angle into the positions, or into the work offset");
    }
    if (word.way != Way::kModal) {
      fail(executor.place, "words-conflict", word.offset, "words of a frame take no AC or IC",
           "ATRANS and AROT add to the frame");
    }
  }
  const int code = *words.frame;
  const bool replaces = code == kTrans || code == kRot || code == kScale || code == kMirror;
  if (code == kScale || code == kMirror || code == kAScale || code == kAMirror) {
    if (words.plane_turn)
      fail(executor.place, "unexpected-word", words.plane_turn.offset, "RPL= belongs to ROT and AROT",
           "ROT RPL=45");
    if (replaces) {
      executor.frames.programmed = Pose::Identity();
      executor.frames.stretch.factor = Vec3::Ones();
    }
    scale_words(executor.place, executor.frames, words, code == kMirror || code == kAMirror);
    set_frame(executor.control, executor.frames, executor.path);
    return;
  }
  const bool shifts = code == kTrans || code == kATrans;
  if (shifts && words.plane_turn) {
    fail(executor.place, "unexpected-word", words.plane_turn.offset, "RPL= belongs to ROT and AROT",
         "ROT RPL=45");
  }
  if (replaces) {
    executor.frames.programmed = Pose::Identity();
    executor.frames.stretch.factor = Vec3::Ones();
  }
  Pose step = Pose::Identity();
  if (shifts) {
    for (int n = 0; n < 3; ++n) {
      const Coordinate& word = words.axes[static_cast<size_t>(n)];
      if (word)
        step.translation()[n] = executor.control.modal.mm(word.value) * executor.frames.stretch.factor[n];
    }
  } else {
    // Within a scaled and mirrored frame S = diag(shape) the turn R becomes S R S^-1, rigid if all scales
    // agree.
    if (!executor.frames.stretch.uniform()) {
      fail(executor.place, "unsupported-word", words.frame_offset,
           "a turn within axes that are scaled differently is not supported", "write AROT before ASCALE");
    }
    const Mat3 signs = Mat3(executor.frames.stretch.factor.cwiseSign().asDiagonal());
    step.linear() = signs * rotation_of(executor.control, executor.place, words) * signs;
  }
  executor.frames.programmed = executor.frames.programmed * step;
  set_frame(executor.control, executor.frames, executor.path);
}

void transform_words(Executor& executor, const BlockWords& words) {
  if (*words.transform == kTraori && executor.modes.feed_of_rotaries) {
    fail(executor.place, "unsupported-word", words.other_offset,
         "TRAORI while FGROUP has rotary axes is not supported", "write FGROUP(X,Y,Z) before it");
  }
  executor.frames.traori = *words.transform == kTraori;
  if (executor.frames.traori) {
    choose_interpolation(executor.control, executor.frames);
  } else {
    nc::set_tcp(executor.control, nc::Tcp::kOff);
    if (executor.frames.swivel_on) nc::set_coordinates(executor.control, nc::Coordinates::kWork);
  }
  executor.path.last.valid = false;
}

/// ORIWKS and ORIVECT turn the tool along the great circle, ORIMKS and ORIAXES the rotary axes evenly. Both
/// pairs are groups of their own; a program with the second one is posted for machines where it decides
/// (MD21104 = 1).
void choose_interpolation(nc::Control& control, Frames& frames) {
  const bool axes = frames.interpolation ? frames.interpolation == kOriAxes : frames.reference == kOriMks;
  if (frames.interpolation && frames.reference && axes != (frames.reference == kOriMks)) {
    control.report.warn_once(
        "orientation-words", 0,
        axes ? "ORIWKS and ORIAXES are both given: ORIAXES says how orientations are interpolated"
             : "ORIMKS and ORIVECT are both given: ORIVECT says how orientations are interpolated",
        "on a machine whose MD21104 is 0, ORIWKS and ORIMKS say it: leave the other word out");
  }
  nc::set_tcp(control, axes ? nc::Tcp::kAxes : nc::Tcp::kVector);
}

/// CYCLE800(_FR,_TC,_ST,_MODE,X0,Y0,Z0,A,B,C,X1,Y1,Z1,_DIR,_FR_I,_DMODE)
void swivel(Executor& executor, const CycleCall& call) {
  if (call.arguments.empty()) {
    swivel_off(executor.control, executor.frames, executor.path);
    return;
  }
  if (call.arguments.size() > kSwivelArguments) {
    fail(executor.place, "wrong-arguments", call.offsets[kSwivelArguments],
         "CYCLE800 takes at most 16 arguments", "_FR, _TC, _ST, _MODE, X0 ...");
  }
  if (executor.frames.traori)
    fail(executor.place, "unsupported-word", call.offset, "CYCLE800 under TRAORI is not supported",
         "write TRAFOOF before it");
  const int how = whole_argument(call, kFr, *executor.place.line, 0);
  if (has_argument(call, kTc) && call.arguments[kTc]->type == Type::kString &&
      call.arguments[kTc]->text == "0") {
    swivel_off(executor.control, executor.frames, executor.path);
    return;
  }
  const int state = whole_argument(call, kSt, *executor.place.line, 0);
  const int tracking = state / 10 % 10, aligning = state / 100 % 100;
  if (state < 0 || state % 10 > 1 || tracking != 0 || aligning != 0 || state / 10000 % 10 != 0 ||
      state > 299999) {
    fail(executor.place, "unsupported-word", call.offsets[kSt],
         fmt::format("CYCLE800 with _ST {} is not supported", state),
         "0 (a new plane) and 1 (on top of the last one) are");
  }
  const int direction = whole_argument(call, kDir, *executor.place.line, 0);
  if (direction < -1 || direction > 1) {
    fail(executor.place, "out-of-range", call.offsets[kDir],
         fmt::format("_DIR {} is not a direction", direction), "-1, 0 or 1");
  }
  if (state % 10 == 1 && executor.frames.stretch.factor != Vec3(Vec3::Ones())) {
    fail(executor.place, "unsupported-word", call.offset,
         "a plane on top of a scaled or mirrored frame is not supported", "write TRANS before it");
  }
  const Pose plane = swivel_plane(executor.control, executor.place, call);
  retract(executor.control, executor.place, call, how);
  executor.frames.swivelled =
      state % 10 == 1 ? Pose(executor.frames.swivelled * executor.frames.programmed * plane) : plane;
  executor.frames.programmed = Pose::Identity();
  executor.frames.stretch.factor = Vec3::Ones();
  set_frame(executor.control, executor.frames, executor.path);
  if (direction != 0) {
    nc::TiltPreference preference;
    preference.choice =
        direction > 0 ? nc::TiltPreference::Choice::kPositive : nc::TiltPreference::Choice::kNegative;
    const auto q =
        nc::tilt_solution(executor.control, Vec3::UnitZ(), preference, column(executor.place, call.offset));
    nc::turn_rotaries(executor.control, Motion::kRapid, q, false);
  }
  nc::set_coordinates(executor.control, nc::Coordinates::kWork);
  executor.frames.swivel_on = true;
}

}  // namespace swarf::program::nc::siemens
