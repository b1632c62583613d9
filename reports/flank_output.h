// What flank milling has come to, for metrics.json, the console and the page.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "reports/report_data.h"
#include "sim/simulation.h"

namespace swarf::reports {

/// "flank_milling" of metrics.json; of results that have it (Result::flank_milling).
nlohmann::ordered_json flank_milling_json(const sim::Job& job, const sim::Result& result);

/// Lines for the console.
std::vector<std::pair<std::string, std::string>> flank_lines(const sim::Job& job, const sim::Result& result);

/// Placements, prediction beside rays as tables and maps, rules of feed, tools and machines compared.
Topic flank_topic(const sim::Job& job, const sim::Result& result);

/// Predicted and measured heights along u.
std::vector<Plot> flank_plots(const sim::Result& result);

}  // namespace swarf::reports
