// The stock: a narrow-band OpenVDB level set that sweeps cut. Negative inside the material.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>

#include "base/frames.h"
#include "mesh/tri_mesh.h"
#include "stock/sweep.h"

namespace swarf::stock {

struct LevelSet;  // internal to this folder

struct CutStatistics {
  uint64_t sweeps = 0;
  uint64_t voxel_updates = 0;  ///< voxels evaluated
  uint64_t leaf_visits = 0;
  double seconds = 0.0;
};

class Stock {
 public:
  /// A box of material. Throws std::bad_alloc never: ask memory_estimate first.
  Stock(const Box& box_W, double voxel_mm);
  ~Stock();
  Stock(Stock&&) noexcept;
  Stock& operator=(Stock&&) noexcept;

  /// Removes the sweeps, in order; parallel, bit-identical for any thread count and any split into calls.
  void cut(std::span<const Sweep> sweeps, const CutterSolid& cutter);

  double voxel_mm() const;
  const Box& box() const;
  /// Material left: every cell by the fraction that its level set fills (exact for planes, even oblique ones;
  /// an edge of length l is off by up to l voxel^2 / 12, with opposite signs for convex and concave ones).
  double volume_mm3() const;
  double distance_mm(const Vec3& point_W) const;  ///< trilinear signed distance, clamped to the band
  /// Closed surface of the material with sharp edges and outward normals: see StockMesher, which makes it, and
  /// makes it faster when it is asked for again after some cutting.
  TriMesh mesh() const;
  uint64_t hash() const;
  size_t memory_bytes() const;
  const CutStatistics& statistics() const;
  /// Invariants, cheap to costly; the first broken one in words, or "".
  std::string check() const;

  /// OpenVDB file, replaced whole. `metadata` is stored as strings.
  void save(const std::string& path, const std::map<std::string, std::string>& metadata) const;
  /// Throws InputError for what is not a level set written by save().
  static Stock load(const std::string& path);

  /// Bytes that a box at this voxel size is expected to need, its peak while cutting included: leaves along
  /// its surface and along as much new surface again as half of that, plus the dense map of leaf positions.
  static size_t memory_estimate(const Box& box_W, double voxel_mm);

 private:
  friend class StockMesher;
  struct Impl;
  const LevelSet& level_set() const;
  explicit Stock(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace swarf::stock
