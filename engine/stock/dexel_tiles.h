// Tiles of rays against a chain of sweeps. Internal to this folder.
//
// Most pairs of a ray and a sweep are ruled out without a look at the ray:
//   1. runs of sweeps: the cutter at the run's middle, moved by no more than the run's spread, is farther
//   away
//      than the ball around the tile's material
//   2. single sweeps: the same, and the bottom plane lies above the highest material of the tile
// What remains goes through the kernel, and near the disc's rim through ray_height. The run nearest to the
// tile goes first: it brings the heights down, and the bounds then rule out nearly all the others. The order
// does not show in the result, which is the least (height, block) over all sweeps.
#pragma once

#include <span>
#include <vector>

#include "stock/surface_dexels.h"
#include "stock/sweep_map.h"

namespace swarf::stock {

inline constexpr int kTileSide = 8;

struct TileSpan {
  int iu, iv, nu, nv;
};
RayTile make_tile(const std::vector<Vec3>& points, const std::vector<Vec3>& normals, int row, TileSpan span);
double highest_of(const RayTile& tile, const std::vector<double>& heights, int row);

/// Consecutive sweeps with a bound of how far their poses lie from the middle one.
struct SweepRun {
  size_t begin = 0, end = 0;
  Mat3 Rt = Mat3::Identity();
  Vec3 tip = Vec3::Zero();
  double tip_spread = 0.0, axis_spread = 0.0;  ///< mm; |axis - axis of the middle|
};

struct SweepChain {
  std::span<const Sweep> sweeps;
  CutterSolid cutter;
  std::vector<SweepMap> maps;
  std::vector<SweepRun> runs;
};
SweepChain make_chain(std::span<const Sweep> sweeps, const CutterSolid& cutter);

/// The rays of a SurfaceDexels; a tile's heights and blocks are written by one task only.
struct RayField {
  const std::vector<Vec3>& points;
  const std::vector<Vec3>& normals;
  std::vector<double>& heights;
  std::vector<uint32_t>& blocks;
  int row;  ///< rays per row
};
/// Lowers the tile's heights by every sweep of the chain; returns the pairs evaluated.
uint64_t cut_tile(const RayField& field, RayTile& tile, const SweepChain& chain);

}  // namespace swarf::stock
