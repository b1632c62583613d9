// Frames, TRAORI and the swivel cycle of Siemens 840D.
//
//   F = swivelled (CYCLE800) * programmed (TRANS, ROT ...), on top of the work offset
//   ROT X Y Z, AROT X Y Z:   R = Rz(Z) Ry(Y) Rx(X)             (RPY, MD10600 = 1)
//   CYCLE800, axis by axis:  T(X0 Y0 Z0) R1(_A) R2(_B) R3(_C) T(X1 Y1 Z1), each about the axes turned before
#include <fmt/format.h>

#include <cmath>

#include "base/units.h"
#include "program/nc/siemens_executor.h"
#include "program/nc/siemens_functions.h"

namespace swarf::program::siemens {

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
Mat3 turned(int axis, double angle_deg) {
  const LineRef nowhere;
  const double s = call_function("SIN", {Value::real(angle_deg)}, nowhere, 0).number;
  const double c = call_function("COS", {Value::real(angle_deg)}, nowhere, 0).number;
  const int b = (axis + 1) % 3, d = (axis + 2) % 3;
  Mat3 R = Mat3::Identity();
  R(b, b) = R(d, d) = c;
  R(d, b) = s;
  R(b, d) = -s;
  return R;
}

Pose pose_of(const Mat3& R, const Vec3& t) {
  Pose X = Pose::Identity();
  X.linear() = R;
  X.translation() = t;
  return X;
}

}  // namespace

void Executor::set_frame() {
  control_.set_frame(swivelled_ * programmed_);
  last_.valid = false;
}

Mat3 Executor::rotation_of(const BlockWords& words) const {
  if (words.plane_turn) {
    if (words.any_axis()) {
      fail("words-conflict", words.plane_turn.offset, "ROT takes RPL= or angles about X Y Z, not both",
           "ROT RPL=45");
    }
    return turned(nc::axes_of(control_.plane()).normal, words.plane_turn.value);
  }
  const auto angle = [&](size_t n) { return words.axes[n] ? words.axes[n].value : 0.0; };
  return turned(2, angle(2)) * turned(1, angle(1)) * turned(0, angle(0));
}

/// TRANS and ROT replace the programmable frame as a whole, ATRANS and AROT build on it.
void Executor::frame_words(const BlockWords& words) {
  for (size_t n = 0; n < words.axes.size(); ++n) {
    const Coordinate& word = words.axes[n];
    if (!word) continue;
    if (n >= 3) {
      fail("unsupported-word", word.offset,
           "frames shift and turn X Y Z; rotary axes in frames are not supported",
           "put the angle into the positions, or into the work offset");
    }
    if (word.way != Way::kModal) {
      fail("words-conflict", word.offset, "words of a frame take no AC or IC",
           "ATRANS and AROT add to the frame");
    }
  }
  const int code = *words.frame;
  if (code == kScale || code == kMirror) {
    if (words.any_axis()) {
      fail("unsupported-word", words.frame_offset, "scaled and mirrored frames are not supported",
           "post the program without SCALE and MIRROR");
    }
    programmed_ = Pose::Identity();
    set_frame();
    return;
  }
  const bool shifts = code == kTrans || code == kATrans;
  if (shifts && words.plane_turn) {
    fail("unexpected-word", words.plane_turn.offset, "RPL= belongs to ROT and AROT", "ROT RPL=45");
  }
  Pose step = Pose::Identity();
  if (shifts) {
    for (int n = 0; n < 3; ++n) {
      const Coordinate& word = words.axes[static_cast<size_t>(n)];
      if (word) step.translation()[n] = control_.mm(word.value);
    }
  } else {
    step.linear() = rotation_of(words);
  }
  programmed_ = code == kTrans || code == kRot ? step : Pose(programmed_ * step);
  set_frame();
}

void Executor::transform_words(const BlockWords& words) {
  traori_ = *words.transform == kTraori;
  if (traori_) {
    choose_interpolation();
  } else {
    control_.set_tcp(nc::Tcp::kOff);
    if (swivel_on_) control_.set_coordinates(nc::Coordinates::kWork);
  }
  last_.valid = false;
}

/// ORIWKS and ORIVECT turn the tool along the great circle, ORIMKS and ORIAXES the rotary axes evenly.
void Executor::choose_interpolation() {
  const bool axes = interpolation_ == kOriMks || interpolation_ == kOriAxes;
  control_.set_tcp(axes ? nc::Tcp::kAxes : nc::Tcp::kVector);
}

/// CYCLE800(): no swivelled plane; the programmable frame goes with it.
void Executor::swivel_off() {
  swivelled_ = programmed_ = Pose::Identity();
  set_frame();
  if (swivel_on_ && !traori_) control_.set_coordinates(nc::Coordinates::kAxes);
  swivel_on_ = false;
}

/// Axis by axis: bits 0-1, 2-3, 4-5 of _MODE name the axes of the first, second and third turn (1 X, 2 Y,
/// 3 Z), bits 6-7 are zero.
Pose Executor::swivel_plane(const CycleCall& call) {
  const int mode = whole_argument(call, kMode, *line_, 57);
  if (mode < 0 || mode > 255)
    fail("out-of-range", call.offsets[kMode], fmt::format("_MODE {} has more than 8 bits", mode),
         "57 turns about X, Y, Z");
  if ((mode & 0xC0) != 0) {
    const char* names[] = {"", "solid angles", "projection angles", "rotary axes directly"};
    fail("unsupported-word", call.offsets[kMode],
         fmt::format("CYCLE800 by {} is not supported", names[mode >> 6]),
         "swivel axis by axis: _MODE 57 (X Y Z), 27 (Z Y X), 39 (Z X Y) ...");
  }
  Mat3 R = Mat3::Identity();
  for (int turn = 0; turn < 3; ++turn) {
    const int axis = (mode >> (2 * turn)) & 3;
    const double angle = argument(call, static_cast<size_t>(kA + turn), *line_, 0.0);
    if (axis == 0 && angle != 0.0) {
      fail("out-of-range", call.offsets[kMode],
           fmt::format("_MODE {} names no axis for turn {}", mode, turn + 1), "57 turns about X, Y, Z");
    }
    if (axis != 0) R = R * turned(axis - 1, angle);
  }
  const auto point = [&](size_t first) {
    Vec3 p;
    for (int n = 0; n < 3; ++n)
      p[n] = control_.mm(argument(call, first + static_cast<size_t>(n), *line_, 0.0));
    return p;
  };
  return pose_of(R, point(kX0)) * pose_of(Mat3::Identity(), point(kX1));
}

/// _FR: 0 stays; 1 Z, 2 Z then XY to where tools are changed (home where the machine file gives no such
/// place); 5 by _FR_I along the tool.
void Executor::retract(const CycleCall& call, int how) {
  if (how == 0) return;
  if (how != 1 && how != 2 && how != 5) {
    fail("unsupported-word", call.offsets[kFr], fmt::format("CYCLE800 with _FR {} is not supported", how),
         "0 (none), 1 (Z), 2 (Z, XY) and 5 (along the tool by _FR_I) are");
  }
  if (how == 5) {
    Target away;
    const Vec3 way = control_.mm(argument(call, kFrI, *line_, std::nullopt)) * control_.machine().tool_axis_M;
    for (int n = 0; n < 3; ++n)
      away.set(n, control_.space().linear_of(control_.axis_values())[n] + way[n], false);
    control_.machine_line(Motion::kRapid, away);
    return;
  }
  const kinematics::MachineModel& machine = control_.machine();
  const auto go = [&](std::initializer_list<nc::AxisWord> words) {
    Target target;
    for (const nc::AxisWord word : words) {
      const int axis = control_.require_axis(word, 0);
      target.set(
          word,
          machine.tool_change ? (*machine.tool_change)[axis] : machine.axes[static_cast<size_t>(axis)].home,
          false);
    }
    control_.machine_line(Motion::kRapid, target);
  };
  go({nc::kZ});
  if (how == 2) go({nc::kX, nc::kY});
}

/// CYCLE800(_FR,_TC,_ST,_MODE,X0,Y0,Z0,A,B,C,X1,Y1,Z1,_DIR,_FR_I,_DMODE)
void Executor::swivel(const CycleCall& call) {
  if (call.arguments.empty()) {
    swivel_off();
    return;
  }
  if (call.arguments.size() > kSwivelArguments) {
    fail("wrong-arguments", call.offsets[kSwivelArguments], "CYCLE800 takes at most 16 arguments",
         "_FR, _TC, _ST, _MODE, X0 ...");
  }
  if (traori_)
    fail("unsupported-word", call.offset, "CYCLE800 under TRAORI is not supported",
         "write TRAFOOF before it");
  const int how = whole_argument(call, kFr, *line_, 0);
  if (has_argument(call, kTc) && call.arguments[kTc]->type == Type::kString &&
      call.arguments[kTc]->text == "0") {
    swivel_off();
    return;
  }
  const int state = whole_argument(call, kSt, *line_, 0);
  const int tracking = state / 10 % 10, aligning = state / 100 % 100;
  if (state < 0 || state % 10 > 1 || tracking != 0 || aligning != 0 || state / 10000 % 10 != 0 ||
      state > 299999) {
    fail("unsupported-word", call.offsets[kSt], fmt::format("CYCLE800 with _ST {} is not supported", state),
         "0 (a new plane) and 1 (on top of the last one) are");
  }
  const int direction = whole_argument(call, kDir, *line_, 0);
  if (direction < -1 || direction > 1) {
    fail("out-of-range", call.offsets[kDir], fmt::format("_DIR {} is not a direction", direction),
         "-1, 0 or 1");
  }
  const Pose plane = swivel_plane(call);
  retract(call, how);
  swivelled_ = state % 10 == 1 ? Pose(swivelled_ * programmed_ * plane) : plane;
  programmed_ = Pose::Identity();
  set_frame();
  if (direction != 0) {
    nc::TiltPreference preference;
    preference.choice =
        direction > 0 ? nc::TiltPreference::Choice::kPositive : nc::TiltPreference::Choice::kNegative;
    const auto q = control_.tilt_solution(Vec3::UnitZ(), preference, column(call.offset));
    control_.turn_rotaries(Motion::kRapid, q, false);
  }
  control_.set_coordinates(nc::Coordinates::kWork);
  swivel_on_ = true;
}

}  // namespace swarf::program::siemens
