// Changes of a position: what the cutter touches stays touched.
#include <gtest/gtest.h>

#include <cmath>

#include "avoidance/path_change.h"
#include "base/units.h"
#include "cutter/profile.h"

namespace {

using namespace swarf;
using avoidance::PathChange;

std::vector<cutter::OutlineElement> outline_of(cutter::Shape shape, double corner) {
  cutter::Cutter tool;
  tool.shape = shape;
  tool.diameter_mm = 10.0;
  tool.corner_radius_mm = corner;
  tool.flute_length_mm = 20.0;
  return cutter::outline(tool);
}

const ToolPose kPose{Vec3(3, -2, 7), Vec3(0.6, 0, 0.8)};
const Vec3 kFeed(0.8, 0.3, -0.6);  // not square to the axis

TEST(PathChange, ABallTurnsAboutItsCentre) {
  const auto outline = outline_of(cutter::Shape::kBall, 0.0);
  const ToolPose leaned = avoidance::changed_pose(kPose, kFeed, outline, {rad_from_deg(17.0), 0.0, 0.0});
  EXPECT_LT((leaned.tip_W + 5.0 * leaned.axis_W - kPose.tip_W - 5.0 * kPose.axis_W).norm(), 1e-9);
  EXPECT_NEAR(leaned.axis_W.dot(kPose.axis_W), std::cos(rad_from_deg(17.0)), 1e-12);
}

/// Lead into the feed, tilt to the left of it, and back by the other sign.
TEST(PathChange, LeansAsItIsNamed) {
  const auto outline = outline_of(cutter::Shape::kFlat, 0.0);
  const ToolPose up{Vec3::Zero(), Vec3::UnitZ()};
  const double angle = rad_from_deg(10.0);
  const auto axis = [&](const PathChange& change) {
    return avoidance::changed_pose(up, Vec3(5, 0, 0), outline, change).axis_W;
  };
  EXPECT_LT((axis({angle, 0, 0}) - Vec3(std::sin(angle), 0, std::cos(angle))).norm(), 1e-12);
  EXPECT_LT((axis({-angle, 0, 0}) - Vec3(-std::sin(angle), 0, std::cos(angle))).norm(), 1e-12);
  EXPECT_LT((axis({0, angle, 0}) - Vec3(0, std::sin(angle), std::cos(angle))).norm(), 1e-12);
}

/// A flat end stands on the edge that it leans to: tip + R (1 - cos) d + R sin a.
TEST(PathChange, AFlatEndTurnsAboutItsEdge) {
  const auto outline = outline_of(cutter::Shape::kFlat, 0.0);
  const ToolPose up{Vec3(1, 2, 3), Vec3::UnitZ()};
  const double angle = rad_from_deg(25.0);
  const ToolPose leaned = avoidance::changed_pose(up, Vec3::UnitY(), outline, {0, angle, 0});
  const Vec3 d = -Vec3::UnitX();  // to the left of +Y
  const Vec3 expected = up.tip_W + 5.0 * (1.0 - std::cos(angle)) * d + 5.0 * std::sin(angle) * Vec3::UnitZ();
  EXPECT_LT((leaned.tip_W - expected).norm(), 1e-9);
}

/// The lowest point of a bull nose keeps its height: r below the torus' circle, whatever the lean.
TEST(PathChange, ABullNoseStaysOnItsPlane) {
  const auto outline = outline_of(cutter::Shape::kBullNose, 2.0);
  for (const double degrees : {1.0, 20.0, 44.0}) {
    const double angle = rad_from_deg(degrees);
    const ToolPose leaned =
        avoidance::changed_pose({Vec3::Zero(), Vec3::UnitZ()}, Vec3::UnitX(), outline, {angle, 0, 0});
    const Vec3 out = Vec3(std::cos(angle), 0, -std::sin(angle));
    const Vec3 torus =
        leaned.tip_W + 2.0 * leaned.axis_W + 3.0 * out;  // centre of the corner on the low side
    EXPECT_NEAR(torus.z(), 2.0, 1e-9) << degrees;
    EXPECT_NEAR(torus.x(), 3.0, 1e-9) << degrees;
  }
}

TEST(PathChange, LiftGoesAlongTheGivenAxis) {
  const auto outline = outline_of(cutter::Shape::kBall, 0.0);
  const ToolPose lifted = avoidance::changed_pose(kPose, kFeed, outline, {0, 0, 1.25});
  EXPECT_LT((lifted.tip_W - kPose.tip_W - 1.25 * kPose.axis_W).norm(), 1e-12);
  EXPECT_EQ(lifted.axis_W, kPose.axis_W);
}

}  // namespace
