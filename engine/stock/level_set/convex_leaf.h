// Prepares one leaf for the kernel of convex_leaf_kernel.h: cuts the motion down to the time in which the
// piece can reach the leaf, and drops the parts of the profile that cannot show there.
#pragma once

#include "cutter/convex_piece.h"
#include "stock/level_set/convex_leaf_kernel.h"
#include "stock/sweep/sweep_map.h"

namespace swarf::stock {

/// Where a leaf of 8x8x8 voxels stands.
struct LeafPlace {
  Vec3 first_W;     ///< its first voxel, mm
  double voxel_mm;  ///< spacing along W's axes
  double band_mm;   ///< values are clamped to +-band
};

/// Removes the piece's sweep: values = max(values, -F), clamped to +-band; index x * 64 + y * 8 + z, in the
/// slices of 64 voxels whose bit x is set. What it writes depends on the leaf, the sweep and the piece alone,
/// so any order of sweeps gives the same bits.
/// Returns the evaluations of F that it took. The distance is that of swept_contact within
/// convex_kernel_error_mm.
int cut_leaf_by_piece(float* values, const LeafPlace& place, const SweepMap& map,
                      const cutter::ConvexPiece& piece, uint32_t slices);

/// False when the piece cannot reach the leaf. `leaf` is what the kernel takes.
bool prepare_convex_leaf(const LeafPlace& place, const SweepMap& map, const cutter::ConvexPiece& piece,
                         ConvexLeaf& leaf);

/// Bound on the error of a voxel's distance, mm, for sweeps of any length:
///   tolerance of the search along the motion   1e-5 + 3e-7 s     (certified by tangents, convex_motion.h)
///   rounding of floats                         1e-6 s            (16 roundings of coordinates up to s)
/// where s is the greatest tool-frame coordinate of a leaf in reach. Holds for voxels within the band of the
/// cylinder around the piece, with distances clamped to +-band.
double convex_kernel_error_mm(const cutter::ConvexPiece& piece, double voxel_mm, double band_mm);

}  // namespace swarf::stock
