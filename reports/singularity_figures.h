// The figures of one block near the pole: its trajectory against its line (So et al., Fig. 9), and the way of
// its tool axis around the pole.
#pragma once

#include "kinematics/machine_model.h"
#include "motion/judged/singularity_scan.h"
#include "reports/report_data.h"

namespace swarf::reports {

/// Programmed line, true trajectory and So's analytic one, seen along the outer rotary axis: along the line
/// to the right, across it upwards, both to the same scale.
Figure trajectory_figure(const kinematics::MachineModel& machine, const motion::BlockSingularity& block);

/// Tool axis in polar coordinates around the pole that it comes nearest to: distance from the pole outwards,
/// azimuth around; with axes linear, on the great circle, and the block's singular cone.
Figure pole_figure(const kinematics::MachineModel& machine, const motion::BlockSingularity& block);

}  // namespace swarf::reports
