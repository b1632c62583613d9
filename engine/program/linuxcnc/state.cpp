// M70 to M73: the modal state kept and brought back.
#include <fmt/format.h>

#include <cmath>

#include "program/linuxcnc/reader.h"

namespace swarf::program::nc::linuxcnc {

/// M70 keeps the state of this call level, M73 as well and brings it back when the subprogram ends, M71
/// forgets it, M72 brings it back.
void LinuxCnc::apply_saved_state(int tenths, int column) {
  Call& call = frame();
  if (tenths == 720) {
    if (!call.saved)
      control_.report.fail("nothing-saved", column,
                           "M72 restores the modal state, and none was kept at this call level",
                           "write M70 before it, in the same subprogram");
    return restore(*call.saved, column);
  }
  call.saved.reset();
  call.restores = tenths == 730;
  if (tenths != 710) call.saved = modal_state();
}

ModalState LinuxCnc::modal_state() const {
  ModalState state;
  state.inches = control_.modal.inches();
  state.incremental = incremental_;
  state.arc_absolute = arc_absolute_;
  state.retract_to_r = retract_to_r_;
  state.plane = control_.modal.plane;
  state.feed_mode = control_.modal.feed_mode;
  state.feed = control_.modal.feed;
  state.speed_rpm = control_.modal.speed_rpm;
  state.spindle = control_.modal.spindle;
  state.work_offset = control_.offsets.active;
  state.tool_number = control_.tools.active_number;
  state.radius_code = radius_code_;
  state.diameter_mm = diameter_mm_;
  state.length_mm = control_.space.length();
  state.length_on = control_.tools.length_on;
  state.exact_stop = control_.modal.exact_stop;
  state.corner_tolerance_mm = control_.modal.corner_tolerance_mm;
  state.mist = mist_;
  state.flood = flood_;
  return state;
}

/// Nothing moves. G41 and G42 cannot come back without a lead-in, and the length of a tool that has been
/// changed since is no state: both are refused.
void LinuxCnc::restore(const ModalState& state, int column) {
  const bool same_cutter = radius_code_ == state.radius_code && diameter_mm_ == state.diameter_mm;
  if (state.radius_code != 400 && !same_cutter)
    control_.report.fail("unsupported-word", column,
                         "restoring the state would switch cutter radius compensation on again",
                         "write G40 before the state is kept");
  if (radius_code_ != state.radius_code) nc::set_compensation(control_, Compensation::kOff, 0.0, column);
  radius_code_ = state.radius_code;
  const bool same_length =
      control_.tools.length_on == state.length_on && control_.space.length() == state.length_mm;
  if (!same_length && state.length_on && control_.tools.active_number != state.tool_number)
    control_.report.fail(
        "unsupported-word", column,
        fmt::format("the tool changed from T{} to T{} since the state was kept: which length comes back is "
                    "not documented",
                    state.tool_number, control_.tools.active_number),
        "write G49 before the state is kept and G43 after it is restored");
  nc::set_inches(control_.modal, state.inches);
  nc::set_plane(control_, state.plane);
  incremental_ = state.incremental;
  arc_absolute_ = state.arc_absolute;
  retract_to_r_ = state.retract_to_r;
  nc::restore_feed(control_.modal, state.feed_mode, state.feed);
  control_.modal.speed_rpm = state.speed_rpm;
  control_.modal.spindle = state.spindle;
  control_.modal.exact_stop = state.exact_stop;
  control_.modal.corner_tolerance_mm = state.corner_tolerance_mm;
  mist_ = state.mist;
  flood_ = state.flood;
  if (!same_length) nc::set_length_compensation(control_, state.length_mm, state.length_on);
  if (control_.offsets.active == state.work_offset) return;
  nc::set_work_offset(control_, state.work_offset);
  update_shift();
}

}  // namespace swarf::program::nc::linuxcnc
