#include "measure/regions.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "base/disjoint_sets.h"
#include "base/units.h"

namespace swarf::measure {
bool larger(const Region& a, const Region& b) {
  return a.worst_um != b.worst_um ? a.worst_um > b.worst_um : a.ray < b.ray;
}

void join_region(const Region& found, uint32_t region_of_ray, double pitch_mm, std::vector<Region>& regions) {
  Region* home = region_of_ray == kNoRegion ? nullptr : &regions[region_of_ray];
  for (Region& region : regions) {
    if (home != nullptr) break;
    if ((region.place - found.place).norm() <= 2.0 * pitch_mm) home = &region;
  }
  if (home == nullptr) {
    regions.push_back(found);
  } else if (found.worst_um > home->worst_um) {
    home->worst_um = found.worst_um;
    home->place = found.place;
    home->block = found.block;
    home->end = found.end;
  }
}

std::vector<Region> find_regions(const stock::RayField& field, std::span<const double> values_mm,
                                 std::span<const uint32_t> blocks, double limit_mm,
                                 std::vector<uint32_t>* region_of) {
  DisjointSets sets(field.size());
  for (const auto& [a, b] : field.edges) {
    if (values_mm[a] > limit_mm && values_mm[b] > limit_mm) sets.join(a, b);
  }
  std::vector<Region> regions;
  std::vector<uint32_t> found_in(field.size(), kNoRegion);
  for (uint32_t n = 0; n < field.size(); ++n) {
    if (!(values_mm[n] > limit_mm)) continue;
    const uint32_t root = sets.root(n);
    if (root == n) regions.emplace_back();
    found_in[n] = root == n ? static_cast<uint32_t>(regions.size() - 1) : found_in[root];
    Region& region = regions[found_in[n]];
    region.area_mm2 += field.areas_mm2[n];
    ++region.rays;
    if (root != n && um_from_mm(values_mm[n]) <= region.worst_um) continue;
    region.worst_um = um_from_mm(values_mm[n]);
    region.place = field.points[n];
    region.block = blocks[n];
    region.ray = n;
  }
  std::sort(regions.begin(), regions.end(), larger);
  if (region_of == nullptr) return regions;
  std::vector<uint32_t> place(regions.size());  // in the sorted list, by the number it was found under
  for (uint32_t i = 0; i < regions.size(); ++i) place[found_in[regions[i].ray]] = i;
  for (uint32_t& region : found_in) region = region == kNoRegion ? kNoRegion : place[region];
  *region_of = std::move(found_in);
  return regions;
}

}  // namespace swarf::measure
