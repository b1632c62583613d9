// What a run holds as NumPy arrays.
#pragma once

#include <pybind11/pybind11.h>

#include "cli/python/scene_run.h"

namespace swarf::cli {

/// The columns of blocks.csv by name, with the numbers that the run holds; a feed that no cycle reached is
/// NaN.
pybind11::dict block_arrays(const SceneRun& run);

/// The measuring rays of all faces of the design: point_mm and normal (n x 3, work frame), deviation_um
/// (material that stands above the design, cut below it negative), area_mm2, line of the program that made
/// the surface there (0: nothing has cut), face.
pybind11::dict ray_arrays(const SceneRun& run);

}  // namespace swarf::cli
