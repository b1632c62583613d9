// Tiles of rays against a chain of sweeps. Internal to this folder.
//
// Most pairs of a ray and a sweep are ruled out without a look at the ray:
//   1. stretches of sweeps, legs of these, runs and groups in them: the cutter at the middle, moved by no
//   more than the part's spread, is farther away than the ball around the tile's material, or its bottom
//   plane lies above the highest of it
//   2. the bottom planes of a group lie above the material on each ray of its own
//   3. single sweeps: as 1 and 2
// What remains goes through the kernel, and near the disc's rim through ray_height. The run nearest to the
// tile goes first, then the groups by their distance: what is near brings the heights down, and the bounds
// then rule out nearly all the others. The order does not show in the result (ray_material.h).
#pragma once

#include <span>
#include <vector>

#include "stock/rays/ray_field.h"
#include "stock/rays/ray_material.h"
#include "stock/rays/tile_bounds.h"
#include "stock/sweep/sweep.h"
#include "stock/sweep/sweep_map.h"

namespace swarf::stock {

struct SweepChain {
  std::span<const Sweep> sweeps;
  CutterSolid cutter;
  std::vector<SweepMap> maps;
  std::vector<SweepRun> stretches, legs, runs, groups;  ///< all sweeps, in ever shorter parts
  bool cylinder = false;  ///< the cutter is a plain one: asked once, not for each ray
};
SweepChain make_chain(std::span<const Sweep> sweeps, const CutterSolid& cutter);

/// The material on all rays; a tile's share of it is written by one task only.
struct Material {
  const RayField& field;
  std::vector<double>& heights;
  std::vector<uint32_t>& blocks;
  std::vector<std::vector<MaterialAbove>>& above;  ///< per tile
};
/// Takes every sweep of the chain out of the tile's material; returns the pairs of ray and sweep evaluated.
uint64_t cut_tile(const Material& material, size_t tile, const SweepChain& chain);

}  // namespace swarf::stock
