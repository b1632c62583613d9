// The measuring rays of a job's design.
#pragma once

#include <vector>

#include "sim/job/scene.h"
#include "stock/rays/ray_field.h"
#include "stock/rays/surface_dexels.h"

namespace swarf::sim {

/// Those on the design's facets; null: the design is no mesh.
stock::RayFieldPtr mesh_rays(const Job& job);

/// One field per design surface, in their order, or one for the design mesh, `made` where that is not null;
/// none without a design.
std::vector<stock::RayFieldPtr> design_rays(const Job& job, const stock::RayFieldPtr& made = nullptr);

/// Such fields in the uncut stock; each ray answers for the material up to where another face is nearer.
std::vector<stock::SurfaceDexels> design_dexels(const Job& job,
                                                const std::vector<stock::RayFieldPtr>& fields);

}  // namespace swarf::sim
