// What drives a [driven] job: the position calculator on its part, and the path over it.
#pragma once

#include "base/diagnostics.h"
#include "sim/job/scene.h"

namespace swarf::sim {

/// Fills Job::driven, and the area where it is open, from the design that has been loaded.
void load_driven(Job& job, Diagnostics& diagnostics);

/// The path of a driven job; above 0: as a CAM system would write it within this tolerance.
toolpath::ToolPath driven_path(const Job& job, double cam_tolerance_mm, Diagnostics& diagnostics);

}  // namespace swarf::sim
