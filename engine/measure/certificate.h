// The proof between the rays: bounds of gouge and excess over the whole design, and every place that breaks a
// limit, by branch and bound over cells of the design (theory 8).
//
// The design is divided into cells (design_cell.h). Over each cell the heights that the sweeps leave standing
// are bounded from below and from above (height_bounds.h) and measured exactly at its corners. A cell is
// closed when its bounds lie within kGap of the deepest cut and the highest material measured near it; else
// it is divided. Rays and level set only say where to begin: the result hangs on neither's pitch.
//
// What is proven: no place of the design lies deeper below it than gouge.um along its normal, down to kSkin
// or to where another face is nearer; no material stands higher above it than excess.um, up to where another
// face is nearer. Cells that the budget did not allow to close keep their bound, which then is the proof's.
//
// Where another face is nearer is no linear function over a cell, and greater between corners that stand on
// edges than at any of them (the top of a thin wall). So a cell looks for cuts down to linear functions that
// are nowhere below it: the ball that touches the place p of the cell and passes through a place q of the
// design has the radius |q - p|^2 / (2 n.(p - q)), a convex function of p - q, and what lies deeper is nearer
// to q (column_range.h: own_below).
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "base/dealt_work.h"
#include "base/progress.h"
#include "measure/metrics.h"
#include "measure/sweep_cutters.h"
#include "stock/rays/free_ranges.h"
#include "stock/rays/ray_field.h"
#include "stock/stock.h"
#include "stock/sweep/sweep.h"

namespace swarf::measure {

struct CertificateInput {
  const stock::RayField& field;          ///< the design
  const stock::FreeRange& ranges;        ///< of the whole design
  std::span<const stock::Sweep> sweeps;  ///< Sweep::block is its index
  const SweepCutters& cutters;
  double sweep_bound_mm = 0.0;    ///< how far they stray from the motion
  const stock::Stock& stock;      ///< says what is air far above the design
  double stock_bound_mm = 0.0;    ///< how far the sweeps that cut it stray from the motion
  double gouge_limit_mm = 0.001;  ///< deeper places are listed
  double excess_limit_mm = 0.01;  ///< higher places are listed
  /// Which of the bounds from above are to be made close; those that are not asked for stay as they come.
  bool wants_excess = true, wants_scallop = false;
  double scallop_limit_mm = 0.01;
  double gouge_known_mm = 0.0, excess_known_mm = 0.0;  ///< what the rays have found: where to begin
  /// Advanced from progress_from by 1; may ask to stop, and is asked for it from any thread. What is returned
  /// then proves nothing.
  Progress& progress;
  double progress_from = 0.0;
  /// Has the portions done by others too (dealt_roots.h), all of them when it returns; empty: nobody helps.
  std::function<void(const DealtWork& work)> deal = {};
};

struct Certificate {
  Bound gouge, excess;
  Bound scallop;  ///< of what stands on the design itself, below the first air over it: never above excess
  /// Deepest cut and highest material that were measured, at a corner of some cell; um, >= 0.
  double gouge_found_um = 0.0, excess_found_um = 0.0;
  Vec3 gouge_bottom = Vec3::Zero();  ///< on the design, W, mm
  Vec3 excess_top = Vec3::Zero();    ///< where that material ends, W, mm
  /// Of excess_found_um, what stands above a gap.
  double above_found_um = 0.0;
  Vec3 above_top = Vec3::Zero();
  uint32_t gouge_block = 0xffffffffu, excess_block = 0xffffffffu;
  std::vector<Region> gouges, excesses;  ///< every place beyond the limits, worst first
  /// Cells whose bound is looser than what was found and than the limit; mm2 and how many.
  double open_area_mm2 = 0.0;
  size_t cells = 0, open_cells = 0;
};

Certificate certify(const CertificateInput& input);

/// What certify() is expected to hold while it proves a surface that keeps its limits, bytes.
double certify_bytes(const stock::RayField& field);

}  // namespace swarf::measure
