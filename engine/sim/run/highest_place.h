// Where the highest material ends on the part, for who looks at it.
#pragma once

#include "sim/job/scene.h"
#include "sim/run/result.h"

namespace swarf::sim {

/// Where another face of the design is as near, the highest material that counts ends within the part, and no
/// picture shows that place: SurfaceMetrics::excess_top is moved to where the material around it ends outside
/// the design, after all sweeps: the nearest such place on lines to all sides. Its height stays what counts.
/// Where every line meets the design before it leaves the material, the place stays within the part.
void end_on_part(const Job& job, MeasuredPath& measured);

}  // namespace swarf::sim
