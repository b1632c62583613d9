// Gaps and steps between patches against the distances that they were made with.
#include "position/patch_joints.h"

#include <gtest/gtest.h>

#include "tests/unit/position/patch_scene.h"

namespace swarf::position {
namespace {

constexpr double kReach = 6.0;

/// Two plates of 10 x 8 mm side by side, the second one farther along X and higher.
std::vector<Patch> plates(double gap, double step) {
  return {plane_patch({0, 0, 0}, {10, 0, 0}, {0, 8, 0}),
          plane_patch({10 + gap, 0, step}, {10, 0, 0}, {0, 8, 0})};
}

TEST(PatchJoints, PlatesThatMeetAreJoined) {
  EXPECT_TRUE(open_joints(plates(0, 0), kReach).empty());
  EXPECT_TRUE(open_joints(plates(5e-4, 0), kReach).empty()) << "CAD systems call that joined";
  EXPECT_TRUE(open_joints({dome_patch()}, kReach).empty()) << "a border alone is an end";
}

TEST(PatchJoints, GapsAndStepsAreAsTheyWereMade) {
  for (const double gap : {0.0, 0.002, 0.1, 2.0, 5.9}) {
    for (const double step : {-0.05, 0.0, 0.05, 0.002}) {
      if (gap == 0.0 && step == 0.0) continue;
      const std::vector<OpenJoint> joints = open_joints(plates(gap, step), kReach);
      // 17 places of the border of either; corners that lie straight over one another belong to two borders.
      EXPECT_EQ(joints.size(), gap == 0.0 ? 38U : 34U) << gap << " " << step;
      for (const OpenJoint& joint : joints) {
        EXPECT_NEAR(joint.gap_mm, gap, 1e-12);
        EXPECT_NEAR(joint.step_mm, joint.patch == 0 ? step : -step, 1e-12);
        EXPECT_NEAR(joint.at.x(), joint.patch == 0 ? 10.0 : 10.0 + gap, 1e-12);
      }
    }
  }
  EXPECT_TRUE(open_joints(plates(6.1, 0), kReach).empty()) << "out of reach";
}

TEST(PatchJoints, ABorderMayMeetTheMiddleOfAPatch) {
  // A wall of 4 x 3 mm on a plate, at its middle; and the same .2 mm above it.
  const Patch plate = plane_patch({0, 0, 0}, {10, 0, 0}, {0, 8, 0});
  for (const double above : {0.0, 0.2}) {
    const Patch wall = plane_patch({5, 2, above}, {0, 4, 0}, {0, 0, 3});
    for (const OpenJoint& joint : open_joints({plate, wall}, kReach)) {
      EXPECT_EQ(joint.patch, 1);
      EXPECT_GT(above, 0.0);
      EXPECT_NEAR(joint.gap_mm, 0.2, 1e-12);
    }
    EXPECT_EQ(open_joints({plate, wall}, kReach).empty(), above == 0.0);
  }
}

TEST(PatchJoints, AClosedPatchMeetsItself) {
  constexpr double kRadius = 5.0;
  const auto tube = [](double sweep) {
    surface::Turn turn;
    turn.to_rad = sweep;
    return Patch{surface::cylinder_surface(turn, kRadius, 10.0, surface::MaterialSide::kConvex)};
  };
  EXPECT_TRUE(open_joints({tube(2.0 * kPi)}, kReach).empty());
  const std::vector<OpenJoint> slit = open_joints({tube(2.0 * kPi - 0.1)}, kReach);
  ASSERT_FALSE(slit.empty());
  for (const OpenJoint& joint : slit) EXPECT_NEAR(joint.to.norm(), 2.0 * kRadius * std::sin(0.05), 1e-9);
}

TEST(PatchJoints, CurvedBordersWithOtherParametersAreJoined) {
  // The same parabola as a border, once in half the parameter and once raised by .05 mm in its middle.
  for (const double rise : {0.0, 0.05}) {
    const Patch left = bezier(2, 1, {{0, 0, 0}, {0, 8, 0}, {5, 0, 4}, {5, 8, 4}, {10, 0, 0}, {10, 8, 0}});
    const Patch right =
        bezier(1, 2, {{10, 8, 0}, {5, 8, 4 + 2 * rise}, {0, 8, 0}, {10, 16, 0}, {5, 16, 4}, {0, 16, 0}});
    double widest = 0.0;
    for (const OpenJoint& joint : open_joints({left, right}, kReach))
      widest = std::max(widest, joint.to.norm());
    EXPECT_NEAR(widest, rise, 2e-4) << "square to the apex, which is level";
  }
}

}  // namespace
}  // namespace swarf::position
