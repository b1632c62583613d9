// What the page knows of the program: which line runs when, and what it says.
#pragma once

#include <string>

#include "reports/run_report.h"

namespace swarf::reports {

/// JSON, one object:
///   file            name of the program
///   from_s, to_s    program time at the start and at the end of animation and movie
///   t_ms, line      ends of stretches of one line, ascending; the line that runs up to there
///   text            {line: what it says} of those lines; of programs with more than kPageLines the page has
///                   the numbers alone
///   tools           names by index, colours as in the path
///   error_um        what a place that is read from the part's mesh is off by at most: the decimation
/// Of ways with more points than kPagePoints every so many stand in it.
std::string page_program(const sim::Job& job, const sim::Result& result, const RunFiles& files);

inline constexpr size_t kPagePoints = 20'000, kPageLines = 6'000;

}  // namespace swarf::reports
