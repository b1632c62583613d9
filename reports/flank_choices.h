// What a flank job has chosen: a tool of a table, how it keeps off fixtures, and how machines compare.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "reports/report_data.h"
#include "sim/simulation.h"

namespace swarf::reports {

/// "tools", "machines" and "clearance" of flank_milling in metrics.json, those that there are.
void add_choices(const sim::Job& job, const sim::FlankFigures& figures, nlohmann::ordered_json& json);

std::vector<Table> choice_tables(const sim::Job& job, const sim::FlankFigures& figures);

/// For the console.
std::vector<std::pair<std::string, std::string>> choice_lines(const sim::Job& job,
                                                              const sim::FlankFigures& figures);

}  // namespace swarf::reports
