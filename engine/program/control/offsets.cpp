#include "program/control/offsets.h"

#include <fmt/format.h>

namespace swarf::program::nc {
namespace {

using kinematics::AxisValues;

}  // namespace

void moved_frame(Control& control, const char* what) {
  if (control.contour.side() != Compensation::kOff) {
    control.report.fail("compensation-active", 0,
                        fmt::format("{} changes while cutter radius compensation is on", what),
                        fmt::format("switch it off first: {}", control.report.words.compensation_off));
  }
  flush(control);
  control.path.position_valid = false;
}

void set_work_offset(Control& control, int number) {
  moved_frame(control, "the work offset");
  control.offsets.active = number;
  control.space.set_origin(offset_origin(control.space, control.offsets, number));
}

AxisValues offset_origin(const WorkSpace& space, const Offsets& offsets, int number) {
  const auto found = offsets.origins.find(number);
  return found == offsets.origins.end() ? space.gauge_zero() : found->second;
}

void set_offset_origin(Control& control, int number, const AxisValues& origin) {
  moved_frame(control, "a work offset");
  control.offsets.origins[number] = origin;
  if (number == control.offsets.active) control.space.set_origin(origin);
}

void set_shift(Control& control, const AxisValues& shift) {
  moved_frame(control, "the shift of the work offsets");
  control.space.set_shift(shift);
}

void set_frame(Control& control, const Pose& frame) {
  moved_frame(control, "the frame");
  control.space.set_frame(frame);
}

void set_coordinates(Control& control, Coordinates coordinates) {
  moved_frame(control, "the meaning of X Y Z");
  control.space.set_coordinates(coordinates);
}

void set_tcp(Control& control, Tcp tcp) {
  moved_frame(control, "TCP");
  control.space.set_coordinates(tcp == Tcp::kOff ? Coordinates::kAxes : Coordinates::kWork);
  control.offsets.tcp = tcp;
}

}  // namespace swarf::program::nc
