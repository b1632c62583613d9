// The design beside the part and the machine in the 3D view: for the eye, nothing is measured on it.
#pragma once

#include "reports/review_models.h"

namespace swarf::reports {

/// Facets of the design, in the work frame, with normals. `error_mm`: no place of the design is farther from
/// its facets. Empty without a design.
DisplayMesh shown_design(const sim::Job& job);

}  // namespace swarf::reports
