// One leaf position while sweeps are applied to it: what each may raise is bounded before it is evaluated.
// Internal to this folder.
#pragma once

#include "stock/level_set/leaf_kernel.h"
#include "stock/level_set/stock_grid_internal.h"
#include "stock/level_set/swept_piece.h"

namespace swarf::stock {

/// The bottom plane of a flat end whose height over every voxel does not change while it moves. Once one such
/// sweep has passed over the whole leaf, another one with the same plane to the last bit has nothing to
/// raise: the floors of pockets and the rows of a plane are cut once, not once for each row that overlaps.
class LevelPlane {
 public:
  bool repeats(const LeafMotion& motion) const;
  /// Remembers the sweep if its flat end passes over the whole leaf, deeper inside than the band.
  void remember(const LeafMotion& motion, const SweptPiece& swept, const Vec3& centre, double leaf_radius);

 private:
  bool known_ = false;
  LeafMotion motion_{};
};

class LeafCut {
 public:
  /// `values`: the leaf's, changed in place.
  LeafCut(const LevelSet& set, size_t leaf, float* values);

  /// Raises the values by one sweep, as far as what the ones before it left does not rule it out. `bound`: of
  /// what it writes.
  void apply(const SweptPiece& swept, const LeafBound& bound);

  /// Sweeps that were evaluated, and in how many patches altogether.
  uint64_t visits() const { return visits_; }
  uint64_t patches() const { return patches_; }
  /// Some value is greater than it was.
  bool changed() const { return changed_; }
  /// What the visits left, at least one of them.
  LeafFloor floor() const;
  const Vec3& centre() const { return centre_; }  ///< W
  /// The floor's value; it rises from visit to visit.
  float lowest() const { return lowest_; }

 private:
  void set_slope(const LeafBound& deepest);
  void set_lowest();
  uint32_t cut_by_search(const SweptPiece& swept, uint32_t patches);

  const LevelSet& set_;
  float* values_;
  Vec3 first_, centre_;  ///< the leaf's first voxel and its centre in W
  LevelPlane plane_;
  PatchFloors floors_{};
  uint64_t visits_ = 0, patches_ = 0;
  bool changed_ = false;
  float lowest_ = 0.0F;
};

}  // namespace swarf::stock
