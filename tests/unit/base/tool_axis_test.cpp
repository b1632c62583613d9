#include "base/tool_axis.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"

namespace swarf {
namespace {

TEST(Slerp, StaysOnTheGreatCircle) {
  Rng rng(3);
  for (int i = 0; i < 200; ++i) {
    const Vec3 a = rng.direction(), b = i % 10 == 0 ? Vec3(-a) : rng.direction();
    const double x = rng.uniform();
    const Vec3 c = slerp(a, b, x);
    EXPECT_NEAR(c.norm(), 1.0, 1e-15);
    const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
    EXPECT_NEAR(std::atan2(a.cross(c).norm(), a.dot(c)), x * angle, 1e-12);
    EXPECT_LT((slerp(a, b, 1.0) - b).norm(), 1e-12);
  }
  EXPECT_EQ(slerp(Vec3::UnitX(), Vec3::UnitX(), 0.3), Vec3(Vec3::UnitX()));
}

TEST(Slerp, OppositeAxesTurnAboutTheDirectionLeastAlongThem) {
  const Vec3 half = slerp(Vec3::UnitZ(), -Vec3::UnitZ(), 0.5);
  EXPECT_LT((half - Vec3::UnitX()).norm(), 1e-15);
  const ToolPose from{{1, 2, 3}, Vec3::UnitZ()}, to{{3, 2, -1}, -Vec3::UnitZ()};
  const ToolPose pose = pose_between(from, to, 0.5);
  EXPECT_EQ(pose.tip_W, Vec3(2, 2, 1));
  EXPECT_LT((pose.axis_W - half).norm(), 1e-15);
}

}  // namespace
}  // namespace swarf
