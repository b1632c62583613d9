// The level set behind Stock: an OpenVDB grid and beside it a dense map of its leaves. Internal to this
// folder: the only header here that includes OpenVDB.
//
// Grid points lie at index * voxel in W. Values are distances in mm, negative inside the material, clamped to
// +-band. Every leaf position of the box is in one of three states; a position whose values are all +band is
// air, all -band solid, and neither has a leaf, so equal material means equal states.
#pragma once

#include <openvdb/openvdb.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/frames.h"
#include "stock/level_set/leaf_file.h"
#include "stock/stock.h"
#include "stock/stock_tiles.h"

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
  /// Of each column, x before y: positions below its highest material, and that one; perhaps too many. A row
  /// of lanes may be read from any of them on.
  std::vector<uint32_t> tops;
  std::vector<uint32_t> marks;  ///< while a batch of sweeps is cut, notes about the position; 0 otherwise

  size_t size() const { return states.size(); }
  size_t index(int i, int j, int k) const {
    return (static_cast<size_t>(i) * dimension.y() + j) * dimension.z() + k;
  }
  size_t column(size_t index) const { return index / static_cast<size_t>(dimension.z()); }
  openvdb::Coord origin(size_t index) const;  ///< first voxel
  /// The position has become air.
  void lower_top(size_t index);
  /// The position has become material.
  void raise_top(size_t index);
};

/// Leaves whose values are on the disk keep their node, their mask and their place in the tree.
struct SpilledLeaves {
  SpilledLeaves(const Spill& spill, size_t positions)
      : file(spill.folder), slots(positions, LeafFile::kNone), most(spill.leaves_most) {}

  LeafFile file;
  std::vector<uint32_t> slots;  ///< by leaf position; LeafFile::kNone: in memory
  size_t most = 0;              ///< leaves that make_room() leaves in memory
};

struct LevelSet {
  Box box;  ///< of the raw stock
  double voxel = 0.0;
  std::optional<RawShape> raw;  ///< none: read from a file without its shape
  openvdb::FloatGrid::Ptr grid;
  LeafMap map;
  std::vector<std::unique_ptr<LeafNode>> spare;  ///< emptied leaves, to be used again
  CutStatistics statistics;
  double rounding_mm = kBoxRounding;  ///< values are the distances they stand for within this
  /// Of each column of leaf positions, x before y: 1 where another process cuts (stock_tiles.h); empty: none.
  std::vector<uint8_t> others;

  std::unique_ptr<SpilledLeaves> spilled;  ///< null: all leaves are in memory
  /// By leaf position: values that stand elsewhere than in a tree, to look at; empty: a tree holds them.
  std::vector<const float*> lent;

  bool is_spilled(size_t leaf) const { return spilled && spilled->slots[leaf] != LeafFile::kNone; }
  /// Of a leaf, to look at.
  const float* values(size_t leaf) const {
    if (!lent.empty()) return lent[leaf];
    return is_spilled(leaf) ? spilled->file.at(spilled->slots[leaf]) : map.leaves[leaf]->buffer().data();
  }
  /// Of a leaf, to change: they are in memory from now on. For one thread at a time and leaf;
  /// forget_spilled() must follow.
  float* own_values(size_t leaf);
  /// What is on the disk of this position no longer counts. For one thread at a time.
  void forget_spilled(size_t leaf);

  /// Cutting may change this position.
  bool owns(size_t index) const { return others.empty() || others[map.column(index)] == 0; }

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
  /// Of the values as they stand, once it was asked for; who changes them forgets it. Not for several threads
  /// at a time.
  mutable std::optional<uint64_t> hash{};
};

/// Positions that a box and its band need: where they lie, without their states.
LeafMap map_extent(const Box& box, double voxel);
/// The same, all of them air.
LeafMap empty_map(const Box& box, double voxel);
openvdb::FloatGrid::Ptr empty_grid(double voxel);
/// `own`: these tiles alone are filled. `spill`: null: all leaves stay in memory.
LevelSet make_box(const Box& box, double voxel, const TileSet& own = {}, const Spill* spill = nullptr);
/// Any raw stock (raw_grid.cpp).
LevelSet make_raw(const RawShape& raw, double voxel, const TileSet& own = {}, const Spill* spill = nullptr);
/// Leaves may go to the disk from now on (stock_spill.cpp).
void begin_spill(LevelSet& set, const Spill& spill);
/// See Stock::make_room; empty: every tile is as good as another.
void make_room(LevelSet& set, std::span<const uint32_t> next_use);
TileGrid tiles_of(const LeafMap& map, double voxel);
/// Leaves all other columns to others (stock_tiles.cpp).
void keep_columns(LevelSet& set, const TileSet& own);
/// Planes of leaf positions, across x, that a fresh stock is filled with at once.
inline constexpr int kPlanesAtOnce = 4;
/// Leaves of the positions from `begin` on.
struct MadeLeaves {
  size_t begin = 0;
  std::vector<std::unique_ptr<LeafNode>> leaves;
  std::unique_ptr<LeafNode>& at(size_t position) { return leaves[position - begin]; }
};
/// Fills a fresh stock: fill(first, last, made) gives the positions of planes [first, last) their states and
/// makes their leaves. What the tree holds between the leaves gets its signs.
void fill_map(LevelSet& set, const std::function<void(int first, int last, MadeLeaves& made)>& fill);

/// What a leaf's values amount to; sets the leaf's mask of active voxels (those inside the band) when it
/// stays.
LeafState settle_leaf(LeafNode& leaf, float band);

/// Removes the sweeps from the level set (stock_cut.cpp).
void cut_level_set(LevelSet& level_set, std::span<const Sweep> sweeps, const CutterSolid& cutter);
/// Of leaf positions [begin, end), each in voxels; the sum of such.
std::vector<double> volumes(const LevelSet& level_set, size_t begin, size_t end);
double sum_of(const LevelSet& level_set, std::span<const double> volumes);
/// See Stock::volume_between (stock_volume.cpp): of leaf positions [begin, end), each in voxels; all of them
/// together.
std::vector<VolumeRange> volume_ranges(const LevelSet& level_set, double slack_mm, size_t begin, size_t end);
VolumeRange sum_of(const LevelSet& level_set, std::span<const VolumeRange> ranges);
double trilinear(const LevelSet& level_set, const Vec3& point_W);
double air_radius(const LevelSet& level_set, const Vec3& point_W);
std::vector<Vec3> air_points(const LevelSet& level_set, double below_mm);
uint64_t state_hash(const LevelSet& level_set);
/// Invariants, see Stock::check (stock_check.cpp).
std::string broken_invariant(const LevelSet& level_set, CheckLevel level);
/// Invariant 8 of leaf positions [begin, end).
std::string broken_step(const LevelSet& level_set, size_t begin, size_t end);
std::string gained_material(const LevelSet& level_set, const LevelSet& earlier);
void write_level_set(const LevelSet& level_set, const std::string& path, const StockMetadata& metadata);
/// `metadata` receives what write_level_set was given.
LevelSet read_level_set(const std::string& path, StockMetadata& metadata);
LevelSet deep_copy(const LevelSet& level_set);

}  // namespace swarf::stock
