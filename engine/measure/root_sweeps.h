// The sweeps that matter to a root cell of the proof. Internal to this folder.
#pragma once

#include <vector>

#include "measure/certificate.h"
#include "measure/design_cell.h"
#include "measure/height_bounds.h"
#include "measure/sweep_index.h"

namespace swarf::measure {

/// Those that may meet the root's columns from the skin up to `reach` over the design, mm; infinite: up to
/// the top of the stock.
std::vector<NearSweep> sweeps_up_to(double reach, const RootCell& root, const CertificateInput& input,
                                    const SweepIndex& index);

}  // namespace swarf::measure
