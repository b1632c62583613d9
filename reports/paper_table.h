// The paper's printed figures beside ours, with the erratum that explains each difference.
#pragma once

#include <vector>

#include "reports/report_data.h"
#include "sim/simulation.h"

namespace swarf::reports {

/// Lin & Koren's figures, recomputed by this program now.
std::vector<PaperRow> paper_rows(const sim::Job& job, const sim::Result& result);

/// The four segmentations of Fig. 6.
Table fig6_table();

}  // namespace swarf::reports
