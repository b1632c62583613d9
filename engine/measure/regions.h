// Connected regions of rays beyond a limit, and the true depth of gouges between the rays. Internal to this
// folder.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "measure/metrics.h"
#include "measure/pass_rule.h"
#include "stock/rays/surface_dexels.h"

namespace swarf::measure {

/// Larger first, then by ray.
bool larger(const Region& a, const Region& b);

inline constexpr uint32_t kNoRegion = 0xffffffffU;

/// Regions of neighbouring rays whose value exceeds `limit_mm`, largest value first. `blocks`: which block
/// set each value. `region_of` (may be null) receives per ray its region, or kNoRegion.
std::vector<Region> find_regions(const stock::RayField& field, std::span<const double> values_mm,
                                 std::span<const uint32_t> blocks, double limit_mm,
                                 std::vector<uint32_t>* region_of);

/// Joins a place that was refined between the rays to the region of its ray, or to one that passes between
/// the rays close by; else it is a region of its own that no ray met.
void join_region(const Region& found, uint32_t region_of_ray, double pitch_mm, std::vector<Region>& regions);

/// All gouges, deepest first: regions of rays deeper than `limit_mm`, and gouges so narrow that they pass
/// between the rays, provided that they are at least as long as the pitch along the path. The search:
///   1. The path is divided into pieces one pitch long; of the rays that a piece owns the lowest stands for
///   it.
///   2. With differences of the owner's exact height beside the ray a parabola foretells the lowest height
///   nearby.
///   3. Around the kRefined deepest forecasts, and the deepest rays of as many regions, the depth is
///   maximised
///      over the foot on the design by a compass search with halving steps, down to a few nanometres of
///      depth; the sweeps before and after the owner count too.
/// `deepest` receives the deepest place of all, beyond the limit or not; it is left alone when nothing lies
/// below the design.
std::vector<Region> find_gouges(const stock::SurfaceDexels& dexels, std::span<const stock::Sweep> sweeps,
                                const PassRule& rule, const SweepCutters& cutters, double limit_mm,
                                Region* deepest);

}  // namespace swarf::measure
