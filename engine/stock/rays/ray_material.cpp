#include "stock/rays/ray_material.h"

#include <algorithm>

namespace swarf::stock {
namespace {

struct Range {
  size_t begin, end;
};

Range range_of(const std::vector<MaterialAbove>& above, uint32_t ray) {
  const auto first = std::lower_bound(above.begin(), above.end(), ray,
                                      [](const MaterialAbove& m, uint32_t r) { return m.ray < r; });
  auto last = first;
  while (last != above.end() && last->ray == ray) ++last;
  return {static_cast<size_t>(first - above.begin()), static_cast<size_t>(last - above.begin())};
}

/// What is left of one interval, appended to `left`; true when that differs from the interval.
bool cut_interval(const RayCut& cut, MaterialAbove m, std::vector<MaterialAbove>& left) {
  bool changed = false;
  if (cut.high <= m.low || cut.low >= m.high) {
    // Beside the interval, or touching its end: then only the end's block may change.
    uint32_t& block = cut.high <= m.low ? m.low_block : m.high_block;
    const bool touches = cut.high == m.low || cut.low == m.high;
    changed = touches && cut.block < block;
    if (changed) block = cut.block;
    left.push_back(m);
    return changed;
  }
  if (cut.low > m.low) left.push_back({m.ray, m.low_block, cut.block, m.low, cut.low});
  if (cut.high < m.high) left.push_back({m.ray, cut.block, m.high_block, cut.high, m.high});
  return true;
}

}  // namespace

bool remove_material(const RayCut& cut, uint32_t ray, StandingMaterial& standing,
                     std::vector<MaterialAbove>& above) {
  if (!(cut.high > cut.low)) return false;  // a touch removes nothing
  const Range range = range_of(above, ray);
  bool changed = false;
  std::vector<MaterialAbove> left;
  if (cut.low < standing.height || (cut.low == standing.height && cut.block < standing.block)) {
    if (cut.high < standing.height) {
      left.push_back({ray, cut.block, standing.block, cut.high, standing.height});
    }
    standing = {cut.low, cut.block};
    changed = true;
  }
  for (size_t i = range.begin; i < range.end; ++i) changed |= cut_interval(cut, above[i], left);
  if (!changed) return false;
  const auto first = above.begin() + static_cast<std::ptrdiff_t>(range.begin);
  const auto next = above.erase(first, above.begin() + static_cast<std::ptrdiff_t>(range.end));
  above.insert(next, left.begin(), left.end());
  return true;
}

std::span<const MaterialAbove> above_ray(const std::vector<MaterialAbove>& above, uint32_t ray) {
  const Range range = range_of(above, ray);
  return std::span(above).subspan(range.begin, range.end - range.begin);
}

}  // namespace swarf::stock
