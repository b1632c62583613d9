// Invariants of the level set; their numbers and meaning stand at Stock::check and Stock::check_since.
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "base/check.h"
#include "base/parallel.h"
#include "stock/level_set/leaf_kernel.h"
#include "stock/level_set/stock_grid_internal.h"

namespace swarf::stock {
namespace {

constexpr size_t kCheckedPerTask = 1024;

/// The first fault in order of position, whatever the threads: fault(n) is "" where all is well.
template <typename Fault>
std::string first_fault(size_t positions, const Fault& fault) {
  std::vector<std::string> faults((positions + kCheckedPerTask - 1) / kCheckedPerTask);
  parallel_chunks(positions, kCheckedPerTask, [&](size_t begin, size_t end) {
    std::string& found = faults[begin / kCheckedPerTask];
    for (size_t n = begin; n < end && found.empty(); ++n) found = fault(n);
  });
  for (std::string& found : faults) {
    if (!found.empty()) return std::move(found);
  }
  return "";
}

std::string count_fault(const LevelSet& set) {
  size_t leaves = 0;
  for (const LeafState state : set.map.states) leaves += state == LeafState::kLeaf ? 1 : 0;
  if (leaves == set.grid->tree().leafCount()) return "";
  return fmt::format("1: the tree has {} leaves, the map {}", set.grid->tree().leafCount(), leaves);
}

/// Invariants 2 and 3.
std::string tree_fault(const LevelSet& set, size_t n) {
  const openvdb::Coord origin = set.map.origin(n);
  if (set.map.states[n] == LeafState::kLeaf) {
    if (set.grid->tree().probeConstLeaf(origin) == set.map.leaves[n]) return "";
    return fmt::format("2: leaf position {} of the map is not the tree's leaf", n);
  }
  const float expected = set.map.states[n] == LeafState::kSolid ? -set.band() : set.band();
  if (set.map.leaves[n] == nullptr && set.grid->tree().getValue(origin) == expected) return "";
  return fmt::format("3: the tree at leaf position {} differs from the map's state", n);
}

/// Invariant 4; each pair is looked at from its lower position. `own`: where this process cuts both.
std::string neighbour_fault(const LevelSet& set, size_t n, bool own) {
  const LeafMap& map = set.map;
  const auto size_y = static_cast<size_t>(map.dimension.y()), size_z = static_cast<size_t>(map.dimension.z());
  const size_t k = n % size_z, j = n / size_z % size_y, i = n / size_z / size_y;
  const auto opposite = [&](size_t other) {
    return map.states[n] != LeafState::kLeaf && map.states[other] != LeafState::kLeaf &&
           map.states[n] != map.states[other] && (!own || (set.owns(n) && set.owns(other)));
  };
  const bool broken = (k + 1 < size_z && opposite(n + 1)) || (j + 1 < size_y && opposite(n + size_z)) ||
                      (i + 1 < static_cast<size_t>(map.dimension.x()) && opposite(n + size_z * size_y));
  return broken ? fmt::format("4: air and solid meet at leaf position {} without a surface", n) : "";
}

std::string voxel_name(const LevelSet& set, size_t position, int offset) {
  const openvdb::Coord origin = set.map.origin(position);
  return fmt::format("voxel ({}, {}, {})", origin.x() + offset / 64, origin.y() + offset / 8 % 8,
                     origin.z() + offset % 8);
}

/// Invariants 5 to 7 of one leaf.
std::string value_fault(const LevelSet& set, size_t n) {
  const LeafNode& leaf = *set.map.leaves[n];
  const float* values = set.values(n);
  const float band = set.band();
  bool air = true, solid = true;
  for (int v = 0; v < kLeafVoxels; ++v) {
    if (!(values[v] >= -band && values[v] <= band)) {
      return fmt::format("5: {} holds {} mm, outside the band", voxel_name(set, n, v), values[v]);
    }
    if (leaf.isValueOn(static_cast<openvdb::Index>(v)) != (values[v] > -band && values[v] < band)) {
      return fmt::format("6: {} of {} mm is wrongly marked", voxel_name(set, n, v), values[v]);
    }
    air &= values[v] == band;
    solid &= values[v] == -band;
  }
  return air || solid ? fmt::format("7: leaf position {} is wholly {}", n, air ? "air" : "solid") : "";
}

/// Invariant 8: steps to the next voxel along +x, +y, +z.
std::string step_fault(const LevelSet& set, size_t n) {
  const float* values = set.values(n);
  const openvdb::Coord origin = set.map.origin(n);
  // A distance changes by at most one voxel per voxel; both ends of the step are rounded by the kernels, and
  // their difference and the voxel once more.
  constexpr float kStepRounding = 1e-6F;  // mm
  const auto steepest = static_cast<float>(set.voxel + 2.0 * set.rounding_mm) + kStepRounding;
  constexpr int kStrides[3] = {64, 8, 1};
  for (int v = 0; v < kLeafVoxels; ++v) {
    const int place[3] = {v / 64, v / 8 % 8, v % 8};
    for (int axis = 0; axis < 3; ++axis) {
      const bool inside = place[axis] + 1 < kLeafSide;
      const float next = inside ? values[v + kStrides[axis]]
                                : set.value({origin.x() + place[0] + (axis == 0 ? 1 : 0),
                                             origin.y() + place[1] + (axis == 1 ? 1 : 0),
                                             origin.z() + place[2] + (axis == 2 ? 1 : 0)});
      if (std::abs(next - values[v]) <= steepest) continue;
      return fmt::format("8: step of {} mm from {} along {}", next - values[v], voxel_name(set, n, v),
                         "xyz"[axis]);
    }
  }
  return "";
}

/// How much material a state can stand for: solid 2, leaf 1, air 0.
int rank(LeafState state) {
  return state == LeafState::kSolid ? 2 : state == LeafState::kLeaf ? 1 : 0;
}

}  // namespace

std::string broken_invariant(const LevelSet& set, CheckLevel level) {
  if (std::string fault = count_fault(set); !fault.empty()) return fault;
  const bool own = level == CheckLevel::kOwnMap;
  std::string fault = first_fault(set.map.size(), [&](size_t n) -> std::string {
    if (own && !set.owns(n)) return "";
    std::string found = tree_fault(set, n);
    return found.empty() ? neighbour_fault(set, n, own) : found;
  });
  if (!fault.empty() || level <= CheckLevel::kMap) return fault;
  fault = first_fault(set.map.size(), [&](size_t n) -> std::string {
    return set.map.states[n] == LeafState::kLeaf ? value_fault(set, n) : "";
  });
  if (!fault.empty() || level == CheckLevel::kLeaves) return fault;
  return broken_step(set, 0, set.map.size());
}

std::string broken_step(const LevelSet& set, size_t begin, size_t end) {
  return first_fault(end - begin, [&](size_t n) -> std::string {
    return set.map.states[begin + n] == LeafState::kLeaf ? step_fault(set, begin + n) : "";
  });
}

std::string gained_material(const LevelSet& set, const LevelSet& earlier) {
  SWARF_CHECK(set.map.size() == earlier.map.size() && set.voxel == earlier.voxel,
              "two states of one stock have the same leaf positions");
  return first_fault(set.map.size(), [&](size_t n) -> std::string {
    if (rank(set.map.states[n]) > rank(earlier.map.states[n])) {
      return fmt::format("9: leaf position {} gained material", n);
    }
    if (set.map.states[n] != LeafState::kLeaf || earlier.map.states[n] != LeafState::kLeaf) return "";
    const float *now = set.values(n), *before = earlier.values(n);
    for (int v = 0; v < kLeafVoxels; ++v) {
      if (now[v] < before[v]) return fmt::format("10: {} gained material", voxel_name(set, n, v));
    }
    return "";
  });
}

}  // namespace swarf::stock
