// What a part driven by its surface has come to, and Kato et al.'s comparison, for metrics.json, the console
// and the page.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "reports/report_data.h"
#include "sim/simulation.h"

namespace swarf::reports {

/// "driven" of metrics.json; of results that have it (Result::driven).
nlohmann::ordered_json driven_json(const sim::Result& result);

/// Lines for the console.
std::vector<std::pair<std::string, std::string>> driven_lines(const sim::Result& result);

/// The comparison as a table.
Topic driven_topic(const sim::Result& result);

/// Speed, clamps and height along the pass with the most corners (Fig. 3 b, 4 and 5).
std::vector<Plot> driven_plots(const sim::Result& result);

}  // namespace swarf::reports
