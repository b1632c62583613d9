#include "stock/stock.h"

#include <gtest/gtest.h>

#include <map>

#include "base/parallel.h"
#include "base/units.h"
#include "stock_test_support.h"

namespace swarf::stock::stock_test {
namespace {

const CutterSolid kCutter{5.0, 25.0};
const Box kBlock{{-10, -10, -12}, {40, 10, 0}};

std::vector<Sweep> level_move(double z, int sweeps) {
  return straight_sweeps({{0, 0, z}, Vec3::UnitZ()}, {{30, 0, z}, Vec3::UnitZ()}, sweeps);
}

double removed(const Box& box, double voxel, const std::vector<Sweep>& sweeps) {
  Stock stock(box, voxel);
  const double full = stock.volume_mm3();
  stock.cut(sweeps, kCutter);
  EXPECT_EQ(stock.check(), "");
  return full - stock.volume_mm3();
}

TEST(Stock, BoxVolumeOffTheVoxelLattice) {
  const Box box{{0.013, -3.07, 1.0}, {20.2, 9.51, 13.33}};
  const Stock stock(box, 0.25);
  EXPECT_EQ(stock.check(), "");
  // Edges are short of l voxel^2 (1/12 and the rounding of outer edges): 240 mm of them here.
  EXPECT_NEAR(stock.volume_mm3(), box.size().prod(), 240.0 * 0.25 * 0.25 / 6.0);
  EXPECT_NEAR(stock.distance_mm({10.0, 3.0, 13.33}), 0.0, 1e-6);
  EXPECT_NEAR(stock.distance_mm({10.0, 3.0, 13.63}), 0.3, 1e-6);
  EXPECT_NEAR(stock.distance_mm({10.0, 3.0, 13.03}), -0.3, 1e-6);
  EXPECT_FLOAT_EQ(static_cast<float>(stock.distance_mm({1e12, 0, 0})), 0.75F);
}

// theory 6: (2 r L + pi r^2) d with r = 5, L = 30, d = 3; voxel D/50.
TEST(Stock, FlatSlotVolume) {
  const double exact = 1135.6194490;
  for (const double voxel : {0.2, 0.1}) {
    EXPECT_NEAR(removed(kBlock, voxel, level_move(-3.0, 30)), exact, 1e-3 * exact) << voxel;
  }
}

TEST(Stock, SlotOffTheLatticeAndTurnedInSpace) {
  // The same slot in a box that the tool's axes do not share with the lattice.
  const Box box{{-25, -25, -25}, {25, 25, 25}};
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, -0.5).normalized()).toRotationMatrix();
  const ToolPose from{turn * Vec3(-5.03, 0.04, 0.017), turn * Vec3::UnitZ()};
  const ToolPose to{turn * Vec3(5.03, 0.04, 0.017), turn * Vec3::UnitZ()};
  Stock stock(box, 0.2);
  const double full = stock.volume_mm3();
  stock.cut(straight_sweeps(from, to, 7), CutterSolid{5.0, 10.0});
  EXPECT_EQ(stock.check(), "");
  // Wholly inside the block: stadium (2 r L + pi r^2) times the height of the cutter.
  const double exact = (10.0 * 10.06 + kPi * 25.0) * 10.0;
  EXPECT_NEAR(full - stock.volume_mm3(), exact, 1e-3 * exact);
}

TEST(Stock, PlungeVolume) {
  const std::vector<Sweep> plunge =
      straight_sweeps({{5, 0, 4}, Vec3::UnitZ()}, {{5, 0, -6.05}, Vec3::UnitZ()}, 5);
  const double exact = kPi * 25.0 * 6.05;
  EXPECT_NEAR(removed(kBlock, 0.2, plunge), exact, 1.5e-3 * exact);
  const std::vector<Sweep> at_once{{plunge.front().start, plunge.back().end, 0}};
  EXPECT_NEAR(removed(kBlock, 0.2, at_once), exact, 1.5e-3 * exact);
}

TEST(Stock, ZeroLengthSweepCutsItsPose) {
  const ToolPose pose{{5, 0, -3}, Vec3::UnitZ()};
  const double exact = kPi * 25.0 * 3.0;
  EXPECT_NEAR(removed(kBlock, 0.1, {{pose, pose, 0}}), exact, 1e-3 * exact);
}

TEST(Stock, RampAndItsReverseLeaveTheSameSurface) {
  const ToolPose top{{0, 0, 1}, Vec3::UnitZ()}, deep{{20, 0, -4}, Vec3::UnitZ()};
  Stock down(kBlock, 0.2);
  down.cut(std::vector<Sweep>{{top, deep, 0}}, kCutter);
  EXPECT_EQ(down.check(), "");
  // The disc leaves a plane of slope -1/4 along the middle; its rear edge is the last to pass x: z there is
  // that of the tip 5 mm ahead.
  for (const double x : {0.0, 4.0, 8.0, 12.0}) {
    EXPECT_NEAR(down.distance_mm({x, 0, 1.0 - 0.25 * (x + 5.0)}), 0.0, 1e-5) << x;
  }
  Stock up(kBlock, 0.2);
  up.cut(std::vector<Sweep>{{deep, top, 0}}, kCutter);
  for (double x = -4.0; x < 25.0; x += 0.37) {
    const Vec3 p(x, 1.3, -2.0);
    EXPECT_NEAR(up.distance_mm(p), down.distance_mm(p), 1e-5) << x;
  }
}

TEST(Stock, BackEdgeOfALeaningFlatEndCutsDeepest) {
  const double phi = 0.1;
  const Vec3 axis(std::sin(phi), 0, std::cos(phi));
  Stock stock(kBlock, 0.1);
  stock.cut(std::vector<Sweep>{{{{-5, 0, -2}, axis}, {{15, 0, -2}, axis}, 0}}, kCutter);
  EXPECT_EQ(stock.check(), "");
  // Axis towards +x lowers the rim at +x: the groove's floor is r sin(phi) below the tip centre.
  EXPECT_NEAR(stock.distance_mm({5, 0, -2 - 5 * std::sin(phi)}), 0.0, 1e-4);
  // Off the middle the rim is an ellipse: depth r sin(phi) sqrt(1 - (y/r)^2).
  EXPECT_NEAR(stock.distance_mm({5, 3, -2 - 4 * std::sin(phi)}), 0.0, 5e-4);
}

TEST(Stock, TurnOnTheSpotSweepsThePosesBetween) {
  const double turn = 0.02;
  const Vec3 axis(std::sin(turn), 0, std::cos(turn));
  Stock stock(kBlock, 0.1);
  stock.cut(std::vector<Sweep>{{{{5, 0, -3}, Vec3::UnitZ()}, {{5, 0, -3}, axis}, 0}}, kCutter);
  EXPECT_EQ(stock.check(), "");
  // The rim at +x goes down by r sin(turn); at -x the start pose was lowest.
  EXPECT_NEAR(stock.distance_mm({5 + 2.0, 0, -3 - 2.0 * std::tan(turn)}), 0.0, 1e-4);
  EXPECT_NEAR(stock.distance_mm({5 - 2.0, 0, -3.0}), 0.0, 1e-4);
}

std::vector<Sweep> wild_path(uint64_t seed, int count) {
  Rng rng(seed);
  std::vector<Sweep> sweeps;
  ToolPose pose{{0, 0, -1}, Vec3::UnitZ()};
  for (int i = 0; i < count; ++i) {
    ToolPose next;
    next.tip_W = Vec3(rng.uniform(-12, 42), rng.uniform(-12, 12), rng.uniform(-9, 1));
    next.tip_W = pose.tip_W + 1.5 * (next.tip_W - pose.tip_W).normalized();
    next.axis_W = (pose.axis_W + 0.1 * rng.direction() + Vec3(0, 0, 0.05)).normalized();
    sweeps.push_back({pose, next, static_cast<uint32_t>(i)});
    pose = next;
  }
  return sweeps;
}

uint64_t hash_after(const std::vector<Sweep>& sweeps, size_t call_size) {
  Stock stock(kBlock, 0.2);
  for (size_t i = 0; i < sweeps.size(); i += call_size) {
    stock.cut(std::span(sweeps).subspan(i, std::min(call_size, sweeps.size() - i)), kCutter);
  }
  EXPECT_EQ(stock.check(), "");
  return stock.hash();
}

TEST(Stock, HashDoesNotDependOnThreadsOrCalls) {
  constexpr uint64_t kSeed = 31;
  const std::vector<Sweep> sweeps = wild_path(kSeed, 1100);
  const uint64_t expected = hash_after(sweeps, sweeps.size());
  for (const int threads : {1, 2, 4}) {
    set_thread_count(threads);
    for (const size_t call_size : {size_t{1}, size_t{64}, size_t{700}}) {
      EXPECT_EQ(hash_after(sweeps, call_size), expected)
          << "seed " << kSeed << ", " << threads << " threads, " << call_size << " sweeps per call";
    }
  }
  set_thread_count(0);
}

TEST(Stock, HashDoesNotDependOnCallsWherePlanesPassThroughGridPoints) {
  // A slot along the grid: distances of exactly zero come with either sign.
  const auto at = [](double x, double z) { return ToolPose{{x, 0, z}, Vec3::UnitZ()}; };
  const std::vector<Sweep> sweeps{{at(-15, 5), at(-15, -3), 0},
                                  {at(-15, -3), at(15, -3), 1},
                                  {at(15, -3), at(15, 5), 2},
                                  {at(15, 5), at(-15, -2), 3}};
  const auto hash_of = [&](std::initializer_list<size_t> calls) {
    Stock stock({{-20, -10, -10}, {20, 10, 0}}, 0.1);
    size_t done = 0;
    for (const size_t count : calls) {
      stock.cut(std::span(sweeps).subspan(done, count), CutterSolid(5.0, 25.0));
      done += count;
    }
    return stock.hash();
  };
  const uint64_t whole = hash_of({4});
  EXPECT_EQ(hash_of({1, 2, 1}), whole);
  EXPECT_EQ(hash_of({1, 1, 1, 1}), whole);
  EXPECT_EQ(hash_of({3, 1}), whole);
}

TEST(Stock, CuttingAgainChangesNothingAndHashTellsMaterialApart) {
  const std::vector<Sweep> sweeps = wild_path(32, 50);
  Stock stock(kBlock, 0.2);
  const uint64_t fresh = stock.hash();
  stock.cut(sweeps, kCutter);
  const uint64_t cut = stock.hash();
  EXPECT_NE(cut, fresh);
  stock.cut(sweeps, kCutter);
  EXPECT_EQ(stock.hash(), cut);
}

TEST(Stock, LevelSetIsTheGreatestOfBoxAndSweeps) {
  // Each voxel against the closed form, so that culling by leaves can hide nothing.
  constexpr uint64_t kSeed = 33;
  const std::vector<Sweep> sweeps = wild_path(kSeed, 40);
  const double voxel = 0.4, band = 3 * voxel;
  Stock stock(kBlock, voxel);
  const Stock fresh(kBlock, voxel);
  stock.cut(sweeps, kCutter);
  for (int i = -28; i < 104; i += 3) {
    for (int j = -28; j < 29; ++j) {
      for (int k = -32; k < 4; ++k) {
        const Vec3 x = Vec3(i, j, k) * voxel;
        double expected = fresh.distance_mm(x);
        for (const Sweep& sweep : sweeps) {
          const SweepMap map = sweep_map(sweep);
          for (int step = 0; step <= 30; ++step) {
            const double t = step / 30.0;
            expected = std::max(
                expected,
                std::clamp(-cutter_value((1.0 - t) * map.start(x) + t * map.end(x), kCutter), -band, band));
          }
        }
        // Thirty standing poses leave out up to half of 1.5 mm / 30, times the slope 1 of the distance.
        ASSERT_GE(stock.distance_mm(x), expected - 1e-5)
            << "seed " << kSeed << " voxel " << i << " " << j << " " << k;
        ASSERT_LE(stock.distance_mm(x), expected + 0.06)
            << "seed " << kSeed << " voxel " << i << " " << j << " " << k;
      }
    }
  }
}

TEST(Stock, MeshIsClosedOrientedAndCarriesOutwardNormals) {
  Stock stock(kBlock, 0.4);
  stock.cut(wild_path(34, 60), kCutter);
  const TriMesh mesh = stock.mesh();
  std::map<std::pair<uint32_t, uint32_t>, int> edges;
  double six_volumes = 0.0;
  size_t against = 0;
  for (const auto& t : mesh.triangles) {
    Vec3 p[3];
    Vec3 normal = Vec3::Zero();
    for (int c = 0; c < 3; ++c) {
      ++edges[{t[c], t[(c + 1) % 3]}];
      p[c] = Vec3(mesh.positions[t[c]][0], mesh.positions[t[c]][1], mesh.positions[t[c]][2]);
      normal += Vec3(mesh.normals[t[c]][0], mesh.normals[t[c]][1], mesh.normals[t[c]][2]);
    }
    six_volumes += p[0].dot(p[1].cross(p[2]));
    if (normal.dot((p[1] - p[0]).cross(p[2] - p[0])) < 0.0) ++against;
  }
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, (edges[{edge.second, edge.first}])) << "edge " << edge.first << " " << edge.second;
  }
  EXPECT_NEAR(six_volumes / 6.0, stock.volume_mm3(), 2e-3 * stock.volume_mm3());
  EXPECT_LE(against, mesh.triangles.size() / 1000);  // slivers on sharp edges
}

TEST(Stock, MemoryEstimateCoversWhatIsUsed) {
  const Box box{{-55, -45, -10}, {55, 45, 45}};
  for (const double voxel : {0.4, 0.2}) {
    const Stock stock(box, voxel);
    EXPECT_GE(Stock::memory_estimate(box, voxel), stock.memory_bytes());
    EXPECT_LE(Stock::memory_estimate(box, voxel), 2 * stock.memory_bytes());
  }
}

}  // namespace
}  // namespace swarf::stock::stock_test
