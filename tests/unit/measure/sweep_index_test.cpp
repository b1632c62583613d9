// What the tree of sweeps leaves out over a place, against every sweep looked at.
#include "measure/sweep_index.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "stock/rays/ray_height.h"
#include "unit/stock/stock_test_support.h"

namespace swarf::measure {
namespace {

/// Boxes around tilted cutters hold much that lies below their planes.
const Vec3 kTilted = Vec3(0.5, 0.3, 1.0).normalized();

/// A path that wanders on with the axis wobbling, so that groups of sweeps lie close together.
std::vector<stock::Sweep> wandering_path(Rng& rng, uint32_t count) {
  ToolPose pose{Vec3(-20.0, -20.0, 0.0), kTilted};
  Vec3 way = Vec3::UnitX();
  std::vector<stock::Sweep> sweeps;
  for (uint32_t n = 0; n < count; ++n) {
    if (n % 90 == 0)
      way = Vec3(rng.uniform(-1.0, 1.0), rng.uniform(-1.0, 1.0), 0.05 * rng.uniform(-1.0, 1.0));
    ToolPose next = pose;
    next.tip_W += 0.1 * way;
    next.tip_W = next.tip_W.cwiseMax(Vec3(-25.0, -25.0, -2.0)).cwiseMin(Vec3(25.0, 25.0, 2.0));
    next.axis_W = (pose.axis_W + 0.002 * rng.direction()).normalized();
    if (n % 700 == 699) next.axis_W = -next.axis_W;  // from below, for a while
    sweeps.push_back({pose, next, n});
    pose = next;
  }
  return sweeps;
}

TEST(SweepIndex, LeavesOutNoneThatCutsBelowThePlace) {
  Rng rng(733);
  const stock::CutterSolid cutter(5.0, 20.0);
  const std::vector<stock::Sweep> sweeps = wandering_path(rng, 2100);
  const SweepCutters cutters(cutter);
  const SweepIndex index(sweeps, cutters);
  size_t cutting = 0, found = 0, all = 0;
  for (int k = 0; k < 300; ++k) {
    const Vec3 foot(rng.uniform(-25.0, 25.0), rng.uniform(-25.0, 25.0), rng.uniform(-9.0, 0.0));
    const Vec3 normal = (kTilted + rng.uniform(0.0, 0.6) * rng.direction()).normalized();
    const double height = rng.uniform(0.0, 1.5);
    const Vec3 top = foot + height * normal;
    const Box box{top.cwiseMin(foot), top.cwiseMax(foot)};
    std::vector<uint32_t> below, near;
    index.find_below({top, normal}, box, below);
    index.find(box, near);
    EXPECT_TRUE(std::is_sorted(below.begin(), below.end()));
    EXPECT_TRUE(std::includes(near.begin(), near.end(), below.begin(), below.end()));
    found += below.size();
    all += near.size();
    for (const stock::Sweep& sweep : sweeps) {
      const double low = stock::ray_height(foot, normal, sweep, cutter);
      if (low < 0.0 || low >= height) continue;
      ++cutting;
      ASSERT_TRUE(std::binary_search(below.begin(), below.end(), sweep.block))
          << "foot " << stock::text(foot) << " height " << height << " " << stock::text(sweep);
    }
  }
  EXPECT_GT(cutting, 500U);
  // .88 and .94, as compilers order the draws of one call.
  EXPECT_LT(100 * found, 97 * all);
}

/// Of columns side by side: what cuts any of them below its top.
TEST(SweepIndex, LeavesOutNoneThatCutsOneOfSeveralColumns) {
  Rng rng(739);
  constexpr int kColumns = 6;
  const stock::CutterSolid cutter(5.0, 20.0);
  const std::vector<stock::Sweep> sweeps = wandering_path(rng, 2100);
  const SweepIndex index(sweeps, cutter);
  size_t cutting = 0, found = 0, all = 0;
  for (int k = 0; k < 300; ++k) {
    const Vec3 middle(rng.uniform(-25.0, 25.0), rng.uniform(-25.0, 25.0), rng.uniform(-9.0, 0.0));
    const Vec3 mean = (kTilted + rng.uniform(0.0, 0.4) * rng.direction()).normalized();
    const double height = rng.uniform(0.0, 0.5);
    std::vector<Vec3> feet, normals;
    Columns columns{middle + height * mean, mean};
    Box box{columns.top, columns.top};
    for (int n = 0; n < kColumns; ++n) {
      feet.push_back(middle + 0.5 * rng.direction());
      normals.push_back((mean + 0.1 * rng.direction()).normalized());
      const Vec3 top = feet.back() + height * normals.back();
      columns.top_spread = std::max(columns.top_spread, (top - columns.top).norm());
      columns.normal_spread = std::max(columns.normal_spread, (normals.back() - mean).norm());
      box.lower = box.lower.cwiseMin(feet.back()).cwiseMin(top);
      box.upper = box.upper.cwiseMax(feet.back()).cwiseMax(top);
    }
    std::vector<uint32_t> below, near;
    index.find_below(columns, box, below);
    index.find(box, near);
    found += below.size();
    all += near.size();
    for (const stock::Sweep& sweep : sweeps) {
      for (size_t n = 0; n < feet.size(); ++n) {
        const double low = stock::ray_height(feet[n], normals[n], sweep, cutter);
        if (low < 0.0 || low >= height) continue;
        ++cutting;
        ASSERT_TRUE(std::binary_search(below.begin(), below.end(), sweep.block))
            << "foot " << stock::text(feet[n]) << " height " << height << " " << stock::text(sweep);
      }
    }
  }
  EXPECT_GT(cutting, 500U);
  EXPECT_LT(found, all);
}

}  // namespace
}  // namespace swarf::measure
