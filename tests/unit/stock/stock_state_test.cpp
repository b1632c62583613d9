// Invariants and the state hash, on level sets that are broken on purpose.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "base/parallel.h"
#include "stock/level_set/leaf_kernel.h"
#include "stock/level_set/stock_grid_internal.h"
#include "stock_test_support.h"

namespace swarf::stock::stock_state_test {
namespace {

const CutterSolid kCutter{2.0, 10.0};

LevelSet small_set() {
  LevelSet set = make_box({{-6, -6, -4}, {6, 6.05, 0}}, 0.3);
  const std::vector<Sweep> sweeps{
      {{{-2, 0, -1.5}, Vec3::UnitZ()}, {{3, 1, -1}, Vec3(0.1, 0, 1).normalized()}, 0}};
  cut_level_set(set, sweeps, kCutter);
  return set;
}

size_t position_in(const LevelSet& set, LeafState state) {
  for (size_t n = 0; n < set.map.size(); ++n) {
    if (set.map.states[n] == state) return n;
  }
  ADD_FAILURE() << "no such position";
  return 0;
}

std::string broken(const LevelSet& set, CheckLevel level) {
  return broken_invariant(set, level).substr(0, 2);
}

TEST(StockCheck, SoundStockHoldsAllInvariants) {
  EXPECT_EQ(broken_invariant(small_set(), CheckLevel::kVoxels), "");
}

TEST(StockCheck, NamesEachBrokenInvariant) {
  LevelSet set = small_set();
  const size_t leaf = position_in(set, LeafState::kLeaf);
  set.map.states[leaf] = LeafState::kAir;
  EXPECT_EQ(broken(set, CheckLevel::kMap), "1:");

  set = small_set();
  std::swap(set.map.leaves[leaf], set.map.leaves[leaf + 1]);
  EXPECT_EQ(broken(set, CheckLevel::kMap), "2:");

  set = make_box({{-9, -9, -9}, {9, 9, 9}}, 0.3);
  const size_t solid = position_in(set, LeafState::kSolid);
  set.map.states[solid] = LeafState::kAir;
  EXPECT_EQ(broken(set, CheckLevel::kMap), "3:");
  set.grid->tree().addTile(1, set.map.origin(solid), set.band(), false);
  // Now the tree agrees, but an air position lies in the middle of the solid.
  const size_t inner = solid + 1;
  ASSERT_EQ(set.map.states[inner], LeafState::kSolid);
  EXPECT_EQ(broken(set, CheckLevel::kMap), "4:");
}

TEST(StockCheck, NamesEachBrokenVoxel) {
  LevelSet set = small_set();
  const size_t leaf = position_in(set, LeafState::kLeaf);
  float* values = set.map.leaves[leaf]->buffer().data();
  for (const float bad : {2.0F * set.band(), std::numeric_limits<float>::quiet_NaN()}) {
    const float kept = values[17];
    values[17] = bad;
    EXPECT_EQ(broken(set, CheckLevel::kVoxels), "5:");
    EXPECT_EQ(broken(set, CheckLevel::kMap), "");
    values[17] = kept;
  }
  set.map.leaves[leaf]->getValueMask().toggle(17);
  EXPECT_EQ(broken(set, CheckLevel::kVoxels), "6:");

  set = small_set();
  set.map.leaves[leaf]->fill(set.band(), false);
  EXPECT_EQ(broken(set, CheckLevel::kVoxels), "7:");

  set = small_set();
  LeafNode& node = *set.map.leaves[leaf];
  for (int v = 0; v < kLeafVoxels; ++v) {
    // Halfway through the band no sound neighbour is more than a voxel away in value.
    if (std::abs(node.buffer().data()[v]) > set.voxel) continue;
    node.buffer().data()[v] += static_cast<float>(1.9 * set.voxel);
    break;
  }
  EXPECT_EQ(broken(set, CheckLevel::kVoxels), "8:");
}

TEST(StockCheck, GainedMaterialIsFound) {
  const LevelSet before = small_set();
  LevelSet now = small_set();
  EXPECT_EQ(gained_material(now, before), "");
  const size_t leaf = position_in(now, LeafState::kLeaf);
  now.map.leaves[leaf]->buffer().data()[5] -= 1e-6F * now.map.leaves[leaf]->buffer().data()[5] + 1e-6F;
  EXPECT_EQ(gained_material(now, before).substr(0, 3), "10:");
  now.map.states[leaf] = LeafState::kSolid;
  EXPECT_EQ(gained_material(now, before).substr(0, 2), "9:");
}

TEST(StockHash, SeesEveryVoxelAndState) {
  LevelSet set = small_set();
  const uint64_t sound = state_hash(set);
  const size_t leaf = position_in(set, LeafState::kLeaf);
  float* values = set.map.leaves[leaf]->buffer().data();
  for (int v = 0; v < kLeafVoxels; ++v) {
    const float kept = values[v];
    values[v] = std::nextafter(kept, 1.0F);
    EXPECT_NE(state_hash(set), sound) << "voxel " << v;
    values[v] = kept;
  }
  EXPECT_EQ(state_hash(set), sound);
  set.map.states[position_in(set, LeafState::kAir)] = LeafState::kSolid;
  EXPECT_NE(state_hash(set), sound);
}

TEST(StockHash, EqualContentInAnotherPlaceIsAnotherStock) {
  LevelSet set = small_set();
  const uint64_t sound = state_hash(set);
  const size_t leaf = position_in(set, LeafState::kLeaf);
  ASSERT_EQ(set.map.states[leaf + 1], LeafState::kLeaf);
  std::swap(set.map.leaves[leaf], set.map.leaves[leaf + 1]);
  EXPECT_NE(state_hash(set), sound);
}

/// Straight, tilted and turning cuts, plunges and a turn on the spot, with long and short sweeps.
std::vector<Sweep> mixed_path() {
  constexpr uint64_t kSeed = 20261;
  Rng rng(kSeed);
  std::vector<Sweep> sweeps;
  ToolPose pose{{-12, 0, 1}, Vec3::UnitZ()};
  for (uint32_t i = 0; i < 600; ++i) {
    ToolPose next = pose;
    const double kind = rng.uniform();
    if (kind < 0.9) next.tip_W += rng.uniform(0.1, 2.0) * rng.direction();
    if (kind > 0.3) next.axis_W = (pose.axis_W + 0.05 * rng.direction()).normalized();
    next.tip_W = next.tip_W.cwiseMax(Vec3(-12, -9, -5)).cwiseMin(Vec3(12, 9, 1));
    sweeps.push_back({pose, next, i});
    pose = next;
  }
  return sweeps;
}

/// The state of a fixed mixed cut, equal in every build type, for any threads and any split into calls.
/// Change it only together with kCutAlgorithm (sim/run/cut_identity.h) and for a reason that CHANGELOG.md
/// names: stocks saved before can then no longer be cut on.
constexpr uint64_t kMixedCutHash = 0xe0d778b42d536c25;

TEST(StockHash, OfAMixedCutIsAConstant) {
  const std::vector<Sweep> sweeps = mixed_path();
  for (const int threads : {1, 2, 4}) {
    set_thread_count(threads);
    for (const size_t call : {size_t{1}, size_t{64}, size_t{4096}}) {
      LevelSet set = make_box({{-10, -8, -4}, {10, 8, 0}}, 0.25);
      for (size_t i = 0; i < sweeps.size(); i += call) {
        cut_level_set(set, std::span(sweeps).subspan(i, std::min(call, sweeps.size() - i)), kCutter);
      }
      EXPECT_EQ(state_hash(set), kMixedCutHash) << std::hex << "0x" << state_hash(set) << std::dec << ": "
                                                << threads << " threads, calls of " << call;
    }
  }
  set_thread_count(0);
}

}  // namespace
}  // namespace swarf::stock::stock_state_test
