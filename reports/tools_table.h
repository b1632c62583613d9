// The tools of a job: what each is, what it does, and how the cycle time is made up.
#pragma once

#include <vector>

#include "reports/report_data.h"
#include "sim/job/scene.h"
#include "sim/run/result.h"

namespace swarf::reports {

/// Seconds in the spindle, by index into Scene::tools.
std::vector<double> time_by_tool(const sim::Job& job, const sim::Result& result);

/// Each tool with its picture, its time, how far it feeds, how deep it goes and how far it has to stick out.
Table tools_table(const sim::Job& job, const sim::Result& result);

/// From tool change to tool change: feed, rapid, dwell, the change; and all together.
Table cycle_time_table(const sim::Job& job, const sim::Result& result);

}  // namespace swarf::reports
