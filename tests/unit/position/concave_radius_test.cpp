// The narrowest hollow of patches against closed forms, and what a ball does there.
#include <gtest/gtest.h>

#include <cmath>

#include "position/concave_radius.h"
#include "tests/unit/position/patch_scene.h"

namespace swarf::position {
namespace {

TEST(ConcaveRadius, ConvexAndFlatHaveNone) {
  for (const Patch& patch : {dome_patch(), plane_patch({0, 0, 0}, {9, 0, 1}, {0, 9, 2})}) {
    const ConcaveRadius found = smallest_concave_radius({patch});
    EXPECT_EQ(found.patch, -1);
    EXPECT_GE(found.at_least, kFlatRadius_mm);
  }
}

TEST(ConcaveRadius, BowlIsNarrowestAtItsBottom) {
  const ConcaveRadius found = smallest_concave_radius({dome_patch(), quadric_patch(0.02, 0.0, 0.05, 15.0)});
  EXPECT_EQ(found.patch, 1);
  EXPECT_NEAR(found.radius, 20.0, 2.0);
  EXPECT_LE(found.at_least, 20.0);
  EXPECT_GE(found.at_least, 20.0 / 1.11);
  EXPECT_NEAR(found.place_W.y(), 0.0, 8.0);
}

TEST(ConcaveRadius, BoreAndShaft) {
  for (const auto side : {surface::MaterialSide::kConcave, surface::MaterialSide::kConvex}) {
    const Patch patch{surface::cylinder_surface({}, 10.0, 40.0, side)};
    const ConcaveRadius found = smallest_concave_radius({patch});
    if (side == surface::MaterialSide::kConvex) {
      EXPECT_EQ(found.patch, -1);
      continue;
    }
    EXPECT_NEAR(found.radius, 10.0, 1e-9);
    EXPECT_LE(found.at_least, 10.0);
    EXPECT_GE(found.at_least, 8.0);
  }
}

// A ball of the proven radius touches at the bottom, a larger one rides over it.
TEST(ConcaveRadius, LargerBallsRideOver) {
  const Patch bowl = quadric_patch(0.02, 0.0, 0.2, 15.0);
  const ConcaveRadius found = smallest_concave_radius({bowl});
  const PatchTarget target({bowl});
  EXPECT_NEAR(rest_on(target, ball_end(found.at_least), upright(0.0, 0.0)).height, 0.0, kPatchProof_mm);
  EXPECT_GT(rest_on(target, ball_end(1.5 * found.radius), upright(0.0, 0.0)).height, 0.01);
}

}  // namespace
}  // namespace swarf::position
