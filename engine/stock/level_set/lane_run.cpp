#include "stock/level_set/lane_run.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "stock/level_set/column_kernel.h"
#include "stock/level_set/leaf_kernel.h"
#include "stock/level_set/piece_window.h"

namespace swarf::stock {
namespace {

constexpr size_t kLanesPerTask = 1;

/// From a leaf's centre to the farthest place where a distance matters.
double reach_of(const LevelSet& set) {
  return set.leaf_radius() + set.band();
}

/// How far beyond a piece a leaf's centre may lie that it changes, mm.
struct Reach {
  double along = 0.0, across = 0.0;     ///< from the axis's ends and from the greatest radius
  double half_leaf = 0.0, under = 0.0;  ///< below the bottom: half_leaf in every direction of W, and `under`
};

Reach reach_around(const LevelSet& set, const cutter::ConvexPiece& piece, double bow) {
  const double reach = reach_of(set) + bow;
  // A cylinder's F tells distances across and along the axis apart.
  if (piece.is_cylinder()) return {reach, reach, 0.5 * (kLeafSide - 1) * set.voxel, set.band() + bow};
  // F is a distance to planes: beyond an edge it reaches farther than a distance, at right angles by sqrt(2).
  return {0.0, std::sqrt(2.0) * reach, 0.0, reach};
}

/// Below which no leaf's centre may lie. Poses of one attitude have one plane.
std::vector<Neighbourhood::Plane> bottom_planes(const std::vector<ToolPose>& poses, double low,
                                                const Reach& reach) {
  // Flatter planes cut little off a vertical line, and the quotient grows coarse.
  constexpr double kUpright = 0.1;
  std::vector<Neighbourhood::Plane> planes;
  for (const ToolPose& pose : poses) {
    const Vec3& a = pose.axis_W;
    if (a.z() < kUpright) return {};
    const double x = -a.x() / a.z(), y = -a.y() / a.z();
    const double below = reach.half_leaf * a.cwiseAbs().sum() + reach.under - low;
    const double z = (pose.tip_W.dot(a) - below) / a.z();
    if (!planes.empty() && planes.back().x == x && planes.back().y == y) {
      planes.back().z = std::min(planes.back().z, z);
    } else {
      planes.push_back({z, x, y});
    }
  }
  return planes;
}

/// Fills the rectangle around the axis between `bottom` and `top` at all poses, enlarged by `margin`.
void set_rectangle(Neighbourhood& around, const std::vector<ToolPose>& poses, double bottom, double top,
                   double margin) {
  const Vec2 way = (poses.back().tip_W - poses.front().tip_W).head<2>();
  if (way.norm() > 0.0) around.along = way.normalized();
  const Vec2 across(-around.along.y(), around.along.x());
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Vec2 low(kFar, kFar), high(-kFar, -kFar);
  for (const ToolPose& pose : poses) {
    for (const double z : {bottom, top}) {
      const Vec2 p = (pose.tip_W + z * pose.axis_W).head<2>();
      const Vec2 local(p.dot(around.along), p.dot(across));
      low = low.cwiseMin(local);
      high = high.cwiseMax(local);
    }
  }
  const Vec2 centre = 0.5 * (low + high);
  around.centre = centre.x() * around.along + centre.y() * across;
  around.half_along = 0.5 * (high.x() - low.x()) + margin;
  around.half_across = 0.5 * (high.y() - low.y()) + margin;
}

/// Around the poses and everything that moves straight between neighbours of them; `bow`: how far the motion
/// strays from straight, mm.
Neighbourhood neighbourhood(const LevelSet& set, const std::vector<ToolPose>& poses,
                            const cutter::ConvexPiece& piece, double bow) {
  Vec3 tip = Vec3::Zero(), axis = Vec3::Zero();
  for (const ToolPose& pose : poses) {
    tip += pose.tip_W / static_cast<double>(poses.size());
    axis += pose.axis_W / static_cast<double>(poses.size());
  }
  const Reach reach = reach_around(set, piece, bow);
  const double low = piece.low - reach.along, high = piece.high + reach.along;
  const double margin = piece.radius + reach.across;
  double stray = 0.0;
  for (const ToolPose& pose : poses) {
    const double turn = std::max(std::abs(low), std::abs(high)) * (pose.axis_W - axis).norm();
    stray = std::max(stray, (pose.tip_W - tip).norm() + turn);
  }
  Neighbourhood around;
  set_rectangle(around, poses, low, high, margin);
  around.foot = tip + low * axis;
  around.axis = axis;
  around.length = high - low;
  around.radius = margin + stray;
  around.bottoms = bottom_planes(poses, piece.low, reach);
  return around;
}

/// Widened by more than the kernel rounds: of the extent e, 4 roundings in the rectangle, 12 (10 + 10) of a
/// bottom plane's slopes, and 6 in a place along the lean, which is taken `kUpright` times as coarse at most.
ColumnQuery column_query(const Neighbourhood& around, const Vec3& origin) {
  constexpr double kUpright = 0.05, kWidening = 1e-5;
  const double extent = around.half_along + around.half_across + around.length + around.radius;
  const double slack = kReachSlack + kWidening * extent;
  const auto f = [](double value) { return static_cast<float>(value); };
  const Vec3 foot = around.foot - origin;
  const double lean = around.axis.head<2>().norm();
  const bool upright = lean < kUpright;
  const double radius = around.radius + slack + (upright ? lean * around.length : 0.0);
  ColumnQuery query{{f(around.centre.x() - origin.x()), f(around.centre.y() - origin.y())},
                    {f(around.along.x()), f(around.along.y())},
                    f(around.half_along + slack),
                    f(around.half_across + slack),
                    {f(foot.x()), f(foot.y()), f(foot.z())},
                    {f(around.axis.x()), f(around.axis.y())},
                    f(around.axis.z()),
                    f(around.length),
                    f(radius),
                    upright ? 0.0F : f(1.0 / lean),
                    static_cast<int>(around.bottoms.size()),
                    {}};
  for (size_t n = 0; n < around.bottoms.size(); ++n) {
    const Neighbourhood::Plane& plane = around.bottoms[n];
    const double z = plane.z + plane.x * origin.x() + plane.y * origin.y() - origin.z();
    query.plane[n] = {f(z - slack), f(plane.x), f(plane.y)};
  }
  return query;
}

/// Inclusive range of the leaf positions along axis `a` whose centres lie in [low, high] mm.
std::pair<int, int> leaf_range(const LevelSet& set, int a, double low, double high) {
  const double leaf_mm = kLeafSide * set.voxel, half = 0.5 * (kLeafSide - 1) * set.voxel;
  const double first = std::ceil((low - half) / leaf_mm) - set.map.lower[a];
  const double last = std::floor((high - half) / leaf_mm) - set.map.lower[a];
  const double top = set.map.dimension[a] - 1;
  return {static_cast<int>(std::clamp(first, 0.0, top + 1.0)), static_cast<int>(std::clamp(last, -1.0, top))};
}

/// The part of a line across the rectangle, at `x`, that lies in it: from its centre on, along y.
struct Part {
  double low, high;
};
Part part_of_rectangle(const Neighbourhood& around, double x) {
  const double dx = x - around.centre.x();
  Part part{-1e300, 1e300};
  const auto clip = [&](double of_x, double of_y, double half) {
    constexpr double kParallel = 1e-6;
    if (std::abs(of_y) < kParallel) return;  // the kernel tells
    const double a = (-half - of_x * dx) / of_y, b = (half - of_x * dx) / of_y;
    part.low = std::max(part.low, std::min(a, b));
    part.high = std::min(part.high, std::max(a, b));
  };
  const Vec2& along = around.along;
  clip(along.x(), along.y(), around.half_along + kReachSlack);
  clip(-along.y(), along.x(), around.half_across + kReachSlack);
  return part;
}

/// Looks at the columns (i, j) to (i, j_last) of leaf positions; visit(position, its centre from the run's
/// origin) at all but air.
template <typename Visit>
void visit_row(const LevelSet& set, const LaneRun& run, const ColumnQuery& query, int i, int j, int j_last,
               Visit visit) {
  static const ColumnKernel kernel = column_kernel_variants().front().kernel;
  const double leaf_mm = kLeafSide * set.voxel;
  const auto f = [](double value) { return static_cast<float>(value); };
  for (; j <= j_last; j += kLanes) {
    const size_t column = set.map.index(i, j, 0);
    const Vec3 foot = set.leaf_centre(column) - run.origin;
    const uint32_t* tops = set.map.tops.data() + set.map.column(column);
    const ColumnRow row{f(foot.x()), f(foot.y()), f(leaf_mm), f(foot.z()), f(1.0 / leaf_mm), tops};
    ColumnSpans spans;
    kernel(query, row, spans);
    const int count = std::min(kLanes, j_last - j + 1);
    for (uint32_t left = spans.some & ((1U << count) - 1U); left != 0; left &= left - 1) {
      const int n = std::countr_zero(left);
      const size_t bottom = column + static_cast<size_t>(n) * set.map.dimension.z();
      if (!set.owns(bottom)) continue;
      for (int k = spans.first[n]; k <= spans.last[n]; ++k) {
        const size_t leaf = bottom + static_cast<size_t>(k);
        if (set.map.states[leaf] == LeafState::kAir) continue;
        visit(leaf, Eigen::Vector3f(row.x, f(foot.y() + n * leaf_mm), f(foot.z() + k * leaf_mm)));
      }
    }
  }
}

template <typename Visit>
void visit_leaves(const LevelSet& set, const LaneRun& run, Visit visit) {
  const Neighbourhood& around = run.around;
  const ColumnQuery query = column_query(around, run.origin);
  const Vec2 along = around.along.cwiseAbs();
  const double half = along.x() * around.half_along + along.y() * around.half_across;
  const auto [i_first, i_last] = leaf_range(set, 0, around.centre.x() - half, around.centre.x() + half);
  for (int i = i_first; i <= i_last; ++i) {
    const Part part = part_of_rectangle(around, set.leaf_centre(set.map.index(i, 0, 0)).x());
    const auto [j_first, j_last] =
        leaf_range(set, 1, around.centre.y() + part.low, around.centre.y() + part.high);
    visit_row(set, run, query, i, j_first, j_last, visit);
  }
}

Neighbourhood neighbourhood(const LevelSet& set, std::span<const SweptPiece> pieces) {
  const cutter::ConvexPiece& piece = *pieces.front().piece;
  const double lever = std::hypot(std::max(std::abs(piece.low), std::abs(piece.high)), piece.radius);
  std::vector<ToolPose> poses;
  double bow = 0.0;
  for (const SweptPiece& swept : pieces) {
    poses.push_back({swept.map.tip0, swept.map.R0t.row(2)});
    poses.push_back({swept.map.tip1, swept.map.R1t.row(2)});
    bow = std::max(bow, motion_bound(swept.map, lever));
  }
  return neighbourhood(set, poses, piece, bow);
}

/// How many pieces from `first` on make one run: the same convex piece, and all within `spread` of each
/// other.
size_t run_length(const std::vector<SweptPiece>& pieces, size_t first, double spread) {
  double travel = 0.0;
  size_t count = 0;
  while (first + count < pieces.size() && count < kLanes) {
    const SweptPiece& next = pieces[first + count];
    if (next.piece != pieces[first].piece) break;
    const Vec3 jump =
        count == 0 ? Vec3(Vec3::Zero()) : Vec3(next.map.tip0 - pieces[first + count - 1].map.tip1);
    travel += jump.norm() + (next.map.tip1 - next.map.tip0).norm() +
              next.piece->high * (next.map.R1t.row(2) - next.map.R0t.row(2)).norm();
    if (count > 0 && travel > spread) break;
    ++count;
  }
  return count;
}

/// Judges leaves by one run, some at a time: their answers do not wait for each other then.
class RunJudge {
 public:
  RunJudge(LevelSet& set, const LaneRun& run, uint32_t index, std::vector<LeafPair>& pairs)
      : set_(set), run_(run), index_(index), pairs_(pairs), extent_(set) {}

  /// `centre`: from the run's origin, mm.
  void ask(size_t leaf, const Eigen::Vector3f& centre) {
    // Neither of them lies near those of the leaf before.
    __builtin_prefetch(&set_.map.marks[leaf]);
    __builtin_prefetch(&set_.map.floors[leaf]);
    leaves_[count_] = static_cast<uint32_t>(leaf);
    centres_[count_] = centre;
    if (++count_ == kAtATime) answer();
  }

  void answer() {
    static const LaneKernel kernel = lane_kernel_variants().front().kernel;
    size_t asked = 0;
    for (size_t n = 0; n < count_; ++n) {
      const uint32_t leaf = leaves_[n];
      if (mark(leaf).load(std::memory_order_relaxed) == LeafMap::kSwallowed) continue;
      leaves_[asked] = leaf;
      const LaneQuery query = run_.query(extent_, centres_[n], set_.map.floors[leaf]);
      kernel(run_.lanes, run_.piece, query, answers_[asked++]);
    }
    for (size_t n = 0; n < asked; ++n) take(leaves_[n], answers_[n]);
    count_ = 0;
  }

 private:
  static constexpr size_t kAtATime = 16;

  std::atomic_ref<uint32_t> mark(size_t leaf) { return std::atomic_ref<uint32_t>(set_.map.marks[leaf]); }

  void take(uint32_t leaf, const LaneAnswer& answer) {
    const bool swallows = (answer.swallows & run_.all()) != 0;
    const uint32_t open = answer.open & run_.all();
    if (!swallows && open == 0) return;
    if (swallows) mark(leaf).store(LeafMap::kSwallowed, std::memory_order_relaxed);
    static const DeepestLanes deepest_lanes = lane_kernel_variants().front().deepest;
    const auto deepest = open != 0 ? static_cast<uint32_t>(std::countr_zero(deepest_lanes(answer, open))) : 0;
    pairs_.push_back({leaf, index_, answer.depth.lane[deepest], deepest});
  }

  LevelSet& set_;
  const LaneRun& run_;
  uint32_t index_;
  std::vector<LeafPair>& pairs_;
  LeafExtent extent_;
  size_t count_ = 0;
  std::array<uint32_t, kAtATime> leaves_;
  std::array<Eigen::Vector3f, kAtATime> centres_;
  std::array<LaneAnswer, kAtATime> answers_;
};

}  // namespace

void LaneRun::set_lane(size_t lane, const SweepMap& map) {
  const Mat3 middle = 0.5 * (map.R0t + map.R1t), change = map.R1t - map.R0t;
  const Vec3 start = map.R0t * (origin - map.tip0), end = map.R1t * (origin - map.tip1);
  const Vec3 middle_shift = 0.5 * (start + end), change_shift = end - start;
  const auto set = [&](LaneFloats& floats, double value) { floats.lane[lane] = static_cast<float>(value); };
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      set(lanes.middle[row][column], middle(row, column));
      set(lanes.change[row][column], change(row, column));
    }
    set(lanes.middle_shift[row], middle_shift[row]);
    set(lanes.change_shift[row], change_shift[row]);
  }
  // A direction differs by half the change's norm, which is its Frobenius norm at most; three components
  // together by sqrt(3) of that.
  set(lanes.turn, 0.5 * std::sqrt(3.0) * change.norm());
}

LeafExtent::LeafExtent(const LevelSet& set)
    : half(static_cast<float>(0.5 * (kLeafSide - 1) * set.voxel)), reach(static_cast<float>(reach_of(set))) {}

LaneQuery LaneRun::query(const LeafExtent& extent, const Eigen::Vector3f& at, const LeafFloor& floor) const {
  return {{at.x(), at.y(), at.z()},
          floor.value,
          {floor.slope[0], floor.slope[1], floor.slope[2]},
          extent.half,
          extent.reach};
}

std::vector<LaneRun> make_runs(const LevelSet& set, const std::vector<SweptPiece>& pieces) {
  std::vector<LaneRun> runs;
  for (size_t first = 0; first < pieces.size(); first += runs.back().count) {
    const double spread = 2.0 * pieces[first].piece->radius + 4.0 * kLeafSide * set.voxel;
    LaneRun& run = runs.emplace_back();
    run.first = first;
    run.count = run_length(pieces, first, spread);
  }
  parallel_chunks(runs.size(), kLanesPerTask, [&](size_t begin, size_t end) {
    for (size_t r = begin; r < end; ++r) {
      LaneRun& run = runs[r];
      const auto own = std::span(pieces).subspan(run.first, run.count);
      run.origin = own.front().map.tip0;
      run.piece = lane_piece(*own.front().piece);
      for (size_t lane = 0; lane < kLanes; ++lane) run.set_lane(lane, own[std::min(lane, run.count - 1)].map);
      run.around = neighbourhood(set, own);
    }
  });
  return runs;
}

std::vector<LeafPair> gather_leaves(LevelSet& set, const LaneRun& run, size_t index) {
  thread_local std::vector<LeafPair> pairs;  // grows once
  pairs.clear();
  RunJudge judge(set, run, static_cast<uint32_t>(index), pairs);
  visit_leaves(set, run, [&](size_t leaf, const Eigen::Vector3f& centre) { judge.ask(leaf, centre); });
  judge.answer();
  return {pairs.begin(), pairs.end()};
}

}  // namespace swarf::stock
