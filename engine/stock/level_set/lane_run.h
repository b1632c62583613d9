// Runs of consecutive sweeps, and which leaf positions each may change. Internal to this folder.
//
// A finishing path passes over the same leaf with dozens of sweeps, of which one or two decide. So sweeps are
// gathered sixteen at a time: the leaf positions around a run are walked once, and lane_kernel.h judges all
// its sweeps together against what is known of each leaf.
#pragma once

#include <cstdint>
#include <vector>

#include "stock/level_set/lane_kernel.h"
#include "stock/level_set/stock_grid_internal.h"
#include "stock/level_set/swept_piece.h"

namespace swarf::stock {

/// The places that a run of sweeps may reach, seen from above and along vertical lines.
struct Neighbourhood {
  // A rectangle that holds them all, along the way of the tip.
  Vec2 centre = Vec2::Zero(), along = Vec2::UnitX();
  double half_along = 0.0, half_across = 0.0;
  // They lie within `radius` of the segment from `foot` along `axis`, and above one of the bottom planes.
  Vec3 foot = Vec3::Zero(), axis = Vec3::UnitZ();
  double length = 0.0, radius = 0.0;
  struct Plane {
    double z, x, y;  ///< z + x X + y Y at the vertical line (X, Y)
  };
  std::vector<Plane> bottoms;  ///< empty when a pose lies too flat for them to help
};

/// What all leaves of a level set have alike, mm.
struct LeafExtent {
  float half, reach;  ///< LaneQuery's
  explicit LeafExtent(const LevelSet& set);
};

/// Up to kLanes consecutive swept pieces of the same convex piece.
struct LaneRun {
  size_t first = 0, count = 0;  ///< in the batch's pieces
  Vec3 origin = Vec3::Zero();   ///< W
  Lanes lanes;
  LanePiece piece;
  Neighbourhood around;

  void set_lane(size_t lane, const SweepMap& map);
  /// `centre`: a leaf's, from the origin, mm.
  LaneQuery query(const LeafExtent& extent, const Eigen::Vector3f& centre, const LeafFloor& floor) const;
  uint32_t all() const { return (1U << count) - 1U; }
};

/// Cuts a batch's pieces into runs; they follow each other as the path does, one convex piece after another.
std::vector<LaneRun> make_runs(const LevelSet& set, const std::vector<SweptPiece>& pieces);

/// A leaf position and a run that may change it.
struct LeafPair {
  uint32_t leaf = 0, run = 0;
  float depth = 0.0F;  ///< LaneAnswer's, the greatest of the lanes
  uint32_t lane = 0;   ///< which has it
};

/// The pairs of one run in order of position; marks the positions of which one of its lanes leaves nothing
/// (LeafMap). Those that are marked already it passes over. Several runs at a time may be asked.
std::vector<LeafPair> gather_leaves(LevelSet& set, const LaneRun& run, size_t index);

}  // namespace swarf::stock
