// How deep the sweeps of a program cut into a design, proven sweep by sweep (theory 8).
//
// A sweep gouges by at most g if a body that lies within g of every point of the cutter passes clear of the
// design (tool_body.h). A cutter that does not turn sweeps the hull of its two ends; one that turns is
// divided in time until the hull of both ends, widened by the sagitta, is clear. Clear of the surface and
// with one point outside, a sweep is outside. The work grows with the sweeps and the facets near them, not
// with the area of the design.
#pragma once

#include <cstdint>
#include <span>

#include "base/progress.h"
#include "measure/sweep_cutters.h"
#include "proof/solid_design.h"
#include "stock/sweep/sweep.h"

namespace swarf::proof {

struct GougeQuestion {
  const SolidDesign& design;
  std::span<const stock::Sweep> sweeps;  ///< Sweep::block is its index
  const measure::SweepCutters& cutters;
  double limit_mm = 0.001;  ///< above 0: what is to be decided
  double known_mm = 0.0;    ///< what rays have found
  const Progress& progress;
};

struct GougeBound {
  double bound_mm = 0.0;      ///< no sweep cuts deeper into the facets
  Vec3 place = Vec3::Zero();  ///< on the design, near the sweep that the bound was loosest for; W, mm
  double found_mm = 0.0;      ///< deepest removed point that was met, 0: none
  Vec3 bottom = Vec3::Zero(), foot = Vec3::Zero();  ///< that point, and the nearest one of the design; W, mm
  uint32_t sweep = 0xffffffffu;                     ///< that removes it
  size_t open = 0;                                  ///< sweeps that were not proven within the limit
};

/// The chord of the design's facets is not included. Interrupted, it proves nothing.
GougeBound bound_gouges(const GougeQuestion& question);

}  // namespace swarf::proof
