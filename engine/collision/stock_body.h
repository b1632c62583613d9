// The stock against bodies of the machine: first the raw one, then what has been left of it.
//
// Material only shrinks: what is clear of the raw stock is clear for ever, so that only the ways on which a
// body comes to the raw stock are suspect. Those are held against the material as it stands at their moment,
// as a mesh (StockMesher says how near it lies: 0.13 voxel). A wall thinner than a voxel may be missing from
// the mesh where it contains no grid point; the grid points beside it tell of it (Stock::air_points): clear
// is what keeps sqrt(3) / 2 voxel from the mesh and from all of those.
#pragma once

#include "collision/containment.h"
#include "stock/stock.h"

namespace swarf::collision {

enum class StockOutcome {
  kClearOfRaw,  ///< proven, whatever has been cut
  kClear,       ///< farther than a voxel from the mesh of the material
  kOpen,        ///< within a voxel of it, or in it but not that deep: not clear
  kContact,     ///< deeper than a voxel in it
};

struct StockAnswer {
  StockOutcome outcome = StockOutcome::kClearOfRaw;
  /// Least distance over the segment, mm, of the raw stock or of the mesh of the material; the upper one is
  /// infinite beyond a voxel and the limit.
  double lower = 0.0, upper = 0.0;
  double voxel_mm = 0.0;        ///< what the bounds may be off beyond the raw stock
  double t = 0.0;               ///< share of the segment where it comes nearest
  Vec3 point_M = Vec3::Zero();  ///< on the body, there
  double depth_mm = 0.0;        ///< of the deepest place over the segment that depth_over() finds
};

/// Where a row of ways comes to the material.
struct StockTouch {
  size_t way = 0;  ///< from the place of this number to the next one
  FirstContact at;
};

class StockBody {
 public:
  /// The raw stock in W: a block or a closed mesh. `scene` must outlive it.
  StockBody(const machine::MachineScene& scene, const Box& raw_W);
  StockBody(const machine::MachineScene& scene, const TriMesh& raw_W);

  /// For PathCheck: its contacts are the suspects.
  const Body& raw() const { return raw_; }
  /// The material as it stands; to be called after cutting, before suspects behind it are asked for.
  void refresh(const stock::Stock& stock);
  /// Of the last refresh(); the raw stock before the first.
  const Body& as_cut() const { return voxel_mm_ > 0.0 ? as_cut_ : raw_; }
  /// A body over a segment on which nothing is cut. Before the first refresh() suspects are held against the
  /// raw stock, without a voxel.
  StockAnswer over(const Body& body, const AxisSegment& segment) const;
  /// How many of the ways between places that follow each other are clear of that material, from the first
  /// one on, however thin it is: proven, with `more_mm` to spare. Gaps of kSeenVoxels voxels and `more_mm`
  /// beside a face are seen.
  static constexpr double kSeenVoxels = 1.75;
  size_t clear_ways(const Body& body, std::span<const AxisValues> places, double more_mm) const;
  /// The first place where the body touches the mesh of the material, which lies within a voxel of it; none:
  /// nowhere.
  std::optional<StockTouch> first_touch(const Body& body, std::span<const AxisValues> places) const;

 private:
  StockAnswer suspect(const Body& body, const AxisSegment& segment) const;
  size_t free_ways(const Body& body, const Body& material, std::span<const AxisValues> places,
                   double more_mm) const;

  const machine::MachineScene* scene_;
  Body raw_, as_cut_;
  Body beside_;  ///< the grid points beside as_cut_, each a triangle of one place
  double voxel_mm_ = 0.0;
};

}  // namespace swarf::collision
