// The hot loop of cutting: one sweep into one 8x8x8 leaf of the level set.
//
// leaf_kernel.cpp alone carries the flags that let the compiler vectorise it (toolchain 3.3), and holds the
// same loop compiled for several instruction sets. Without fused multiply-add all of them round alike, so the
// result does not depend on the processor: unit tests compare the variants bit by bit.
#pragma once

#include <span>

namespace swarf::stock {

inline constexpr int kLeafSide = 8;
inline constexpr int kLeafVoxels = kLeafSide * kLeafSide * kLeafSide;

/// Tool-frame coordinates (mm) of the leaf's first voxel at both ends of the sweep, and their steps per voxel
/// along the leaf's x, y, z.
struct LeafMotion {
  float start[3], end[3];
  float start_step[3][3], end_step[3][3];  ///< [leaf axis][tool coordinate]
  float radius, height;                    ///< cutter, mm
  float background;                        ///< values are clamped to +-background, mm
  bool capped;                             ///< the cutter's top end matters in this leaf
};

/// values = max(values, -distance to the swept cutter), index x * 64 + y * 8 + z. Returns the number of
/// voxels evaluated: slices of 64 that lie wholly below the bottom plane's reach are left out, because no
/// point of the cutter is nearer than that plane. The values do not depend on what is left out.
using LeafKernel = int (*)(float* values, const LeafMotion& motion);

struct LeafKernelVariant {
  const char* instruction_set;
  LeafKernel kernel;
};
/// The variants this processor can run, fastest first.
std::span<const LeafKernelVariant> leaf_kernel_variants();

}  // namespace swarf::stock
