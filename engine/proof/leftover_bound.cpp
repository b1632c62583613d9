#include "proof/leftover_bound.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "proof/region_proof.h"

namespace swarf::proof {
namespace {

constexpr size_t kCellsPerTask = 64;
/// Height up to which regions are proven by the sweeps, in voxels; above it the level set answers.
constexpr double kTopVoxels = 3.2;
/// Rounds, each above what the one before has found.
constexpr int kRounds = 8;
/// What is asked for above a leftover that was found: mm, and share.
constexpr double kGap = 4e-5, kGapShare = 5e-4;

double angle_to(const Vec3& a, const Vec3& b) {
  return std::acos(std::clamp(a.dot(b), -1.0, 1.0));
}

/// The region of a feature from `low` up to `high` over its feet; empty where it has no height.
Region region_of(const FeatureCell& cell, double low, double high) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& way : cell.ways) mean += way;
  mean.normalize();
  double turn = 0.0;
  for (const Vec3& way : cell.ways) turn = std::max(turn, angle_to(mean, way));
  // Between the ways the upper side is a chord: it reaches `high` there too.
  const double top = high / std::cos(turn);
  std::vector<Vec3> lower, upper;
  const auto add = [&](const Vec3& foot, const Vec3& way) {
    lower.push_back(foot + low * way);
    upper.push_back(foot + top * way);
  };
  if (cell.feet.size() == 2) {
    add(cell.feet[0], cell.ways[0]);
    add(cell.feet[0], cell.ways[1]);
    add(cell.feet[1], cell.ways[1]);
    add(cell.feet[1], cell.ways[0]);
  } else {
    for (size_t k = 0; k < 3; ++k)
      add(cell.feet[cell.feet.size() == 3 ? k : 0], cell.ways[cell.ways.size() == 3 ? k : 0]);
  }
  return {frustum_between(lower, upper), {mean, cell.feet.front(), 0.0}};
}

double area_of(const FeatureCell& cell) {
  if (cell.feet.size() != 3) return 0.0;
  return 0.5 * (cell.feet[1] - cell.feet[0]).cross(cell.feet[2] - cell.feet[0]).norm();
}

/// What a task has to tell of its regions.
struct TaskResult {
  double found_mm = 0.0;
  Vec3 top = Vec3::Zero(), foot = Vec3::Zero();
  size_t parts = 0;
  double open_mm = 0.0;  ///< nothing of what stays open far from the design is farther off it
};

class LeftoverSearch {
 public:
  explicit LeftoverSearch(const LeftoverQuestion& in)
      : in_(in), index_(in.sweeps, in.cutters), cells_(in.design.cells()) {}

  LeftoverBound run() {
    result_.regions = cells_.size();
    double above = std::max(in_.limit_mm, raised(in_.known_mm));
    // The same in all rounds: a region that one round has proven ends there.
    top_mm_ = std::max(kTopVoxels * in_.stock.voxel_mm() + in_.stock_bound_mm, 1.2 * above);
    std::vector<uint32_t> todo(cells_.size());
    for (uint32_t n = 0; n < todo.size(); ++n) todo[n] = n;
    for (int round = 0; round < kRounds && !in_.progress.stop_requested(); ++round) {
      open_.clear();
      far_open_mm_ = 0.0;
      far_open_ = 0;
      std::vector<uint32_t> left = prove_cells(todo, above, round);
      const bool far = !prove_far(above);
      if (left.empty() && !far) {
        result_.bound_mm = above;
        finish_open();
        return result_;
      }
      if (result_.found_mm > 0.0) {
        RegionProver prover(in_, index_);
        prover.look_around(result_.top, result_.found_mm);
        take({prover.found_mm(), prover.top(), prover.foot(), 0});
      }
      above = std::max(above, raised(result_.found_mm));
      todo = std::move(left);
      todo.insert(todo.end(), open_.begin(), open_.end());
    }
    result_.bound_mm = std::max(above, in_.stock.raw().box().size().norm());
    finish_open();
    return result_;
  }

 private:
  static double raised(double found) { return found > 0.0 ? found * (1.0 + kGapShare) + kGap : 0.0; }

  /// Those in which material above `above` was met.
  std::vector<uint32_t> prove_cells(const std::vector<uint32_t>& todo, double above, int round) {
    std::vector<RegionState> states(todo.size(), RegionState::kProven);
    const size_t tasks = (todo.size() + kCellsPerTask - 1) / kCellsPerTask;
    std::vector<TaskResult> told(tasks);
    constexpr size_t kSlice = 64;  // tasks between two steps of the progress
    for (size_t first = 0; first < tasks && !in_.progress.stop_requested(); first += kSlice) {
      const size_t count = std::min(kSlice, tasks - first);
      parallel_chunks(count, 1, [&](size_t begin, size_t) {
        const size_t task = first + begin;
        RegionProver prover(in_, index_);
        for (size_t i = task * kCellsPerTask; i < std::min(todo.size(), (task + 1) * kCellsPerTask); ++i) {
          if (top_mm_ <= above) continue;
          states[i] = prover.prove(region_of(cells_[todo[i]], above, top_mm_), above);
        }
        told[task] = {prover.found_mm(), prover.top(), prover.foot(), prover.parts()};
      });
      if (round == 0)
        in_.progress.advance(in_.progress_from +
                             0.8 * static_cast<double>(first + count) / static_cast<double>(tasks));
    }
    for (const TaskResult& one : told) take(one);
    std::vector<uint32_t> left;
    for (size_t i = 0; i < todo.size(); ++i) {
      if (states[i] == RegionState::kLeftover) left.push_back(todo[i]);
      if (states[i] == RegionState::kOpen) open_.push_back(todo[i]);
    }
    return left;
  }

  void take(const TaskResult& one) {
    result_.parts += one.parts;
    if (!(one.found_mm > result_.found_mm)) return;
    result_.found_mm = one.found_mm;
    result_.top = one.top;
    result_.foot = one.foot;
  }

  /// Whether no material is farther from the design than the regions reach.
  bool prove_far(double above) {
    const Box& box = in_.stock.raw().box();
    const double voxel = in_.stock.voxel_mm(), side = 16.0 * voxel;
    const Vec3 size = box.size();
    const auto count = [&](int k) { return static_cast<size_t>(std::max(1.0, std::ceil(size[k] / side))); };
    const size_t nx = count(0), ny = count(1), nz = count(2);
    std::vector<TaskResult> told(nx * ny * nz);
    std::vector<uint8_t> states(told.size(), 0);
    parallel_chunks(told.size(), 1, [&](size_t n, size_t) {
      if (in_.progress.stop_requested()) return;
      const Vec3 low = box.lower + side * Vec3(static_cast<double>(n % nx), static_cast<double>(n / nx % ny),
                                               static_cast<double>(n / nx / ny));
      RegionProver prover(in_, index_);
      double open_mm = 0.0;
      const RegionState state = prove_cube(prover, low, side, std::max(above, top_mm_), above, open_mm);
      states[n] = static_cast<uint8_t>(state);
      told[n] = {prover.found_mm(), prover.top(), prover.foot(), prover.parts(), open_mm};
    });
    for (const TaskResult& one : told) {
      take(one);
      far_open_mm_ = std::max(far_open_mm_, one.open_mm);
    }
    bool clear = true;
    for (const uint8_t state : states) {
      clear = clear && state != static_cast<uint8_t>(RegionState::kLeftover);
      far_open_ += state == static_cast<uint8_t>(RegionState::kOpen) ? 1 : 0;
    }
    return clear;
  }

  /// `within`: nearer places are proven by the features' regions.
  RegionState prove_cube(RegionProver& prover, const Vec3& low, double side, double within, double above,
                         double& open_mm) {
    const double half = 0.5 * side, radius = half * std::sqrt(3.0);
    const Vec3 centre = low + Vec3::Constant(half);
    if (in_.stock.air_radius_mm(centre) - in_.stock_bound_mm >= radius) return RegionState::kProven;
    if (in_.design.distance().at(centre).distance_mm + radius <= within) return RegionState::kProven;
    constexpr double kLeast = 0.7;  // voxels
    if (side < kLeast * in_.stock.voxel_mm()) {
      const Region cube{box_polytope({low, low + Vec3::Constant(side)}),
                        {Vec3::Zero(), Vec3::Zero(), within}};
      const RegionState state = prover.prove(cube, above);
      if (state == RegionState::kOpen)
        open_mm = std::max(open_mm, in_.design.distance().at(centre).distance_mm + radius);
      return state;
    }
    RegionState worst = RegionState::kProven;
    for (int k = 0; k < 8; ++k) {
      const Vec3 corner = low + half * Vec3(k & 1, k >> 1 & 1, k >> 2);
      const RegionState state = prove_cube(prover, corner, half, within, above, open_mm);
      if (state == RegionState::kLeftover) return state;
      if (state == RegionState::kOpen) worst = state;
    }
    return worst;
  }

  void finish_open() {
    result_.open = open_.size() + far_open_;
    for (const uint32_t n : open_) {
      result_.open_area_mm2 += area_of(cells_[n]);
      result_.place = cells_[n].feet.front();
    }
    result_.bound_mm = std::max(result_.bound_mm, far_open_mm_);
    if (!open_.empty()) result_.bound_mm = std::max(result_.bound_mm, top_mm_);
  }

  const LeftoverQuestion& in_;
  measure::SweepIndex index_;
  std::vector<FeatureCell> cells_;
  double top_mm_ = 0.0;
  std::vector<uint32_t> open_;
  size_t far_open_ = 0;       ///< of the last round
  double far_open_mm_ = 0.0;  ///< nothing of them is farther off the design
  LeftoverBound result_;
};

}  // namespace

LeftoverBound bound_leftover(const LeftoverQuestion& question) {
  return LeftoverSearch(question).run();
}

}  // namespace swarf::proof
