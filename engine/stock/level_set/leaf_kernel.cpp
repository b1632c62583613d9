#include "stock/level_set/leaf_kernel.h"

#include <vector>

#include "stock/sweep/sweep_distance.h"

namespace swarf::stock {
namespace {

constexpr int kSlice = kLeafSide * kLeafSide;

/// The coordinates of one x-slice of the leaf relative to its first voxel, shared by all eight slices.
struct Slice {
  alignas(64) float px[kSlice], py[kSlice], pz[kSlice];  ///< at the start pose
  alignas(64) float qx[kSlice], qy[kSlice], qz[kSlice];  ///< at the end pose
};

SWARF_KERNEL_INLINE void fill_slice(Slice& slice, const LeafMotion& m) {
  for (int j = 0; j < kSlice; ++j) {
    const float y = static_cast<float>(j / kLeafSide);
    const float z = static_cast<float>(j % kLeafSide);
    slice.px[j] = m.start[0] + (m.start_step[1][0] * y + m.start_step[2][0] * z);
    slice.py[j] = m.start[1] + (m.start_step[1][1] * y + m.start_step[2][1] * z);
    slice.pz[j] = m.start[2] + (m.start_step[1][2] * y + m.start_step[2][2] * z);
    slice.qx[j] = m.end[0] + (m.end_step[1][0] * y + m.end_step[2][0] * z);
    slice.qy[j] = m.end[1] + (m.end_step[1][1] * y + m.end_step[2][1] * z);
    slice.qz[j] = m.end[2] + (m.end_step[1][2] * y + m.end_step[2][2] * z);
  }
}

template <bool kCapped>
SWARF_KERNEL_INLINE void cut_slices(float* values, const LeafMotion& m, uint32_t slices) {
  Slice slice;
  fill_slice(slice, m);
  // Locals, not members: the float output could alias the struct, which would stop vectorisation.
  const float radius = m.radius, height = m.height, background = m.background;
  for (int x = 0; x < kLeafSide; ++x) {
    if ((slices >> x & 1U) == 0) continue;
    const float fx = static_cast<float>(x);
    const float ax = m.start_step[0][0] * fx, ay = m.start_step[0][1] * fx, az = m.start_step[0][2] * fx;
    const float bx = m.end_step[0][0] * fx, by = m.end_step[0][1] * fx, bz = m.end_step[0][2] * fx;
    float* row = values + x * kSlice;
    for (int j = 0; j < kSlice; ++j) {
      const float px = slice.px[j] + ax, py = slice.py[j] + ay, pz = slice.pz[j] + az;
      const MovingPoint<float> point{
          px, py, pz, slice.qx[j] + bx - px, slice.qy[j] + by - py, slice.qz[j] + bz - pz};
      const float distance = swept_distance<float, kCapped>(point, radius, height);
      row[j] = kernel::max_of(row[j], kernel::min_of(-distance, background));
    }
  }
}

SWARF_KERNEL_INLINE void cut_leaf(float* values, const LeafMotion& motion, uint32_t slices) {
  if (motion.capped) {
    cut_slices<true>(values, motion, slices);
  } else {
    cut_slices<false>(values, motion, slices);
  }
}

/// c + sy y + sz z over one slice.
SWARF_KERNEL_INLINE void fill_linear(float* out, float c, const float step[3]) {
  const float sy = step[1], sz = step[2];
  for (int j = 0; j < kSlice; ++j) {
    out[j] = c + (sy * static_cast<float>(j / kLeafSide) + sz * static_cast<float>(j % kLeafSide));
  }
}

SWARF_KERNEL_INLINE uint32_t test_bound(const float* values, const LeafBound& bound, float background) {
  constexpr float kSlack = 1e-4F;  // mm; distances of up to a metre round to a third of it
  alignas(64) float start[2][kSlice], end[2][kSlice];
  for (int face = 0; face < 2; ++face) {
    fill_linear(start[face], bound.of_face[face].start + kSlack, bound.of_face[face].start_step);
    fill_linear(end[face], bound.of_face[face].end + kSlack, bound.of_face[face].end_step);
  }
  uint32_t slices = 0;
  for (int x = 0; x < kLeafSide; ++x) {
    const float fx = static_cast<float>(x);
    const float a0 = bound.of_face[0].start_step[0] * fx, b0 = bound.of_face[0].end_step[0] * fx;
    const float a1 = bound.of_face[1].start_step[0] * fx, b1 = bound.of_face[1].end_step[0] * fx;
    const float* row = values + x * kSlice;
    int open = 0;
    for (int j = 0; j < kSlice; ++j) {
      const float first = kernel::max_of(start[0][j] + a0, end[0][j] + b0);
      const float second = kernel::max_of(start[1][j] + a1, end[1][j] + b1);
      open += row[j] < kernel::min_of(kernel::min_of(first, second), background) ? 1 : 0;
    }
    slices |= (open > 0 ? 1U : 0U) << x;
  }
  return slices;
}

SWARF_KERNEL_INLINE float fit_floor(const float* values, const float slope[3], float band) {
  alignas(64) float linear[kSlice];
  fill_linear(linear, 0.0F, slope);
  constexpr float kNoVoxel = 1e30F;
  float least = kNoVoxel;
  for (int x = 0; x < kLeafSide; ++x) {
    const float shift = slope[0] * static_cast<float>(x);
    const float* row = values + x * kSlice;
    for (int j = 0; j < kSlice; ++j) {
      const float rest = row[j] < band ? row[j] - (linear[j] + shift) : kNoVoxel;
      least = kernel::min_of(least, rest);
    }
  }
  return least;
}

/// Eight bytes of 0 or 1 as eight bits.
SWARF_KERNEL_INLINE uint64_t packed(const uint8_t* flags) {
  uint64_t bytes = 0;
  for (int n = 0; n < 8; ++n) bytes |= static_cast<uint64_t>(flags[n]) << (8 * n);
  return bytes * 0x0102040810204080U >> 56;
}

SWARF_KERNEL_INLINE LeafRange summarise(const float* values, float band, uint64_t active[kLeafSide]) {
  float least = values[0], greatest = values[0];
  for (int n = 0; n < kLeafVoxels; ++n) {
    least = kernel::min_of(least, values[n]);
    greatest = kernel::max_of(greatest, values[n]);
  }
  alignas(64) uint8_t flags[kLeafVoxels];
  for (int n = 0; n < kLeafVoxels; ++n) {
    flags[n] = static_cast<uint8_t>(values[n] > -band) & static_cast<uint8_t>(values[n] < band);
  }
  for (int x = 0; x < kLeafSide; ++x) {
    uint64_t word = 0;
    for (int y = 0; y < kLeafSide; ++y) word |= packed(flags + x * kSlice + y * kLeafSide) << (8 * y);
    active[x] = word;
  }
  return {least, greatest};
}

// NOLINTBEGIN(bugprone-macro-parentheses): an attribute cannot stand in parentheses
#define SWARF_LEAF_VARIANT(name, attribute)                                                             \
  attribute void cut_leaf_##name(float* values, const LeafMotion& motion, uint32_t slices) {            \
    cut_leaf(values, motion, slices);                                                                   \
  }                                                                                                     \
  attribute uint32_t test_bound_##name(const float* values, const LeafBound& bound, float background) { \
    return test_bound(values, bound, background);                                                       \
  }                                                                                                     \
  attribute float fit_floor_##name(const float* values, const float slope[3], float band) {             \
    return fit_floor(values, slope, band);                                                              \
  }                                                                                                     \
  attribute LeafRange summarise_##name(const float* values, float band, uint64_t active[kLeafSide]) {   \
    return summarise(values, band, active);                                                             \
  }

SWARF_LEAF_VARIANT(baseline, )
SWARF_LEAF_VARIANT(v3, SWARF_X86_64_V3)
SWARF_LEAF_VARIANT(v4, SWARF_X86_64_V4_WIDE)
#undef SWARF_LEAF_VARIANT
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace

std::span<const LeafKernelVariant> leaf_kernel_variants() {
  static const std::vector<LeafKernelVariant> variants = runnable<LeafKernelVariant>(
      {"x86-64-v4", cut_leaf_v4, test_bound_v4, fit_floor_v4, summarise_v4},
      {"x86-64-v3", cut_leaf_v3, test_bound_v3, fit_floor_v3, summarise_v3},
      {"baseline", cut_leaf_baseline, test_bound_baseline, fit_floor_baseline, summarise_baseline});
  return variants;
}

}  // namespace swarf::stock
