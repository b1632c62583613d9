// The measuring rays of a job's design.
#pragma once

#include <functional>
#include <vector>

#include "sim/job/scene.h"
#include "stock/rays/ray_field.h"
#include "stock/rays/surface_dexels.h"

namespace swarf::sim {

/// One field per design surface, in their order, or one for the design mesh; none without a design.
std::vector<stock::RayFieldPtr> design_rays(const Job& job);

/// The fields in the uncut stock; each ray answers for the material up to where another face is nearer.
/// `step`: called when the rays stand, and when it is known how far each of them answers.
std::vector<stock::SurfaceDexels> design_dexels(const Job& job, const std::function<void()>& step);

}  // namespace swarf::sim
