// M70 to M73: the modal state kept and brought back.
#include <fmt/format.h>

#include <cmath>

#include "program/linuxcnc/steps.h"

namespace swarf::program::nc::linuxcnc {
namespace {

ModalState modal_state(const Modes& modes, const LetterDialect& letters) {
  ModalState state;
  state.inches = letters.control.modal.inches();
  state.incremental = modes.incremental;
  state.unit_known = letters.control.modal.unit_known;
  state.arc_absolute = modes.arc_absolute;
  state.retract_to_r = modes.retract_to_r;
  state.plane = letters.control.modal.plane;
  state.feed_mode = letters.control.modal.feed_mode;
  state.feed = letters.control.modal.feed;
  state.speed_rpm = letters.control.modal.speed_rpm;
  state.spindle = letters.control.modal.spindle;
  state.work_offset = letters.control.offsets.active;
  state.tool_number = letters.control.tools.active_number;
  state.radius_code = modes.radius_code;
  state.diameter_mm = modes.diameter_mm;
  state.length_mm = letters.control.space.length();
  state.length_on = letters.control.tools.length_on;
  state.exact_stop = letters.control.modal.exact_stop;
  state.corner_tolerance_mm = letters.control.modal.corner_tolerance_mm;
  state.mist = modes.mist;
  state.flood = modes.flood;
  return state;
}

}  // namespace

/// M70 keeps the state of this call level, M73 as well and brings it back when the subprogram ends, M71
/// forgets it, M72 brings it back.
void apply_saved_state(LinuxCnc& linuxcnc, int tenths, int column) {
  Call& call = frame(linuxcnc.calls);
  if (tenths == M::kRestoreState) {
    if (!call.saved)
      linuxcnc.control.report.fail("nothing-saved", column,
                                   "M72 restores the modal state, and none was kept at this call level",
                                   "write M70 before it, in the same subprogram");
    return restore(linuxcnc.modes, linuxcnc.zero, linuxcnc, *call.saved, column);
  }
  call.saved.reset();
  call.restores = tenths == M::kSaveAndRestoreState;
  if (tenths != M::kForgetState) call.saved = modal_state(linuxcnc.modes, linuxcnc);
}

/// Nothing moves. G41 and G42 cannot come back without a lead-in, and the length of a tool that has been
/// changed since is no state: both are refused.
void restore(Modes& modes, Zero& zero, LetterDialect& letters, const ModalState& state, int column) {
  const bool same_cutter = modes.radius_code == state.radius_code && modes.diameter_mm == state.diameter_mm;
  if (state.radius_code != G::kCompensationOff && !same_cutter)
    letters.control.report.fail("unsupported-word", column,
                                "restoring the state would switch cutter radius compensation on again",
                                "write G40 before the state is kept");
  if (modes.radius_code != state.radius_code)
    nc::set_compensation(letters.control, Compensation::kOff, 0.0, column);
  modes.radius_code = state.radius_code;
  const bool same_length =
      letters.control.tools.length_on == state.length_on && letters.control.space.length() == state.length_mm;
  if (!same_length && state.length_on && letters.control.tools.active_number != state.tool_number)
    letters.control.report.fail(
        "unsupported-word", column,
        fmt::format("the tool changed from T{} to T{} since the state was kept: which length comes back is "
                    "not documented",
                    state.tool_number, letters.control.tools.active_number),
        "write G49 before the state is kept and G43 after it is restored");
  nc::set_inches(letters.control.modal, state.inches);
  letters.control.modal.unit_known = state.unit_known;
  nc::set_plane(letters.control, state.plane);
  modes.incremental = state.incremental;
  modes.arc_absolute = state.arc_absolute;
  modes.retract_to_r = state.retract_to_r;
  nc::restore_feed(letters.control.modal, state.feed_mode, state.feed);
  letters.control.modal.speed_rpm = state.speed_rpm;
  letters.control.modal.spindle = state.spindle;
  letters.control.modal.exact_stop = state.exact_stop;
  letters.control.modal.corner_tolerance_mm = state.corner_tolerance_mm;
  modes.mist = state.mist;
  modes.flood = state.flood;
  if (!same_length) nc::set_length_compensation(letters.control, state.length_mm, state.length_on);
  if (letters.control.offsets.active == state.work_offset) return;
  nc::set_work_offset(letters.control, state.work_offset);
  update_shift(zero, letters);
}

}  // namespace swarf::program::nc::linuxcnc
