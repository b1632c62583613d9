// Cutting, in batches of sweeps:
//   1. gather: runs of sweeps list the leaf positions they may change (parallel over runs)
//   2. share out: slabs of neighbouring positions, with as many pairs of a run and a position each
//   3. cut: a slab groups its pairs by position; each position applies its sweeps, deepest first (parallel
//      over slabs; one task owns a position)
//   4. settle: new leaves enter the tree, emptied ones leave it (serial, in order of position)
// Each voxel ends as the maximum over the pieces that reach it, whatever the order, batches, calls and
// threads. The order saves work: after the deepest piece most others of the batch have nothing left to raise.
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <limits>
#include <memory>

#include "base/parallel.h"
#include "stock/level_set/convex_leaf.h"
#include "stock/level_set/lane_run.h"
#include "stock/level_set/leaf_cut.h"
#include "stock/level_set/leaf_kernel.h"
#include "stock/level_set/piece_window.h"
#include "stock/level_set/stock_grid_internal.h"

namespace swarf::stock {
namespace {

/// Sweeps that are applied together: of more of them a leaf meets its deepest sweep early, and fewer evaluate
/// it. As many as leave room for `kMostPairs` pairs of a run and a leaf.
constexpr size_t kLeastBatch = 512, kMostBatch = 4096;
constexpr double kMostPairs = 2.5e5;
constexpr size_t kRunsPerTask = 1;
constexpr size_t kSlabs = 128;
/// Leaves that are kept to be made again: freed ones would be looked up and joined by the allocator.
constexpr size_t kMostSpare = 8192;

/// A leaf position and the pairs that may change it.
struct Group {
  uint32_t leaf = 0;
  bool swallowed = false;     ///< a sweep leaves nothing of it
  size_t begin = 0, end = 0;  ///< in the slab's pairs
};

/// Pairs of neighbouring leaf positions.
struct Slab {
  std::vector<Group> groups;    ///< in order of position
  std::vector<LeafPair> pairs;  ///< in the order of their groups, there in the order of the path
};

/// By run, in order of position.
using FoundPairs = std::vector<std::vector<LeafPair>>;

struct Batch {
  std::vector<SweptPiece> pieces;
  std::vector<LaneRun> runs;
  FoundPairs found;
  std::vector<uint32_t> slab_ends;  ///< first position beyond each slab
  std::atomic<size_t> spare_taken{0};

  /// The deepest of a pair's sweeps, in `pieces`.
  uint32_t piece(const LeafPair& pair) const {
    return static_cast<uint32_t>(runs[pair.run].first) + pair.lane;
  }
};

/// Shares the positions out, by a sample of the pairs.
void set_slabs(Batch& batch) {
  constexpr size_t kOfPairs = 32;
  std::vector<uint32_t> sample;
  for (const auto& part : batch.found) {
    for (size_t n = kOfPairs / 2; n < part.size(); n += kOfPairs) sample.push_back(part[n].leaf);
  }
  std::sort(sample.begin(), sample.end());
  batch.slab_ends.clear();
  for (size_t slab = 1; slab < kSlabs && !sample.empty(); ++slab) {
    const uint32_t end = sample[slab * sample.size() / kSlabs];
    if (batch.slab_ends.empty() || batch.slab_ends.back() < end) batch.slab_ends.push_back(end);
  }
  batch.slab_ends.push_back(std::numeric_limits<uint32_t>::max());
}

void gather(LevelSet& set, Batch& batch) {
  batch.runs = make_runs(set, batch.pieces);
  batch.found.clear();
  batch.found.resize(batch.runs.size());
  parallel_chunks(batch.runs.size(), kRunsPerTask, [&](size_t begin, size_t end) {
    for (size_t n = begin; n < end; ++n) batch.found[n] = gather_leaves(set, batch.runs[n], n);
  });
  set_slabs(batch);
}

/// The pairs of each run that lie in a slab.
std::vector<std::span<const LeafPair>> parts_of(const Batch& batch, size_t number) {
  const auto lies_before = [](const LeafPair& pair, uint32_t leaf) { return pair.leaf < leaf; };
  const uint32_t first = number == 0 ? 0 : batch.slab_ends[number - 1], end = batch.slab_ends[number];
  std::vector<std::span<const LeafPair>> parts;
  for (const auto& part : batch.found) {
    if (part.empty() || part.back().leaf < first || part.front().leaf >= end) continue;
    const auto from = std::lower_bound(part.begin(), part.end(), first, lies_before);
    const auto to = std::lower_bound(from, part.end(), end, lies_before);
    if (from != to) parts.emplace_back(from, to);
  }
  return parts;
}

/// One group for each position that was found, with as many pairs as it has. Each position's mark is its
/// group's number then, from kFirstGroup on.
constexpr uint32_t kFirstGroup = LeafMap::kSwallowed + 1;
void count_groups(LevelSet& set, Slab& slab, std::span<const std::span<const LeafPair>> parts) {
  for (const auto& part : parts) {
    for (const LeafPair& pair : part) {
      uint32_t& mark = set.map.marks[pair.leaf];
      if (mark < kFirstGroup) {
        slab.groups.push_back({pair.leaf, mark == LeafMap::kSwallowed});
        mark = kFirstGroup + static_cast<uint32_t>(slab.groups.size() - 1);
      }
      Group& group = slab.groups[mark - kFirstGroup];
      group.end += group.swallowed ? 0 : 1;
    }
  }
}

void sort_groups(LevelSet& set, Slab& slab) {
  std::sort(slab.groups.begin(), slab.groups.end(),
            [](const Group& a, const Group& b) { return a.leaf < b.leaf; });
  size_t total = 0;
  for (size_t g = 0; g < slab.groups.size(); ++g) {
    Group& group = slab.groups[g];
    set.map.marks[group.leaf] = kFirstGroup + static_cast<uint32_t>(g);
    group.begin = total;
    total += group.end;
    group.end = group.begin;
  }
  slab.pairs.resize(total);
}

Slab slab_of(LevelSet& set, const Batch& batch, size_t number) {
  const std::vector<std::span<const LeafPair>> parts = parts_of(batch, number);
  Slab slab;
  count_groups(set, slab, parts);
  sort_groups(set, slab);
  for (const auto& part : parts) {
    for (const LeafPair& pair : part) {
      Group& group = slab.groups[set.map.marks[pair.leaf] - kFirstGroup];
      if (!group.swallowed) slab.pairs[group.end++] = pair;
    }
  }
  for (const Group& group : slab.groups) set.map.marks[group.leaf] = 0;
  return slab;
}

/// A sweep that may raise a value of the leaf.
struct Candidate {
  float depth, above;  ///< LaneAnswer's, mm
  uint32_t piece;      ///< in the batch
  uint32_t bound;      ///< in `bounds`

  bool before(const Candidate& other) const {
    return depth > other.depth || (depth == other.depth && piece < other.piece);
  }
};
struct Candidates {
  std::vector<Candidate> sweeps;
  std::vector<LeafBound> bounds;
};

/// Runs against one leaf.
struct LeafJudge {
  const Batch& batch;
  LeafExtent extent;
  Vec3 centre;  ///< W

  const LaneRun& run(const LeafPair& pair) const { return batch.runs[pair.run]; }
  LaneQuery query(const LaneRun& run, const LeafFloor& floor) const {
    return run.query(extent, (centre - run.origin).cast<float>(), floor);
  }
  LaneBounds bounds(const LaneRun& run) const {
    static const LaneBoundKernel kernel = lane_kernel_variants().front().bounds;
    LaneBounds bounds;
    kernel(run.lanes, run.piece, query(run, {}), bounds);
    return bounds;
  }
};

/// The candidates of a group, but for the piece `but`, in the order of the path, as far as the floor does not
/// rule them out.
void find_candidates(const LeafJudge& judge, std::span<const LeafPair> pairs, const LeafFloor& floor,
                     uint32_t but, Candidates& candidates) {
  static const LaneKernel kernel = lane_kernel_variants().front().kernel;
  constexpr size_t kAtATime = 16;  // their answers do not wait for each other
  std::array<LaneAnswer, kAtATime> answers;
  candidates.sweeps.clear();
  candidates.bounds.clear();
  for (size_t first = 0; first < pairs.size(); first += kAtATime) {
    const size_t end = std::min(first + kAtATime, pairs.size());
    for (size_t n = first; n < end; ++n) {
      const LaneRun& run = judge.run(pairs[n]);
      kernel(run.lanes, run.piece, judge.query(run, floor), answers[n - first]);
    }
    for (size_t n = first; n < end; ++n) {
      const LaneRun& run = judge.run(pairs[n]);
      const LaneAnswer& answer = answers[n - first];
      uint32_t open = answer.open & run.all();
      if (but - run.first < kLanes) open &= ~(1U << (but - run.first));
      if (open == 0) continue;
      const LaneBounds bounds = judge.bounds(run);
      for (; open != 0; open &= open - 1) {
        const auto lane = static_cast<uint32_t>(std::countr_zero(open));
        candidates.sweeps.push_back({answer.depth.lane[lane], answer.above.lane[lane],
                                     static_cast<uint32_t>(run.first) + lane,
                                     static_cast<uint32_t>(candidates.bounds.size())});
        candidates.bounds.push_back(bounds.lane(lane));
      }
    }
  }
}

struct Outcome {
  LeafState state = LeafState::kLeaf;
  std::unique_ptr<LeafNode> made;
  LeafFloor floor;
  bool changed = false;
  uint64_t visits = 0, patches = 0;

  void take(const LeafCut& cut) {
    visits = cut.visits();
    patches = cut.patches();
    if (visits > 0) floor = cut.floor();
  }
};

const LeafPair& deepest_of(const Batch& batch, std::span<const LeafPair> pairs) {
  return *std::min_element(pairs.begin(), pairs.end(), [&](const LeafPair& a, const LeafPair& b) {
    return a.depth > b.depth || (a.depth == b.depth && batch.piece(a) < batch.piece(b));
  });
}

/// Deepest first: what it leaves rules out most of the others.
void apply_pairs(const LevelSet& set, const Batch& batch, std::span<const LeafPair> pairs,
                 Candidates& candidates, float* values, Outcome& outcome) {
  LeafCut cut(set, pairs.front().leaf, values);
  const LeafJudge judge{batch, LeafExtent(set), cut.centre()};
  const LeafPair& deepest = deepest_of(batch, pairs);
  cut.apply(batch.pieces[batch.piece(deepest)], judge.bounds(judge.run(deepest)).lane(deepest.lane));
  outcome.take(cut);
  find_candidates(judge, pairs, outcome.floor, batch.piece(deepest), candidates);
  std::sort(candidates.sweeps.begin(), candidates.sweeps.end(),
            [](const Candidate& a, const Candidate& b) { return a.before(b); });
  for (const Candidate& sweep : candidates.sweeps) {
    if (sweep.above >= cut.lowest()) cut.apply(batch.pieces[sweep.piece], candidates.bounds[sweep.bound]);
  }
  outcome.take(cut);
  outcome.changed = cut.changed();
}

/// A leaf of solid material; one that was emptied before if there is any.
std::unique_ptr<LeafNode> solid_leaf(LevelSet& set, Batch& batch, size_t leaf) {
  const size_t number = batch.spare_taken.fetch_add(1, std::memory_order_relaxed);
  if (number >= set.spare.size()) {
    return std::make_unique<LeafNode>(set.map.origin(leaf), -set.band(), false);
  }
  std::unique_ptr<LeafNode> node = std::move(set.spare[number]);
  node->setOrigin(set.map.origin(leaf));
  std::fill_n(node->buffer().data(), kLeafVoxels, -set.band());  // makes room if its values were on the disk
  return node;
}

/// Applies one group. The leaf is changed in place, or made when the position was solid so far.
Outcome cut_leaf(LevelSet& set, Batch& batch, const Group& group, std::span<const LeafPair> pairs,
                 Candidates& candidates) {
  const size_t leaf = group.leaf;
  Outcome outcome;
  outcome.floor = set.map.floors[leaf];
  if (group.swallowed) {
    outcome.state = LeafState::kAir;
    return outcome;
  }
  LeafNode* node = set.map.leaves[leaf];
  if (node == nullptr) {
    outcome.made = solid_leaf(set, batch, leaf);
    node = outcome.made.get();
  }
  float* const values = outcome.made ? node->buffer().data() : set.own_values(leaf);
  apply_pairs(set, batch, pairs, candidates, values, outcome);
  outcome.state = settle_leaf(*node, set.band());
  return outcome;
}

/// What the tree has to take over of a position.
struct ForTree {
  uint32_t leaf = 0;
  bool had_leaf = false;
  std::unique_ptr<LeafNode> made;  ///< null: nothing is left of it
};

struct SlabOutcome {
  std::vector<ForTree> for_tree;    ///< in order of position
  std::vector<uint32_t> from_disk;  ///< what is there of these no longer counts
  uint64_t visits = 0, patches = 0;
};

/// Leaves a position as it is from now on, but for the tree.
void settle(LevelSet& set, size_t leaf, Outcome& outcome, SlabOutcome& slab) {
  const bool changed = outcome.changed || outcome.state != set.map.states[leaf];
  set.map.states[leaf] = outcome.state;
  set.map.floors[leaf] = outcome.floor;
  set.map.cuts[leaf] += changed ? 1 : 0;
  if (set.is_spilled(leaf)) slab.from_disk.push_back(static_cast<uint32_t>(leaf));
  slab.visits += outcome.visits;
  slab.patches += outcome.patches;
  const bool is_new = outcome.state == LeafState::kLeaf && outcome.made;
  if (!is_new && outcome.state != LeafState::kAir) return;
  LeafNode*& node = set.map.leaves[leaf];
  slab.for_tree.push_back(
      {static_cast<uint32_t>(leaf), node != nullptr, is_new ? std::move(outcome.made) : nullptr});
  node = slab.for_tree.back().made.get();
}

/// Starts to bring what the map knows of groups to come into the cache, and the nodes of their leaves.
void fetch_places(const LevelSet& set, std::span<const Group> next) {
  constexpr size_t kForMap = 7, kForNode = 2;
  if (next.size() > kForMap) {
    const size_t leaf = next[kForMap].leaf;
    __builtin_prefetch(&set.map.leaves[leaf]);
    __builtin_prefetch(&set.map.floors[leaf], 1);
    __builtin_prefetch(&set.map.cuts[leaf], 1);
  }
  if (next.size() > kForNode) __builtin_prefetch(set.map.leaves[next[kForNode].leaf]);
}

/// The same for one half of the next leaf's values: a processor waits for no more than some lines at a time.
void fetch_values(const LevelSet& set, std::span<const Group> next, int half) {
  if (next.empty() || next[0].swallowed || set.is_spilled(next[0].leaf)) return;
  const LeafNode* const node = set.map.leaves[next[0].leaf];
  if (node == nullptr) return;
  constexpr int kOfLine = 16, kOfHalf = kLeafVoxels / 2;
  const float* const values = node->buffer().data() + half * kOfHalf;
  for (int n = 0; n < kOfHalf; n += kOfLine) __builtin_prefetch(values + n, 1);
}

SlabOutcome cut_slab(LevelSet& set, Batch& batch, size_t number) {
  const Slab slab = slab_of(set, batch, number);
  SlabOutcome done;
  Candidates scratch;
  for (size_t g = 0; g < slab.groups.size(); ++g) {
    const Group& group = slab.groups[g];
    const auto next = std::span(slab.groups).subspan(g + 1);
    fetch_places(set, next);
    fetch_values(set, next, 0);
    const std::span<const LeafPair> pairs(slab.pairs.data() + group.begin, group.end - group.begin);
    Outcome outcome = cut_leaf(set, batch, group, pairs, scratch);
    fetch_values(set, next, 1);
    settle(set, group.leaf, outcome, done);
  }
  return done;
}

/// The tree while leaves enter and leave it; remembers the node of the position before.
class TreeUpdate {
 public:
  explicit TreeUpdate(LevelSet& set) : set_(set), near_(set.grid->tree()) {}

  void take(ForTree& change) {
    if (change.made) {
      near_.addLeaf(change.made.release());
      return;
    }
    const openvdb::Coord origin = set_.map.origin(change.leaf);
    if (change.had_leaf && set_.spare.size() < kMostSpare) {
      Parent* const parent = near_.probeNode<Parent>(origin);
      set_.spare.emplace_back(parent->stealNode<LeafNode>(origin, set_.band(), false));
    } else {
      constexpr openvdb::Index kLeafLevel = 1;  // a tile that replaces one leaf
      near_.addTile(kLeafLevel, origin, set_.band(), false);
    }
    set_.map.lower_top(change.leaf);
  }

 private:
  using Parent = openvdb::FloatTree::RootNodeType::ChildNodeType::ChildNodeType;

  LevelSet& set_;
  openvdb::tree::ValueAccessor<openvdb::FloatTree> near_;
};

void cut_batch(LevelSet& set, Batch& batch) {
  gather(set, batch);
  std::vector<SlabOutcome> outcomes(batch.slab_ends.size());
  parallel_chunks(outcomes.size(), 1, [&](size_t begin, size_t end) {
    for (size_t n = begin; n < end; ++n) outcomes[n] = cut_slab(set, batch, n);
  });
  set.spare.erase(set.spare.begin(),
                  set.spare.begin() + std::min(batch.spare_taken.exchange(0), set.spare.size()));
  TreeUpdate tree(set);
  for (SlabOutcome& outcome : outcomes) {
    set.statistics.leaf_visits += outcome.visits;
    set.statistics.voxel_updates += outcome.patches * kPatchVoxels;
    for (const uint32_t leaf : outcome.from_disk) set.forget_spilled(leaf);
    for (const ForTree& change : outcome.for_tree) __builtin_prefetch(change.made.get());
    for (ForTree& change : outcome.for_tree) tree.take(change);
  }
}

/// By the leaves of a surface under the cutter, which a run of sweeps reaches.
size_t batch_size(const LevelSet& set, const CutterSolid& cutter) {
  constexpr double kLeavesPerColumn = 2.0, kRimLeaves = 4.0;
  const double across = 2.0 * cutter.radius / (kLeafSide * set.voxel) + kRimLeaves;
  const double runs = kMostPairs / (kLeavesPerColumn * across * across);
  const double pieces = std::max(1.0, static_cast<double>(cutter.pieces.size()));
  return static_cast<size_t>(std::clamp(runs * kLanes / pieces, double{kLeastBatch}, double{kMostBatch}));
}

/// What the kernels round at most.
double rounding_of(const LevelSet& set, const CutterSolid& cutter) {
  double rounding = 0.0;
  for (const cutter::ConvexPiece& piece : cutter.pieces) {
    rounding = std::max(rounding, piece.is_cylinder() ? cylinder_kernel_error_mm(piece, set.voxel, set.band())
                                                      : convex_kernel_error_mm(piece, set.voxel, set.band()));
  }
  return rounding;
}

}  // namespace

void cut_level_set(LevelSet& set, std::span<const Sweep> sweeps, const CutterSolid& cutter) {
  const auto begun = std::chrono::steady_clock::now();
  Batch batch;
  const size_t most = batch_size(set, cutter);
  for (size_t first = 0; first < sweeps.size(); first += most) {
    const auto part = sweeps.subspan(first, std::min(most, sweeps.size() - first));
    batch.pieces.clear();
    for (const cutter::ConvexPiece& piece : cutter.pieces) {
      for (const Sweep& sweep : part) batch.pieces.push_back({sweep_map(sweep), &piece});
    }
    cut_batch(set, batch);
  }
  if (!sweeps.empty()) set.rounding_mm = std::max(set.rounding_mm, rounding_of(set, cutter));
  set.statistics.sweeps += sweeps.size();
  set.statistics.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
}

}  // namespace swarf::stock
