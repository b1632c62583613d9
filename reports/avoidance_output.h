// What the post and its simulation decided together, for metrics.json, the console and the page.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "avoidance/advice.h"
#include "avoidance/control.h"
#include "reports/report_data.h"

namespace swarf::reports {

/// "avoidance" of metrics.json.
nlohmann::ordered_json avoidance_json(const avoidance::Outcome& outcome, const sim::Job& job);

/// Lines for the console.
std::vector<std::pair<std::string, std::string>> avoidance_lines(const avoidance::Outcome& outcome,
                                                                 const sim::Job& job);

/// "advice" of swarf post --json; `file`: the changed CL data.
nlohmann::ordered_json advice_json(const avoidance::Advice& advice, const std::string& file);
std::vector<std::pair<std::string, std::string>> advice_lines(const avoidance::Advice& advice,
                                                              const std::string& file);

/// Decisions as a tree, and the map of the clamping positions.
Topic avoidance_topic(const avoidance::Outcome& outcome, const sim::Job& job);

}  // namespace swarf::reports
