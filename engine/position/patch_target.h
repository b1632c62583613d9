// Where a tool comes to rest on surface patches: the position calculator on the true surfaces (Kato et al.,
// section 2.1; theory 3).
//
//   1. The tree of the cells, highest bound first; what cannot be higher than the best so far is left out.
//   2. In a leaf: Newton to the greatest height in it (patch_footing.h).
//   3. Proof that nothing in the leaf is higher (patch_bound.h); where it fails, both halves of the leaf.
#pragma once

#include <cstddef>
#include <vector>

#include "position/patch_bound.h"

namespace swarf::position {

/// How much lower than the true height a position may be, mm (.02 um). It is never above: each is the height
/// that a point of a patch asks for, but for the rounding of its evaluation.
inline constexpr double kPatchProof_mm = 2e-5;

/// Where the last position touched, for the next one near by.
struct PatchHint {
  int patch = -1;  ///< -1: nowhere
  Vec2 uv = Vec2::Zero();
};

/// What a position took, and what it proves.
struct PatchWork {
  int cells = 0;   ///< whose bounds were taken
  int leaves = 0;  ///< and parts of leaves, in which the surface was evaluated
  int steps = 0;   ///< of Newton's method
  /// The truth is at most this much higher, mm: kPatchProof_mm, unless `most_leaves` was reached.
  double gap = kPatchProof_mm;
};

/// Patches of one part, whose surfaces are shared. A patch stops a tool from both of its sides.
///
/// Of a trimmed patch what lies inside its loops stops the tool, but not the loops themselves: who raises
/// `best` has raised it to them before (FaceTarget). Rest::number: the patch; kEdge: touched on the border of
/// its square of parameters, kVertex: at a corner.
class PatchTarget {
 public:
  /// Throws as cell_tree(). Without patches it stops no tool.
  explicit PatchTarget(std::vector<Patch> patches, const CellOptions& options = {});

  /// Raises `best` to where the patches stop the tool, if that is higher by more than kPatchProof_mm; within
  /// that, it may or may not. `near` is tried first and set where the patches raise `best`: the height
  /// depends on it by less than kPatchProof_mm. Allocates nothing (as the surfaces' evaluation does not); may
  /// be called from several threads.
  void raise(const ToolProfile& profile, const GuideLine& line, Rest& best, PatchHint& near) const;
  /// The same, telling what it took. `loop`: where on a loop the tool rests already, for bounds near by; it
  /// changes no result.
  void raise(const ToolProfile& profile, const GuideLine& line, Rest& best, PatchHint& near, PatchWork& work,
             const PatchHint& loop = {}) const;

  const std::vector<Patch>& patches() const { return patches_; }
  const std::vector<PatchCell>& cells() const { return cells_; }
  size_t memory_bytes() const { return cells_.size() * sizeof(PatchCell); }
  /// Parts of leaves that a position may take before it gives up and says so in `gap`.
  static constexpr int kMostLeaves = 200'000;

 private:
  std::vector<Patch> patches_;
  std::vector<PatchCell> cells_;  ///< the root is the last
};

}  // namespace swarf::position
