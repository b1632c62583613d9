// The hot loop of cutting with any convex piece: one sweep into one 8x8x8 leaf of the level set.
//
// A voxel moves on P + t D, t in [0,1], and F = max over the piece's faces and rounds is convex along it. The
// minimiser of F lies between the least and the greatest minimiser of its parts (left of all of them every
// part falls). These have closed forms: n.x rho(t) + n.y z(t) for the lowest and highest normal n, the
// nearest point for a ball. They make the bracket; for level moves and for leaves that only one part reaches
// it is a single point. What is left is closed by the steps of convex_motion.h, 64 voxels at a time, until
// the tangents prove every voxel's value to `tolerance`, or prove that the sweep cannot change the voxel.
//
// convex_leaf_kernel.cpp is compiled like leaf_kernel.cpp, and its variants too give the same bits.
#pragma once

#include <cstdint>
#include <span>

namespace swarf::stock {

/// Parts of each kind that a leaf can hold; ConvexPieces with more are refused by convex_leaf.cpp.
inline constexpr int kMostParts = 64;

/// One leaf, one sweep, one piece, in the tool's frame, mm. As LeafMotion, with the motion cut down to the
/// time in which the piece can reach the leaf and the parts that matter there.
struct ConvexLeaf {
  float start[3], end[3];
  float start_step[3][3], end_step[3][3];  ///< [leaf axis][tool coordinate]
  float background;                        ///< values are clamped to +-background
  float tolerance;                         ///< of the search along the motion

  int faces, rounds;
  struct {
    float x, z, offset;
  } face[kMostParts];
  struct {
    float x, z, radius, from_x, from_z, to_x, to_z;
  } round[kMostParts];

  // What makes the bracket: the lowest and the highest normal of the parts (0 to 2), a ball on the axis. At
  // least one of them.
  int normals;
  struct {
    float x, z;
  } normal[2];
  bool has_ball;
  float ball_z;
};

/// values = max(values, -distance to the swept piece), index x * 64 + y * 8 + z, in the slices whose bit x is
/// set. Returns the number of evaluations of F, which tells the length of the search.
using ConvexKernel = int (*)(float* values, const ConvexLeaf& leaf, uint32_t slices);

struct ConvexKernelVariant {
  const char* instruction_set;
  ConvexKernel kernel;
};
/// The variants this processor can run, fastest first.
std::span<const ConvexKernelVariant> convex_kernel_variants();

}  // namespace swarf::stock
