// What is read off the level set: volume, distance, state hash.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "base/hash.h"
#include "base/parallel.h"
#include "stock/level_set/leaf_kernel.h"
#include "stock/level_set/stock_grid_internal.h"

namespace swarf::stock {
namespace {

constexpr size_t kPositionsPerTask = 1024;

/// Difference per voxel along the axis of stride `stride` at place `at` (0..7) of the leaf: central inside,
/// one-sided at its ends, so that a leaf needs no neighbour (exact for planes either way).
float slope(const float* value, int at, int stride) {
  if (at == 0) return value[stride] - value[0];
  if (at == kLeafSide - 1) return value[0] - value[-stride];
  return 0.5F * (value[stride] - value[-stride]);
}

/// Filled fraction of the cell of one voxel. Along the axis of steepest change the cell is cut at value = 0;
/// summed over a column this is the column's exact height under a plane.
double filled(const float* values, int n) {
  const float value = values[n];
  const float steepest =
      std::max({std::abs(slope(values + n, n / 64, 64)), std::abs(slope(values + n, n / 8 % 8, 8)),
                std::abs(slope(values + n, n % 8, 1))});
  if (steepest <= 0.0F) return value < 0.0F ? 1.0 : 0.0;
  return std::clamp(0.5 - static_cast<double>(value) / steepest, 0.0, 1.0);
}

/// Volume of one leaf position in voxels.
double leaf_volume(const LevelSet& set, size_t n) {
  const LeafState state = set.map.states[n];
  if (state != LeafState::kLeaf) return state == LeafState::kSolid ? kLeafVoxels : 0.0;
  const float* values = set.values(n);
  double sum = 0.0;
  for (int voxel = 0; voxel < kLeafVoxels; ++voxel) sum += filled(values, voxel);
  return sum;
}

/// -0 equals 0, and which of the two the greatest of many cuts leaves depends on their order.
std::array<float, kLeafVoxels> without_minus_zero(const float* values) {
  std::array<float, kLeafVoxels> plain;
  for (int n = 0; n < kLeafVoxels; ++n) plain[n] = values[n] + 0.0F;
  return plain;
}

/// Four lanes of FNV-1a by words, so that the processor works on four multiplications at a time: a leaf of
/// 2 kB then costs little more than reading it.
uint64_t leaf_hash(const LevelSet& set, size_t n) {
  Hash hash;
  hash.add(static_cast<uint64_t>(n));
  hash.add(static_cast<uint64_t>(set.map.states[n]));
  if (set.map.states[n] == LeafState::kLeaf) {
    constexpr int kLanes = 4, kWords = kLeafVoxels * sizeof(float) / sizeof(uint64_t);
    const std::array<float, kLeafVoxels> values = without_minus_zero(set.values(n));
    std::array<Hash, kLanes> lanes;
    for (int word = 0; word < kWords; word += kLanes) {
      std::array<uint64_t, kLanes> words;
      std::memcpy(words.data(), values.data() + 2 * word, sizeof(words));
      for (int lane = 0; lane < kLanes; ++lane) lanes[lane].add(words[lane]);
    }
    for (const Hash& lane : lanes) hash.add(lane.value());
  }
  return hash.value();
}

}  // namespace

std::vector<double> volumes(const LevelSet& set, size_t begin, size_t end) {
  std::vector<double> parts(end - begin);
  parallel_chunks(parts.size(), kPositionsPerTask, [&](size_t from, size_t to) {
    for (size_t n = from; n < to; ++n) parts[n] = leaf_volume(set, begin + n);
  });
  return parts;
}

double sum_of(const LevelSet& set, std::span<const double> volumes) {
  double sum = 0.0;
  for (const double part : volumes) sum += part;
  return sum * std::pow(set.voxel, 3);
}

double trilinear(const LevelSet& set, const Vec3& point_W) {
  const Vec3 index = point_W / set.voxel;
  const Vec3 cell = index.array().floor();
  const Vec3 f = index - cell;
  // Far outside every corner is air; the cast below would overflow there.
  constexpr double kFar = 1e9;
  if (!(index.cwiseAbs().maxCoeff() < kFar)) return set.band();
  const openvdb::Coord low(static_cast<int>(cell.x()), static_cast<int>(cell.y()),
                           static_cast<int>(cell.z()));
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const int i = corner >> 2, j = corner >> 1 & 1, k = corner & 1;
    const double weight = (i ? f.x() : 1.0 - f.x()) * (j ? f.y() : 1.0 - f.y()) * (k ? f.z() : 1.0 - f.z());
    sum += weight * set.value(low.offsetBy(i, j, k));
  }
  return sum;
}

double air_radius(const LevelSet& set, const Vec3& point_W) {
  constexpr double kFar = 1e9;      // the casts below would overflow there
  constexpr double kFloats = 2e-5;  // mm, of the values and of coordinates in the tool frame
  const Vec3 index = point_W / set.voxel;
  if (!(index.cwiseAbs().maxCoeff() < kFar)) return set.band();
  const Vec3 nearest = index.array().round();
  const openvdb::Coord at(static_cast<int>(nearest.x()), static_cast<int>(nearest.y()),
                          static_cast<int>(nearest.z()));
  double radius = set.value(at) - (index - nearest).norm() * set.voxel;
  // A leaf position without a leaf holds +band at all its points: their balls cover its cube and more.
  const openvdb::Coord leaf(at.x() >> 3, at.y() >> 3, at.z() >> 3);
  const openvdb::Coord place(leaf.x() - set.map.lower.x(), leaf.y() - set.map.lower.y(),
                             leaf.z() - set.map.lower.z());
  const bool known = place.x() >= 0 && place.y() >= 0 && place.z() >= 0 &&
                     place.x() < set.map.dimension.x() && place.y() < set.map.dimension.y() &&
                     place.z() < set.map.dimension.z();
  if (known && set.map.states[set.map.index(place.x(), place.y(), place.z())] == LeafState::kAir) {
    const Vec3 low(leaf.x() * 8.0, leaf.y() * 8.0, leaf.z() * 8.0);
    const double inside =
        std::min((index - low).minCoeff(), (low + Vec3::Constant(kLeafSide - 1.0) - index).minCoeff());
    radius = std::max(radius, inside * set.voxel + set.band() - 0.5 * std::sqrt(3.0) * set.voxel);
  }
  return std::max(0.0, radius - kFloats);
}

std::vector<Vec3> air_points(const LevelSet& set, double below_mm) {
  const size_t chunks = (set.map.size() + kPositionsPerTask - 1) / kPositionsPerTask;
  std::vector<std::vector<Vec3>> parts(chunks);
  parallel_chunks(set.map.size(), kPositionsPerTask, [&](size_t begin, size_t end) {
    std::vector<Vec3>& part = parts[begin / kPositionsPerTask];
    for (size_t n = begin; n < end; ++n) {
      if (set.map.states[n] != LeafState::kLeaf) continue;
      const float* values = set.values(n);
      const openvdb::Coord at = set.map.origin(n);
      for (int v = 0; v < kLeafVoxels; ++v)
        if (values[v] >= 0.0F && values[v] < below_mm)
          part.push_back(set.voxel * Vec3(at.x() + v / 64, at.y() + v / 8 % 8, at.z() + v % 8));
    }
  });
  std::vector<Vec3> points;
  for (const std::vector<Vec3>& part : parts) points.insert(points.end(), part.begin(), part.end());
  return points;
}

uint64_t state_hash(const LevelSet& set) {
  const size_t chunks = (set.map.size() + kPositionsPerTask - 1) / kPositionsPerTask;
  std::vector<uint64_t> parts(chunks, 0);
  parallel_chunks(set.map.size(), kPositionsPerTask, [&](size_t begin, size_t end) {
    for (size_t n = begin; n < end; ++n) parts[begin / kPositionsPerTask] += leaf_hash(set, n);
  });
  // A sum, because it does not care for order: integers wrap, so every split into chunks adds up alike.
  uint64_t sum = 0;
  for (const uint64_t part : parts) sum += part;
  Hash hash;
  hash.add(set.voxel);
  hash.add(sum);
  return hash.value();
}

}  // namespace swarf::stock
