// Leaves on the disk. A leaf that goes gives up its values and keeps its node: map, masks and tree stand as
// they were, so that all who look at a leaf by LevelSet::values() see no difference.
//
// Which ones go: when it is known how soon each tile will be cut again, those of the tile that is cut last go
// first, which no other choice betters (Belady 1966); leaves that nothing will cut again go before all.
#include <algorithm>
#include <utility>

#include "base/check.h"
#include "stock/level_set/leaf_kernel.h"
#include "stock/level_set/stock_grid_internal.h"
#include "stock/stock_tiles.h"

namespace swarf::stock {
namespace {

static_assert(Stock::kLeafBytes == kLeafVoxels * sizeof(float));

struct HeldLeaf {
  uint32_t next_use;
  size_t leaf;
};

std::vector<HeldLeaf> held_leaves(const LevelSet& set, std::span<const uint32_t> next_use) {
  const TileGrid tiles = tiles_of(set.map, set.voxel);
  const LeafMap& map = set.map;
  std::vector<HeldLeaf> held;
  size_t leaf = 0;
  for (int i = 0; i < map.dimension.x(); ++i)
    for (int j = 0; j < map.dimension.y(); ++j) {
      const uint32_t next = next_use.empty() ? 0 : next_use[tiles.index(i / kTileLeaves, j / kTileLeaves)];
      for (int k = 0; k < map.dimension.z(); ++k, ++leaf)
        if (map.leaves[leaf] != nullptr && !set.is_spilled(leaf)) held.push_back({next, leaf});
    }
  return held;
}

void spill_leaf(LevelSet& set, size_t leaf) {
  LeafNode& node = *set.map.leaves[leaf];
  set.spilled->slots[leaf] = set.spilled->file.put(node.buffer().data());
  LeafNode::Buffer none(openvdb::PartialCreate(), 0.0F);
  node.swap(none);
}

}  // namespace

void begin_spill(LevelSet& set, const Spill& spill) {
  SWARF_CHECK(!set.spilled, "a stock spills to one place");
  set.spilled = std::make_unique<SpilledLeaves>(spill, set.map.size());
}

float* LevelSet::own_values(size_t leaf) {
  float* const values = map.leaves[leaf]->buffer().data();  // makes room for those that are on the disk
  if (is_spilled(leaf)) std::copy_n(spilled->file.at(spilled->slots[leaf]), kLeafVoxels, values);
  return values;
}

void LevelSet::forget_spilled(size_t leaf) {
  if (is_spilled(leaf)) spilled->file.free(std::exchange(spilled->slots[leaf], LeafFile::kNone));
}

TileGrid tiles_of(const LeafMap& map, double voxel) {
  const double leaf_mm = kLeafSide * voxel;
  return {leaf_mm * Vec2(map.lower.x(), map.lower.y()), kTileLeaves * leaf_mm,
          (map.dimension.x() + kTileLeaves - 1) / kTileLeaves,
          (map.dimension.y() + kTileLeaves - 1) / kTileLeaves};
}

void make_room(LevelSet& set, std::span<const uint32_t> next_use) {
  SWARF_CHECK(set.spilled != nullptr, "a stock that does not spill has no room to make");
  std::vector<HeldLeaf> held = held_leaves(set, next_use);
  const size_t most = set.spilled->most;
  if (held.size() <= most) return;
  set.spare.clear();
  const auto goes_before = [](const HeldLeaf& a, const HeldLeaf& b) {
    return a.next_use > b.next_use || (a.next_use == b.next_use && a.leaf < b.leaf);
  };
  const auto stay = held.begin() + static_cast<ptrdiff_t>(held.size() - most / 2);
  std::nth_element(held.begin(), stay, held.end(), goes_before);
  std::sort(held.begin(), stay, [](const HeldLeaf& a, const HeldLeaf& b) { return a.leaf < b.leaf; });
  for (auto one = held.begin(); one != stay; ++one) spill_leaf(set, one->leaf);
}

}  // namespace swarf::stock
