// G10, G28, G30, G52, G92: positions and offsets that belong to no modal group.
#include <fmt/format.h>

#include <cmath>

#include "base/units.h"
#include "program/linuxcnc/reader.h"

namespace swarf::program::nc::linuxcnc {

using kinematics::AxisValues;

void LinuxCnc::non_modal() {
  switch (block_.g[kNonModal]) {
    case 100:
      return set_data();
    case 280:
    case 300:
      return reference(block_.g[kNonModal]);
    case 281:
    case 301:
      return set_reference(block_.g[kNonModal]);
    case 520:
      return shift_to_words(false);
    case 920:
      return shift_to_words(true);
    case 921:
      shift_ = AxisValues::Zero();
      shift_on_ = false;
      return update_shift();
    case 922:
      shift_on_ = false;
      return update_shift();
    case 923:
      shift_on_ = true;
      return update_shift();
    default:
      return;  // G4 has been done
  }
}

/// The rotation of the offset stands inside the G92 shift: p turns, the shift does not (RS274/NGC: the shift
/// is added before the turn).
void LinuxCnc::update_shift() {
  const AxisValues on = shift_on_ ? shift_ : AxisValues(AxisValues::Zero());
  const int offset = control_.offsets.active;
  const double turn = offset < 10 ? offset_turn_[static_cast<size_t>(offset)] : 0.0;
  Pose frame = Pose::Identity();
  if (turn != 0.0) frame.linear() = Eigen::AngleAxisd(turn, Vec3::UnitZ()).toRotationMatrix();
  AxisValues rotary = on;
  Vec3 linear = Vec3::Zero();
  for (int i = 0; i < 3; ++i) {
    const int axis = control_.space.axis_of(static_cast<AxisWord>(i));
    linear[i] = on[axis];
    rotary[axis] = 0.0;
  }
  frame.translation() = frame.linear() * linear;
  nc::set_shift(control_, rotary);
  nc::set_frame(control_, frame);
}

void LinuxCnc::set_data() {
  need('L', "G10");
  const int kind = whole(block_, 'L', 0, 20, reader_, control_);
  if (kind == 1 || kind == 10 || kind == 11) {
    need('P', "G10");
    return set_tool_data(kind);
  }
  if (kind != 2 && kind != 20)
    control_.report.fail("unsupported-word", column('L'), fmt::format("G10 L{} is not read", kind),
                         "G10 L1, L10 and L11 write tool data, L2 and L20 offsets");
  need('P', "G10");
  for (const char letter : {'I', 'J', 'Q'}) check_letter(letter, false, "G10 L1");
  int number = whole(block_, 'P', 0, 9, reader_, control_);
  if (number == 0) number = control_.offsets.active;
  const Target words = target_of(block_, false, reader_, control_);
  AxisValues origin = nc::offset_origin(control_.space, control_.offsets, number);
  const std::array<double, kAxisWords> here = nc::position(control_);
  if (block_.has('R')) {
    if (kind != 2)
      control_.report.fail("unexpected-word", column('R'), "R turns an offset with G10 L2 only",
                           "write G10 L2");
    offset_turn_[static_cast<size_t>(number)] = rad_from_deg(block_.get('R'));
  }
  const double turn = offset_turn_[static_cast<size_t>(number)];
  if (kind == 20 && turn != 0.0)
    control_.report.fail("unsupported-word", column('L'),
                         "G10 L20 into an offset that is turned (R) is not supported",
                         "write the offset with G10 L2");
  for (int word = 0; word < kAxisWords; ++word) {
    if (!words.has(word)) continue;
    const int axis = nc::require_axis(control_, static_cast<AxisWord>(word), words.column);
    const double value = words.value[static_cast<size_t>(word)];
    if (kind == 2) {  // G91 has no effect on it
      origin[axis] = value;
      continue;
    }
    if (!std::isfinite(here[static_cast<size_t>(word)]))
      control_.report.fail("start-unknown", words.column,
                           "G10 L20 needs the position, which is not known yet",
                           "give the start position in the scene");
    // In the offset that is active: so that the present position reads `value`.
    origin[axis] = nc::offset_origin(control_.space, control_.offsets, control_.offsets.active)[axis] +
                   here[static_cast<size_t>(word)] - value;
  }
  nc::set_offset_origin(control_, number, origin);
  update_shift();
}

/// G28.1, G30.1: the place where the machine stands is the one that G28, G30 go to.
void LinuxCnc::set_reference(int tenths) {
  if (!control_.path.started)
    control_.report.fail("start-unknown", g_column(kNonModal), "the position to keep is not known yet",
                         "give the start position in the scene");
  nc::flush(control_);
  references_[tenths == 281 ? 0 : 1] = control_.path.q;
}

/// Where G28 (home, or kept by G28.1) and G30 (where tools are changed, or kept by G30.1) go.
std::optional<AxisValues> LinuxCnc::reference_position(bool second) const {
  if (references_[second ? 1 : 0]) return references_[second ? 1 : 0];
  const kinematics::MachineModel& machine = control_.setup.machine;
  if (second) return machine.tool_change;
  AxisValues home = AxisValues::Zero();
  for (size_t i = 0; i < machine.axes.size(); ++i) home[static_cast<long>(i)] = machine.axes[i].home;
  return home;
}

void LinuxCnc::reference(int tenths) {
  const std::optional<AxisValues> goal = reference_position(tenths == 300);
  if (!goal)
    control_.report.fail("no-reference", g_column(kNonModal),
                         "G30 goes to the tool change position, and the machine has none",
                         "add tool_change to the machine file, write G30.1 before it, or write G28");
  const Target words = target_of(block_, incremental_, reader_, control_);
  spline_tangent_.reset();
  if (words.any()) nc::line(control_, Motion::kRapid, words);
  Target home;
  home.column = g_column(kNonModal);
  for (int word = 0; word < kAxisWords; ++word) {
    const int axis = control_.space.axis_of(static_cast<AxisWord>(word));
    if (axis < 0 || (words.any() && !words.has(word))) continue;
    home.set(word, (*goal)[axis], false);
  }
  nc::machine_line(control_, Motion::kRapid, home);
}

/// G92: the present position reads as written. G52: the shift is as written. Axes without a word keep theirs.
void LinuxCnc::shift_to_words(bool position) {
  const Target words = target_of(block_, false, reader_, control_);
  if (!words.any())
    control_.report.fail("missing-word", g_column(kNonModal), "this shift has no axis words",
                         "add the axes that it shifts");
  const std::array<double, kAxisWords> here = nc::position(control_);
  if (!shift_on_) shift_ = AxisValues::Zero();
  for (int word = 0; word < kAxisWords; ++word) {
    if (!words.has(word)) continue;
    const int axis = nc::require_axis(control_, static_cast<AxisWord>(word), words.column);
    const double value = words.value[static_cast<size_t>(word)], now = here[static_cast<size_t>(word)];
    if (position && !std::isfinite(now))
      control_.report.fail("start-unknown", words.column, "G92 needs the position, which is not known yet",
                           "give the start position in the scene");
    shift_[axis] = position ? shift_[axis] + now - value : value;
  }
  shift_on_ = true;
  update_shift();
}

}  // namespace swarf::program::nc::linuxcnc
