// The proof over one root cell of the design, by branch and bound (certificate.h). Internal to this folder.
#pragma once

#include <vector>

#include "measure/certificate.h"
#include "measure/certified_regions.h"
#include "measure/design_cell.h"
#include "measure/sweep_index.h"
#include "stock/rays/surface_dexels.h"

namespace swarf::measure {

/// A cell is closed when its bound is this near to what was measured: mm, and share.
inline constexpr double kGap = 4e-5, kGapShare = 2e-4;

/// The same above a gap, mm: sweeps bound what they leave lowest, the grid alone bounds a roof from above.
inline double above_gap(double voxel_mm) {
  constexpr double kVoxels = 3.0;
  return kVoxels * voxel_mm;
}

/// Everything of one root cell, worked on by one task.
struct RootResult {
  double gouge = 0.0, excess = 0.0, scallop = 0.0;  ///< bounds, mm
  Vec3 gouge_at = Vec3::Zero(), excess_at = Vec3::Zero(), scallop_at = Vec3::Zero();
  double gouge_found = 0.0, excess_found = 0.0;                 ///< mm
  Vec3 gouge_bottom = Vec3::Zero(), excess_top = Vec3::Zero();  ///< where the material ends there
  double above_found = 0.0;                                     ///< measured top of material above a gap, mm
  Vec3 above_top = Vec3::Zero();
  uint32_t gouge_block = stock::kUncut, excess_block = stock::kUncut;
  RootRegions gouges, excesses;  ///< beyond the limits
  struct Open {
    double depth, height, skin, area;
  };
  std::vector<Open> open;
  size_t cells = 0, work = 0;
  bool broken = false;     ///< a place beyond a limit was found
  bool cut_short = false;  ///< the budget did not suffice
};

/// Looks at a sweep over a cell: in all, and once a limit is broken, when nothing is left to prove but how
/// deep, how high and how wide.
struct Budget {
  size_t all, broken;
};

/// Cells that the budget does not suffice for stay open.
RootResult prove_root(const CertificateInput& input, const SweepIndex& index, const RootCell& root,
                      const Budget& budget);

}  // namespace swarf::measure
