// The plots of the report.
#pragma once

#include <vector>

#include "reports/report_data.h"
#include "sim/simulation.h"

namespace swarf::reports {

/// Feed, axis positions, axis speeds, scallop histogram, and the paper's Fig. 6.
std::vector<Plot> run_plots(const sim::Job& job, const sim::Result& result);

}  // namespace swarf::reports
