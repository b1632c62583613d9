// The printed figures of Lin & Koren (1996) beside ours, with the erratum that explains each difference.
#pragma once

#include <vector>

#include "papers/paper_row.h"
#include "sim/simulation.h"

namespace swarf::papers {

/// Their figures, recomputed by this program now; `result` is that of a job of surface blocks.
std::vector<PaperRow> lin_koren_rows(const sim::Job& job, const sim::Result& result);

}  // namespace swarf::papers
