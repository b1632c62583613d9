// Between which volumes the material lies, from the level set alone.
//
// The value at a grid point is the distance d of a 1-Lipschitz function whose zero set is the surface, so the
// ball of radius |d| about the point is all material (d < 0) or all air (d > 0). A cell, the cube of one
// voxel about its grid point, with |d| above its half diagonal is settled by its own ball. Every other one is
// divided into kRods x kRods rods along the axis of its steepest change; each ball about a grid point nearby
// settles the stretch of a rod that lies in it at the rod's farthest edge. What is left unsettled may be
// either.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>
#include <vector>

#include "base/instruction_sets.h"
#include "base/parallel.h"
#include "stock/level_set/leaf_kernel.h"
#include "stock/level_set/stock_grid_internal.h"

namespace swarf::stock {
namespace {

constexpr size_t kCountedPerTask = 16;

constexpr int kRods = 3;             // along each side of a cell
constexpr int kAcross = 1;           // grid points on each side of a cell whose balls are looked at, across
constexpr int kAlong = kBandVoxels;  // and along the rods: the farthest ball in the band
constexpr int kRim = 3, kSide = kLeafSide + 2 * kRim;
static_assert(kRim >= kAlong && kRim >= kAcross);

/// Values of a leaf and of what surrounds it, in voxels; strides x, y, z.
struct Surroundings {
  std::array<float, kSide * kSide * kSide> values;
  static constexpr std::array<int, 3> kStride{kSide * kSide, kSide, 1};

  Surroundings(const LevelSet& set, size_t position) {
    const openvdb::Coord leaf = (set.map.origin(position) >> 3) - set.map.lower;
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j)
        for (int k = -1; k <= 1; ++k) copy(set, leaf, {i, j, k});
  }

 private:
  /// The part of a leaf or of one beside it that lies here, counted from the leaf's first voxel.
  static int begin_of(int step) { return step < 0 ? -kRim : step * kLeafSide; }
  static int end_of(int step) { return step > 0 ? kLeafSide + kRim : (step + 1) * kLeafSide; }

  void copy(const LevelSet& set, const openvdb::Coord& leaf, const openvdb::Coord& step) {
    const auto scale = static_cast<float>(1.0 / set.voxel);
    const openvdb::Coord at = leaf + step;
    const bool known = openvdb::CoordBBox({0, 0, 0}, set.map.dimension.offsetBy(-1)).isInside(at);
    const size_t index = known ? set.map.index(at.x(), at.y(), at.z()) : 0;
    const LeafState state = known ? set.map.states[index] : LeafState::kAir;
    const float* held = state == LeafState::kLeaf ? set.values(index) : nullptr;
    const float same = state == LeafState::kSolid ? -set.band() : set.band();
    for (int i = begin_of(step.x()); i < end_of(step.x()); ++i)
      for (int j = begin_of(step.y()); j < end_of(step.y()); ++j)
        for (int k = begin_of(step.z()); k < end_of(step.z()); ++k) {
          const float value = held != nullptr ? held[LeafNode::coordToOffset({i, j, k})] : same;
          const int n = (i + kRim) * kStride[0] + (j + kRim) * kStride[1] + (k + kRim);
          values[static_cast<size_t>(n)] = scale * value;
        }
  }
};

constexpr int kPoints = 2 * kAcross + 1;
/// The rods of a cell side by side, filled up so that the loops over them are vectorised.
constexpr int kLanes = 12;
static_assert(kRods * kRods <= kLanes);

/// Square of the distance across, in voxels, from the line of a grid point to the farthest edge of a rod.
struct Across {
  alignas(16) float square[kPoints][kPoints][kLanes] = {};  // [point a + kAcross][point b + kAcross][rod]
  Across() {
    const auto reach = [](int rod, int point) {
      const double middle = (rod + 0.5) / kRods - 0.5;
      return std::abs(middle - (point - kAcross)) + 0.5 / kRods;
    };
    for (int a = 0; a < kRods; ++a)
      for (int b = 0; b < kRods; ++b)
        for (int p = 0; p < kPoints; ++p)
          for (int q = 0; q < kPoints; ++q)
            square[p][q][a * kRods + b] =
                static_cast<float>(reach(a, p) * reach(a, p) + reach(b, q) * reach(b, q));
  }
};
const Across kAcrossOfRods;

/// A grid point whose ball may settle something: its square of |d| and where it stands.
struct BallPoint {
  float square;
  int a, b;     ///< indices into Across
  float along;  ///< from the cell's grid point
};

/// Share of a cell that is settled as material or as air.
struct Settled {
  double solid = 0.0, air = 0.0;
};

/// The balls of a cell that may settle something.
class Balls {
 public:
  void add(const BallPoint& ball) { balls_[count_++] = ball; }

  /// Share of the cell that they settle. Of each rod, from -1/2 to 1/2: the stretches at its ends, below
  /// `up_to` and above `from`.
  [[gnu::always_inline]] double share() const {
    alignas(16) float up_to[kLanes], from[kLanes];
    std::fill(std::begin(up_to), std::end(up_to), -0.5F);
    std::fill(std::begin(from), std::end(from), 0.5F);
    for (size_t n = 0; n < count_; ++n) {
      const BallPoint& ball = balls_[n];
      const float* across = kAcrossOfRods.square[ball.a][ball.b];
      for (int rod = 0; rod < kLanes; ++rod) {
        const float square = ball.square - across[rod];
        const float half = std::sqrt(square > 0.0F ? square : 0.0F);
        const float low = ball.along - half, high = ball.along + half;
        const bool at_low = (square > 0.0F) & (low <= -0.5F) & (high > up_to[rod]);
        const bool at_high = (square > 0.0F) & (high >= 0.5F) & (low < from[rod]);
        up_to[rod] = at_low ? high : up_to[rod];
        from[rod] = at_high ? low : from[rod];
      }
    }
    double sum = 0.0;
    for (int rod = 0; rod < kRods * kRods; ++rod) {
      const double below = std::max(0.0F, up_to[rod] + 0.5F), above = std::max(0.0F, 0.5F - from[rod]);
      sum += std::min(1.0, below + above);
    }
    return sum / (kRods * kRods);
  }

 private:
  std::array<BallPoint, kPoints * kPoints*(2 * kAlong + 1)> balls_;
  size_t count_ = 0;
};

class Cell {
 public:
  [[gnu::always_inline]] Cell(const Surroundings& around, int at, float slack) {
    const float* here = around.values.data() + at;
    int axis = 0;
    float steepest = -1.0F;
    for (int n = 0; n < 3; ++n) {
      const int stride = Surroundings::kStride.at(static_cast<size_t>(n));
      const float change = std::abs(here[stride] - here[-stride]);
      if (change > steepest) steepest = change, axis = n;
    }
    const auto stride = [&](int n) { return Surroundings::kStride.at(static_cast<size_t>((axis + n) % 3)); };
    for (int a = 0; a < kPoints; ++a)
      for (int b = 0; b < kPoints; ++b)
        for (int k = -kAlong; k <= kAlong; ++k) {
          const float value = here[k * stride(0) + (a - kAcross) * stride(1) + (b - kAcross) * stride(2)];
          const float radius = std::abs(value) - slack;
          if (radius <= 1.0F) continue;  // nearer ones settle what farther ones do
          (value < 0.0F ? solid_ : air_).add({radius * radius, a, b, static_cast<float>(k)});
        }
  }

  [[gnu::always_inline]] Settled settled() const { return {solid_.share(), air_.share()}; }

 private:
  Balls solid_, air_;
};

/// Of one leaf, in voxels: least volume and greatest.
[[gnu::always_inline]] inline VolumeRange leaf_volume_range(const Surroundings& around, float slack) {
  const float half_diagonal = 0.5F * std::sqrt(3.0F) + slack;
  VolumeRange range;
  for (int v = 0; v < kLeafVoxels; ++v) {
    const int at = (v / 64 + kRim) * Surroundings::kStride[0] +
                   (v / 8 % 8 + kRim) * Surroundings::kStride[1] + (v % 8 + kRim);
    const float value = around.values.at(static_cast<size_t>(at));
    if (std::abs(value) >= half_diagonal) {
      range.least += value < 0.0F ? 1.0 : 0.0;
      range.greatest += value < 0.0F ? 1.0 : 0.0;
      continue;
    }
    const Settled settled = Cell(around, at, slack).settled();
    range.least += settled.solid;
    range.greatest += 1.0 - settled.air;
  }
  return range;
}

VolumeRange leaf_volume_range_any(const Surroundings& around, float slack) {
  return leaf_volume_range(around, slack);
}
SWARF_X86_64_V3 VolumeRange leaf_volume_range_v3(const Surroundings& around, float slack) {
  return leaf_volume_range(around, slack);
}

}  // namespace

std::vector<VolumeRange> volume_ranges(const LevelSet& set, double slack_mm, size_t begin, size_t end) {
  // The conversion to voxels rounds once more.
  constexpr double kRounding = 1e-6;
  const auto slack = static_cast<float>((slack_mm + set.rounding_mm) / set.voxel + kRounding);
  // Every instruction set rounds alike: no sum is contracted.
  const auto range_of = runs_x86_64_v3() ? leaf_volume_range_v3 : leaf_volume_range_any;
  std::vector<VolumeRange> ranges(end - begin);
  parallel_chunks(ranges.size(), kCountedPerTask, [&](size_t from, size_t to) {
    for (size_t n = from; n < to; ++n) {
      const LeafState state = set.map.states[begin + n];
      if (state == LeafState::kLeaf) {
        ranges[n] = range_of(Surroundings(set, begin + n), slack);
      } else if (state == LeafState::kSolid) {
        ranges[n] = {kLeafVoxels, kLeafVoxels};
      }
    }
  });
  return ranges;
}

VolumeRange sum_of(const LevelSet& set, std::span<const VolumeRange> ranges) {
  VolumeRange whole;
  for (const VolumeRange& range : ranges) {
    whole.least += range.least;
    whole.greatest += range.greatest;
  }
  const double voxel3 = std::pow(set.voxel, 3);
  return {whole.least * voxel3, whole.greatest * voxel3};
}

}  // namespace swarf::stock
