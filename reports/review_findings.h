// Findings for the page and the 3D view: grouped, numbered, with their lines of the program.
#pragma once

#include <vector>

#include "reports/report_data.h"
#include "reports/review_models.h"
#include "sim/run/result.h"

namespace swarf::reports {

/// One for each group of group_findings(), in its order: the number in the page is the index + 1.
std::vector<ReportFinding> report_findings(const sim::Result& result);

/// Those that have a place on the part.
std::vector<ReviewPin> review_pins(const sim::Result& result);

/// The deepest gouge, the highest excess and the highest ridge, as the measures have refined them.
std::vector<WorstPlace> worst_places(const sim::Result& result);

}  // namespace swarf::reports
