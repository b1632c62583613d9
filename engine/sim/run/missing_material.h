// What the raw stock lacks of the design.
#pragma once

#include "sim/job/scene.h"

namespace swarf::measure {
struct SurfaceMetrics;
}

namespace swarf::sim {

/// Rays stand `design.pitch_mm` apart and within the facets of a mesh, never at their corners: the design's
/// own places, which may be farther from the stock, raise SurfaceMetrics::missing_max_um.
void raise_missing(const Job& job, measure::SurfaceMetrics& surface);

}  // namespace swarf::sim
