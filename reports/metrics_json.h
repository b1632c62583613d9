// metrics.json and findings.json: the numbers of a run for scripts. Names are stable; units are in the names.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "sim/simulation.h"

namespace swarf::avoidance {
struct Outcome;
}

namespace swarf::reports {

/// What the pictures cost; part of metrics.json.
struct RenderStatistics {
  int frames = 0;
  double frame_ms_median = 0.0;
  bool is_whole = true;  ///< false: the movie ends before its last planned frame
};

/// The JSON text of metrics.json (schema 1). `avoidance`: of a scene with [post].
std::string metrics_json(const sim::Job& job, const sim::Result& result, const RenderStatistics& render,
                         const avoidance::Outcome* avoidance = nullptr);

/// The JSON text of findings.json: an array in the order of the page. Findings that are one fault have one
/// `number`, that of the page, and follow each other, the worst first.
std::string findings_json(const sim::Result& result);

/// As a file has it. Names of folders and texts of programs need not be UTF-8: what is not shows as U+FFFD.
std::string json_text(const nlohmann::ordered_json& json);

/// Peak resident memory of this process so far, MB.
double peak_memory_mb();

/// "error", "warning" or "note", as every JSON of the program has it.
std::string severity_name(Severity severity);

}  // namespace swarf::reports
