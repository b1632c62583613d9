// Measuring the finished part on the rays of its design, and the level set against them.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "measure/metrics.h"
#include "measure/sweep_cutters.h"
#include "stock/raw/raw_shape.h"
#include "stock/rays/free_ranges.h"
#include "stock/rays/surface_dexels.h"
#include "stock/stock.h"
#include "stock/sweep/sweep.h"

namespace swarf::measure {

struct MeasureLimits {
  double scallop_mm = 0.01;  ///< a sample is within tolerance up to this above the design
  double gouge_mm = 0.001;   ///< and down to this below it; also the limit of the gouged area
};

/// What rays of a design begin with. Borrowed.
struct RayMaterial {
  const stock::RawShape& raw;
  const stock::FreeRange& ranges;  ///< of the whole design
};

/// Scallops, gouges and excess on the rays of one surface or mesh.
///   sweeps         what cut the dexels, indexed by Sweep::block
///   pass_of_sweep  pass of each sweep, -1 for moves between passes; as long as `sweeps`. Empty for a path
///   whose
///                  passes nobody knows: two sweeps then belong to different passes when the way between them
///                  along the path is more than twice the straight line (pass_rule.h)
///   cutters        of each sweep
///   material       what the dexels began with: between the rays the highest material is looked for by exact
///                  rays from the highest of them on (highest.h), a search, no proof. Null: excess is that of
///                  the rays and of the refined ridges
///   ridges         every refined cusp is appended to it
/// Areas weigh: gouged area and the share within tolerance do not depend on how the rays are spread.
/// scallop_theory_um is left to the caller: it belongs to the path.
SurfaceMetrics measure_surface(const stock::SurfaceDexels& dexels, std::span<const stock::Sweep> sweeps,
                               std::span<const int> pass_of_sweep, const SweepCutters& cutters,
                               const MeasureLimits& limits, std::vector<Ridge>* ridges,
                               const RayMaterial* material = nullptr);

/// Several surfaces as one; `ridges` are those of all of them. No parts: all zero.
SurfaceMetrics combine(const std::vector<SurfaceMetrics>& parts, const std::vector<Ridge>& ridges);

/// Equal bins over [low, high); heights beyond are counted in the first and the last.
std::vector<HistogramBin> height_histogram(const stock::SurfaceDexels& dexels, double low_um, double high_um,
                                           int bins);

/// The level set's distance at the material's surface as the rays see it: zero but for
///   sweep_bound                  what cut the level set and what cut the rays lie so far from one motion
///   sqrt(3)/2 voxel slope        trilinear values cut a cusp of that slope low (theory 6)
///   3/8 voxel^2 curvature        chord of a curved surface
///   the rounding of floats
/// Slopes and curvature are taken between rays. A sample beyond them is looked at again: the level set there
/// must be, within sweep bound and rounding, what the sweeps themselves make of its grid points; its bound
/// then is the exact level set's own distance. Each sample is held to its own bound; bound_um is the greatest
/// of them, or that of the sample that fails worst. `sweeps` cut the rays, by Sweep::block; parametric
/// designs only.
CrossCheck cross_check(const stock::Stock& stock, const stock::SurfaceDexels& dexels,
                       std::span<const stock::Sweep> sweeps, const SweepCutters& cutters,
                       double sweep_bound_mm);

/// Several surfaces as one: it holds when all hold. Figures are of the worst, a failing one first whatever
/// the others show; counts are of all. None: nothing was compared.
std::optional<CrossCheck> combine(const std::vector<CrossCheck>& parts);

}  // namespace swarf::measure
