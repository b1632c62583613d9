// The stock: a narrow-band OpenVDB level set that sweeps cut. Negative inside the material.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/frames.h"
#include "mesh/tri_mesh.h"
#include "stock/raw/raw_shape.h"
#include "stock/sweep/sweep.h"

namespace swarf::stock {

struct LevelSet;  // internal to this folder

struct CutStatistics {
  uint64_t sweeps = 0;
  uint64_t voxel_updates = 0;  ///< voxels evaluated
  uint64_t leaf_visits = 0;
  double seconds = 0.0;
};

/// Texts kept in a stock file, by key.
using StockMetadata = std::map<std::string, std::string>;

/// Least and greatest volume, mm3.
struct VolumeRange {
  double least = 0.0, greatest = 0.0;
};

/// Leaves go to the disk while they are not cut.
struct Spill {
  std::string folder;      ///< where there is room; nothing is left there, however the process ends
  size_t leaves_most = 0;  ///< in memory after each Stock::make_room
};

/// The columns of the stock's leaf positions, kTileLeaves x kTileLeaves at a time, through the whole height.
struct TileGrid {
  Vec2 lower_mm = Vec2::Zero();  ///< W
  double side_mm = 0.0;
  int count_x = 0, count_y = 0;
  size_t size() const { return static_cast<size_t>(count_x) * count_y; }
  size_t index(int i, int j) const { return static_cast<size_t>(i) * count_y + j; }
};

/// How far Stock::check goes.
enum class CheckLevel {
  kOwnMap,  ///< the next within the tiles of one process (stock_tiles.h), which others may have passed
  kMap,     ///< invariants 1 to 4: leaf positions only, about a millisecond per 100 000 of them
  kLeaves,  ///< 1 to 7: each leaf by itself
  kVoxels,  ///< all: reads every voxel and its neighbours
};

class Stock {
 public:
  /// A box of material. Throws std::bad_alloc never: ask memory_estimate first.
  Stock(const Box& box_W, double voxel_mm);
  /// Any raw stock; a box gives the same bits as above. Parallel, the same for any number of threads.
  /// Material thinner than a voxel is lost where it holds no grid point (RawShape::thinnest_wall).
  /// `spill`: leaves go to the disk from the start; null: they stay in memory.
  Stock(const RawShape& raw, double voxel_mm, const Spill* spill = nullptr);
  ~Stock();
  Stock(Stock&&) noexcept;
  Stock& operator=(Stock&&) noexcept;

  /// Removes the sweeps, in order; parallel, bit-identical for any thread count and any split into calls.
  void cut(std::span<const Sweep> sweeps, const CutterSolid& cutter);

  /// From now on leaves go to the disk. Everything that the stock is asked is answered as if they had not;
  /// what is cut again comes back. Throws InputError "spill-unwritable".
  void begin_spill(const Spill& spill);
  bool spills() const;
  static TileGrid tiles_of(const Box& box_W, double voxel_mm);
  /// When more leaves are in memory than may be, half of that stays: those of the tiles that are used first.
  /// `next_use`: by tile, when it will be cut next, in any unit. Throws InputError "spill-disk-full".
  void make_room(std::span<const uint32_t> next_use);
  size_t leaves_on_disk() const;

  double voxel_mm() const;
  const Box& box() const;  ///< of the raw stock
  /// What was there before any cut. Of a stock that was read from a file without its shape only a box is
  /// known: asked for another one it is our own fault.
  const RawShape& raw() const;
  /// Material left: every cell by the fraction that its level set fills (exact for planes, even oblique ones;
  /// an edge of length l is off by up to l voxel^2 / 12, with opposite signs for convex and concave ones).
  double volume_mm3() const;
  /// Proven: the material whose distances the level set holds lies between these. Each grid point of distance
  /// d has a ball of radius |d| about it that is all material or all air; what no ball settles may be either.
  /// `slack_mm`: how far the sweeps that cut it may lie from the motion they stand for.
  VolumeRange volume_between(double slack_mm) const;
  /// Values are the distances of box and sweeps within this, mm: what the kernels round at most.
  double rounding_mm() const;
  double distance_mm(const Vec3& point_W) const;  ///< trilinear signed distance, clamped to the band
  /// Closed surface of the material with sharp edges and outward normals: see StockMesher, which makes it,
  /// and makes it faster when it is asked for again after some cutting.
  TriMesh mesh() const;
  /// Radius in mm of a ball about the point in which there is certainly no material, as far as the grid
  /// tells; 0: nothing is known. Values are distance bounds (each cut is 1-Lipschitz and only raises them),
  /// so a grid point of value v > 0 has no material within v. The caller takes off how far the sweeps that
  /// cut the grid stray from the motion.
  double air_radius_mm(const Vec3& point_W) const;
  /// Grid points in the air whose value is below this, mm, in W. Whatever the grid misses lies near them: a
  /// place of the material is no farther than sqrt(3) / 2 voxel from a grid point, whose value is then no
  /// more than that, so that it is one of these or inside the material.
  std::vector<Vec3> air_points(double below_mm) const;
  uint64_t hash() const;
  size_t memory_bytes() const;
  const CutStatistics& statistics() const;
  /// Invariants, numbered from cheap to costly; the first broken one in words, or "".
  ///  1 the tree has as many leaves as the map of leaf positions
  ///  2 each leaf of the map is the tree's leaf at that position
  ///  3 where the map has no leaf, the tree's value is the background with the sign of air or solid
  ///  4 no air position shares a face with a solid one: the surface between them would be missing
  ///  5 every value lies within the band and is a number
  ///  6 a voxel is active exactly when its value lies inside the band
  ///  7 no leaf is wholly air or wholly solid: equal material means equal leaves
  ///  8 values of neighbouring voxels, across leaf borders too, differ by no more than their distance
  std::string check(CheckLevel level = CheckLevel::kVoxels) const;
  /// Invariants between two states of one stock, `earlier` cut on to this one; the first broken one, or "".
  ///  9 leaf positions go from solid to leaf to air, never back
  /// 10 no voxel gained material
  std::string check_since(const Stock& earlier) const;

  /// A stock of its own with the same material: twice the memory.
  Stock clone() const;

  /// OpenVDB file, replaced whole. `metadata` is stored as strings of the grid, which is named "stock".
  void save(const std::string& path, const StockMetadata& metadata) const;
  /// Throws InputError for what is not a stock written by save(): "stock-file-unreadable",
  /// "stock-file-empty", "stock-file-foreign", "stock-not-level-set", "stock-file-incomplete",
  /// "stock-file-damaged". `metadata`, if given, receives every text of the grid: what save() was given and
  /// OpenVDB's own.
  /// `raw`: what it was before its cuts, for raw(); null: the box, if the file says so.
  static Stock load(const std::string& path, StockMetadata* metadata = nullptr,
                    const RawShape* raw = nullptr);

  size_t leaves() const;                      ///< blocks of 8x8x8 voxels along the surface
  static constexpr size_t kLeafBytes = 2048;  ///< what a leaf on the disk takes less of memory

  /// Bytes of a stock with so many leaves: theirs and those of the map of all leaf positions.
  static size_t memory_for(const Box& box_W, double voxel_mm, double leaves);
  /// Bytes of the uncut box, by its area: the least that a run needs.
  static size_t memory_estimate(const Box& box_W, double voxel_mm);
  static size_t memory_estimate(const RawShape& raw, double voxel_mm);

 private:
  friend class ContactFinder;
  friend class SlabProofs;
  friend class StockMesher;
  friend class StockTiles;
  struct Impl;
  const LevelSet& level_set() const;
  explicit Stock(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace swarf::stock
