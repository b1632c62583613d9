// The memory that a run may take.
#pragma once

#include "sim/job/scene.h"

namespace swarf::sim {

/// stock.max_memory_mb of the scene, else 80 % of the memory that is free now.
double memory_limit_mb(const Scene& scene);

}  // namespace swarf::sim
