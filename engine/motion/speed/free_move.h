// Free moves: the tip on a straight line, the axis on a great circle, from rest to rest.
#pragma once

#include <vector>

#include "kinematics/machine_model.h"
#include "motion/options.h"
#include "motion/speed/speed_clamps.h"
#include "motion/tool_sample.h"
#include "toolpath/tool_path.h"

namespace swarf::motion {

/// Length that a move is planned with, mm: the way of the tip, or the turn of the axis on an arm of 100 mm
/// where that is longer, so that a move that only turns has a length too.
double move_length(const ToolPose& from, const ToolPose& to);

/// The ends of the ticks of a move; t_s and element are left to the caller. Rapid moves are limited by the
/// speeds, accelerations and jerks of the axes, the others by the feed of the tip and the path limits as
/// well. Empty when the move goes nowhere. `hint`: axis values before the move.
std::vector<ToolSample> sample_free_move(const toolpath::FreeMove& move,
                                         const kinematics::MachineModel& machine,
                                         const kinematics::InverseKinematics& inverse,
                                         const MotionOptions& options, const kinematics::AxisValues& hint);

}  // namespace swarf::motion
