// Lead and tilt: where the tool stands in contact.
#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"
#include "base/units.h"
#include "toolpath/orientation.h"
#include "toolpath/tool_path.h"

namespace swarf::toolpath {
namespace {

constexpr double kRadius = 5.0;

struct Contact {
  Vec3 point, normal, feed;
};
Contact random_contact(Rng& rng) {
  Contact c;
  c.point = 50.0 * rng.direction();
  c.normal = rng.direction();
  c.feed = c.normal.cross(rng.direction()).normalized();
  return c;
}

TEST(PoseInContact, WithoutLeanTheTipCentreTouches) {
  const ToolPose pose = pose_in_contact({1, 2, 3}, Vec3::UnitZ(), Vec3::UnitX(), 0.0, 0.0, {kRadius});
  EXPECT_EQ(pose.tip_W, Vec3(1, 2, 3));
  EXPECT_EQ(pose.axis_W, Vec3(Vec3::UnitZ()));
}

TEST(PoseInContact, LeadPutsTheContactOnTheFrontOfTheRim) {
  const double phi = rad_from_deg(10.0);
  const Vec3 contact(1, 2, 3);
  const ToolPose pose = pose_in_contact(contact, Vec3::UnitZ(), Vec3::UnitX(), phi, 0.0, {kRadius});
  EXPECT_LT((pose.axis_W - Vec3(std::sin(phi), 0, std::cos(phi))).norm(), 1e-15);
  EXPECT_LT((contact - pose.tip_W - kRadius * Vec3(std::cos(phi), 0, -std::sin(phi))).norm(), 1e-14);
}

TEST(PoseInContact, TiltLeansToTheLeftOfTheFeed) {
  const double angle = rad_from_deg(10.0);
  const ToolPose pose = pose_in_contact(Vec3::Zero(), Vec3::UnitZ(), Vec3::UnitX(), 0.0, angle, {kRadius});
  EXPECT_LT((pose.axis_W - Vec3(0, std::sin(angle), std::cos(angle))).norm(), 1e-15);
}

TEST(PoseInContact, TheContactIsTheLowestPointOfTheBottomForAnyLean) {
  Rng rng(5);
  for (int i = 0; i < 500; ++i) {
    const Contact c = random_contact(rng);
    const double lead = rng.uniform(-0.6, 0.6);
    const double tilt = rng.uniform(-0.6, 0.6);
    const ToolPose pose = pose_in_contact(c.point, c.normal, c.feed, lead, tilt, {kRadius});
    const Vec3 to_contact = c.point - pose.tip_W;
    EXPECT_NEAR(pose.axis_W.norm(), 1.0, 1e-14);
    EXPECT_NEAR(to_contact.norm(), kRadius, 1e-12);
    EXPECT_NEAR(to_contact.dot(pose.axis_W), 0.0, 1e-12);
    const Vec3 side = pose.axis_W.unitOrthogonal();
    for (int k = 0; k < 36; ++k) {
      const Vec3 rim = pose.tip_W + kRadius * (Eigen::AngleAxisd(k * kPi / 18, pose.axis_W) * side);
      EXPECT_GT((rim - c.point).dot(c.normal), -1e-12) << "lead " << lead << " tilt " << tilt;
    }
    const Lean lean = lean_of(lead, tilt);
    EXPECT_NEAR(std::cos(lean.angle), pose.axis_W.dot(c.normal), 1e-12);
    const Vec3 towards = std::cos(lean.yaw) * c.feed + std::sin(lean.yaw) * c.normal.cross(c.feed);
    EXPECT_NEAR(std::sin(lean.angle), pose.axis_W.dot(towards), 1e-12);
  }
}

/// Distance of the rounded end from the surface's tangent plane: the deepest place of the corner's tube.
TEST(PoseInContact, ARoundCornerTouchesThePlaneAndStaysAboveIt) {
  Rng rng(6);
  for (int i = 0; i < 500; ++i) {
    const Contact c = random_contact(rng);
    const ContactEnd end{i % 3 == 0 ? 0.0 : rng.uniform(0.5, 6.0), rng.uniform(0.2, 4.0)};
    const ToolPose pose =
        pose_in_contact(c.point, c.normal, c.feed, rng.uniform(-0.6, 0.6), rng.uniform(-0.6, 0.6), end);
    // Centres of the corner lie on a circle round the axis; a sphere about the lowest of them is in contact.
    const Vec3 middle = pose.tip_W + end.corner_mm * pose.axis_W;
    const Vec3 side = pose.axis_W.unitOrthogonal();
    double lowest = 1e9;
    for (int k = 0; k < 3600; ++k) {
      const Vec3 centre = middle + end.flat_mm * (Eigen::AngleAxisd(k * kPi / 1800, pose.axis_W) * side);
      lowest = std::min(lowest, (centre - c.point).dot(c.normal) - end.corner_mm);
    }
    EXPECT_NEAR(lowest, 0.0, 1e-5) << i;  // 6 mm (pi/3600)^2/2
    EXPECT_GT(lowest, -1e-12) << i;
    const Vec3 to_axis = c.point + end.corner_mm * c.normal - middle;
    EXPECT_NEAR(to_axis.norm(), end.flat_mm, 1e-12) << i;
    EXPECT_NEAR(to_axis.dot(pose.axis_W), 0.0, 1e-12) << i;
  }
}

}  // namespace
}  // namespace swarf::toolpath
