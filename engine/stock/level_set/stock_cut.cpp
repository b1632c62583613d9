// Cutting, in batches of sweeps:
//   1. gather: runs of sweeps list the leaf positions they may change (parallel over runs)
//   2. sort by position
//   3. cut: each position applies its sweeps, deepest first (parallel over positions; one task owns a leaf)
//   4. settle: new leaves enter the tree, emptied ones leave it (serial, in order of position)
// Each voxel ends as the maximum over the pieces that reach it, whatever the order, batches, calls and
// threads. The order saves work: after the deepest piece most others of the batch have nothing left to raise.
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <chrono>
#include <memory>

#include "base/parallel.h"
#include "stock/level_set/convex_leaf.h"
#include "stock/level_set/lane_run.h"
#include "stock/level_set/leaf_kernel.h"
#include "stock/level_set/piece_window.h"
#include "stock/level_set/stock_grid_internal.h"

namespace swarf::stock {
namespace {

/// Large enough to share the sort and the task start-up and to meet a leaf's deepest sweep early, small
/// enough that what one batch leaves is known to the next.
constexpr size_t kBatch = 512;
constexpr size_t kRunsPerTask = 1;
constexpr size_t kGroupsPerTask = 32;

struct Group {
  size_t begin, end;  ///< in the sorted pairs
};

struct Batch {
  std::vector<SweptPiece> pieces;
  std::vector<LaneRun> runs;
  std::vector<LeafPair> pairs;
  std::vector<Group> groups;
};

void gather(const LevelSet& set, Batch& batch) {
  batch.runs = make_runs(set, batch.pieces);
  const size_t count = batch.runs.size();
  std::vector<std::vector<LeafPair>> found((count + kRunsPerTask - 1) / kRunsPerTask);
  parallel_chunks(count, kRunsPerTask, [&](size_t begin, size_t end) {
    std::vector<LeafPair> own;  // not in place: neighbours in `found` share a cache line
    for (size_t n = begin; n < end; ++n) gather_leaves(set, batch.runs[n], n, own);
    found[begin / kRunsPerTask] = std::move(own);
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

/// The time in which the piece can change a value of the leaf; all of it when it cannot.
Window window_of(const LevelSet& set, const SweptPiece& swept, const Vec3& centre) {
  const Vec3 P = swept.map.start(centre), D = swept.map.end(centre) - P;
  const double reach = set.leaf_radius() + kReachSlack + set.band();
  // Neighbouring leaves that see the whole sweep round alike: facets stay as flat as they were. Only a sweep
  // that goes far beyond the cutter is shortened.
  const double across = kFarFactor * (swept.piece->radius + reach);
  const double along = kFarFactor * (swept.piece->high + reach);
  const auto far = [&](const Vec3& X) { return X.head<2>().norm() > across || std::abs(X.z()) > along; };
  if (!far(P) && !far(P + D)) return {};
  const Window window = time_in_reach(*swept.piece, P, D, reach);
  return window.empty() ? Window{} : window;
}

LeafMotion leaf_motion(const LevelSet& set, const SweptPiece& swept, size_t leaf) {
  const SweepMap& map = swept.map;
  const openvdb::Coord origin = set.map.origin(leaf);
  const Vec3 first = Vec3(origin.x(), origin.y(), origin.z()) * set.voxel;
  const Vec3 centre = set.leaf_centre(leaf);
  const Window window = window_of(set, swept, centre);
  const Vec3 start = map.start(first), end = map.end(first);
  // As start + t (end - start), so that what does not change stays equal to the last bit (LevelPlane).
  const auto at = [](double t, double a, double b) { return static_cast<float>(a + t * (b - a)); };
  LeafMotion motion{};
  for (int c = 0; c < 3; ++c) {
    motion.start[c] = at(window.low, start[c], end[c]);
    motion.end[c] = at(window.high, start[c], end[c]);
    for (int a = 0; a < 3; ++a) {
      const double from = map.R0t(c, a) * set.voxel, to = map.R1t(c, a) * set.voxel;
      motion.start_step[a][c] = at(window.low, from, to);
      motion.end_step[a][c] = at(window.high, from, to);
    }
  }
  motion.radius = static_cast<float>(swept.piece->radius);
  motion.height = static_cast<float>(swept.piece->high);
  motion.background = set.band();
  // Below (height - band) the top end could only change values that the clamp makes equal anyway.
  const double highest = std::max(map.start(centre).z(), map.end(centre).z()) + set.leaf_radius();
  motion.capped = highest > swept.piece->high - set.band();
  return motion;
}

/// The bounds as the kernel wants them: from the leaf's first voxel, per voxel.
LeafBound leaf_bound(const LevelSet& set, const ReachBound& reach) {
  LeafBound bound{};
  for (int face = 0; face < 2; ++face) {
    const LinearBound& linear = reach.of_face[face];
    const Vec3 start = linear.start_slope * set.voxel, end = linear.end_slope * set.voxel;
    LeafBound::Linear& out = bound.of_face[face];
    for (int a = 0; a < 3; ++a) {
      out.start_step[a] = static_cast<float>(start[a]);
      out.end_step[a] = static_cast<float>(end[a]);
    }
    constexpr double kHalf = 0.5 * (kLeafSide - 1);
    out.start = static_cast<float>(linear.start - kHalf * start.sum());
    out.end = static_cast<float>(linear.end - kHalf * end.sum());
  }
  return bound;
}

/// Linear function below the leaf's values, with the slope of what cut deepest.
LeafFloor fitted_floor(const LevelSet& set, const float* values, const LeafBound& deepest) {
  static const LeafFloorFit fit = leaf_kernel_variants().front().floor_fit;
  const LeafBound::Linear& face = deepest.of_face[0];
  float step[3];
  for (int a = 0; a < 3; ++a) step[a] = 0.5F * (face.start_step[a] + face.end_step[a]);
  const float first = fit(values, step, set.band());
  const auto per_mm = static_cast<float>(1.0 / set.voxel);
  return {first + 0.5F * (kLeafSide - 1) * (step[0] + step[1] + step[2]),
          {step[0] * per_mm, step[1] * per_mm, step[2] * per_mm}};
}

/// A sweep that may raise a value of the leaf.
struct Candidate {
  float depth;     ///< of the leaf's centre inside the cutter, mm
  uint32_t piece;  ///< in the batch

  bool before(const Candidate& other) const {
    return depth > other.depth || (depth == other.depth && piece < other.piece);
  }
};

/// The candidates of a group in the order of the path, as far as the floor does not rule them out.
void find_candidates(const LevelSet& set, const Batch& batch, const Group& group, const LeafFloor& floor,
                     std::vector<Candidate>& candidates) {
  static const LaneKernel kernel = lane_kernel_variants().front().kernel;
  const Vec3 centre = set.leaf_centre(leaf_of(batch.pairs[group.begin]));
  candidates.clear();
  LaneAnswer answer;
  for (size_t n = group.begin; n < group.end; ++n) {
    const LaneRun& run = batch.runs[run_of(batch.pairs[n])];
    kernel(run.lanes, run.piece, run.query(set, centre, floor), answer);
    for (uint32_t open = answer.open & run.all(); open != 0; open &= open - 1) {
      const auto lane = static_cast<uint32_t>(__builtin_ctz(open));
      candidates.push_back({answer.depth.lane[lane], static_cast<uint32_t>(run.first) + lane});
    }
  }
}

struct Outcome {
  LeafState state = LeafState::kLeaf;
  std::unique_ptr<LeafNode> made;
  LeafFloor floor;
  uint64_t visits = 0, slices = 0;
};

/// The bottom plane of a flat end whose height over every voxel does not change while it moves. Once one such
/// sweep has passed over the whole leaf, another one with the same plane to the last bit has nothing to
/// raise: the floors of pockets and the rows of a plane are cut once, not once for each row that overlaps.
class LevelPlane {
 public:
  bool repeats(const LeafMotion& motion) const { return known_ && same(motion_, motion); }

  /// Remembers the sweep if its flat end passes over the whole leaf, deeper inside than the band.
  void remember(const LeafMotion& motion, const SweptPiece& swept, const Vec3& centre, double leaf_radius) {
    if (known_ || !swept.piece->is_cylinder() || !level(motion)) return;
    const Vec2 P = swept.map.start(centre).head<2>(), D = swept.map.end(centre).head<2>() - P;
    const double t = D.squaredNorm() > 0.0 ? std::clamp(-P.dot(D) / D.squaredNorm(), 0.0, 1.0) : 0.0;
    known_ = (P + t * D).norm() + leaf_radius < motion.radius - motion.background && !motion.capped;
    motion_ = motion;
  }

 private:
  static bool same(const LeafMotion& a, const LeafMotion& b) {
    return a.start[2] == b.start[2] && a.start_step[0][2] == b.start_step[0][2] &&
           a.start_step[1][2] == b.start_step[1][2] && a.start_step[2][2] == b.start_step[2][2] && level(b);
  }
  static bool level(const LeafMotion& m) {
    return m.start[2] == m.end[2] && m.start_step[0][2] == m.end_step[0][2] &&
           m.start_step[1][2] == m.end_step[1][2] && m.start_step[2][2] == m.end_step[2][2];
  }

  LeafMotion motion_{};
  bool known_ = false;
};

/// One leaf position while its group is applied.
class LeafCut {
 public:
  LeafCut(const LevelSet& set, const Batch& batch, size_t leaf, float* values, Outcome& outcome)
      : set_(set),
        batch_(batch),
        leaf_(leaf),
        values_(values),
        outcome_(outcome),
        centre_(set.leaf_centre(leaf)) {}

  /// Raises the values by one sweep, if what the ones before it left does not rule it out.
  void apply(const Candidate& candidate) {
    const LeafKernelVariant& kernels = leaf_kernel_variants().front();
    const SweptPiece& swept = batch_.pieces[candidate.piece];
    const ReachBound reach = reach_bound(swept, swept.map.start(centre_), swept.map.end(centre_));
    if (stands_above(outcome_.floor, reach, 0.5 * (kLeafSide - 1) * set_.voxel)) return;
    const LeafMotion motion = leaf_motion(set_, swept, leaf_);
    const bool flat_end = swept.piece->is_cylinder();
    if (flat_end && plane_.repeats(motion)) return;
    const LeafBound bound = leaf_bound(set_, reach);
    const uint32_t slices = kernels.bound_test(values_, bound, set_.band());
    if (slices != 0) {
      if (flat_end) {
        kernels.kernel(values_, motion, slices);
      } else {
        cut_by_search(swept, slices);
      }
      if (outcome_.visits == 0) outcome_.floor = fitted_floor(set_, values_, bound);
      ++outcome_.visits;
      outcome_.slices += static_cast<uint64_t>(__builtin_popcount(slices));
    }
    plane_.remember(motion, swept, centre_, set_.leaf_radius());
  }

 private:
  /// Every piece but the plain cylinder, which has a closed form.
  void cut_by_search(const SweptPiece& swept, uint32_t slices) {
    const openvdb::Coord origin = set_.map.origin(leaf_);
    const LeafPlace place{Vec3(origin.x(), origin.y(), origin.z()) * set_.voxel, set_.voxel, set_.band()};
    cut_leaf_by_piece(values_, place, swept.map, *swept.piece, slices);
  }

  const LevelSet& set_;
  const Batch& batch_;
  size_t leaf_;
  float* values_;
  Outcome& outcome_;
  Vec3 centre_;
  LevelPlane plane_;
};

/// Deepest first: what it leaves rules out most of the others.
void apply_candidates(const LevelSet& set, const Batch& batch, const Group& group,
                      std::vector<Candidate>& candidates, float* values, Outcome& outcome) {
  const auto before = [](const Candidate& a, const Candidate& b) { return a.before(b); };
  find_candidates(set, batch, group, outcome.floor, candidates);
  if (candidates.empty()) return;
  LeafCut cut(set, batch, leaf_of(batch.pairs[group.begin]), values, outcome);
  const Candidate deepest = *std::min_element(candidates.begin(), candidates.end(), before);
  cut.apply(deepest);
  if (candidates.size() == 1) return;
  find_candidates(set, batch, group, outcome.floor, candidates);
  std::sort(candidates.begin(), candidates.end(), before);
  for (const Candidate& candidate : candidates) {
    if (candidate.piece != deepest.piece) cut.apply(candidate);
  }
}

/// Applies one group. The leaf is changed in place, or made when the position was solid so far.
Outcome cut_leaf(const LevelSet& set, const Batch& batch, const Group& group,
                 std::vector<Candidate>& candidates) {
  const size_t leaf = leaf_of(batch.pairs[group.begin]);
  Outcome outcome;
  outcome.floor = set.map.floors[leaf];
  if (swallows(batch.pairs[group.begin])) {
    outcome.state = LeafState::kAir;
    return outcome;
  }
  LeafNode* node = set.map.leaves[leaf];
  if (node == nullptr) {
    outcome.made = std::make_unique<LeafNode>(set.map.origin(leaf), -set.band(), false);
    node = outcome.made.get();
  }
  apply_candidates(set, batch, group, candidates, node->buffer().data(), outcome);
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
  const bool changed = outcome.visits > 0 || outcome.state != set.map.states[leaf];
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
    set.statistics.voxel_updates += outcomes[g].slices * kLeafSide * kLeafSide;
    settle(set, leaf_of(batch.pairs[batch.groups[g].begin]), outcomes[g]);
  }
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
  for (size_t first = 0; first < sweeps.size(); first += kBatch) {
    const auto part = sweeps.subspan(first, std::min(kBatch, sweeps.size() - first));
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
