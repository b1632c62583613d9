// Findings for the page and the 3D view: grouped, numbered, with their lines of the program.
#pragma once

#include <vector>

#include "reports/kept_findings.h"
#include "reports/report_data.h"
#include "reports/review_models.h"
#include "sim/run/result.h"

namespace swarf::reports {

/// One for each group of group_findings(), in its order: the number in the page is the index + 1.
std::vector<ReportFinding> report_findings(const sim::Result& result);

/// Those that have a place on the part or in the machine, kPinsMost at most.
std::vector<ReviewPin> review_pins(const sim::Result& result);
/// The same of a run that is read back.
std::vector<ReviewPin> review_pins(const KeptFindings& kept);

/// The highest cusp between two passes; null: there is none. Borrowed.
const measure::Ridge* highest_ridge(const sim::Result& result);
/// That, the deepest gouge and the highest material, as the measures have refined them.
std::vector<WorstPlace> worst_places(const sim::Result& result);
/// The same of a run that is read back, as its metrics.json says them. None where that is missing or says
/// none.
std::vector<WorstPlace> kept_worst_places(const std::string& folder);

}  // namespace swarf::reports
