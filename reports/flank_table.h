// The flank milling errors of a ruled design as a table of the report.
#pragma once

#include "measure/flank_error.h"
#include "reports/report_data.h"

namespace swarf::reports {

/// Rows: the axis standing, moved in 1 to 32 blocks, moved without end; beside each the bound of E18.
Table flank_table(const measure::FlankError& flank);

}  // namespace swarf::reports
