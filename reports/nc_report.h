// What the report says of an NC program: how it was read and executed, and with which tools.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "reports/report_data.h"
#include "sim/simulation.h"

namespace swarf::reports {

/// "joint, 812 blocks; tcp_axes, 96 blocks": the modes of execution that the program's own words chose.
std::string execution_modes(const toolpath::NcReading& reading);

/// Facts of the group "Program" of the report.
FactGroup nc_facts(const sim::Job& job, const sim::Result& result);

/// Lines of the table that people get on the terminal.
std::vector<std::pair<std::string, std::string>> nc_lines(const sim::Job& job, const sim::Result& result);

/// "not simulated": words that were read and have no effect, and what else was left out.
std::vector<Check> nc_checks(const sim::Job& job, const sim::Result& result);

}  // namespace swarf::reports
