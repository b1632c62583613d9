// What is left out while cutting must not show in the result: verdicts of whole runs, bounds and floors are
// held against plain evaluation.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <iterator>

#include "base/parallel.h"
#include "cutter_shapes.h"
#include "stock/level_set/column_kernel.h"
#include "stock/level_set/lane_run.h"
#include "stock/level_set/leaf_kernel.h"
#include "stock/stock.h"
#include "stock_test_support.h"

namespace swarf::stock::pruning_test {
namespace {

/// Least F over the motion, by a scan of its instants refined around the best (F is convex along the motion).
double scanned(const SweptPiece& swept, const Vec3& point) {
  double best = 1e300, low = 0.0, high = 1.0;
  for (int level = 0; level < 3; ++level) {
    const double step = (high - low) / 50;
    double best_t = low;
    for (int i = 0; i <= 50; ++i) {
      const double t = low + i * step;
      const Vec3 X = (1.0 - t) * swept.map.start(point) + t * swept.map.end(point);
      const double value = cutter::signed_distance(*swept.piece, X.head<2>().norm(), X.z());
      if (value < best) {
        best = value;
        best_t = t;
      }
    }
    low = std::max(0.0, best_t - step);
    high = std::min(1.0, best_t + step);
  }
  return best;
}

/// The same for sweeps of metres, by thirds: F is convex along the motion.
double found_by_thirds(const SweptPiece& swept, const Vec3& point) {
  const Vec3 from = swept.map.start(point), way = swept.map.end(point) - from;
  const auto value = [&](double t) {
    const Vec3 X = from + t * way;
    return cutter::signed_distance(*swept.piece, X.head<2>().norm(), X.z());
  };
  double low = 0.0, high = 1.0;
  for (int n = 0; n < 100; ++n) {
    const double a = (2.0 * low + high) / 3.0, b = (low + 2.0 * high) / 3.0;
    (value(a) < value(b) ? high : low) = value(a) < value(b) ? b : a;
  }
  return value(low);
}

/// A leaf position and sixteen sweeps near it.
struct LaneCase {
  std::vector<Sweep> sweeps;
  std::vector<SweptPiece> pieces;
  Vec3 centre;
};
LaneCase random_case(Rng& rng, const cutter::ConvexPiece& piece) {
  LaneCase made;
  for (int lane = 0; lane < kLanes; ++lane) {
    made.sweeps.push_back(random_sweep(rng, 2.0, 2.0, 0.1));
    made.pieces.push_back({sweep_map(made.sweeps.back()), &piece});
  }
  made.centre = 6.0 * rng.direction() * rng.uniform();
  return made;
}

TEST(LaneKernel, AllInstructionSetsJudgeAlikeAndNeverCloseALeafThatASweepRaises) {
  constexpr uint64_t kSeed = 72;
  constexpr double kHalf = 0.35, kReach = 0.9;
  Rng rng(kSeed);
  int closed = 0;
  for (int n = 0; n < 300; ++n) {
    const cutter::ConvexPiece piece =
        n % 4 == 0 ? cutter::ConvexPiece::cylinder(4.0, 12.0) : random_piece(rng);
    const LaneCase lane_case = random_case(rng, piece);
    LaneRun run;
    run.piece = lane_piece(piece);
    for (int lane = 0; lane < kLanes; ++lane)
      run.set_lane(static_cast<size_t>(lane), lane_case.pieces[static_cast<size_t>(lane)].map);
    const Vec3 slope = 0.9 * rng.direction();
    const double level = rng.uniform(-0.6, 0.6);
    const Eigen::Vector3f centre = lane_case.centre.cast<float>(), s = slope.cast<float>();
    const LaneQuery query{{centre.x(), centre.y(), centre.z()},
                          static_cast<float>(level),
                          {s.x(), s.y(), s.z()},
                          static_cast<float>(kHalf),
                          static_cast<float>(kReach)};
    LaneAnswer answer, other;
    lane_kernel_variants().front().kernel(run.lanes, run.piece, query, answer);
    const uint32_t deepest = lane_kernel_variants().front().deepest(answer, answer.open);
    for (const LaneKernelVariant& variant : lane_kernel_variants()) {
      variant.kernel(run.lanes, run.piece, query, other);
      ASSERT_EQ(other.open, answer.open) << variant.instruction_set << " case " << n;
      ASSERT_EQ(other.swallows, answer.swallows) << variant.instruction_set << " case " << n;
      ASSERT_EQ(variant.deepest(answer, answer.open), deepest) << variant.instruction_set << " case " << n;
      ASSERT_EQ(std::memcmp(&other.depth, &answer.depth, sizeof(answer.depth)), 0) << variant.instruction_set;
      ASSERT_EQ(std::memcmp(&other.above, &answer.above, sizeof(answer.above)), 0) << variant.instruction_set;
    }
    ASSERT_EQ(deepest == 0, answer.open == 0) << "case " << n;
    for (int lane = 0; lane < kLanes; ++lane) {
      ASSERT_EQ((answer.open >> lane & 1U) != 0, answer.above.lane[lane] >= query.floor) << "case " << n;
      if (answer.open >> lane & 1U) {
        const float most = answer.depth.lane[std::countr_zero(deepest)];
        ASSERT_EQ((deepest >> lane & 1U) != 0, answer.depth.lane[lane] == most) << "case " << n;
        ASSERT_LE(answer.depth.lane[lane], most) << "case " << n;
      }
      if ((answer.open >> lane & 1U) != 0) continue;
      ++closed;
      for (int corner = 0; corner < 8; ++corner) {
        const Vec3 x = kHalf * Vec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
        const double written = -scanned(lane_case.pieces[static_cast<size_t>(lane)], lane_case.centre + x);
        ASSERT_LE(written, level + slope.dot(x))
            << "seed " << kSeed << " case " << n << " lane " << lane << ": "
            << text(lane_case.sweeps[static_cast<size_t>(lane)]) << "\n"
            << text(piece);
      }
    }
  }
  EXPECT_GT(closed, 1000);
}

/// One block across a part of metres that passes a leaf anywhere: what rounds grows with its length.
LaneCase long_case(Rng& rng, const cutter::ConvexPiece& piece) {
  LaneCase made;
  made.centre = Vec3(rng.uniform(10, 5000), rng.uniform(-3000, 3000), rng.uniform(-200, 200));
  for (int lane = 0; lane < kLanes; ++lane) {
    const Vec3 axis = Vec3(rng.uniform(-0.3, 0.3), rng.uniform(-0.3, 0.3), 1.0).normalized();
    const Vec3 through = made.centre + 4.0 * rng.direction();
    Vec3 after = rng.uniform(10, 5000) * Vec3(1.0, rng.uniform(-0.5, 0.5), rng.uniform(-0.01, 0.01));
    if (lane % 2 == 0) after -= after.dot(axis) * axis;  // the bound of a flat end is tight then
    const ToolPose start{Vec3(0, rng.uniform(-1, 1), rng.uniform(-1, 1)), axis};
    made.sweeps.push_back({start, {through + after, axis}, 0});
    made.sweeps.back().start.tip_W = through - made.centre.norm() / after.norm() * after;
    made.pieces.push_back({sweep_map(made.sweeps.back()), &piece});
  }
  return made;
}

TEST(LaneKernel, NoLongSweepThatRaisesALeafIsClosed) {
  constexpr uint64_t kSeed = 79;
  constexpr double kHalf = 0.35, kReach = 0.9;
  Rng rng(kSeed);
  double worst = -1.0;
  for (int n = 0; n < 400; ++n) {
    const cutter::ConvexPiece piece =
        n % 4 == 0 ? cutter::ConvexPiece::cylinder(4.0, 12.0) : random_piece(rng);
    const LaneCase lane_case = long_case(rng, piece);
    LaneRun run;
    run.origin = lane_case.sweeps.front().start.tip_W;
    run.piece = lane_piece(piece);
    for (size_t lane = 0; lane < kLanes; ++lane) run.set_lane(lane, lane_case.pieces[lane].map);
    const Eigen::Vector3f centre = (lane_case.centre - run.origin).cast<float>();
    const LaneQuery query{{centre.x(), centre.y(), centre.z()},
                          0.0F,
                          {},
                          static_cast<float>(kHalf),
                          static_cast<float>(kReach)};
    LaneAnswer answer;
    lane_kernel_variants().front().kernel(run.lanes, run.piece, query, answer);
    for (size_t lane = 0; lane < kLanes; ++lane) {
      double written = -1e300;
      for (int corner = 0; corner < 8; ++corner) {
        const Vec3 x = kHalf * Vec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
        written = std::max(written, -found_by_thirds(lane_case.pieces[lane], lane_case.centre + x));
      }
      worst = std::max(worst, written - answer.above.lane[lane]);
    }
  }
  EXPECT_LT(worst, 0.0) << "mm above the bound; seed " << kSeed;
}

TEST(LaneKernel, NothingThatASweepWritesLiesAboveItsBound) {
  constexpr uint64_t kSeed = 71;
  constexpr double kVoxel = 0.25, kHalf = 0.5 * (kLeafSide - 1) * kVoxel;
  Rng rng(kSeed);
  for (int n = 0; n < 60; ++n) {
    const cutter::ConvexPiece piece =
        n % 4 == 0 ? cutter::ConvexPiece::cylinder(4.0, 12.0) : random_piece(rng);
    const LaneCase lane_case = random_case(rng, piece);
    LaneRun run;
    run.piece = lane_piece(piece);
    for (size_t lane = 0; lane < kLanes; ++lane) run.set_lane(lane, lane_case.pieces[lane].map);
    const Eigen::Vector3f centre = lane_case.centre.cast<float>();
    const LaneQuery query{{centre.x(), centre.y(), centre.z()}, 0.0F, {}, static_cast<float>(kHalf), 2.5F};
    LaneBounds bounds, other;
    lane_kernel_variants().front().bounds(run.lanes, run.piece, query, bounds);
    for (const LaneKernelVariant& variant : lane_kernel_variants()) {
      variant.bounds(run.lanes, run.piece, query, other);
      ASSERT_EQ(std::memcmp(&other, &bounds, sizeof(bounds)), 0) << variant.instruction_set << " case " << n;
    }
    for (int look = 0; look < 120; ++look) {
      const auto lane = static_cast<uint32_t>(look % kLanes);
      const auto place = [&] { return static_cast<int>(rng.uniform(0.0, kLeafSide - 1e-9)); };
      const int v[3] = {place(), place(), place()};
      const Vec3 x = lane_case.centre - Vec3::Constant(kHalf) + kVoxel * Vec3(v[0], v[1], v[2]);
      const double written = -scanned(lane_case.pieces[lane], x);
      for (const LeafBound::Linear& linear : bounds.lane(lane).of_face) {
        double start = linear.start, end = linear.end;
        for (int a = 0; a < 3; ++a) {
          start += double{linear.start_step[a]} * v[a];
          end += double{linear.end_step[a]} * v[a];
        }
        ASSERT_LE(written, std::max(start, end))
            << "seed " << kSeed << " case " << n << ": " << text(lane_case.sweeps[lane]) << " centre "
            << text(lane_case.centre) << " at " << text(x) << "\n"
            << text(piece);
      }
    }
  }
}

/// Below its point a cone's F grows with the sine of the half angle: it reaches farther than a distance.
TEST(LaneRun, ReachesAllThatAPointedCutterRaises) {
  constexpr double kVoxel = 0.25, kBand = 3 * kVoxel, kTip = 4.0;
  for (const double half_angle : {20.0, 30.0, 45.0, 59.0, 75.0}) {
    const double a = half_angle * M_PI / 180.0;
    cutter::ConvexPiece cone;
    cone.faces = {{{std::cos(a), -std::sin(a)}, 0.0}, {{1.0, 0.0}, 3.0}, {{0.0, 1.0}, 12.0}};
    cone.radius = 3.0;
    cone.high = 12.0;
    CutterSolid cutter{3.0, 12.0};
    cutter.pieces = {cone};
    const Sweep sweep{{{4.1, 8.0, kTip}, Vec3::UnitZ()}, {{11.9, 8.3, kTip + 0.1}, Vec3::UnitZ()}};
    Stock stock({{0, 0, 0}, {16, 16, 8}}, kVoxel);
    stock.cut(std::span(&sweep, 1), cutter);
    const SweptPiece swept{sweep_map(sweep), &cone};
    int raised = 0;
    for (int i = 8; i <= 56; ++i) {
      for (int j = 28; j <= 36; ++j) {
        for (int k = 4; k <= 20; ++k) {
          const Vec3 x = kVoxel * Vec3(i, j, k);
          const double expected = std::max(-scanned(swept, x), -kBand);
          raised += expected > -kBand && x.z() < kTip ? 1 : 0;
          ASSERT_NEAR(std::min(expected, kBand), stock.distance_mm(x), 1e-3)
              << "half angle " << half_angle << " at " << text(x);
        }
      }
    }
    EXPECT_GT(raised, 100) << half_angle;
  }
}

/// Moves of every kind near a small block: level and sloping rows, plunges, moves that stand or all but
/// stand, turning axes, and rows again a little higher or lower.
std::vector<Sweep> mixed_sweeps(Rng& rng, double tilt) {
  std::vector<Sweep> sweeps;
  const auto place = [&] { return Vec3(rng.uniform(-3, 15), rng.uniform(-3, 15), rng.uniform(2, 7)); };
  const auto axis = [&] {
    return Vec3(tilt * rng.uniform(-1, 1), tilt * rng.uniform(-1, 1), 1.0).normalized();
  };
  for (int n = 0; n < 60; ++n) {
    Sweep sweep{{place(), axis()}, {Vec3::Zero(), Vec3::UnitZ()}, 0};
    const Vec3 along(rng.uniform(-2, 2), rng.uniform(-2, 2), 0.0);
    const Vec3 changes[] = {along,
                            along + Vec3(0, 0, rng.uniform(-0.1, 0.1)),
                            Vec3(0, 0, -1.5),
                            Vec3::Zero(),
                            1e-7 * along + Vec3(0, 0, 1e-7),
                            Vec3(2.5, 0, 1e-9)};
    sweep.end = {sweep.start.tip_W + changes[n % 6], n % 4 == 0 ? axis() : sweep.start.axis_W};
    sweeps.push_back(sweep);
    if (n % 5 == 0) {
      const Vec3 lift(0.0, 0.0, n % 10 == 0 ? 2e-3 : -2e-3);
      sweep.start.tip_W += lift;
      sweep.end.tip_W += lift;
      sweeps.push_back(sweep);
    }
  }
  return sweeps;
}

/// Sixteen moves that follow each other, through the block and beside it.
std::vector<Sweep> chain(Rng& rng, double tilt) {
  const auto axis = [&] {
    return Vec3(tilt * rng.uniform(-1, 1), tilt * rng.uniform(-1, 1), 1.0).normalized();
  };
  ToolPose pose{{rng.uniform(-3, 15), rng.uniform(-3, 15), rng.uniform(1, 6)}, axis()};
  const Vec3 way(rng.uniform(-0.6, 0.6), rng.uniform(-0.6, 0.6), rng.uniform(-0.1, 0.1)), target = axis();
  std::vector<Sweep> sweeps;
  for (int n = 1; n <= kLanes; ++n) {
    const double t = static_cast<double>(n) / kLanes;
    const ToolPose next{pose.tip_W + way, ((1.0 - t) * pose.axis_W + t * target).normalized()};
    sweeps.push_back({pose, next, 0});
    pose = next;
  }
  return sweeps;
}

/// Positions of material that gather_leaves() passed over beside others.
std::vector<size_t> passed_over(const LevelSet& set, const std::vector<LeafPair>& pairs) {
  std::vector<uint8_t> found(set.map.size(), 0);
  for (const LeafPair& pair : pairs) found[pair.leaf] = 1;
  const size_t to_next[] = {1, set.map.index(0, 1, 0), set.map.index(1, 0, 0)};
  const auto is_beside = [&](size_t leaf) {
    return std::any_of(std::begin(to_next), std::end(to_next), [&](size_t step) {
      return (leaf >= step && found[leaf - step] != 0) ||
             (leaf + step < found.size() && found[leaf + step] != 0);
    });
  };
  std::vector<size_t> rest;
  for (size_t leaf = 0; leaf < set.map.size(); ++leaf)
    if (found[leaf] == 0 && set.map.states[leaf] != LeafState::kAir && is_beside(leaf)) rest.push_back(leaf);
  return rest;
}

TEST(LaneRun, PassesOverNoLeafThatItRaises) {
  constexpr uint64_t kSeed = 76;
  constexpr double kVoxel = 0.2;
  Rng rng(kSeed);
  size_t found = 0;
  for (int n = 0; n < 48; ++n) {
    const double tilts[] = {0.0, 0.03, 0.3, 1.0, 30.0};
    const cutter::ConvexPiece piece =
        n % 3 == 0 ? random_piece(rng) : cutter::ConvexPiece::cylinder(2.5, n % 2 == 0 ? 5.0 : 40.0);
    LevelSet set = make_box({{0, 0, 0}, {12, 12, 6}}, kVoxel);
    cut_level_set(set, mixed_sweeps(rng, 0.2), CutterSolid(1.5, 10.0));
    std::vector<SweptPiece> pieces;
    for (const Sweep& sweep : chain(rng, tilts[n % 5])) pieces.push_back({sweep_map(sweep), &piece});
    std::vector<LeafPair> pairs;
    for (const LaneRun& run : make_runs(set, pieces))
      for (const LeafPair& pair : gather_leaves(set, run, 0)) pairs.push_back(pair);
    found += pairs.size();
    const std::vector<size_t> rest = passed_over(set, pairs);
    for (int look = 0; look < 150 && !rest.empty(); ++look) {
      const auto corner = [&] { return static_cast<int>(rng.uniform(0.0, 2.0)) * (kLeafSide - 1); };
      const size_t leaf = rest[static_cast<size_t>(rng.uniform() * static_cast<double>(rest.size() - 1))];
      const openvdb::Coord voxel = set.map.origin(leaf).offsetBy(corner(), corner(), corner());
      const Vec3 x = kVoxel * Vec3(voxel.x(), voxel.y(), voxel.z());
      const SweptPiece& swept = pieces[static_cast<size_t>(rng.uniform() * (kLanes - 1e-9))];
      ASSERT_LE(std::min(-scanned(swept, x), double{set.band()}), set.value(voxel) + 1e-4)
          << "seed " << kSeed << " case " << n << " at " << text(x) << "\n"
          << text(piece);
    }
  }
  EXPECT_GT(found, 3000U);
}

TEST(ColumnKernel, AllInstructionSetsFindTheSameSpans) {
  constexpr uint64_t kSeed = 77;
  Rng rng(kSeed);
  const auto f = [&](double low, double high) { return static_cast<float>(rng.uniform(low, high)); };
  int some = 0;
  for (int n = 0; n < 500; ++n) {
    ColumnQuery query{{f(-2, 2), f(-2, 2)},
                      {1.0F, 0.0F},
                      f(2, 9),
                      f(2, 9),
                      {f(-2, 2), f(-2, 2), f(-2, 2)},
                      {f(-0.5, 0.5), f(-0.5, 0.5)},
                      f(0.5, 1.0),
                      f(5, 40),
                      f(2, 7),
                      0.0F,
                      n % 18,
                      {}};
    if (n % 3 != 0) query.per_lean = 1.0F / std::hypot(query.lean[0], query.lean[1]);
    for (int p = 0; p < query.planes; ++p) query.plane[p] = {f(-3, 3), f(-0.4, 0.4), f(-0.4, 0.4)};
    uint32_t tops[kLanes];
    for (uint32_t& top : tops) top = static_cast<uint32_t>(rng.uniform(0, 40));
    const ColumnRow row{f(-5, 5), f(-9, -2), 0.8F, -10.0F, 1.25F, tops};
    ColumnSpans spans, other;
    column_kernel_variants().front().kernel(query, row, spans);
    for (const ColumnKernelVariant& variant : column_kernel_variants()) {
      variant.kernel(query, row, other);
      ASSERT_EQ(std::memcmp(&other, &spans, sizeof(spans)), 0) << variant.instruction_set << " case " << n;
    }
    for (int lane = 0; lane < kLanes; ++lane) ASSERT_LT(spans.last[lane], static_cast<int>(tops[lane]));
    some += std::popcount(spans.some);
  }
  EXPECT_GT(some, 1000);
}

TEST(LeafKernel, PatchTestFloorsAndRangeAreAlikeInAllInstructionSets) {
  constexpr uint64_t kSeed = 73;
  Rng rng(kSeed);
  for (int n = 0; n < 300; ++n) {
    float values[kLeafVoxels];
    for (float& value : values) value = static_cast<float>(std::clamp(rng.uniform(-0.5, 0.5), -0.3, 0.3));
    LeafBound bound{};
    for (LeafBound::Linear& face : bound.of_face) {
      face.start = static_cast<float>(rng.uniform(-0.6, 0.3));
      face.end = static_cast<float>(rng.uniform(-0.6, 0.3));
      for (int a = 0; a < 3; ++a) {
        face.start_step[a] = static_cast<float>(rng.uniform(-0.1, 0.1));
        face.end_step[a] = static_cast<float>(rng.uniform(-0.1, 0.1));
      }
    }
    PatchFloors floors{}, others{};
    floors.band = others.band = 0.3F;
    for (int a = 0; a < 3; ++a)
      floors.slope[a] = others.slope[a] = static_cast<float>(rng.uniform(-0.1, 0.1));
    const LeafKernelVariant& base = leaf_kernel_variants().back();
    base.patch_fit(values, kAllPatches, floors);
    const uint32_t open = base.patch_test(floors, bound);
    uint64_t active[kLeafSide], other[kLeafSide];
    const LeafRange range = base.summary(values, 0.3F, active);
    for (const LeafKernelVariant& variant : leaf_kernel_variants()) {
      ASSERT_EQ(variant.patch_test(floors, bound), open);
      variant.patch_fit(values, kAllPatches, others);
      ASSERT_EQ(std::memcmp(others.of_patch, floors.of_patch, sizeof(floors.of_patch)), 0);
      const LeafRange again = variant.summary(values, 0.3F, other);
      ASSERT_TRUE(again.least == range.least && again.greatest == range.greatest);
      ASSERT_EQ(std::memcmp(active, other, sizeof(active)), 0);
    }
    for (int voxel = 0; voxel < kLeafVoxels; ++voxel) {
      const bool on = values[voxel] > -0.3F && values[voxel] < 0.3F;
      ASSERT_EQ((active[voxel / 64] >> (voxel % 64) & 1U) != 0, on);
    }
  }
}

/// Of a patch, what its bound has over the floors, without rounding and slack.
double exact_over(const LeafBound& bound, const PatchFloors& floors, int patch) {
  const double middle[3] = {2.0 * (patch / kPatchSide) + 0.5, 2.0 * (patch % kPatchSide) + 0.5,
                            0.5 * (kLeafSide - 1)};
  const double half[3] = {0.5, 0.5, 0.5 * (kLeafSide - 1)};
  const auto most = [&](float first, const float(&step)[3], double slopes) {
    double value = first;
    for (int a = 0; a < 3; ++a) {
      const double over = double{step[a]} - slopes * floors.slope[a];
      value += over * middle[a] + half[a] * std::abs(over);
    }
    return value;
  };
  double least = 1e300;
  for (int n = 0; n < 2; ++n) {
    const LeafBound::Linear &face = bound.of_face[n], &other = bound.of_face[1 - n];
    const double from = most(other.start, other.start_step, 0.0), to = most(other.end, other.end_step, 0.0);
    const double first = most(face.start, face.start_step, 1.0), last = most(face.end, face.end_step, 1.0);
    double over = -1e300;
    for (int level = 0; level < kLevels; ++level) {
      const double reached = level == 0 ? -floors.band : floors.level(level - 1);
      if (std::max(from, to) <= reached) continue;
      const double t = std::clamp((reached - from) / (to - from), 0.0, 1.0);
      const double at_end = to > reached ? last : -1e300, at_start = from > reached ? first : -1e300;
      over = std::max(over, std::max({first + t * (last - first), at_start, at_end}) -
                                double{floors.of_patch[level][patch]});
    }
    least = std::min(least, over);
  }
  return least;
}

TEST(LeafKernel, PatchTestOfALongSweepPassesOverNothing) {
  constexpr uint64_t kSeed = 80;
  Rng rng(kSeed);
  int close = 0;
  for (int n = 0; n < 4000; ++n) {
    // Both faces come from afar, or go there, and pass the floors on the way.
    LeafBound bound{};
    const double length = rng.uniform(1.0, 6000.0), at = rng.uniform();
    for (LeafBound::Linear& face : bound.of_face) {
      const double middle = rng.uniform(-0.01, 0.01), sign = rng.uniform() < 0.5 ? -1.0 : 1.0;
      face.start = static_cast<float>(middle - sign * at * length);
      face.end = static_cast<float>(middle + sign * (1.0 - at) * length);
      for (int a = 0; a < 3; ++a)
        face.start_step[a] = face.end_step[a] = static_cast<float>(rng.uniform(-0.1, 0.1));
    }
    PatchFloors floors{};
    floors.band = 0.3F;
    for (auto& level : floors.of_patch)
      for (float& floor : level) floor = 1e30F;
    for (float& floor : floors.of_patch[kLevels - 1]) floor = static_cast<float>(rng.uniform(-0.3, 0.3));
    // A floor as high as the bound but for a twentieth of a micrometre.
    for (int patch = 0; patch < kPatches; ++patch) {
      PatchFloors low = floors;
      low.of_patch[kLevels - 1][patch] = 0.0F;
      const double over = exact_over(bound, low, patch);
      if (std::abs(over) > 1.0) continue;
      floors.of_patch[kLevels - 1][patch] = static_cast<float>(over - 5e-5);
      ++close;
    }
    const uint32_t open = leaf_kernel_variants().front().patch_test(floors, bound);
    for (int patch = 0; patch < kPatches; ++patch)
      if (exact_over(bound, floors, patch) > 0.0)
        ASSERT_TRUE((open >> patch & 1U) != 0) << "seed " << kSeed << " case " << n << " patch " << patch
                                               << " " << exact_over(bound, floors, patch);
  }
  EXPECT_GT(close, 1000);
}

/// The block that repeated rows, tilted passes, plunges and a long move across cut, in pieces of `pieces`
/// sweeps.
uint64_t hash_of_cut(size_t pieces, int threads) {
  set_thread_count(threads);
  Stock stock({{0, 0, 0}, {40, 30, 12}}, 0.25);
  std::vector<Sweep> sweeps;
  Rng rng(74);
  for (int row = 0; row < 12; ++row) {
    const Vec3 level(0, 2.5 * row, 10.0);
    for (const Sweep& s :
         straight_sweeps({level, Vec3::UnitZ()}, {level + Vec3(40, 0, 0), Vec3::UnitZ()}, 20)) {
      sweeps.push_back(s);
    }
    const Vec3 axis = Vec3(0.1 * std::sin(row), 0.2, 1.0).normalized(),
               turned = Vec3(0.3, -0.1, 1.0).normalized();
    for (const Sweep& s :
         straight_sweeps({level - Vec3(0, 0, 2), axis}, {level + Vec3(40, 3, -3), turned}, 25)) {
      sweeps.push_back(s);
    }
    sweeps.push_back({{level, Vec3::UnitZ()}, {level - Vec3(0, 0, 6), Vec3::UnitZ()}, 0});
  }
  sweeps.push_back({{{-5, -5, 5}, Vec3::UnitZ()}, {{45, 35, 5}, Vec3::UnitZ()}, 0});
  const CutterSolid cutter{3.0, 15.0};
  for (size_t first = 0; first < sweeps.size(); first += pieces) {
    stock.cut(std::span(sweeps).subspan(first, std::min(pieces, sweeps.size() - first)), cutter);
  }
  EXPECT_EQ(stock.check(), "");
  set_thread_count(0);
  return stock.hash();
}

TEST(Stock, BatchesAndThreadsLeaveTheSameBits) {
  const uint64_t expected = hash_of_cut(1, 1);
  for (const int threads : {1, 2, 4}) {
    for (const size_t pieces : {size_t{1}, size_t{64}, size_t{4096}}) {
      ASSERT_EQ(hash_of_cut(pieces, threads), expected)
          << pieces << " sweeps a call, " << threads << " threads";
    }
  }
}

/// Alone, each sweep is evaluated in every patch of the leaves that it reaches; together, what one leaves
/// rules others out.
TEST(Stock, WhatPatchesLeaveOutNeverChangesABit) {
  constexpr uint64_t kSeed = 75;
  Rng rng(kSeed);
  for (int n = 0; n < 40; ++n) {
    const double tilts[] = {0.0, 0.0, 1e-4, 0.5};
    const std::vector<Sweep> sweeps = mixed_sweeps(rng, tilts[n % 4]);
    const CutterSolid cutter =
        n % 5 == 4 ? bull_nose(2.5, 0.5, 6.0) : CutterSolid(2.5, n % 3 == 0 ? 2.0 : 6.0);
    Stock together({{0, 0, 0}, {12, 12, 6}}, 0.2), alone({{0, 0, 0}, {12, 12, 6}}, 0.2);
    together.cut(sweeps, cutter);
    for (const Sweep& sweep : sweeps) alone.cut(std::span(&sweep, 1), cutter);
    ASSERT_EQ(together.hash(), alone.hash()) << "seed " << kSeed << " case " << n;
    ASSERT_LT(together.statistics().voxel_updates, alone.statistics().voxel_updates);
  }
}

/// One block across a part of metres: coordinates and distances are rounded to as many parts of its length.
TEST(Stock, WhatLongSweepsLeaveOutNeverChangesABit) {
  constexpr uint64_t kSeed = 78;
  Rng rng(kSeed);
  for (int n = 0; n < 6; ++n) {
    const double tilt = n % 2 == 0 ? 0.0 : 0.2;
    const Vec3 axis = Vec3(tilt * rng.uniform(-1, 1), tilt * rng.uniform(-1, 1), 1.0).normalized();
    std::vector<Sweep> sweeps;
    for (int row = 0; row < 64; ++row) {
      const Vec3 through(6.0, rng.uniform(0, 12), 4.0 + rng.uniform(-1e-3, 1e-3));
      const Vec3 way(1.0, rng.uniform(-1e-3, 1e-3), n % 3 == 0 ? 0.0 : rng.uniform(-1e-3, 1e-3));
      const double before = rng.uniform(10, 6000), after = rng.uniform(10, 6000);
      sweeps.push_back({{through - before * way, axis}, {through + after * way, axis}, 0});
    }
    const CutterSolid cutter(2.5, 6.0);
    Stock together({{0, 0, 0}, {12, 12, 6}}, 0.2), alone({{0, 0, 0}, {12, 12, 6}}, 0.2);
    together.cut(sweeps, cutter);
    for (const Sweep& sweep : sweeps) alone.cut(std::span(&sweep, 1), cutter);
    ASSERT_EQ(together.hash(), alone.hash()) << "seed " << kSeed << " case " << n;
  }
}

}  // namespace
}  // namespace swarf::stock::pruning_test
