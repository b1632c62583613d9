// What is measured of the finished part. Plain numbers; units in the names, as in metrics.json.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/frames.h"

namespace swarf::measure {

/// A cusp between two passes, refined between the rays (theory 6, toolchain 3.6).
struct Ridge {
  double u = 0.0, v = 0.0;
  double height_um = 0.0;
  uint32_t block_a = 0, block_b = 0;  ///< sweeps on its two sides
};

struct SurfaceMetrics {
  size_t samples = 0;
  double scallop_max_um = 0.0;   ///< highest refined ridge
  double scallop_mean_um = 0.0;  ///< mean of the refined ridges
  double scallop_p05_um = 0.0;   ///< 5th percentile of the ridges
  double scallop_p95_um = 0.0;
  double scallop_theory_um = 0.0;  ///< from the planner's intervals
  size_t ridges = 0;
  double gouge_max_um = 0.0;    ///< deepest cut below the design, >= 0
  double gouge_area_mm2 = 0.0;  ///< area deeper than the gouge limit
  uint32_t gouge_block = 0xffffffffu;
  double excess_max_um = 0.0;  ///< highest material anywhere, uncut included
  uint32_t excess_block = 0xffffffffu;
  double within_tolerance_pct = 0.0;  ///< share of samples between -gouge limit and +scallop limit
  size_t uncut_samples = 0;
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
