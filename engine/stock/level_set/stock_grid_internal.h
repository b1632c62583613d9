// The level set behind Stock: an OpenVDB grid and beside it a dense map of its leaves. Internal to this
// folder: the only header here that includes OpenVDB.
//
// Grid points lie at index * voxel in W. Values are distances in mm, negative inside the material, clamped to
// +-band. Every leaf position of the box is in one of three states; a position whose values are all +band is
// air, all -band solid, and neither has a leaf, so equal material means equal states.
#pragma once

#include <openvdb/openvdb.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "base/frames.h"
#include "base/ranks.h"
#include "stock/stock.h"

// Grid and tree are compiled once, in stock_grid.cpp: each further file would spend six seconds on them.
namespace openvdb {
OPENVDB_USE_VERSION_NAMESPACE
namespace OPENVDB_VERSION_NAME {
extern template class Grid<FloatTree>;
namespace tree {
extern template class Tree<FloatTree::RootNodeType>;
}
}  // namespace OPENVDB_VERSION_NAME
}  // namespace openvdb

namespace swarf::stock {

using LeafNode = openvdb::FloatTree::LeafNodeType;

/// Half width of the narrow band in voxels.
inline constexpr int kBandVoxels = 3;

/// Distances of the uncut box, rounded to floats; mm.
inline constexpr double kBoxRounding = 1e-6;

enum class LeafState : uint8_t { kAir, kSolid, kLeaf };

/// What is known of a leaf position without looking at its values: none of them lies below
/// min(value + slope . (x - centre), band).
struct LeafFloor {
  float value = 0.0F;   ///< mm
  float slope[3] = {};  ///< per mm
};

/// All leaf positions of the box and its band, z fastest; position (i,j,k) holds voxels (lower + ijk) * 8 and
/// on.
struct LeafMap {
  openvdb::Coord lower;      ///< in leaves
  openvdb::Coord dimension;  ///< number of leaves
  std::vector<LeafState> states;
  std::vector<LeafNode*> leaves;  ///< owned by the tree; nullptr unless the state is kLeaf
  std::vector<LeafFloor> floors;  ///< raised by cutting; -band, which always holds, after loading
  std::vector<uint32_t> cuts;     ///< how often cutting has changed the position's values
  static constexpr uint32_t kSwallowed = 1;
  std::vector<uint32_t> marks;  ///< while a batch of sweeps is cut, notes about the position; 0 otherwise

  size_t size() const { return states.size(); }
  size_t index(int i, int j, int k) const {
    return (static_cast<size_t>(i) * dimension.y() + j) * dimension.z() + k;
  }
  openvdb::Coord origin(size_t index) const;  ///< first voxel
};

struct LevelSet {
  Box box;  ///< of the raw stock
  double voxel = 0.0;
  std::optional<RawShape> raw;  ///< none: read from a file without its shape
  openvdb::FloatGrid::Ptr grid;
  LeafMap map;
  CutStatistics statistics;
  double rounding_mm = kBoxRounding;  ///< values are the distances they stand for within this
  /// Of each column of leaf positions, x before y: 1 where another process cuts (stock_tiles.h); empty: none.
  std::vector<uint8_t> others;

  /// Cutting may change this position.
  bool owns(size_t index) const {
    return others.empty() || others[index / static_cast<size_t>(map.dimension.z())] == 0;
  }

  float band() const { return static_cast<float>(kBandVoxels * voxel); }
  /// Centre of a leaf position in W.
  Vec3 leaf_centre(size_t index) const;
  /// From a leaf's centre to its farthest voxel.
  double leaf_radius() const;
  /// Value at a grid point; +band outside the map.
  float value(const openvdb::Coord& ijk) const;
};

struct Stock::Impl {
  LevelSet level_set;
};

/// Positions that a box and its band need.
LeafMap empty_map(const Box& box, double voxel);
openvdb::FloatGrid::Ptr empty_grid(double voxel);
/// `share`: its tiles alone are filled (stock_tiles.h).
LevelSet make_box(const Box& box, double voxel, Share share = {});
/// Any raw stock (raw_grid.cpp).
LevelSet make_raw(const RawShape& raw, double voxel, Share share = {});
/// Leaves the columns of other shares to others (stock_tiles.cpp).
void keep_columns(LevelSet& set, Share share);
/// Takes over the leaves of a fresh stock whose map knows its states, and gives the rest of the tree its
/// signs.
void take_leaves(LevelSet& set, std::vector<std::unique_ptr<LeafNode>>& made);

/// What a leaf's values amount to; sets the leaf's mask of active voxels (those inside the band) when it
/// stays.
LeafState settle_leaf(LeafNode& leaf, float band);

/// Removes the sweeps from the level set (stock_cut.cpp).
void cut_level_set(LevelSet& level_set, std::span<const Sweep> sweeps, const CutterSolid& cutter);
double volume(const LevelSet& level_set);
/// See Stock::volume_between (stock_volume.cpp).
VolumeRange volume_between(const LevelSet& level_set, double slack_mm);
double trilinear(const LevelSet& level_set, const Vec3& point_W);
double air_radius(const LevelSet& level_set, const Vec3& point_W);
std::vector<Vec3> air_points(const LevelSet& level_set, double below_mm);
uint64_t state_hash(const LevelSet& level_set);
/// Invariants, see Stock::check (stock_check.cpp).
std::string broken_invariant(const LevelSet& level_set, CheckLevel level);
std::string gained_material(const LevelSet& level_set, const LevelSet& earlier);
void write_level_set(const LevelSet& level_set, const std::string& path, const StockMetadata& metadata);
/// `metadata` receives what write_level_set was given.
LevelSet read_level_set(const std::string& path, StockMetadata& metadata);
LevelSet deep_copy(const LevelSet& level_set);

}  // namespace swarf::stock
