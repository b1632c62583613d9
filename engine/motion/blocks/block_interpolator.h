// The off-line way to machine a pass: straight blocks by chord tolerance, as a CAM system would have written
// them, with the tool axis filled in between their ends.
//
// 1. Segments: greedy, each as long as the chord tolerance lets it be.
// 2. Axis: constant, linear in the curve's parameter (Eq. 7), or linear along the chord, then normalised.
// 3. Speed, stop at each block: a seven-phase profile per block, rest to rest; blocks follow each other
// without
//    waiting for the next tick.
//    Speed, look-ahead: one profile for the pass; a corner of angle theta is passed at
//      v = sqrt(a e cos(theta/2) / (1 - cos(theta/2))),
//    the centripetal limit of the arc that rounds the corner by the chord tolerance e.
// Known limit: with look-ahead the axes' speeds break at corners; what that asks of their accelerations is
// measured (MotionStatistics) but not limited.
#pragma once

#include <vector>

#include "cutter/cutter.h"
#include "kinematics/machine_model.h"
#include "motion/options.h"
#include "motion/result.h"
#include "motion/tool_sample.h"
#include "toolpath/tool_path.h"

namespace swarf::motion {

/// Parameters of the segment ends, t_start first, t_end last.
std::vector<double> segment_pass(const toolpath::SurfacePass& pass);

/// The ends of the ticks of a pass; t_s and element are left to the caller. `hint`: axis values before it.
std::vector<ToolSample> sample_offline_pass(const toolpath::SurfacePass& pass, const cutter::Cutter& cutter,
                                            const kinematics::MachineModel& machine,
                                            const kinematics::InverseKinematics& inverse,
                                            const MotionOptions& options, const kinematics::AxisValues& hint);

}  // namespace swarf::motion
