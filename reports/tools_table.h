// The tools of a run: what they are and how long each stood in the spindle.
#pragma once

#include <vector>

#include "reports/report_data.h"
#include "sim/simulation.h"

namespace swarf::reports {

/// Time in the spindle of each of Scene::tools, s.
std::vector<double> time_by_tool(const sim::Job& job, const sim::Result& result);

/// One row for each tool of the scene.
Table tools_table(const sim::Job& job, const sim::Result& result);

}  // namespace swarf::reports
