// Merging cycles of a cutter that is wider than it is long: its rim is what strays.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/run/job_sweeps.h"

namespace swarf::sim {
namespace {

TEST(Lever, TheRimOfAFlatDiscCounts) {
  Scene scene;
  scene.tools.front().diameter_mm = 50.0;
  scene.tools.front().flute_length_mm = 4.0;
  scene.stock.sweep_tolerance_mm = 1e-3;
  // Three poses of a turn about the tip; the one in the middle is off by `stray`, rad.
  for (const double stray : {1e-5, 3e-5, 1e-4, 2e-4}) {
    std::vector<ToolPose> poses;
    for (const double angle : {0.0, 0.01 + stray, 0.02})
      poses.push_back({Vec3::Zero(), Vec3(std::sin(angle), 0.0, std::cos(angle))});
    const stock::MergedSweeps merged = merged_sweeps(poses, scene, scene.stock.sweep_tolerance_mm);
    EXPECT_TRUE(merged.sweeps.size() == 2 || merged.error_bound_mm >= 25.0 * stray)
        << stray << ": " << merged.sweeps.size() << " sweeps, bound " << merged.error_bound_mm;
    EXPECT_LE(merged.error_bound_mm, scene.stock.sweep_tolerance_mm);
  }
}

}  // namespace
}  // namespace swarf::sim
