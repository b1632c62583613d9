// What is measured of the finished part. Plain numbers; units in the names, as in metrics.json.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/frames.h"

namespace swarf::measure {

/// A cusp between two passes, refined between the rays (theory 6).
struct Ridge {
  double u = 0.0, v = 0.0;
  double height_um = 0.0;
  uint32_t block_a = 0, block_b = 0;  ///< sweeps on its two sides
  Vec3 point = Vec3::Zero();          ///< its foot on the design, W, mm; u and v are 0 on a mesh
  Vec3 top = Vec3::Zero();            ///< its crest over the foot, W, mm
  uint32_t ray = 0;                   ///< one of the two beside it
};

/// A connected part of the design that lies deeper (a gouge) or stands higher (excess) than the limit.
struct Region {
  double worst_um = 0.0;         ///< its greatest depth or height, > 0
  double area_mm2 = 0.0;         ///< of the design
  double volume_mm3 = 0.0;       ///< between the design and the part, over that area
  Vec3 place = Vec3::Zero();     ///< where the worst is: a point of the design, W, mm
  uint32_t block = 0xffffffffu;  ///< Sweep::block of the worst; kUncut where no sweep came
  size_t rays = 0;
  uint32_t ray = 0;         ///< the worst ray
  Vec3 end = Vec3::Zero();  ///< where the material ends over or below `place`, W, mm
};
/// SurfaceMetrics lists no more regions of a kind than this, the worst.
inline constexpr size_t kListedRegions = 20;

/// What is proven of the whole design, between the rays too (theory 8): no place of it lies deeper, or
/// carries higher material, than this.
struct Bound {
  double um = 0.0;
  Vec3 place = Vec3::Zero();  ///< about where the proof is loosest: a point of the design, W, mm
};

struct SurfaceMetrics {
  size_t samples = 0;
  double area_mm2 = 0.0;         ///< of the design
  double scallop_max_um = 0.0;   ///< highest refined ridge
  double scallop_mean_um = 0.0;  ///< mean of the refined ridges
  double scallop_p05_um = 0.0;   ///< 5th percentile of the ridges
  double scallop_p95_um = 0.0;
  double scallop_theory_um = 0.0;  ///< from the planner's intervals
  size_t ridges = 0;
  double gouge_max_um = 0.0;         ///< deepest cut below the design, >= 0; refined between the rays
  Vec3 gouge_bottom = Vec3::Zero();  ///< its bottom, W, mm
  double gouge_area_mm2 = 0.0;       ///< area deeper than the gouge limit
  uint32_t gouge_block = 0xffffffffu;
  /// What the stock lacks below the design where no sweep has come: deepest of the rays, and farther where
  /// the design's own places are (sim/run/missing_material.h); a point of the design, W, mm.
  double missing_max_um = 0.0;
  Vec3 missing_place = Vec3::Zero();
  /// Highest material anywhere: uncut, or left above an undercut, included; refined between the rays. Where
  /// it ends, W, mm: within the part where another face is as near (sim/run/highest_place.h).
  double excess_max_um = 0.0;
  Vec3 excess_top = Vec3::Zero();
  uint32_t excess_block = 0xffffffffu;
  double within_tolerance_pct = 0.0;  ///< share of the area between -gouge limit and +scallop limit
  /// None: not proven (no design, or the proof was not asked for). Never below gouge_max_um, excess_max_um,
  /// scallop_max_um. The scallop's is of all that stands on the design below the first air over it.
  std::optional<Bound> gouge_bound, excess_bound, scallop_bound;
  double unmeasured_area_mm2 = 0.0;  ///< of the design, that neither rays nor the proof have looked at
  size_t uncut_samples = 0;
  size_t overhung_samples = 0;                   ///< rays with material above a gap
  size_t gouge_regions = 0, excess_regions = 0;  ///< all of them
  std::vector<Region> gouges, excesses;          ///< the worst kListedRegions, worst first
};

struct HistogramBin {
  double low_um, high_um;
  size_t count;
};

/// Level set against dexels, the built-in check of one by the other.
struct CrossCheck {
  double mean_abs_um = 0.0, p99_um = 0.0, max_um = 0.0;
  double bound_um = 0.0;  ///< what the voxel size and the sweep bounds allow at most
  bool holds = true;      ///< every compared sample lies within its own bound
  size_t samples = 0;     ///< compared
  size_t excluded =
      0;  ///< uncut, at a wall, or at a face of the block, where the level set rounds a sharp edge
};

}  // namespace swarf::measure
