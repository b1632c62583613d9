// height_in_cylinder() against what is found by trying points, and where the answer is plain.
#include "sim/run/box_height.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"
#include "base/units.h"

namespace swarf::sim {
namespace {

const Box kBox{Vec3(-10, -5, -8), Vec3(20, 15, 4)};

TEST(BoxHeight, AnUprightToolSeesTheUpperFace) {
  const ToolPose over{Vec3(0, 0, -3), Vec3::UnitZ()};
  EXPECT_DOUBLE_EQ(height_in_cylinder(kBox, over, 3.0).value(), 7.0);
  EXPECT_DOUBLE_EQ(height_of_box(kBox, over), 7.0);
  const ToolPose beside{Vec3(24, 0, -3), Vec3::UnitZ()};
  EXPECT_FALSE(height_in_cylinder(kBox, beside, 3.9).has_value());
  EXPECT_DOUBLE_EQ(height_in_cylinder(kBox, beside, 4.1).value(), 7.0);
  EXPECT_DOUBLE_EQ(height_in_cylinder(kBox, {Vec3(0, 0, 9), Vec3::UnitZ()}, 1.0).value(), -5.0);
}

/// By points of a grid over the faces, which come near the highest point and never above it.
TEST(BoxHeight, RandomToolsAgreeWithTriedPoints) {
  Rng rng(7);
  const auto uniform = [&](double low, double high) { return low + (high - low) * rng.uniform(); };
  constexpr int kGrid = 160;
  const double step = kBox.size().maxCoeff() / kGrid;
  int met = 0;
  for (int n = 0; n < 60; ++n) {
    ToolPose pose{Vec3(uniform(-25, 35), uniform(-20, 30), uniform(-20, 15)),
                  Vec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)).normalized()};
    if (n % 4 == 0) pose.axis_W = Vec3::Unit(n / 4 % 3);
    const double radius = uniform(0.5, 12.0);
    double highest = -1e9;
    for (int face = 0; face < 6; ++face)
      for (int a = 0; a <= kGrid; ++a)
        for (int b = 0; b <= kGrid; ++b) {
          const int i = face % 3, j = (i + 1) % 3, k = (i + 2) % 3;
          Vec3 p;
          p[i] = face < 3 ? kBox.lower[i] : kBox.upper[i];
          p[j] = kBox.lower[j] + kBox.size()[j] * a / kGrid;
          p[k] = kBox.lower[k] + kBox.size()[k] * b / kGrid;
          const double up = pose.axis_W.dot(p - pose.tip_W);
          if ((p - pose.tip_W - up * pose.axis_W).norm() <= radius) highest = std::max(highest, up);
        }
    const auto found = height_in_cylinder(kBox, pose, radius);
    if (highest < -1e8) {
      // Only a corner of the cylinder between two points of the grid may have been missed.
      EXPECT_TRUE(!found || !height_in_cylinder(kBox, pose, radius - step)) << n;
      continue;
    }
    ++met;
    ASSERT_TRUE(found.has_value()) << n;
    EXPECT_GE(*found, highest - 1e-9) << n;
    EXPECT_LE(height_in_cylinder(kBox, pose, std::max(radius - step, 1e-3)).value_or(-1e9),
              highest + 2.0 * step)
        << n;
    EXPECT_LE(*found, height_of_box(kBox, pose) + 1e-9) << n;
  }
  EXPECT_GT(met, 20);
}

}  // namespace
}  // namespace swarf::sim
