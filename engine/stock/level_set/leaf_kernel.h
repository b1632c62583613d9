// The hot loops of cutting: one sweep into one 8x8x8 leaf of the level set.
//
// leaf_kernel.cpp alone carries the flags that let the compiler vectorise it, and holds the
// same loops compiled for several instruction sets. Without fused multiply-add all of them round alike, so
// the result does not depend on the processor: unit tests compare the variants bit by bit.
#pragma once

#include <cstdint>
#include <span>

namespace swarf::stock {

inline constexpr int kLeafSide = 8;
inline constexpr int kLeafVoxels = kLeafSide * kLeafSide * kLeafSide;
inline constexpr uint32_t kAllSlices = 0xffU;  ///< bit x: the 64 voxels at place x

/// Tool-frame coordinates (mm) of the leaf's first voxel at both ends of the sweep, and their steps per voxel
/// along the leaf's x, y, z.
struct LeafMotion {
  float start[3], end[3];
  float start_step[3][3], end_step[3][3];  ///< [leaf axis][tool coordinate]
  float radius, height;                    ///< cutter, mm
  float background;                        ///< values are clamped to +-background, mm
  bool capped;                             ///< the cutter's top end matters in this leaf
};

/// What a sweep writes lies below both of_face[0] and of_face[1]: each is the greater of two linear functions
/// of the voxel's place in the leaf.
struct LeafBound {
  struct Linear {
    float start, end;                  ///< at the leaf's first voxel, mm
    float start_step[3], end_step[3];  ///< per voxel along the leaf's x, y, z
  };
  Linear of_face[2];
};

/// Bit x: the slice of 64 voxels at place x has a value below min(bounds, background), so the sweep may raise
/// it. With a slack above the rounding of the values, so that leaving the others out never changes a bit.
using LeafBoundTest = uint32_t (*)(const float* values, const LeafBound& bound, float background);

/// values = max(values, -distance to the swept cutter), index x * 64 + y * 8 + z, in the given slices.
using LeafKernel = void (*)(float* values, const LeafMotion& motion, uint32_t slices);

/// The greatest c such that no value below `band` lies below c + slope . place (place in voxels).
using LeafFloorFit = float (*)(const float* values, const float slope[3], float band);

struct LeafRange {
  float least, greatest;
};
/// Least and greatest value; active[x] has a bit for each voxel of slice x that lies inside the band.
using LeafSummary = LeafRange (*)(const float* values, float band, uint64_t active[kLeafSide]);

struct LeafKernelVariant {
  const char* instruction_set;
  LeafKernel kernel;
  LeafBoundTest bound_test;
  LeafFloorFit floor_fit;
  LeafSummary summary;
};
/// The variants this processor can run, fastest first.
std::span<const LeafKernelVariant> leaf_kernel_variants();

}  // namespace swarf::stock
