// Which rotary values point the tool along a direction, and the moves that bring it there.
#pragma once

#include <vector>

#include "program/control/control.h"

namespace swarf::program::nc {

/// Both rotary solutions that bring the tool axis to `axis_P` (program frame F), nearest to the present
/// values first; empty when the machine cannot point there. Linear values keep the tip where it is in W.
std::vector<kinematics::AxisValues> tilt_solutions(const Control& control, const Vec3& axis_P);
/// The one that `preference` chooses ("unreachable-orientation", with the degrees that are missing).
kinematics::AxisValues tilt_solution(const Control& control, const Vec3& axis_P,
                                     const TiltPreference& preference, int column);
/// Moves the rotaries to those of `q`: linear axes stand (tip_stands false) or keep the tip in W.
void turn_rotaries(Control& control, Motion motion, const kinematics::AxisValues& q, bool tip_stands);

}  // namespace swarf::program::nc
