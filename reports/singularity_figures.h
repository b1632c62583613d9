// The figures of one block near the pole: its trajectory against its line (So et al., Fig. 9), and the way of
// its tool axis around the pole.
#pragma once

#include "motion/judged/singularity_scan.h"
#include "papers/so_study.h"
#include "reports/report_data.h"

namespace swarf::reports {

/// Programmed line, true trajectory and So's analytic one, seen along the outer rotary axis: along the line
/// to the right, across it upwards, both to the same scale.
Figure trajectory_figure(const motion::BlockSingularity& block, const papers::BlockStudy& study);

/// Tool axis in polar coordinates around the pole that it comes nearest to: distance from the pole outwards,
/// azimuth around; with axes linear, on the great circle, and the block's singular cone.
Figure pole_figure(const motion::BlockSingularity& block, const papers::BlockStudy& study);

}  // namespace swarf::reports
