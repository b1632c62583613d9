#include "stock/level_set/column_kernel.h"

#include <cmath>
#include <vector>

#include "stock/sweep/sweep_distance.h"

namespace swarf::stock {
namespace {

/// Heights of a column between which the run may reach it, mm; outside > 0: it does not.
struct Heights {
  LaneFloats low, high, outside;
};

SWARF_KERNEL_INLINE void find_heights(Heights& out, const ColumnQuery& q, const ColumnRow& row) {
  const float first_y = row.y, step = row.step, x = row.x - q.centre[0], ox = row.x - q.foot[0];
  const float per_lean = q.per_lean, radius = q.radius, length = q.length;
  const float ux = q.lean[0] * per_lean, uy = q.lean[1] * per_lean;
  const bool upright = per_lean == 0.0F;
  const float z_first = q.foot[2], rise = q.rise, cy = q.centre[1], fy = q.foot[1];
  const float along_x = q.along[0], along_y = q.along[1], half_along = q.half_along,
              half_across = q.half_across;
  for (int n = 0; n < kLanes; ++n) {
    const float y = first_y + step * static_cast<float>(n);
    const float along = std::abs(along_x * x + along_y * (y - cy));
    const float across = std::abs(along_x * (y - cy) - along_y * x);
    const float oy = y - fy, passed = ox * ux + oy * uy;  // level, along the lean
    const float mx = ox - passed * ux, my = oy - passed * uy;
    const float spare = radius * radius - (mx * mx + my * my);
    const float half = std::sqrt(kernel::max_of(spare, 0.0F));
    const float from = upright ? 0.0F : kernel::max_of((passed - half) * per_lean, 0.0F);
    const float to = upright ? length : kernel::min_of((passed + half) * per_lean, length);
    const float z0 = z_first + from * rise, z1 = z_first + to * rise;
    out.low.lane[n] = kernel::min_of(z0, z1) - radius;
    out.high.lane[n] = kernel::max_of(z0, z1) + radius;
    const float beside = kernel::max_of(along - half_along, across - half_across);
    out.outside.lane[n] = kernel::max_of(beside, kernel::max_of(-spare, from - to));
  }
}

/// The least of the bottom planes.
SWARF_KERNEL_INLINE void raise_by_bottoms(Heights& out, const ColumnQuery& q, const ColumnRow& row) {
  const float x = row.x, first_y = row.y, step = row.step;
  LaneFloats bottom;
  for (int n = 0; n < kLanes; ++n) bottom.lane[n] = q.planes == 0 ? -1e30F : 1e30F;
  for (int p = 0; p < q.planes; ++p) {
    const float z = q.plane[p].z + q.plane[p].x * x, slope = q.plane[p].y;
    for (int n = 0; n < kLanes; ++n) {
      const float y = first_y + step * static_cast<float>(n);
      bottom.lane[n] = kernel::min_of(bottom.lane[n], z + slope * y);
    }
  }
  for (int n = 0; n < kLanes; ++n) out.low.lane[n] = kernel::max_of(out.low.lane[n], bottom.lane[n]);
}

SWARF_KERNEL_INLINE void find_spans(const ColumnQuery& asked, const ColumnRow& row, ColumnSpans& out) {
  constexpr float kAlmostOne = 0.99F;  // whole numbers stay what they are when it is added
  constexpr float kFar = 1e6F;
  Heights heights;
  find_heights(heights, asked, row);
  raise_by_bottoms(heights, asked, row);
  const float bottom = row.bottom, per_leaf = row.per_leaf;
  uint32_t tops[kLanes];
  for (int n = 0; n < kLanes; ++n) tops[n] = row.tops[n];
  uint32_t some = 0;
  for (int n = 0; n < kLanes; ++n) {
    const float low = kernel::min_of((heights.low.lane[n] - bottom) * per_leaf, kFar);
    const float high = kernel::min_of((heights.high.lane[n] - bottom) * per_leaf, kFar);
    const int first = static_cast<int>(kernel::max_of(low, 0.0F) + kAlmostOne);
    const int last = static_cast<int>(kernel::max_of(high + 1.0F, 0.0F)) - 1;
    const int top = static_cast<int>(tops[n]) - 1;
    out.first[n] = first;
    out.last[n] = last < top ? last : top;
  }
  for (int n = 0; n < kLanes; ++n) {
    some |= out.first[n] <= out.last[n] && heights.outside.lane[n] <= 0.0F ? 1U << n : 0U;
  }
  out.some = some;
}

void find_spans_baseline(const ColumnQuery& query, const ColumnRow& row, ColumnSpans& out) {
  find_spans(query, row, out);
}

SWARF_X86_64_V3 void find_spans_v3(const ColumnQuery& query, const ColumnRow& row, ColumnSpans& out) {
  find_spans(query, row, out);
}

SWARF_X86_64_V4_WIDE void find_spans_v4(const ColumnQuery& query, const ColumnRow& row, ColumnSpans& out) {
  find_spans(query, row, out);
}

}  // namespace

std::span<const ColumnKernelVariant> column_kernel_variants() {
  static const std::vector<ColumnKernelVariant> variants = runnable<ColumnKernelVariant>(
      {"x86-64-v4", find_spans_v4}, {"x86-64-v3", find_spans_v3}, {"baseline", find_spans_baseline});
  return variants;
}

}  // namespace swarf::stock
