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
      control_.fail("nothing-saved", column,
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
  state.inches = control_.inches();
  state.incremental = incremental_;
  state.arc_absolute = arc_absolute_;
  state.retract_to_r = retract_to_r_;
  state.plane = control_.plane();
  state.feed_mode = control_.feed_mode();
  state.feed = control_.feed();
  state.speed_rpm = control_.speed_rpm();
  state.spindle = control_.spindle();
  state.work_offset = control_.work_offset();
  state.tool_number = control_.tool_number();
  state.radius_code = radius_code_;
  state.diameter_mm = diameter_mm_;
  state.length_mm = control_.length_compensation();
  state.length_on = control_.length_compensated();
  state.exact_stop = control_.exact_stop();
  state.corner_tolerance_mm = control_.corner_tolerance();
  state.mist = mist_;
  state.flood = flood_;
  return state;
}

/// Nothing moves. G41 and G42 cannot come back without a lead-in, and the length of a tool that has been
/// changed since is no state: both are refused.
void LinuxCnc::restore(const ModalState& state, int column) {
  const bool same_cutter = radius_code_ == state.radius_code && diameter_mm_ == state.diameter_mm;
  if (state.radius_code != 400 && !same_cutter)
    control_.fail("unsupported-word", column,
                  "restoring the state would switch cutter radius compensation on again",
                  "write G40 before the state is kept");
  if (radius_code_ != state.radius_code) control_.set_compensation(Compensation::kOff, 0.0, column);
  radius_code_ = state.radius_code;
  const bool same_length =
      control_.length_compensated() == state.length_on && control_.length_compensation() == state.length_mm;
  if (!same_length && state.length_on && control_.tool_number() != state.tool_number)
    control_.fail(
        "unsupported-word", column,
        fmt::format("the tool changed from T{} to T{} since the state was kept: which length comes back is "
                    "not documented",
                    state.tool_number, control_.tool_number()),
        "write G49 before the state is kept and G43 after it is restored");
  control_.set_inches(state.inches);
  control_.set_plane(state.plane);
  incremental_ = state.incremental;
  arc_absolute_ = state.arc_absolute;
  retract_to_r_ = state.retract_to_r;
  control_.restore_feed(state.feed_mode, state.feed);
  control_.set_speed(state.speed_rpm);
  control_.set_spindle(state.spindle);
  control_.set_exact_stop(state.exact_stop);
  control_.set_corner_tolerance(state.corner_tolerance_mm);
  mist_ = state.mist;
  flood_ = state.flood;
  if (!same_length) control_.set_length_compensation(state.length_mm, state.length_on);
  if (control_.work_offset() == state.work_offset) return;
  control_.set_work_offset(state.work_offset);
  update_shift();
}

}  // namespace swarf::program::nc::linuxcnc
