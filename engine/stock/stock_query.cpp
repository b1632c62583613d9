// What is read off the level set: volume, distance, state hash, invariants.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/hash.h"
#include "base/parallel.h"
#include "stock/leaf_kernel.h"
#include "stock/stock_grid_internal.h"

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
double leaf_volume(const LeafMap& map, size_t n) {
  if (map.states[n] != LeafState::kLeaf) return map.states[n] == LeafState::kSolid ? kLeafVoxels : 0.0;
  const float* values = map.leaves[n]->buffer().data();
  double sum = 0.0;
  for (int voxel = 0; voxel < kLeafVoxels; ++voxel) sum += filled(values, voxel);
  return sum;
}

uint64_t leaf_hash(const LeafMap& map, size_t n) {
  Hash hash;
  hash.add(static_cast<uint64_t>(map.states[n]));
  if (map.states[n] == LeafState::kLeaf) {
    const float* values = map.leaves[n]->buffer().data();
    for (int voxel = 0; voxel < kLeafVoxels; ++voxel) hash.add(values[voxel]);
  }
  return hash.value();
}

/// Invariants 1 and 2: the tree and the map name the same leaves.
std::string map_fault(const LevelSet& set) {
  size_t leaves = 0;
  for (size_t n = 0; n < set.map.size(); ++n) {
    if (set.map.states[n] != LeafState::kLeaf) continue;
    ++leaves;
    if (set.grid->tree().probeConstLeaf(set.map.origin(n)) != set.map.leaves[n]) {
      return fmt::format("1: leaf position {} of the map is not the tree's leaf", n);
    }
  }
  if (leaves != set.grid->tree().leafCount()) {
    return fmt::format("2: the tree has {} leaves, the map {}", set.grid->tree().leafCount(), leaves);
  }
  return "";
}

/// Invariant 3: tiles of the tree carry the state's sign.
std::string tile_fault(const LevelSet& set, size_t n) {
  if (set.map.states[n] == LeafState::kLeaf) return "";
  const float expected = set.map.states[n] == LeafState::kSolid ? -set.band() : set.band();
  if (set.grid->tree().getValue(set.map.origin(n)) == expected) return "";
  return fmt::format("3: tile at leaf position {} differs from the map's state", n);
}

/// Invariants 4 to 6 of one leaf: values inside the band, mask of active voxels, slopes within the norm.
std::string leaf_fault(const LevelSet& set, size_t n) {
  if (set.map.states[n] != LeafState::kLeaf) return "";
  const LeafNode& leaf = *set.map.leaves[n];
  const float band = set.band();
  // A distance changes by at most one voxel per voxel; floats of 50 mm coordinates add 1e-5 mm.
  const float steepest = static_cast<float>(set.voxel) + 2e-5F;
  for (auto voxel = leaf.cbeginValueAll(); voxel; ++voxel) {
    const openvdb::Coord ijk = voxel.getCoord();
    const float value = *voxel;
    if (!(value >= -band && value <= band)) return fmt::format("4: value {} mm outside the band", value);
    if (voxel.isValueOn() != (value > -band && value < band)) {
      return fmt::format("5: activity of voxel ({}, {}, {})", ijk.x(), ijk.y(), ijk.z());
    }
    for (int axis = 0; axis < 3; ++axis) {
      openvdb::Coord next = ijk;
      ++next[axis];
      if (std::abs(set.value(next) - value) > steepest) {
        return fmt::format("6: step of {} mm beside voxel ({}, {}, {})", set.value(next) - value, ijk.x(),
                           ijk.y(), ijk.z());
      }
    }
  }
  return "";
}

}  // namespace

double volume(const LevelSet& set) {
  std::vector<double> parts(set.map.size());
  parallel_chunks(parts.size(), kPositionsPerTask, [&](size_t begin, size_t end) {
    for (size_t n = begin; n < end; ++n) parts[n] = leaf_volume(set.map, n);
  });
  double sum = 0.0;
  for (const double part : parts) sum += part;
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

uint64_t state_hash(const LevelSet& set) {
  std::vector<uint64_t> parts(set.map.size());
  parallel_chunks(parts.size(), kPositionsPerTask, [&](size_t begin, size_t end) {
    for (size_t n = begin; n < end; ++n) parts[n] = leaf_hash(set.map, n);
  });
  Hash hash;
  hash.add(set.voxel);
  for (const uint64_t part : parts) hash.add(part);
  return hash.value();
}

std::string broken_invariant(const LevelSet& set) {
  if (std::string fault = map_fault(set); !fault.empty()) return fault;
  const size_t chunks = (set.map.size() + kPositionsPerTask - 1) / kPositionsPerTask;
  std::vector<std::string> faults(chunks);
  parallel_chunks(set.map.size(), kPositionsPerTask, [&](size_t begin, size_t end) {
    std::string& fault = faults[begin / kPositionsPerTask];
    for (size_t n = begin; n < end && fault.empty(); ++n) {
      fault = tile_fault(set, n);
      if (fault.empty()) fault = leaf_fault(set, n);
    }
  });
  for (const std::string& fault : faults) {
    if (!fault.empty()) return fault;
  }
  return "";
}

}  // namespace swarf::stock
