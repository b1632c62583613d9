#include "stock/sweep/sweep.h"

#include <gtest/gtest.h>

#include "stock/sweep/sweep_distance.h"
#include "stock_test_support.h"

namespace swarf::stock {
namespace {

double distance_to(const Sweep& sweep, const Vec3& x, const CutterSolid& cutter) {
  const SweepMap map = sweep_map(sweep);
  const Vec3 P = map.start(x), D = map.end(x) - P;
  return swept_distance<double, true>(MovingPoint<double>{P.x(), P.y(), P.z(), D.x(), D.y(), D.z()},
                                      cutter.radius, cutter.height);
}

/// A smooth motion with the axis turning: ticks of about 0.05 mm.
std::vector<ToolPose> curved_motion(uint64_t seed, int ticks) {
  Rng rng(seed);
  const double a = rng.uniform(10, 40), b = rng.uniform(0.5, 2.0), phase = rng.uniform(0, 6);
  std::vector<ToolPose> poses;
  for (int i = 0; i < ticks; ++i) {
    const double s = 0.05 * i;
    const Vec3 axis(0.4 * std::sin(s / a + phase), 0.3 * std::cos(b * s / a), 1.0);
    poses.push_back({{s, 3.0 * std::sin(s / a), b * std::cos(s / a)}, axis.normalized()});
  }
  return poses;
}

TEST(MergeSweeps, StraightMoveBecomesOneSweep) {
  std::vector<ToolPose> poses;
  for (int i = 0; i <= 1000; ++i) poses.push_back({Vec3(1, 2, 3) * (0.001 * i), Vec3::UnitZ()});
  const std::vector<uint8_t> breaks(poses.size(), 0);
  const MergedSweeps merged = merge_sweeps(poses, breaks, 25.0, 1e-6);
  ASSERT_EQ(merged.sweeps.size(), 1u);
  EXPECT_EQ(merged.sweeps.front().block, 1000u);
  EXPECT_LE(merged.error_bound_mm, 1e-12);
}

TEST(MergeSweeps, BreaksAreNotSweptAndBlocksNameTheLastPose) {
  std::vector<ToolPose> poses;
  for (int i = 0; i < 10; ++i) poses.push_back({Vec3(i, i == 7 ? 5 : 0, 0), Vec3::UnitZ()});
  std::vector<uint8_t> breaks(poses.size(), 0);
  breaks[0] = breaks[4] = breaks[7] = breaks[8] = 1;
  const MergedSweeps merged = merge_sweeps(poses, breaks, 25.0, 1e-3);
  ASSERT_EQ(merged.sweeps.size(), 3u);
  EXPECT_EQ(merged.sweeps[0].block, 3u);
  EXPECT_EQ(merged.sweeps[1].start.tip_W.x(), 4.0);
  EXPECT_EQ(merged.sweeps[1].block, 6u);
  EXPECT_EQ(merged.sweeps[2].start.tip_W.x(), 8.0);
  EXPECT_EQ(merged.sweeps[2].block, 9u);
}

TEST(MergeSweeps, FewerThanTwoPoses) {
  EXPECT_TRUE(merge_sweeps({}, {}, 25.0, 1e-3).sweeps.empty());
  const std::vector<ToolPose> one(1);
  const std::vector<uint8_t> breaks{0};
  EXPECT_TRUE(merge_sweeps(one, breaks, 25.0, 1e-3).sweeps.empty());
}

TEST(MergeSweeps, ReversalIsNotCutOff) {
  // Out 10 mm and back to 1 mm: a chord from the first to the last pose would miss the turning point.
  std::vector<ToolPose> poses;
  for (int i = 0; i <= 100; ++i) poses.push_back({Vec3(0.1 * i, 0, 0), Vec3::UnitZ()});
  for (int i = 99; i >= 10; --i) poses.push_back({Vec3(0.1 * i, 0, 0), Vec3::UnitZ()});
  const std::vector<uint8_t> breaks(poses.size(), 0);
  const MergedSweeps merged = merge_sweeps(poses, breaks, 25.0, 1e-3);
  double farthest = 0.0;
  for (const Sweep& sweep : merged.sweeps) farthest = std::max(farthest, sweep.end.tip_W.x());
  EXPECT_GE(farthest, 10.0 - 1e-3);
}

TEST(MergeSweeps, BoundHoldsBothWays) {
  const CutterSolid cutter{5.0, 25.0};
  const double lever = std::hypot(cutter.radius, cutter.height);
  for (const uint64_t seed : {61, 62, 63, 64}) {
    const std::vector<ToolPose> poses = curved_motion(seed, 400);
    const std::vector<uint8_t> breaks(poses.size(), 0);
    std::vector<Sweep> ticks;
    for (uint32_t i = 1; i < poses.size(); ++i) ticks.push_back({poses[i - 1], poses[i], i});
    for (const double tolerance : {5e-4, 2e-3, 1e-2}) {
      const MergedSweeps merged = merge_sweeps(poses, breaks, lever, tolerance);
      EXPECT_LT(merged.sweeps.size(), ticks.size() / 2);
      EXPECT_LE(merged.error_bound_mm, tolerance + 1e-4);
      Rng rng(seed);
      double worst = 0.0;
      for (int n = 0; n < 2000; ++n) {
        // The signed distances to both unions differ by no more than the bound, anywhere near the cutter.
        const ToolPose& pose = poses[rng.next() % poses.size()];
        const Vec3 x = pose.tip_W + 6.0 * rng.direction();
        double merged_distance = 1e9, tick_distance = 1e9;
        for (const Sweep& s : merged.sweeps)
          merged_distance = std::min(merged_distance, distance_to(s, x, cutter));
        for (const Sweep& s : ticks) tick_distance = std::min(tick_distance, distance_to(s, x, cutter));
        if (tick_distance > 1.0) continue;
        worst = std::max(worst, std::abs(merged_distance - tick_distance));
      }
      EXPECT_LE(worst, merged.error_bound_mm) << "seed " << seed << " tolerance " << tolerance;
      EXPECT_GE(worst, 0.001 * merged.error_bound_mm) << "seed " << seed << " tolerance " << tolerance;
    }
  }
}

}  // namespace
}  // namespace swarf::stock
