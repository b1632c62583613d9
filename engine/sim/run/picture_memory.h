// What pictures take of the memory of a run.
#pragma once

#include "sim/job/scene.h"

namespace swarf::sim {

/// Of the stocks that only the movie has, MB; 0 without a movie. `leaves`: of the scene's stock.
double movie_stock_mb(const Scene& scene, double leaves);

}  // namespace swarf::sim
