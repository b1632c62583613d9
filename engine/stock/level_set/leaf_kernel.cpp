#include "stock/level_set/leaf_kernel.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <vector>

#include "stock/sweep/sweep_distance.h"

namespace swarf::stock {
namespace {

constexpr int kSlice = kLeafSide * kLeafSide;
/// Two columns of a slice lie one behind the other: a patch is this twice.
constexpr int kPair = 2 * kLeafSide;

SWARF_KERNEL_INLINE bool has_patch(uint32_t patches, int x, int pair) {
  return (patches >> (x / 2 * kPatchSide + pair) & 1U) != 0;
}

/// Voxels of two neighbouring columns relative to the leaf's first slice, in the tool frame at both ends:
/// heights, and the other two coordinates, which most of them do not need.
struct PairHeights {
  alignas(64) float pz[kPair], qz[kPair];
};
struct PairSides {
  alignas(64) float px[kPair], py[kPair], qx[kPair], qy[kPair];
};

SWARF_KERNEL_INLINE void fill_coordinate(float* start, float* end, const LeafMotion& m, int number, int c) {
  const float first = static_cast<float>(2 * number), from = m.start[c], to = m.end[c];
  const float y_from = m.start_step[1][c], y_to = m.end_step[1][c], z_from = m.start_step[2][c],
              z_to = m.end_step[2][c];
  for (int j = 0; j < kPair; ++j) {
    const float y = first + static_cast<float>(j / kLeafSide);
    const float z = static_cast<float>(j % kLeafSide);
    start[j] = from + (y_from * y + z_from * z);
    end[j] = to + (y_to * y + z_to * z);
  }
}

/// The same in one slice, on their way.
struct MovingPair {
  alignas(64) float px[kPair], py[kPair], pz[kPair], dx[kPair], dy[kPair], dz[kPair];
};

SWARF_KERNEL_INLINE void move_pair(MovingPair& moving, const PairHeights& heights, const PairSides& sides,
                                   const LeafMotion& m, int slice) {
  const float fx = static_cast<float>(slice);
  const float ax = m.start_step[0][0] * fx, ay = m.start_step[0][1] * fx, az = m.start_step[0][2] * fx;
  const float bx = m.end_step[0][0] * fx, by = m.end_step[0][1] * fx, bz = m.end_step[0][2] * fx;
  for (int j = 0; j < kPair; ++j) {
    const float px = sides.px[j] + ax, py = sides.py[j] + ay, pz = heights.pz[j] + az;
    moving.px[j] = px;
    moving.py[j] = py;
    moving.pz[j] = pz;
    moving.dx[j] = sides.qx[j] + bx - px;
    moving.dy[j] = sides.qy[j] + by - py;
    moving.dz[j] = heights.qz[j] + bz - pz;
  }
}

/// Whether a voxel stands highest above the bottom at the end of its motion: 1, or 0.
SWARF_KERNEL_INLINE float highest_at(float dz) {
  return dz > 0.0F ? 1.0F : 0.0F;
}

/// A sweep never writes more than a voxel's height above the bottom where it stands highest. True if that
/// raises a voxel of the patch that begins with `slice`: most of the patches that the tests let through are
/// told from the others by that alone.
SWARF_KERNEL_INLINE bool bottom_raises(const float* values, const PairHeights& pair, const LeafMotion& m,
                                       int slice, int number) {
  const float* first = values + slice * kSlice + number * kPair;
  const float step_from = m.start_step[0][2], step_to = m.end_step[0][2], background = m.background;
  const float a0 = step_from * static_cast<float>(slice), a1 = step_from * static_cast<float>(slice + 1);
  const float b0 = step_to * static_cast<float>(slice), b1 = step_to * static_cast<float>(slice + 1);
  float most = 0.0F;
  for (int j = 0; j < kPair; ++j) {
    const float p0 = pair.pz[j] + a0, d0 = pair.qz[j] + b0 - p0, p1 = pair.pz[j] + a1,
                d1 = pair.qz[j] + b1 - p1;
    const float high0 = kernel::min_of(p0 + highest_at(d0) * d0, background);
    const float high1 = kernel::min_of(p1 + highest_at(d1) * d1, background);
    most = kernel::max_of(most, kernel::max_of(high0 - first[j], high1 - first[j + kSlice]));
  }
  return most > 0.0F;
}

/// What the bottom alone tells of a voxel, without a root: its height above it where it stands highest is
/// what the sweep writes if it is well inside the flank there.
struct Bottom {
  float most;
  float outside;  ///< above 0: the flank has a say
};
SWARF_KERNEL_INLINE Bottom bottom_of(const MovingPair& m, int j, float radius, float background) {
  constexpr float kWellInside = 1.0F - 1e-6F;  // of a square: more than the rounding of root and square
  const float t = highest_at(m.dz[j]);
  const float high = m.pz[j] + t * m.dz[j];
  const float x = m.px[j] + t * m.dx[j], y = m.py[j] + t * m.dy[j], within = radius - high;
  const float outside = kernel::max_of(x * x + y * y - within * within * kWellInside, -within);
  return {kernel::min_of(high, background), outside};
}

/// Raises `value` to `to`, and `over` to the difference.
SWARF_KERNEL_INLINE void raise_to(float& value, float& over, float to) {
  over = kernel::max_of(over, to - value);
  value = kernel::max_of(value, to);
}

/// Raises the row by the bottom where that is all that counts. True if nothing is left to do.
SWARF_KERNEL_INLINE bool raise_by_bottom(float* row, float* over, const MovingPair& m, float radius,
                                         float background) {
  alignas(64) float most[kPair];
  constexpr int kOfFlank = 0x100;
  int open = 0;  // how many voxels may be raised, and kOfFlank for each that the flank decides about
  for (int j = 0; j < kPair; ++j) {
    const Bottom bottom = bottom_of(m, j, radius, background);
    most[j] = bottom.most;
    const int by_flank = bottom.outside > 0.0F ? kOfFlank + 1 : 1;
    open += row[j] < bottom.most ? by_flank : 0;
  }
  if (open == 0) return true;
  if (open >= kOfFlank) return false;
  for (int j = 0; j < kPair; ++j) raise_to(row[j], over[j], most[j]);
  return true;
}

template <bool kCapped>
SWARF_KERNEL_INLINE void cut_row(float* row, float* over, const MovingPair& moving, const LeafMotion& m) {
  // Locals, not members: the float output could alias the struct, which would stop vectorisation.
  const float radius = m.radius, height = m.height, background = m.background;
  if (!kCapped && raise_by_bottom(row, over, moving, radius, background)) return;
  for (int j = 0; j < kPair; ++j) {
    const MovingPoint<float> point{moving.px[j], moving.py[j], moving.pz[j],
                                   moving.dx[j], moving.dy[j], moving.dz[j]};
    float depth = kernel::min_of(-swept_distance<float, kCapped>(point, radius, height), background);
    if (!kCapped) {  // what a voxel gets does not depend on the others of its row
      const Bottom bottom = bottom_of(moving, j, radius, background);
      depth = bottom.outside > 0.0F ? kernel::min_of(depth, bottom.most) : bottom.most;
    }
    raise_to(row[j], over[j], depth);
  }
}

SWARF_KERNEL_INLINE bool any_above(const float* over) {
  float most = 0.0F;
  for (int j = 0; j < kPair; ++j) most = kernel::max_of(most, over[j]);
  return most > 0.0F;
}

/// The patches that lie behind each other along x from columns 2 number and 2 number + 1 on.
template <bool kCapped>
SWARF_KERNEL_INLINE uint32_t cut_pair(float* values, const LeafMotion& m, uint32_t patches, int number) {
  PairHeights heights;
  fill_coordinate(heights.pz, heights.qz, m, number, 2);
  uint32_t open = 0;
  for (int x = 0; x < kLeafSide; x += 2) {
    if (has_patch(patches, x, number) && (kCapped || bottom_raises(values, heights, m, x, number)))
      open |= 1U << x;
  }
  if (open == 0) return 0;
  PairSides sides;
  fill_coordinate(sides.px, sides.qx, m, number, 0);
  fill_coordinate(sides.py, sides.qy, m, number, 1);
  uint32_t risen = 0;
  for (int x = 0; x < kLeafSide; x += 2) {
    if ((open >> x & 1U) == 0) continue;
    alignas(64) float over[kPair] = {};
    for (int slice = x; slice < x + 2; ++slice) {
      MovingPair moving;
      move_pair(moving, heights, sides, m, slice);
      cut_row<kCapped>(values + slice * kSlice + number * kPair, over, moving, m);
    }
    if (any_above(over)) risen |= 1U << (x / 2 * kPatchSide + number);
  }
  return risen;
}

/// Any motion. Returns the patches that have risen.
template <bool kCapped>
SWARF_KERNEL_INLINE uint32_t cut_by_rows(float* values, const LeafMotion& m, uint32_t patches) {
  constexpr uint32_t kOfPair = 0x1111U;
  uint32_t risen = 0;
  for (int number = 0; number < kPatchSide; ++number) {
    if ((patches >> number & kOfPair) != 0) risen |= cut_pair<kCapped>(values, m, patches, number);
  }
  return risen;
}

/// A cutter that stands along the columns and does not turn: the terms of swept_distance that its voxels have
/// alike. Numbered as the columns are.
struct Columns {
  alignas(64) float low[kSlice];                ///< `deep` of the first voxel
  alignas(64) float rho[kSlice], most[kSlice];  ///< radius - rho
  alignas(64) float along[kSlice], way[kSlice], fixed[kSlice];
};

/// The same motion for all voxels.
struct CommonMotion {
  float dx, dy, dz, a, rise;
  float step;      ///< along the axis from voxel to voxel
  float per_fall;  ///< 1 / (a - rise^2)
  bool flat;       ///< so much wider than high that this loses no digits

  SWARF_KERNEL_INLINE explicit CommonMotion(const LeafMotion& m)
      : dx(m.end[0] - m.start[0]), dy(m.end[1] - m.start[1]), dz(m.end[2] - m.start[2]) {
    constexpr float kFlat = 0.25F;
    a = dx * dx + dy * dy;
    rise = std::abs(dz);
    step = m.start_step[2][2];
    flat = rise * rise <= kFlat * a;
    per_fall = 1.0F / kernel::max_of(a - rise * rise, 1e-30F);
  }
};

SWARF_KERNEL_INLINE void fill_columns(Columns& out, const LeafMotion& m, const CommonMotion& c) {
  const float first_x = m.start[0], first_y = m.start[1], first_z = m.start[2], radius = m.radius;
  const float xx = m.start_step[0][0], xy = m.start_step[0][1], xz = m.start_step[0][2];
  const float yx = m.start_step[1][0], yy = m.start_step[1][1], yz = m.start_step[1][2];
  const float dx = c.dx, dy = c.dy, dz = c.dz, rise = c.rise;
  const float per_a = 1.0F / kernel::max_of(c.a, 1e-30F), forward = dz > 0.0F ? 1.0F : -1.0F;
  const float end = dz > 0.0F ? 1.0F : 0.0F;
  for (int n = 0; n < kSlice; ++n) {
    const float i = static_cast<float>(n / kLeafSide), j = static_cast<float>(n % kLeafSide);
    const float px = first_x + (xx * i + yx * j), py = first_y + (xy * i + yy * j);
    const float nearest = kernel::clamp01(-(px * dx + py * dy) * per_a);
    const float x = px + nearest * dx, y = py + nearest * dy;
    const float rho = std::sqrt(x * x + y * y), along = forward * (x * dx + y * dy), side = rise * rho;
    out.low[n] = first_z + (xz * i + yz * j) + nearest * dz;
    out.rho[n] = rho;
    out.most[n] = radius - rho;
    out.along[n] = along;
    out.way[n] = std::abs(end - nearest);
    out.fixed[n] = along * along + side * side;
  }
}

enum class Slope { kLevel, kFlat, kSteep };

/// What two neighbouring columns have, each. Joined by their bits: of a choice the compiler makes two loops.
struct TwoFloats {
  int first, second;
  SWARF_KERNEL_INLINE TwoFloats(const float (&of)[kSlice], int n)
      : first(std::bit_cast<int>(of[n])), second(std::bit_cast<int>(of[n + 1])) {}
  SWARF_KERNEL_INLINE float at(int j) const {
    const int is_second = -(j / kLeafSide);
    return std::bit_cast<float>((first & ~is_second) | (second & is_second));
  }
};

/// Columns n and n + 1.
template <Slope kSlope>
SWARF_KERNEL_INLINE void cut_two_columns(float* row, float* over, const Columns& columns, int n,
                                         const CommonMotion& motion, float radius, float background) {
  const TwoFloats low(columns.low, n), rho(columns.rho, n), most(columns.most, n), along(columns.along, n),
      way(columns.way, n), fixed(columns.fixed, n);
  const float a = motion.a, rise = motion.rise, step = motion.step, per_fall = motion.per_fall;
  for (int j = 0; j < kPair; ++j) {
    const float deep = low.at(j) + step * static_cast<float>(j % kLeafSide);
    float to = deep;
    if (kSlope != Slope::kLevel) {
      const float within = radius - deep, level = within * rise, b = along.at(j) + level;
      const float c = (within - rho.at(j)) * (within + rho.at(j));
      const float d = fixed.at(j) + along.at(j) * (level + level) + a * c;
      const float root = std::sqrt(kernel::max_of(d, 0.0F));
      const float s = kSlope == Slope::kFlat ? (root - b) * per_fall : c / kernel::max_of(b + root, 1e-30F);
      to = deep + kernel::min_of(kernel::max_of(s, 0.0F), way.at(j)) * rise;
    }
    raise_to(row[j], over[j], kernel::min_of(to, kernel::min_of(most.at(j), background)));
  }
}

template <Slope kSlope>
SWARF_KERNEL_INLINE uint32_t cut_columns(float* values, const LeafMotion& m, const CommonMotion& motion,
                                         uint32_t patches) {
  Columns columns;
  fill_columns(columns, m, motion);
  const float radius = m.radius, background = m.background;
  uint32_t risen = 0;
  for (uint32_t left = patches; left != 0; left &= left - 1) {
    const int patch = __builtin_ctz(left), first = patch / kPatchSide * kPair + patch % kPatchSide * 2;
    alignas(64) float over[kPair] = {};
    for (int n = first; n <= first + kLeafSide; n += kLeafSide) {
      cut_two_columns<kSlope>(values + n * kLeafSide, over, columns, n, motion, radius, background);
    }
    if (any_above(over)) risen |= 1U << patch;
  }
  return risen;
}

SWARF_KERNEL_INLINE bool moves_along_columns(const LeafMotion& m) {
  bool same = m.start_step[2][0] == 0.0F && m.start_step[2][1] == 0.0F;
  for (int axis = 0; axis < 3; ++axis) {
    for (int c = 0; c < 3; ++c) same = same && m.start_step[axis][c] == m.end_step[axis][c];
  }
  return same;
}

SWARF_KERNEL_INLINE uint32_t cut_leaf(float* values, const LeafMotion& motion, uint32_t patches) {
  if (motion.capped) return cut_by_rows<true>(values, motion, patches);
  if (!moves_along_columns(motion)) return cut_by_rows<false>(values, motion, patches);
  const CommonMotion common(motion);
  if (common.rise == 0.0F) return cut_columns<Slope::kLevel>(values, motion, common, patches);
  if (common.flat) return cut_columns<Slope::kFlat>(values, motion, common, patches);
  return cut_columns<Slope::kSteep>(values, motion, common, patches);
}

/// From the leaf's first voxel to the middle of a patch, and half its extent, in voxels.
struct PatchMiddles {
  float x[kPatches], y[kPatches];
};
constexpr PatchMiddles patch_middles() {
  PatchMiddles middles{};
  for (int n = 0; n < kPatches; ++n) {
    middles.x[n] = 2.0F * static_cast<float>(n / kPatchSide) + 0.5F;
    middles.y[n] = 2.0F * static_cast<float>(n % kPatchSide) + 0.5F;
  }
  return middles;
}
constexpr PatchMiddles kMiddles = patch_middles();
constexpr float kHalfPatch[3] = {0.5F, 0.5F, 0.5F * (kLeafSide - 1)};

/// Greatest value of a linear function in a patch: first + x X + y Y.
struct PatchMost {
  float first, x, y;
};
SWARF_KERNEL_INLINE PatchMost patch_most(float first, const float step[3], const float slope[3],
                                         float slack) {
  float over[3], spread = slack;
  for (int a = 0; a < 3; ++a) {
    over[a] = step[a] - slope[a];
    spread += kHalfPatch[a] * std::abs(over[a]);
  }
  return {first + kHalfPatch[2] * over[2] + spread, over[0], over[1]};
}

/// Greatest value of a bound in the patches at both ends of the motion, and of what it has over the floors'
/// slope.
struct PatchBound {
  alignas(64) float start[kPatches], end[kPatches], start_over[kPatches], end_over[kPatches];
};
SWARF_KERNEL_INLINE void fill_most(float* out, const PatchMost& most) {
  for (int n = 0; n < kPatches; ++n) out[n] = most.first + most.x * kMiddles.x[n] + most.y * kMiddles.y[n];
}
SWARF_KERNEL_INLINE void fill_bound(PatchBound& out, const LeafBound::Linear& linear, const float slope[3]) {
  constexpr float kLevel[3] = {0.0F, 0.0F, 0.0F};
  // mm; of a distance on the way six roundings count at most, of the time, its product and the sum.
  constexpr float kOfLeaf = 2e-5F, kRoundings = 6.0F * 6e-8F;
  const float slack = kOfLeaf + kRoundings * (std::abs(linear.start) + std::abs(linear.end));
  fill_most(out.start, patch_most(linear.start, linear.start_step, kLevel, slack));
  fill_most(out.end, patch_most(linear.end, linear.end_step, kLevel, slack));
  fill_most(out.start_over, patch_most(linear.start, linear.start_step, slope, slack));
  fill_most(out.end_over, patch_most(linear.end, linear.end_step, slope, slack));
}

/// Lowers over[n] to what one face has over the floors while the other face reaches their levels. Both bounds
/// change evenly on the way, so the first is greatest where the second comes to a level, or at an end.
SWARF_KERNEL_INLINE void lower_over(float* over, const PatchFloors& floors, const PatchBound& face,
                                    const PatchBound& other) {
  constexpr float kEven = 1e-6F, kNever = -1e30F;  // mm
  const float l0 = -floors.band, l1 = floors.level(0), l2 = floors.level(1), l3 = floors.level(2);
  for (int n = 0; n < kPatches; ++n) {
    const float from = other.start[n], change = other.end[n] - from;
    const float per_change = 1.0F / kernel::nonzero(change);
    const float first = face.start_over[n], rise = face.end_over[n] - first;
    const float at_end = change > -kEven ? face.end_over[n] : kNever,
                at_start = change < kEven ? first : kNever;
    const float last = kernel::max_of(at_start, at_end), most = kernel::max_of(from, other.end[n]);
    const auto over_at = [&](float level, float floor) __attribute__((always_inline)) {
      const float t = kernel::clamp01((level - from) * per_change);
      const float over_floor = kernel::max_of(first + t * rise, last) - floor;
      return most > level ? over_floor : -1.0F;
    };
    const float low = kernel::max_of(over_at(l0, floors.of_patch[0][n]), over_at(l1, floors.of_patch[1][n]));
    const float high = kernel::max_of(over_at(l2, floors.of_patch[2][n]), over_at(l3, floors.of_patch[3][n]));
    over[n] = kernel::min_of(over[n], kernel::max_of(low, high));
  }
}

SWARF_KERNEL_INLINE uint32_t test_patches(const PatchFloors& floors, const LeafBound& bound) {
  PatchBound first, second;
  fill_bound(first, bound.of_face[0], floors.slope);
  fill_bound(second, bound.of_face[1], floors.slope);
  alignas(64) float over[kPatches];
  for (float& value : over) value = 1.0F;
  lower_over(over, floors, first, second);
  lower_over(over, floors, second, first);
  uint32_t patches = 0;
  for (int n = 0; n < kPatches; ++n) patches |= over[n] > 0.0F ? 1U << n : 0U;
  return patches;
}

SWARF_KERNEL_INLINE void fit_patches(const float* values, uint32_t patches, PatchFloors& floors) {
  constexpr float kNoVoxel = 1e30F;
  const float sx = floors.slope[0], sy = floors.slope[1], sz = floors.slope[2];
  const float l0 = floors.level(0), l1 = floors.level(1), l2 = floors.level(2), l3 = floors.level(3);
  for (uint32_t left = patches; left != 0; left &= left - 1) {
    const int n = __builtin_ctz(left);
    const int x = n / kPatchSide * 2, y = n % kPatchSide * 2;
    const float* first = values + x * kSlice + y * kLeafSide;
    const float shift = sx * static_cast<float>(x), next = sx * static_cast<float>(x + 1);
    float f0 = kNoVoxel, f1 = kNoVoxel, f2 = kNoVoxel, f3 = kNoVoxel;
    for (int j = 0; j < kPair; ++j) {
      const float linear =
          sy * static_cast<float>(y + j / kLeafSide) + sz * static_cast<float>(j % kLeafSide);
      const float a = first[j], b = first[j + kSlice];
      const float over_a = a - (linear + shift), over_b = b - (linear + next);
      const auto least = [&](float level) __attribute__((always_inline)) {
        return kernel::min_of(a < level ? over_a : kNoVoxel, b < level ? over_b : kNoVoxel);
      };
      f0 = kernel::min_of(f0, least(l0));
      f1 = kernel::min_of(f1, least(l1));
      f2 = kernel::min_of(f2, least(l2));
      f3 = kernel::min_of(f3, least(l3));
    }
    floors.of_patch[0][n] = f0;
    floors.of_patch[1][n] = f1;
    floors.of_patch[2][n] = f2;
    floors.of_patch[3][n] = f3;
  }
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
  // Eight bytes of 0 or 1 as eight bits, the first one lowest.
  constexpr uint64_t kGather = 0x0102040810204080U;
  static_assert(std::endian::native == std::endian::little);
  uint64_t columns[kSlice];
  uint8_t bits[kSlice];
  std::memcpy(columns, flags, sizeof(columns));
  for (int n = 0; n < kSlice; ++n) bits[n] = static_cast<uint8_t>(columns[n] * kGather >> 56);
  std::memcpy(active, bits, sizeof(bits));
  return {least, greatest};
}

// NOLINTBEGIN(bugprone-macro-parentheses): an attribute cannot stand in parentheses
#define SWARF_LEAF_VARIANT(name, attribute)                                                           \
  attribute uint32_t cut_leaf_##name(float* values, const LeafMotion& motion, uint32_t patches) {     \
    return cut_leaf(values, motion, patches);                                                         \
  }                                                                                                   \
  attribute uint32_t test_patches_##name(const PatchFloors& floors, const LeafBound& bound) {         \
    return test_patches(floors, bound);                                                               \
  }                                                                                                   \
  attribute void fit_patches_##name(const float* values, uint32_t patches, PatchFloors& floors) {     \
    fit_patches(values, patches, floors);                                                             \
  }                                                                                                   \
  attribute LeafRange summarise_##name(const float* values, float band, uint64_t active[kLeafSide]) { \
    return summarise(values, band, active);                                                           \
  }

SWARF_LEAF_VARIANT(baseline, )
SWARF_LEAF_VARIANT(v3, SWARF_X86_64_V3)
SWARF_LEAF_VARIANT(v4, SWARF_X86_64_V4_WIDE)
#undef SWARF_LEAF_VARIANT
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace

std::span<const LeafKernelVariant> leaf_kernel_variants() {
  static const std::vector<LeafKernelVariant> variants = runnable<LeafKernelVariant>(
      {"x86-64-v4", cut_leaf_v4, test_patches_v4, fit_patches_v4, summarise_v4},
      {"x86-64-v3", cut_leaf_v3, test_patches_v3, fit_patches_v3, summarise_v3},
      {"baseline", cut_leaf_baseline, test_patches_baseline, fit_patches_baseline, summarise_baseline});
  return variants;
}

}  // namespace swarf::stock
