#include "stock/leaf_kernel.h"

#include <vector>

#include "stock/sweep_distance.h"

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

/// Whether the bottom plane could raise any value of the slice: -F <= max(z_start, z_end).
SWARF_KERNEL_INLINE bool plane_reaches(const float* row, const Slice& slice, float az, float bz,
                                       float background) {
  // More than the rounding of z along the motion, so that leaving a slice out never changes a bit of the
  // result.
  constexpr float kSlack = 1e-4F;
  int open = 0;
  for (int j = 0; j < kSlice; ++j) {
    const float highest = kernel::max_of(slice.pz[j] + az, slice.qz[j] + bz) + kSlack;
    open += row[j] < kernel::min_of(highest, background) ? 1 : 0;
  }
  return open > 0;
}

template <bool kCapped>
SWARF_KERNEL_INLINE int cut_slices(float* values, const LeafMotion& m) {
  Slice slice;
  fill_slice(slice, m);
  int evaluated = 0;
  // Locals, not members: the float output could alias the struct, which would stop vectorisation.
  const float radius = m.radius, height = m.height, background = m.background;
  for (int x = 0; x < kLeafSide; ++x) {
    const float fx = static_cast<float>(x);
    const float ax = m.start_step[0][0] * fx, ay = m.start_step[0][1] * fx, az = m.start_step[0][2] * fx;
    const float bx = m.end_step[0][0] * fx, by = m.end_step[0][1] * fx, bz = m.end_step[0][2] * fx;
    float* row = values + x * kSlice;
    if (!plane_reaches(row, slice, az, bz, background)) continue;
    evaluated += kSlice;
    for (int j = 0; j < kSlice; ++j) {
      const float px = slice.px[j] + ax, py = slice.py[j] + ay, pz = slice.pz[j] + az;
      const MovingPoint<float> point{
          px, py, pz, slice.qx[j] + bx - px, slice.qy[j] + by - py, slice.qz[j] + bz - pz};
      const float distance = swept_distance<float, kCapped>(point, radius, height);
      row[j] = kernel::max_of(row[j], kernel::min_of(-distance, background));
    }
  }
  return evaluated;
}

SWARF_KERNEL_INLINE int cut_leaf(float* values, const LeafMotion& motion) {
  return motion.capped ? cut_slices<true>(values, motion) : cut_slices<false>(values, motion);
}

int cut_leaf_baseline(float* values, const LeafMotion& motion) {
  return cut_leaf(values, motion);
}

#ifdef SWARF_KERNEL_VARIANTS
__attribute__((target("arch=x86-64-v3"))) int cut_leaf_v3(float* values, const LeafMotion& motion) {
  return cut_leaf(values, motion);
}
__attribute__((target("arch=x86-64-v4"))) int cut_leaf_v4(float* values, const LeafMotion& motion) {
  return cut_leaf(values, motion);
}
#endif

std::vector<LeafKernelVariant> supported_variants() {
  std::vector<LeafKernelVariant> variants;
#ifdef SWARF_KERNEL_VARIANTS
  if (__builtin_cpu_supports("x86-64-v4")) variants.push_back({"x86-64-v4", cut_leaf_v4});
  if (__builtin_cpu_supports("x86-64-v3")) variants.push_back({"x86-64-v3", cut_leaf_v3});
#endif
  variants.push_back({"baseline", cut_leaf_baseline});
  return variants;
}

}  // namespace

std::span<const LeafKernelVariant> leaf_kernel_variants() {
  static const std::vector<LeafKernelVariant> variants = supported_variants();
  return variants;
}

}  // namespace swarf::stock
