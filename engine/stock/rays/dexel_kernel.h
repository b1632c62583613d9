// The hot loop of the surface dexels: 64 rays against the bottom plane of one sweep.
//
// For a ray that leaves the part on the tool's side (normal . axis > 0) no point of the cutter lies below the
// bottom plane, so the plane bounds the height from below; s(t) on the plane is a ratio of linear functions,
// hence monotone, and its least value lies at an end of the motion. Where the ray meets the disc itself at
// both ends the bound is the answer. All other rays that the bound does not rule out are left to ray_height.
#pragma once

#include <cstdint>
#include <span>

#include "stock/sweep/sweep_map.h"

namespace swarf::stock {

inline constexpr int kTileRays = 64;

/// Rays of one tile, by component.
struct TileRays {
  alignas(64) double px[kTileRays], py[kTileRays], pz[kTileRays];  ///< feet, W, mm
  alignas(64) double nx[kTileRays], ny[kTileRays], nz[kTileRays];  ///< unit normals
};

struct TileHeights {
  alignas(64) double exact[kTileRays];  ///< the sweep's height, or kNoHeight when the disc's rim is near
  alignas(64) double bound[kTileRays];  ///< no point of the sweep on this ray lies lower
};
/// Finite on purpose: the kernel is compiled without infinities.
inline constexpr double kNoHeight = 1e300;

/// Material that stands on the design under each ray. A block's id as a number, so that one loop has one
/// width.
struct TileMaterial {
  alignas(64) double heights[kTileRays];  ///< mm
  alignas(64) double blocks[kTileRays];
};

/// What one sweep of a disc did to a tile.
struct Lowering {
  bool changed = false;
  bool left =
      false;  ///< rays remain that the disc's plane does not answer for: near the rim, below the design
};

using DexelKernel = void (*)(const TileRays& rays, const SweepMap& map, double radius, TileHeights& out);

/// Which sweeps' bottom planes do not pass above `tops` (mm, greatest height with material) on every ray: bit
/// k for maps[k], 32 at the most. At a third of the kernel's cost, which finds no bound below the tops for
/// the others; a pose at which one sweep ends and the next begins is looked at once.
using PlaneTest = uint32_t (*)(const TileRays& rays, std::span<const SweepMap> maps, const double* tops);

/// Lowers each ray that the disc itself meets at both ends to the height where it does, in one loop; of two
/// sweeps of one height the smaller block stays. For tiles without material above gaps, whose material the
/// cutter holds (`disc_holds`): the cut then reaches up to the material's top.
using DiscCut = Lowering (*)(const TileRays& rays, const SweepMap& map, double radius, double block,
                             TileMaterial& material);

struct DexelKernelVariant {
  const char* instruction_set;
  DexelKernel kernel;
  PlaneTest planes_reach;
  DiscCut cut_by_disc;
};
/// The variants this processor can run, fastest first; all give the same bits.
std::span<const DexelKernelVariant> dexel_kernel_variants();

}  // namespace swarf::stock
