// Work offsets, shifts, frames and TCP: what moves the program's zero. Each is a fault while the cutter is
// compensated ("compensation-active").
#pragma once

#include "program/control/control.h"

namespace swarf::program::nc {

void set_work_offset(Control& control, int number);
/// Axis values of the origin of an offset in machine coordinates (G10 L2, $P_UIFR).
kinematics::AxisValues offset_origin(const WorkSpace& space, const Offsets& offsets, int number);
void set_offset_origin(Control& control, int number, const kinematics::AxisValues& origin);
/// Further shift of all offsets, as axis values (G92, G52): added to the origin.
void set_shift(Control& control, const kinematics::AxisValues& shift);
/// The programmable frame F (control.h), and what XYZ mean.
void set_frame(Control& control, const Pose& frame);
void set_coordinates(Control& control, Coordinates coordinates);
/// TCP on (kWork with the law of the tip) or off. Off leaves the coordinates at kAxes.
void set_tcp(Control& control, Tcp tcp);
/// `what` is about to move the program's zero: flushes, and forgets the programmed position.
void moved_frame(Control& control, const char* what);

}  // namespace swarf::program::nc
