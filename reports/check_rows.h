// The judge's list as the page shows it: words and signs, no decisions.
#pragma once

#include <vector>

#include "reports/report_data.h"
#include "sim/judge/judge.h"

namespace swarf::reports {

/// The verdict with its sentence; criteria are the judged checks that have a limit.
Verdict verdict_of(const std::vector<sim::Check>& checks);

/// Every check, with what it rests on or why it was not judged.
std::vector<Check> check_rows(const std::vector<sim::Check>& checks);

/// Of a key number that a check has judged.
Tone tone_of(const sim::Check& check);

}  // namespace swarf::reports
