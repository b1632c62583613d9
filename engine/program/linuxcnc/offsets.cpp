// G10, G28, G30, G52, G92: positions and offsets that belong to no modal group.
#include <fmt/format.h>

#include <cmath>

#include "base/units.h"
#include "program/linuxcnc/steps.h"

namespace swarf::program::nc::linuxcnc {

using kinematics::AxisValues;

namespace {

Vec3 linear_of(const LetterDialect& letters, const AxisValues& values) {
  Vec3 linear;
  for (int i = 0; i < 3; ++i) linear[i] = values[letters.control.space.axis_of(i)];
  return linear;
}

Mat3 turn_of(const Zero& zero, int offset) {
  return Eigen::AngleAxisd(offset < 10 ? zero.offset_turn[static_cast<size_t>(offset)] : 0.0, Vec3::UnitZ())
      .toRotationMatrix();
}

/// The origin of an offset in which the present position reads as the words say; what they leave out reads on
/// as it did. The machine stands at O + R (reading + shift) in the active offset and in this one.
AxisValues origin_that_reads(const Zero& zero, LetterDialect& letters, int number, const Target& words) {
  const Offsets& offsets = letters.control.offsets;
  AxisValues origin = nc::offset_origin(letters.control.space, offsets, number);
  const AxisValues active = nc::offset_origin(letters.control.space, offsets, offsets.active);
  const std::array<double, kAxisWords> here = nc::position(letters.control);
  const Mat3 R_active = turn_of(zero, offsets.active), R = turn_of(zero, number);
  const bool turned = !R_active.isIdentity(0.0) || !R.isIdentity(0.0);
  const bool both = turned && (words.has(kX) || words.has(kY));
  const auto set = [&](int word) { return words.has(word) || (both && word <= kY); };
  for (int word = 0; word < kAxisWords; ++word) {
    if (!set(word)) continue;
    const int axis = nc::require_axis(letters.control, static_cast<AxisWord>(word), words.column);
    const auto slot = static_cast<size_t>(word);
    if (!std::isfinite(here[slot]))
      letters.control.report.fail(
          "start-unknown", words.column, "G10 L20 needs the position, which is not known yet",
          "give the start position: start in [setup] of the scene, swarf check --home");
    if (word >= kA) origin[axis] = active[axis] + here[slot] - words.value[slot];
  }
  Vec3 shift = zero.shift_on ? linear_of(letters, zero.shift) : Vec3(Vec3::Zero()), position;
  for (int i = 0; i < 3; ++i) {
    position[i] = std::isfinite(here[static_cast<size_t>(i)]) ? here[static_cast<size_t>(i)] : 0.0;
  }
  const Vec3 machine = linear_of(letters, active) + R_active * (position + shift);
  Vec3 reading = R.transpose() * (machine - linear_of(letters, origin)) - shift;
  for (int i = 0; i < 3; ++i) {
    if (words.has(i)) reading[i] = words.value[static_cast<size_t>(i)];
  }
  const Vec3 linear = machine - R * (reading + shift);
  for (int i = 0; i < 3; ++i) {
    if (set(i)) origin[letters.control.space.axis_of(i)] = linear[i];
  }
  return origin;
}

void set_data(Zero& zero, LetterDialect& letters) {
  letters.need('L', "G10");
  const int kind = whole(letters.block, 'L', 0, 20, letters.reader, letters.control);
  if (kind == 1 || kind == 10 || kind == 11) {
    letters.need('P', "G10");
    return set_tool_data(zero, letters, kind);
  }
  if (kind != 2 && kind != 20)
    letters.control.report.fail("unsupported-word", letters.column('L'),
                                fmt::format("G10 L{} is not read", kind),
                                "G10 L1, L10 and L11 write tool data, L2 and L20 offsets");
  letters.need('P', "G10");
  for (const char letter : {'I', 'J', 'Q'}) letters.check_letter(letter, false, "G10 L1");
  int number = whole(letters.block, 'P', 0, 9, letters.reader, letters.control);
  if (number == 0) number = letters.control.offsets.active;
  const Target words = target_of(letters.block, false, letters.reader, letters.control);
  AxisValues origin = nc::offset_origin(letters.control.space, letters.control.offsets, number);
  if (letters.block.has('R')) {
    if (kind != 2)
      letters.control.report.fail("unexpected-word", letters.column('R'),
                                  "R turns an offset with G10 L2 only", "write G10 L2");
    zero.offset_turn[static_cast<size_t>(number)] = rad_from_deg(letters.block.get('R'));
  }
  for (int word = 0; kind == 2 && word < kAxisWords; ++word) {  // G91 has no effect on it
    if (!words.has(word)) continue;
    const int axis = nc::require_axis(letters.control, static_cast<AxisWord>(word), words.column);
    origin[axis] = words.value[static_cast<size_t>(word)];
  }
  if (kind == 20) origin = origin_that_reads(zero, letters, number, words);
  nc::set_offset_origin(letters.control, number, origin);
  update_shift(zero, letters);
}

/// G28.1, G30.1: the place where the machine stands is the one that G28, G30 go to.
void set_reference(Zero& zero, LetterDialect& letters, int tenths) {
  if (!letters.control.path.started)
    letters.control.report.fail("start-unknown", letters.g_column(kNonModal),
                                "the position to keep is not known yet",
                                "give the start position: start in [setup] of the scene, swarf check --home");
  nc::flush(letters.control);
  zero.references[tenths == G::kSetReference ? 0 : 1] = letters.control.path.q;
}

void reference(LinuxCnc& linuxcnc, int tenths) {
  const std::optional<AxisValues> goal =
      reference_position(linuxcnc.zero, linuxcnc, tenths == G::kToSecondReference);
  if (!goal)
    linuxcnc.control.report.fail("no-reference", linuxcnc.g_column(kNonModal),
                                 "G30 goes to the tool change position, and the machine has none",
                                 "add tool_change to the machine file, write G30.1 before it, or write G28");
  const Target words =
      target_of(linuxcnc.block, linuxcnc.modes.incremental, linuxcnc.reader, linuxcnc.control);
  linuxcnc.curves.spline_tangent.reset();
  if (words.any()) nc::line(linuxcnc.control, Motion::kRapid, words);
  Target home;
  home.column = linuxcnc.g_column(kNonModal);
  for (int word = 0; word < kAxisWords; ++word) {
    const int axis = linuxcnc.control.space.axis_of(static_cast<AxisWord>(word));
    if (axis < 0 || (words.any() && !words.has(word))) continue;
    home.set(word, (*goal)[axis], false);
  }
  nc::machine_line(linuxcnc.control, Motion::kRapid, home);
}

/// G92: the present position reads as written. G52: the shift is as written. Axes without a word keep theirs.
void shift_to_words(Zero& zero, LetterDialect& letters, bool position) {
  const Target words = target_of(letters.block, false, letters.reader, letters.control);
  if (!words.any())
    letters.control.report.fail("missing-word", letters.g_column(kNonModal), "this shift has no axis words",
                                "add the axes that it shifts");
  const std::array<double, kAxisWords> here = nc::position(letters.control);
  if (!zero.shift_on) zero.shift = AxisValues::Zero();
  for (int word = 0; word < kAxisWords; ++word) {
    if (!words.has(word)) continue;
    const int axis = nc::require_axis(letters.control, static_cast<AxisWord>(word), words.column);
    const double value = words.value[static_cast<size_t>(word)], now = here[static_cast<size_t>(word)];
    if (position && !std::isfinite(now))
      letters.control.report.fail(
          "start-unknown", words.column, "G92 needs the position, which is not known yet",
          "give the start position: start in [setup] of the scene, swarf check --home");
    zero.shift[axis] = position ? zero.shift[axis] + now - value : value;
  }
  zero.shift_on = true;
  update_shift(zero, letters);
}

}  // namespace

void non_modal(LinuxCnc& linuxcnc) {
  switch (linuxcnc.block.g[kNonModal]) {
    case G::kSetData:
      return set_data(linuxcnc.zero, linuxcnc);
    case G::kToReference:
    case G::kToSecondReference:
      return reference(linuxcnc, linuxcnc.block.g[kNonModal]);
    case G::kSetReference:
    case G::kSetSecondReference:
      return set_reference(linuxcnc.zero, linuxcnc, linuxcnc.block.g[kNonModal]);
    case G::kLocalShift:
      return shift_to_words(linuxcnc.zero, linuxcnc, false);
    case G::kShift:
      return shift_to_words(linuxcnc.zero, linuxcnc, true);
    case G::kShiftClear:
      linuxcnc.zero.shift = AxisValues::Zero();
      linuxcnc.zero.shift_on = false;
      return update_shift(linuxcnc.zero, linuxcnc);
    case G::kShiftOff:
      linuxcnc.zero.shift_on = false;
      return update_shift(linuxcnc.zero, linuxcnc);
    case G::kShiftRestore:
      linuxcnc.zero.shift_on = true;
      return update_shift(linuxcnc.zero, linuxcnc);
    default:
      return;  // G4 has been done
  }
}

/// The rotation of the offset stands inside the G92 shift: p turns, the shift does not (RS274/NGC: the shift
/// is added before the turn).
void update_shift(Zero& zero, LetterDialect& letters) {
  const AxisValues on = zero.shift_on ? zero.shift : AxisValues(AxisValues::Zero());
  const int offset = letters.control.offsets.active;
  const double turn = offset < 10 ? zero.offset_turn[static_cast<size_t>(offset)] : 0.0;
  Pose frame = Pose::Identity();
  if (turn != 0.0) frame.linear() = Eigen::AngleAxisd(turn, Vec3::UnitZ()).toRotationMatrix();
  AxisValues rotary = on;
  Vec3 linear = Vec3::Zero();
  for (int i = 0; i < 3; ++i) {
    const int axis = letters.control.space.axis_of(static_cast<AxisWord>(i));
    linear[i] = on[axis];
    rotary[axis] = 0.0;
  }
  frame.translation() = frame.linear() * linear;
  nc::set_shift(letters.control, rotary);
  nc::set_frame(letters.control, frame);
}

/// Where G28 (home, or kept by G28.1) and G30 (where tools are changed, or kept by G30.1) go.
std::optional<AxisValues> reference_position(const Zero& zero, const LetterDialect& letters, bool second) {
  if (zero.references[second ? 1 : 0]) return zero.references[second ? 1 : 0];
  const kinematics::MachineModel& machine = letters.control.setup.machine;
  if (second) return machine.tool_change;
  AxisValues home = AxisValues::Zero();
  for (size_t i = 0; i < machine.axes.size(); ++i) home[static_cast<long>(i)] = machine.axes[i].home;
  return home;
}

}  // namespace swarf::program::nc::linuxcnc
