// Cutting, in batches of sweeps:
//   1. gather: every sweep lists the leaf positions it can change (parallel over sweeps)
//   2. sort by position, then by sweep
//   3. cut: each position applies its sweeps in order (parallel over positions; one task owns a leaf)
//   4. settle: new leaves enter the tree, emptied ones leave it (serial, in order of position)
// Each voxel ends as the maximum over the sweeps that reach it, whatever the batches, calls and threads.
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <memory>

#include "base/parallel.h"
#include "stock/leaf_kernel.h"
#include "stock/stock_grid_internal.h"
#include "stock/sweep_distance.h"
#include "stock/sweep_map.h"

namespace swarf::stock {
namespace {

/// Large enough to share the sort and the task start-up, small enough for the pairs to stay in cache.
constexpr size_t kBatch = 512;
constexpr size_t kSweepsPerTask = 4;
constexpr size_t kGroupsPerTask = 8;

/// leaf position << 32 | sweep of the batch << 1 | the cutter swallows the whole leaf.
using Pair = uint64_t;

Pair make_pair(size_t leaf, size_t sweep, bool swallows) {
  return static_cast<Pair>(leaf) << 32 | static_cast<Pair>(sweep) << 1 | static_cast<Pair>(swallows);
}
size_t leaf_of(Pair pair) {
  return pair >> 32;
}
size_t sweep_of(Pair pair) {
  return (pair & 0xffffffffu) >> 1;
}
bool swallows(Pair pair) {
  return (pair & 1u) != 0;
}

struct Group {
  size_t begin, end;  ///< in the sorted pairs
};

struct Batch {
  std::span<const Sweep> sweeps;
  std::vector<SweepMap> maps;
  CutterSolid cutter;
  std::vector<Pair> pairs;
  std::vector<Group> groups;
};

/// A capsule around the swept cutter: every place that is nearer to it than `reach` lies within `radius` of
/// the segment from `tip` along `axis`.
struct Capsule {
  Vec3 tip, axis;
  double length, radius;
};

Capsule capsule_of(const Sweep& sweep, const CutterSolid& cutter, double reach) {
  const double travel = (sweep.end.tip_W - sweep.start.tip_W).norm() +
                        cutter.height * (sweep.end.axis_W - sweep.start.axis_W).norm();
  const double bow = motion_bound(sweep, std::hypot(cutter.height, cutter.radius));
  // The distance is a max norm: at the edge of the bottom it reaches sqrt(2) farther.
  return {0.5 * (sweep.start.tip_W + sweep.end.tip_W), 0.5 * (sweep.start.axis_W + sweep.end.axis_W),
          cutter.height, cutter.radius + std::sqrt(2.0) * reach + 0.5 * travel + bow};
}

/// The part [low, high] of a vertical line that lies inside the capsule's neighbourhood; empty when low >
/// high.
struct Span {
  double low = 0.0, high = -1.0;
};
Span vertical_span(const Capsule& capsule, double x, double y) {
  const Vec2 offset = Vec2(x, y) - capsule.tip.head<2>();
  const Vec2 lean = capsule.axis.head<2>();
  const double lean2 = lean.squaredNorm(), radius2 = capsule.radius * capsule.radius;
  double first = 0.0, last = capsule.length;  // along the axis, where it passes the line closely enough
  constexpr double kUpright = 1e-12;
  if (lean2 > kUpright) {
    const double middle = offset.dot(lean) / lean2;
    const double miss2 = (offset - middle * lean).squaredNorm();
    if (miss2 > radius2) return {};
    const double half = std::sqrt((radius2 - miss2) / lean2);
    first = std::max(first, middle - half);
    last = std::min(last, middle + half);
    if (first > last) return {};
  } else if (offset.norm() > capsule.radius + capsule.length * std::sqrt(kUpright)) {
    return {};
  }
  const double z0 = capsule.tip.z() + first * capsule.axis.z(),
               z1 = capsule.tip.z() + last * capsule.axis.z();
  return {std::min(z0, z1) - capsule.radius, std::max(z0, z1) + capsule.radius};
}

/// Cuts off the part of the line below both ends' bottom planes by more than `reach`.
void clip_at_bottom(Span& span, const SweepMap& map, double reach, double x, double y) {
  constexpr double kUpright =
      0.1;  // flatter planes cut little off a vertical line, and the quotient grows coarse
  const double az0 = map.R0t(2, 2), az1 = map.R1t(2, 2);
  if (std::min(az0, az1) < kUpright) return;
  const auto plane = [&](const Mat3& Rt, const Vec3& tip) {
    return tip.z() - (reach + Rt(2, 0) * (x - tip.x()) + Rt(2, 1) * (y - tip.y())) / Rt(2, 2);
  };
  span.low = std::max(span.low, std::min(plane(map.R0t, map.tip0), plane(map.R1t, map.tip1)));
}

/// Inclusive range of leaf positions along axis `a` that [low, high] mm reaches.
std::pair<int, int> leaf_range(const LevelSet& set, int a, double low, double high) {
  const double leaf_mm = kLeafSide * set.voxel;
  const double first = std::floor(low / leaf_mm) - set.map.lower[a];
  const double last = std::floor(high / leaf_mm) - set.map.lower[a];
  const double top = set.map.dimension[a] - 1;
  return {static_cast<int>(std::clamp(first, 0.0, top + 1.0)), static_cast<int>(std::clamp(last, -1.0, top))};
}

/// First position in [k, end) that is not air, or `end`; eight states at a time, for most of a box is air.
size_t skip_air(const LeafState* states, size_t k, size_t end) {
  while (k < end) {
    uint64_t eight = 0;
    static_assert(sizeof(LeafState) == 1 && static_cast<int>(LeafState::kAir) == 0);
    if (k + sizeof(eight) <= end) {
      std::memcpy(&eight, states + k, sizeof(eight));
      if (eight == 0) {
        k += sizeof(eight);
        continue;
      }
    }
    if (states[k] != LeafState::kAir) return k;
    ++k;
  }
  return end;
}

/// What one sweep asks of each leaf position.
struct LeafQuery {
  const SweepMap& map;
  const CutterSolid& cutter;
  double reach;  ///< from a leaf's centre to the farthest place where a distance matters

  enum class Answer { kOutOfReach, kReaches, kSwallows };

  /// The pose at half time decides nearly always: the point moves by at most half its way from there.
  Answer ask(const Vec3& centre) const {
    const Vec3 P = map.start(centre), D = map.end(centre) - P;
    const Vec3 X = P + 0.5 * D;
    const double middle = std::max({X.head<2>().norm() - cutter.radius, -X.z(), X.z() - cutter.height});
    if (middle < -reach) return Answer::kSwallows;
    if (middle < reach) return Answer::kReaches;
    if (middle - 0.5 * D.norm() > reach) return Answer::kOutOfReach;
    const MovingPoint<double> point{P.x(), P.y(), P.z(), D.x(), D.y(), D.z()};
    const bool reaches = swept_distance<double, true>(point, cutter.radius, cutter.height) < reach;
    return reaches ? Answer::kReaches : Answer::kOutOfReach;
  }
};

/// Lists the leaf positions whose values sweep `n` can raise: those whose centre is near enough, because the
/// distance changes by no more than the way walked from there (1-Lipschitz).
void gather_sweep(const LevelSet& set, const Batch& batch, size_t n, std::vector<Pair>& pairs) {
  const LeafQuery query{batch.maps[n], batch.cutter, set.leaf_radius() + set.band()};
  const Capsule capsule = capsule_of(batch.sweeps[n], batch.cutter, query.reach);
  const Vec3 top = capsule.tip + capsule.length * capsule.axis;
  const auto range = [&](int axis) {
    return leaf_range(set, axis, std::min(capsule.tip[axis], top[axis]) - capsule.radius,
                      std::max(capsule.tip[axis], top[axis]) + capsule.radius);
  };
  const auto [i_first, i_last] = range(0);
  const auto [j_first, j_last] = range(1);
  const double leaf_mm = kLeafSide * set.voxel;
  for (int i = i_first; i <= i_last; ++i) {
    for (int j = j_first; j <= j_last; ++j) {
      const size_t column = set.map.index(i, j, 0);
      const Vec3 foot = set.leaf_centre(column);
      Span span = vertical_span(capsule, foot.x(), foot.y());
      clip_at_bottom(span, query.map, query.reach, foot.x(), foot.y());
      const auto [k_first, k_last] = leaf_range(set, 2, span.low - leaf_mm, span.high + leaf_mm);
      if (span.low > span.high || k_first > k_last) continue;
      const LeafState* states = set.map.states.data() + column;
      const auto end = static_cast<size_t>(k_last) + 1;
      for (size_t k = static_cast<size_t>(k_first); (k = skip_air(states, k, end)) < end; ++k) {
        const LeafQuery::Answer answer = query.ask(foot + Vec3(0, 0, static_cast<double>(k) * leaf_mm));
        if (answer == LeafQuery::Answer::kOutOfReach) continue;
        pairs.push_back(make_pair(column + k, n, answer == LeafQuery::Answer::kSwallows));
      }
    }
  }
}

void gather(const LevelSet& set, Batch& batch) {
  const size_t count = batch.sweeps.size();
  std::vector<std::vector<Pair>> found((count + kSweepsPerTask - 1) / kSweepsPerTask);
  parallel_chunks(count, kSweepsPerTask, [&](size_t begin, size_t end) {
    for (size_t n = begin; n < end; ++n) gather_sweep(set, batch, n, found[begin / kSweepsPerTask]);
  });
  batch.pairs.clear();
  for (const auto& part : found) batch.pairs.insert(batch.pairs.end(), part.begin(), part.end());
  tbb::parallel_sort(batch.pairs.begin(), batch.pairs.end());
  batch.groups.clear();
  for (size_t n = 0; n < batch.pairs.size(); ++n) {
    if (n == 0 || leaf_of(batch.pairs[n]) != leaf_of(batch.pairs[n - 1])) batch.groups.push_back({n, n});
    batch.groups.back().end = n + 1;
  }
}

LeafMotion leaf_motion(const LevelSet& set, const SweepMap& map, const CutterSolid& cutter, size_t leaf) {
  const openvdb::Coord origin = set.map.origin(leaf);
  const Vec3 first = Vec3(origin.x(), origin.y(), origin.z()) * set.voxel;
  const Vec3 start = map.start(first), end = map.end(first);
  LeafMotion motion{};
  for (int c = 0; c < 3; ++c) {
    motion.start[c] = static_cast<float>(start[c]);
    motion.end[c] = static_cast<float>(end[c]);
    for (int a = 0; a < 3; ++a) {
      motion.start_step[a][c] = static_cast<float>(map.R0t(c, a) * set.voxel);
      motion.end_step[a][c] = static_cast<float>(map.R1t(c, a) * set.voxel);
    }
  }
  motion.radius = static_cast<float>(cutter.radius);
  motion.height = static_cast<float>(cutter.height);
  motion.background = set.band();
  // Below (height - band) the top end could only change values that the clamp makes equal anyway.
  const Vec3 centre = set.leaf_centre(leaf);
  const double highest = std::max(map.start(centre).z(), map.end(centre).z()) + set.leaf_radius();
  motion.capped = highest > cutter.height - set.band();
  return motion;
}

struct Outcome {
  LeafState state = LeafState::kLeaf;
  std::unique_ptr<LeafNode> made;
  uint64_t visits = 0, voxels = 0;
};

/// Applies one group. The leaf is changed in place, or made when the position was solid so far.
Outcome cut_leaf(const LevelSet& set, const Batch& batch, const Group& group) {
  const size_t leaf = leaf_of(batch.pairs[group.begin]);
  Outcome outcome;
  for (size_t n = group.begin; n < group.end; ++n) {
    if (!swallows(batch.pairs[n])) continue;
    outcome.state = LeafState::kAir;
    return outcome;
  }
  LeafNode* node = set.map.leaves[leaf];
  if (node == nullptr) {
    outcome.made = std::make_unique<LeafNode>(set.map.origin(leaf), -set.band(), false);
    node = outcome.made.get();
  }
  static const LeafKernel kernel = leaf_kernel_variants().front().kernel;
  float* values = node->buffer().data();
  for (size_t n = group.begin; n < group.end; ++n) {
    outcome.voxels += static_cast<uint64_t>(
        kernel(values, leaf_motion(set, batch.maps[sweep_of(batch.pairs[n])], batch.cutter, leaf)));
  }
  outcome.visits = group.end - group.begin;
  outcome.state = settle_leaf(*node, set.band());
  return outcome;
}

void settle(LevelSet& set, size_t leaf, Outcome& outcome) {
  auto& tree = set.grid->tree();
  if (outcome.state == LeafState::kLeaf && outcome.made) {
    set.map.leaves[leaf] = outcome.made.get();
    tree.addLeaf(outcome.made.release());
  } else if (outcome.state == LeafState::kAir) {
    constexpr openvdb::Index kLeafLevel = 1;  // a tile that replaces one leaf
    tree.addTile(kLeafLevel, set.map.origin(leaf), set.band(), false);
    set.map.leaves[leaf] = nullptr;
  }
  set.map.states[leaf] = outcome.state;
}

void cut_batch(LevelSet& set, Batch& batch) {
  gather(set, batch);
  std::vector<Outcome> outcomes(batch.groups.size());
  parallel_chunks(batch.groups.size(), kGroupsPerTask, [&](size_t begin, size_t end) {
    for (size_t g = begin; g < end; ++g) outcomes[g] = cut_leaf(set, batch, batch.groups[g]);
  });
  for (size_t g = 0; g < outcomes.size(); ++g) {
    set.statistics.leaf_visits += outcomes[g].visits;
    set.statistics.voxel_updates += outcomes[g].voxels;
    settle(set, leaf_of(batch.pairs[batch.groups[g].begin]), outcomes[g]);
  }
}

}  // namespace

void cut_level_set(LevelSet& set, std::span<const Sweep> sweeps, const CutterSolid& cutter) {
  const auto begun = std::chrono::steady_clock::now();
  Batch batch;
  batch.cutter = cutter;
  for (size_t first = 0; first < sweeps.size(); first += kBatch) {
    batch.sweeps = sweeps.subspan(first, std::min(kBatch, sweeps.size() - first));
    batch.maps.clear();
    for (const Sweep& sweep : batch.sweeps) batch.maps.push_back(sweep_map(sweep));
    cut_batch(set, batch);
  }
  set.statistics.sweeps += sweeps.size();
  set.statistics.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
}

}  // namespace swarf::stock
