// The material on one ray as a sorted list of intervals, and what a sweep takes out of it. Internal to this
// folder.
//
//    s ^   top  ========  high, high_block     Above the design (s = 0) the material that stands on it
//    reaches up
//      |        ========                       to `height`. A sweep that passes under an overhang leaves
//      further |        ========  low, low_block       intervals above a gap. The lowest one has no lower
//      end: what lies |                  (gap)                below the design is the part. |        ========
//      height, block
//    0 |........========........
//
// Subtracting intervals is independent of their order; where two sweeps end at the same s, the smaller block
// id is kept. So is the result of any split of a program into calls, on any number of threads.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace swarf::stock {

/// What a sweep removes from a ray: [low, high], mm along the normal.
struct RayCut {
  double low, high;
  uint32_t block;
};

/// Material above a gap.
struct MaterialAbove {
  uint32_t ray;  ///< its number in its tile
  uint32_t low_block, high_block;
  double low, high;  ///< mm along the normal
};

/// Top of the material that stands on the design, and the block that set it.
struct StandingMaterial {
  double height;
  uint32_t block;
};

/// Takes `cut` out of one ray. `above` holds the intervals of all rays of a tile, sorted by (ray, low).
/// True when anything changed, be it only a block id.
bool remove_material(const RayCut& cut, uint32_t ray, StandingMaterial& standing,
                     std::vector<MaterialAbove>& above);

/// The intervals of one ray.
std::span<const MaterialAbove> above_ray(const std::vector<MaterialAbove>& above, uint32_t ray);

}  // namespace swarf::stock
