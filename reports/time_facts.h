// What the time of a program of blocks is spent on, for the report.
#pragma once

#include "reports/report_data.h"
#include "sim/simulation.h"

namespace swarf::reports {

/// Cycle time by kind and tool, corners and the tip error of the mode that is not in use; with thresholds and
/// lines of the program. Empty facts for programs without blocks but for the times.
FactGroup time_facts(const sim::Job& job, const sim::Result& result);

/// Table of how near the axes come to their limits of speed, acceleration and jerk.
Table axis_limit_table(const sim::Job& job, const sim::Result& result);

}  // namespace swarf::reports
