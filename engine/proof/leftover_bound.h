// How far material that the sweeps leave stands off a design, proven between all samples (theory 8).
//
// The regions of the design's features (solid_design.h), from the height h up to the height T over their
// feet, hold every place outside the design that is between h and T away from it. Each is a convex body. It
// holds no material where one convex set holds all its corners:
//   sweep     what one piece of a cutter removes along a line, or at one instant where it turns
//   raw       what lies beyond the raw stock there
//   nearer    places that are nearer to another facet Q than to their own foot: dist(x, Q) - way . (x - foot)
//             is a convex function, and such places belong to the region of the feature that is nearest
//   air       a ball that the level set knows to be air
// A body that no set holds is cut in two by a plane across the border of the set that holds most of it. A
// centre that no set holds, outside the design and in the raw stock, is leftover material, as high as its
// distance. What is farther than T is looked at by an octree over the raw stock, which the level set answers
// for.
#pragma once

#include <cstdint>
#include <span>

#include "base/progress.h"
#include "measure/sweep_cutters.h"
#include "proof/solid_design.h"
#include "stock/stock.h"
#include "stock/sweep/sweep.h"

namespace swarf::proof {

struct LeftoverQuestion {
  const SolidDesign& design;
  std::span<const stock::Sweep> sweeps;  ///< Sweep::block is its index
  const measure::SweepCutters& cutters;
  const stock::Stock& stock;
  double stock_bound_mm = 0.0;  ///< how far the sweeps that cut it stray from the motion
  double limit_mm = 0.01;       ///< above 0: what is to be decided
  double known_mm = 0.0;        ///< what rays have found
  Progress& progress;
  double progress_from = 0.0;  ///< advanced from here by 1
};

struct LeftoverBound {
  double bound_mm = 0.0;      ///< no material stands farther off the facets
  Vec3 place = Vec3::Zero();  ///< where the bound was loosest: a point of the design, W, mm
  double found_mm = 0.0;      ///< farthest leftover point that was met; 0: none beyond what was known
  Vec3 top = Vec3::Zero(), foot = Vec3::Zero();  ///< that point, and the nearest one of the design; W, mm
  size_t open = 0;                               ///< regions that were not proven
  double open_area_mm2 = 0.0;
  size_t regions = 0, parts = 0;
};

/// The chord of the design's facets is not included. Interrupted, it proves nothing.
LeftoverBound bound_leftover(const LeftoverQuestion& question);

}  // namespace swarf::proof
