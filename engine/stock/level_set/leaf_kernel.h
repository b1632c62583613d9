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
/// A leaf is looked at in patches: 2 x 2 columns of its voxels. Bit 4 (x / 2) + y / 2.
inline constexpr int kPatchSide = 4, kPatches = kPatchSide * kPatchSide;  ///< of a leaf
inline constexpr int kPatchVoxels = kLeafVoxels / kPatches;
inline constexpr uint32_t kAllPatches = 0xffffU;
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

/// What is known of the values: in patch n no value below level k lies below of_patch[k][n] + slope . place.
/// The levels divide the band: -band / 2, 0, band / 2, band. A sweep that reaches the patch with its rim
/// alone raises low values only, and only those count then.
inline constexpr int kLevels = 4;
struct PatchFloors {
  float slope[3];  ///< per voxel
  float band;      ///< mm
  alignas(64) float of_patch[kLevels][kPatches];

  float level(int k) const { return band * (0.5F * static_cast<float>(k) - 0.5F); }
};

/// Patches in which the sweep may raise a value. With a slack above the rounding of the values, so that
/// leaving the others out never changes a bit.
using PatchTest = uint32_t (*)(const PatchFloors& floors, const LeafBound& bound);

/// values = max(values, -distance to the swept cutter), index x * 64 + y * 8 + z, in the given patches.
/// Returns those in which a value rose.
using LeafKernel = uint32_t (*)(float* values, const LeafMotion& motion, uint32_t patches);

/// Lifts the floors of the given patches as far as the values allow.
using PatchFit = void (*)(const float* values, uint32_t patches, PatchFloors& floors);

struct LeafRange {
  float least, greatest;
};
/// Least and greatest value; active[x] has a bit for each voxel of slice x that lies inside the band.
using LeafSummary = LeafRange (*)(const float* values, float band, uint64_t active[kLeafSide]);

struct LeafKernelVariant {
  const char* instruction_set;
  LeafKernel kernel;
  PatchTest patch_test;
  PatchFit patch_fit;
  LeafSummary summary;
};
/// The variants this processor can run, fastest first.
std::span<const LeafKernelVariant> leaf_kernel_variants();

}  // namespace swarf::stock
