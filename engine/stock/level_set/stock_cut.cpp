// Cutting, in batches of sweeps:
//   1. gather: runs of sweeps list the leaf positions they may change (parallel over runs)
//   2. group them by position
//   3. cut: each position applies its sweeps, deepest first (parallel over positions; one task owns a leaf)
//   4. settle: new leaves enter the tree, emptied ones leave it (serial, in order of position)
// Each voxel ends as the maximum over the pieces that reach it, whatever the order, batches, calls and
// threads. The order saves work: after the deepest piece most others of the batch have nothing left to raise.
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <chrono>
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
constexpr size_t kGroupsPerTask = 32;

/// A leaf position and the pairs that may change it.
struct Group {
  uint32_t leaf = 0;
  bool swallowed = false;     ///< a sweep leaves nothing of it
  size_t begin = 0, end = 0;  ///< in the batch's pairs
};

struct Batch {
  std::vector<SweptPiece> pieces;
  std::vector<LaneRun> runs;
  std::vector<LeafPair> pairs;  ///< in the order of their groups, there in the order of the path
  std::vector<Group> groups;    ///< in order of position
};

using FoundPairs = std::vector<std::vector<LeafPair>>;

/// One group for each position that was found, with as many pairs as it has. Each position's mark is its
/// group's number then, from kFirstGroup on.
constexpr uint32_t kFirstGroup = LeafMap::kSwallowed + 1;
void count_groups(LevelSet& set, Batch& batch, const FoundPairs& found) {
  batch.groups.clear();
  std::vector<uint32_t>& marks = set.map.marks;
  for (const auto& part : found) {
    for (const LeafPair& pair : part) {
      uint32_t& mark = marks[pair.leaf];
      if (mark < kFirstGroup) {
        batch.groups.push_back({pair.leaf, mark == LeafMap::kSwallowed});
        mark = kFirstGroup + static_cast<uint32_t>(batch.groups.size() - 1);
      }
      Group& group = batch.groups[mark - kFirstGroup];
      group.end += group.swallowed ? 0 : 1;
    }
  }
}

void sort_groups(LevelSet& set, Batch& batch) {
  tbb::parallel_sort(batch.groups.begin(), batch.groups.end(),
                     [](const Group& a, const Group& b) { return a.leaf < b.leaf; });
  size_t total = 0;
  for (size_t g = 0; g < batch.groups.size(); ++g) {
    Group& group = batch.groups[g];
    set.map.marks[group.leaf] = kFirstGroup + static_cast<uint32_t>(g);
    group.begin = total;
    total += group.end;
    group.end = group.begin;
  }
  batch.pairs.resize(total);
}

void group_pairs(LevelSet& set, Batch& batch, const FoundPairs& found) {
  count_groups(set, batch, found);
  sort_groups(set, batch);
  for (const auto& part : found) {
    for (const LeafPair& pair : part) {
      Group& group = batch.groups[set.map.marks[pair.leaf] - kFirstGroup];
      if (!group.swallowed) batch.pairs[group.end++] = pair;
    }
  }
  for (const Group& group : batch.groups) set.map.marks[group.leaf] = 0;
}

void gather(LevelSet& set, Batch& batch) {
  batch.runs = make_runs(set, batch.pieces);
  const size_t count = batch.runs.size();
  FoundPairs found((count + kRunsPerTask - 1) / kRunsPerTask);
  parallel_chunks(count, kRunsPerTask, [&](size_t begin, size_t end) {
    std::vector<LeafPair> own;  // not in place: neighbours in `found` share a cache line
    for (size_t n = begin; n < end; ++n) gather_leaves(set, batch.runs[n], n, own);
    found[begin / kRunsPerTask] = std::move(own);
  });
  group_pairs(set, batch, found);
}

/// A sweep that may raise a value of the leaf.
struct Candidate {
  float depth, above;  ///< LaneAnswer's, mm
  uint32_t piece;      ///< in the batch

  bool before(const Candidate& other) const {
    return depth > other.depth || (depth == other.depth && piece < other.piece);
  }
};

/// The candidates of a group in the order of the path, as far as the floor does not rule them out.
void find_candidates(const LevelSet& set, const Batch& batch, const Group& group, const LeafFloor& floor,
                     std::vector<Candidate>& candidates) {
  static const LaneKernel kernel = lane_kernel_variants().front().kernel;
  constexpr size_t kAtATime = 16;  // their answers do not wait for each other
  std::array<LaneAnswer, kAtATime> answers;
  const LeafExtent extent(set);
  const Vec3 centre = set.leaf_centre(group.leaf);
  candidates.clear();
  for (size_t first = group.begin; first < group.end; first += kAtATime) {
    const size_t end = std::min(first + kAtATime, group.end);
    for (size_t n = first; n < end; ++n) {
      const LaneRun& run = batch.runs[batch.pairs[n].run];
      kernel(run.lanes, run.piece, run.query(extent, centre, floor), answers[n - first]);
    }
    for (size_t n = first; n < end; ++n) {
      const LaneRun& run = batch.runs[batch.pairs[n].run];
      const LaneAnswer& answer = answers[n - first];
      for (uint32_t open = answer.open & run.all(); open != 0; open &= open - 1) {
        const auto lane = static_cast<uint32_t>(__builtin_ctz(open));
        candidates.push_back(
            {answer.depth.lane[lane], answer.above.lane[lane], static_cast<uint32_t>(run.first) + lane});
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

Candidate deepest_of(const Batch& batch, const Group& group) {
  const auto candidate = [&](size_t n) -> Candidate {
    const LeafPair& pair = batch.pairs[n];
    return {pair.depth, 0.0F, static_cast<uint32_t>(batch.runs[pair.run].first) + pair.lane};
  };
  Candidate deepest = candidate(group.begin);
  for (size_t n = group.begin + 1; n < group.end; ++n) {
    if (candidate(n).before(deepest)) deepest = candidate(n);
  }
  return deepest;
}

/// Deepest first: what it leaves rules out most of the others.
void apply_group(const LevelSet& set, const Batch& batch, const Group& group,
                 std::vector<Candidate>& candidates, float* values, Outcome& outcome) {
  LeafCut cut(set, group.leaf, values);
  const Candidate deepest = deepest_of(batch, group);
  cut.apply(batch.pieces[deepest.piece]);
  outcome.take(cut);
  find_candidates(set, batch, group, outcome.floor, candidates);
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.before(b); });
  for (const Candidate& candidate : candidates) {
    if (candidate.piece != deepest.piece && candidate.above >= cut.lowest()) {
      cut.apply(batch.pieces[candidate.piece]);
    }
  }
  outcome.take(cut);
  outcome.changed = cut.changed();
}

/// Applies one group. The leaf is changed in place, or made when the position was solid so far.
Outcome cut_leaf(LevelSet& set, const Batch& batch, const Group& group, std::vector<Candidate>& candidates) {
  const size_t leaf = group.leaf;
  Outcome outcome;
  outcome.floor = set.map.floors[leaf];
  if (group.swallowed) {
    outcome.state = LeafState::kAir;
    return outcome;
  }
  LeafNode* node = set.map.leaves[leaf];
  if (node == nullptr) {
    outcome.made = std::make_unique<LeafNode>(set.map.origin(leaf), -set.band(), false);
    node = outcome.made.get();
  }
  float* const values = outcome.made ? node->buffer().data() : set.own_values(leaf);
  apply_group(set, batch, group, candidates, values, outcome);
  outcome.state = settle_leaf(*node, set.band());
  return outcome;
}

void settle(LevelSet& set, size_t leaf, Outcome& outcome) {
  auto& tree = set.grid->tree();
  set.forget_spilled(leaf);
  if (outcome.state == LeafState::kLeaf && outcome.made) {
    set.map.leaves[leaf] = outcome.made.get();
    tree.addLeaf(outcome.made.release());
  } else if (outcome.state == LeafState::kAir) {
    constexpr openvdb::Index kLeafLevel = 1;  // a tile that replaces one leaf
    tree.addTile(kLeafLevel, set.map.origin(leaf), set.band(), false);
    set.map.leaves[leaf] = nullptr;
  }
  const bool changed = outcome.changed || outcome.state != set.map.states[leaf];
  set.map.states[leaf] = outcome.state;
  set.map.floors[leaf] = outcome.floor;
  set.map.cuts[leaf] += changed ? 1 : 0;
}

void cut_batch(LevelSet& set, Batch& batch) {
  gather(set, batch);
  std::vector<Outcome> outcomes(batch.groups.size());
  parallel_chunks(batch.groups.size(), kGroupsPerTask, [&](size_t begin, size_t end) {
    std::vector<Candidate> scratch;
    for (size_t g = begin; g < end; ++g) outcomes[g] = cut_leaf(set, batch, batch.groups[g], scratch);
  });
  for (size_t g = 0; g < outcomes.size(); ++g) {
    set.statistics.leaf_visits += outcomes[g].visits;
    set.statistics.voxel_updates += outcomes[g].patches * kPatchVoxels;
    settle(set, batch.groups[g].leaf, outcomes[g]);
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
