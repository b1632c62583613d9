// The memory that a run will need, told before it is taken.
#pragma once

#include <cstddef>

#include "sim/job/scene.h"

namespace swarf::sim {

struct MeasuredPath;

/// MB are 2^20 bytes.
struct MemoryPrediction {
  double stock_mb = 0.0;    ///< of the level set at its greatest
  double peak_mb = 0.0;     ///< of the whole process: libraries, path, rays, meshes and pictures included
  double scaling_mb = 0.0;  ///< of what grows with 1/voxel^2: level set and its mesh
  double fixed_mb = 0.0;    ///< of libraries and pictures, at any voxel size
  double limit_mb = 0.0;    ///< what may be used: see memory_limit_mb
  double rest_mb = 0.0;     ///< peak_mb when all leaves of the level set are on the disk
  double leaf_mb = 0.0;     ///< what each leaf in memory adds to that
  double leaves = 0.0;      ///< of the level set at its greatest
};

/// Paths that are only compared: so many are moved, cut and measured at once.
constexpr size_t kComparedAtOnce = 2;

/// What follows the cut and the measuring.
struct Outputs {
  bool pictures = true;  ///< stills and a movie
  bool page = true;      ///< with glTF
};

/// Cuts the path into a stock of voxels up to four times as large, with sweeps merged as coarsely, and counts
/// leaves and triangles: both grow with the square of the voxel sizes' ratio. The rest follows from the sizes
/// of what the run holds at the same time; memory.cpp states each constant with what it stands for.
/// Of long programs every n-th sweep is cut.
/// A design of facets needs its rays in `path.mesh_rays`. `stocks`: copies of the level set held at once (2
/// with --check).
MemoryPrediction predict_memory(const Job& job, const MeasuredPath& path, const Outputs& outputs, int stocks);

/// Throws InputError "out-of-memory" with a voxel size that fits when the prediction exceeds its limit.
/// `ranks` that share the run cannot take leaves to the disk.
void require_memory(const Job& job, const MemoryPrediction& prediction, int ranks = 1);

}  // namespace swarf::sim
