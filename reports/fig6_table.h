// Lin & Koren, Fig. 6: its four segmentations as a table and as curves.
#pragma once

#include "reports/report_data.h"

namespace swarf::reports {

/// The greatest errors of each segmentation.
Table fig6_table();

/// Orientation error over the curve parameter.
Plot fig6_plot();

}  // namespace swarf::reports
