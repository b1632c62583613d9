// The tool at rest on surface patches, against closed forms (theory 3) and against sampling.
#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"
#include "tests/unit/position/patch_scene.h"

namespace swarf::position {
namespace {

/// Nothing in this file may be off by more: the proof's own bound.
constexpr double kNear_mm = kPatchProof_mm;

surface::Turn turn_about(const Vec3& base, const Vec3& axis) {
  surface::Turn turn;
  turn.base_W = base;
  turn.axis_W = axis;
  return turn;
}

Patch sphere_patch(double radius) {
  return {surface::sphere_surface(turn_about(Vec3::Zero(), Vec3::UnitX()), radius, 0.05, kPi - 0.05,
                                  surface::MaterialSide::kConvex)};
}

/// The height, proven and without having given up.
double proven(const PatchTarget& target, const ToolProfile& profile, const GuideLine& line) {
  PatchWork work;
  const Rest rest = rest_on(target, profile, line, &work);
  EXPECT_LE(work.gap, kPatchProof_mm);
  return rest.height;
}

TEST(PatchTarget, BallOnSphere) {
  const PatchTarget target({sphere_patch(20.0)});
  const ToolProfile ball = ball_end(5.0);
  EXPECT_NEAR(proven(target, ball, upright(0.0, 0.0)), 20.0, kNear_mm);
  EXPECT_NEAR(proven(target, ball, upright(6.0, 0.0)), 19.269322199, kNear_mm);
  EXPECT_NEAR(proven(target, ball, upright(0.0, 12.5)), 16.650635095, kNear_mm);
}

TEST(PatchTarget, FlatAndBullNoseOnSphere) {
  const PatchTarget target({sphere_patch(20.0)});
  // The flat passes over the top; beyond, the rim itself or the corner touches.
  EXPECT_NEAR(proven(target, flat_end(5.0), upright(3.0, 1.0)), 20.0, kNear_mm);
  EXPECT_NEAR(proven(target, flat_end(5.0), upright(12.0, 0.0)), std::sqrt(400.0 - 49.0), kNear_mm);
  const double m = 9.0 - 3.0;
  EXPECT_NEAR(proven(target, nose_end(3.0, 2.0), upright(0.0, 9.0)), -2.0 + std::sqrt(22.0 * 22.0 - m * m),
              kNear_mm);
}

TEST(PatchTarget, PlaneOfTwentyDegrees) {
  const double slope = std::tan(rad_from_deg(20.0));
  const PatchTarget target({plane_patch({-30, -30, -30 * slope}, {60, 0, 60 * slope}, {0, 60, 0})});
  const double x = 3.7, h = x * slope;
  EXPECT_NEAR(proven(target, nose_end(3.0, 2.0), upright(x, 2.0)) - h, 1.220266248, kNear_mm);
  EXPECT_NEAR(proven(target, ball_end(5.0), upright(x, 2.0)) - h, 5.0 / std::cos(std::atan(slope)) - 5.0,
              kNear_mm);
  EXPECT_NEAR(proven(target, flat_end(5.0), upright(x, 2.0)) - h, 5.0 * slope, kNear_mm);
  // Steeper and less steep than the plane.
  EXPECT_NEAR(proven(target, pointed(5.0, 0.5), upright(x, 2.0)) - h, 0.0, kNear_mm);
  EXPECT_NEAR(proven(target, pointed(5.0, 0.2), upright(x, 2.0)) - h, 5.0 * (slope - 0.2), kNear_mm);
}

TEST(PatchTarget, LevelPlaneUnderAFlatEndEnds) {
  const PatchTarget target({plane_patch({-30, -30, 7}, {60, 0, 0}, {0, 60, 0})});
  PatchWork work;
  EXPECT_EQ(rest_on(target, flat_end(5.0), upright(1.0, 2.0), &work).height, 7.0);
  EXPECT_LT(work.cells, 20);
}

TEST(PatchTarget, EdgesAndCornersOfAPatch) {
  const PatchTarget target({plane_patch({0, 0, 3}, {20, 0, 0}, {0, 20, 0})});
  const Rest edge = rest_on(target, ball_end(5.0), upright(-3.0, 8.0));
  EXPECT_NEAR(edge.height, 3.0 - (5.0 - 4.0), kNear_mm);
  EXPECT_EQ(edge.what, Touched::kEdge);
  EXPECT_NEAR(edge.contact_W.y(), 8.0, 1e-3);
  const Rest corner = rest_on(target, ball_end(5.0), upright(-2.0, 22.0));
  EXPECT_NEAR(corner.height, 3.0 - (5.0 - std::sqrt(25.0 - 8.0)), kNear_mm);
  EXPECT_EQ(corner.what, Touched::kVertex);
  EXPECT_FALSE(rest_on(target, ball_end(5.0), upright(-5.1, 8.0)).touches());
}

TEST(PatchTarget, CylinderBySmallAndLargeBalls) {
  // A bore of radius 10 along y: z = 10 - sqrt(100 - x^2) within 8.
  const Patch bore{surface::cylinder_surface(
      [] {
        surface::Turn turn = turn_about({0, -30, 0}, Vec3::UnitY());
        turn.from_rad = kPi * 0.2;
        turn.to_rad = kPi * 0.8;
        return turn;
      }(),
      10.0, 60.0, surface::MaterialSide::kConcave)};
  const PatchTarget target({bore});
  // x_W of the turn is (1,0,0); y_W = axis x x_W = (0,0,-1): the lower half of the cylinder.
  const double lowest = -10.0;
  EXPECT_NEAR(proven(target, ball_end(5.0), upright(0.0, 0.0)), lowest, kNear_mm);
  EXPECT_NEAR(proven(target, ball_end(5.0), upright(2.0, 1.0)), -std::sqrt(25.0 - 4.0) - 5.0, kNear_mm);
  // Larger than the bore: it hangs in the two edges, 10 cos(36 deg) to each side.
  const double half = 10.0 * std::cos(0.2 * kPi), edge = -10.0 * std::sin(0.2 * kPi);
  EXPECT_NEAR(proven(target, ball_end(12.0), upright(0.0, 0.0)),
              edge - (12.0 - std::sqrt(144.0 - half * half)), kNear_mm);
  // As large as the bore: touches along a whole arc.
  EXPECT_NEAR(proven(target, ball_end(10.0), upright(0.0, 0.0)), -10.0, kNear_mm);
  EXPECT_NEAR(proven(target, flat_end(4.0), upright(0.0, 0.0)), -std::sqrt(100.0 - 16.0), kNear_mm);
}

TEST(PatchTarget, SaddleIsItsParallelSurfaceForABall) {
  const double a = 0.03, c = -0.05, r = 5.0;
  const PatchTarget target({quadric_patch(a, 0.01, c, 25.0)});
  for (const Vec2& at : {Vec2(0.0, 0.0), Vec2(3.0, -4.0), Vec2(-7.0, 6.0)}) {
    // The contact is chosen; the tool's place follows from the normal there.
    const double x = at.x(), y = at.y(), z = 0.5 * a * x * x + 0.01 * x * y + 0.5 * c * y * y;
    const Vec3 normal = Vec3(-a * x - 0.01 * y, -c * y - 0.01 * x, 1.0).normalized();
    const Vec3 tip = Vec3(x, y, z) + r * normal - Vec3(0, 0, r);
    EXPECT_NEAR(proven(target, ball_end(r), upright(tip.x(), tip.y())), tip.z(), kNear_mm);
  }
}

TEST(PatchTarget, StepHoldsTheRimAtItsUpperEdge) {
  const PatchTarget target({plane_patch({-40, -40, 0}, {40, 0, 0}, {0, 80, 0}),
                            plane_patch({0, -40, 0}, {0, 80, 0}, {0, 0, 10}),
                            plane_patch({0, -40, 10}, {40, 0, 0}, {0, 80, 0})});
  EXPECT_NEAR(proven(target, flat_end(5.0), upright(-5.0, 3.0)), 10.0, kNear_mm);
  EXPECT_NEAR(proven(target, flat_end(5.0), upright(-5.00001, 3.0)), 0.0, kNear_mm);
  EXPECT_NEAR(proven(target, flat_end(5.0), upright(-4.99999, 3.0)), 10.0, kNear_mm);
  EXPECT_NEAR(proven(target, ball_end(5.0), upright(-3.0, 3.0)), 9.0, kNear_mm);
  EXPECT_NEAR(proven(target, ball_end(5.0), upright(-4.9, 3.0)), 5.0 + std::sqrt(25.0 - 4.9 * 4.9), kNear_mm);
}

TEST(PatchTarget, ConcaveCornerHoldsABallOnBothSides) {
  // Two planes of 30 degrees that meet in a valley: the ball rests on both.
  const double slope = std::tan(rad_from_deg(30.0));
  const PatchTarget target({plane_patch({-40, -40, 40 * slope}, {40, 0, -40 * slope}, {0, 80, 0}),
                            plane_patch({0, -40, 0}, {40, 0, 40 * slope}, {0, 80, 0})});
  EXPECT_NEAR(proven(target, ball_end(5.0), upright(0.0, 0.0)), 5.0 / std::cos(rad_from_deg(30.0)) - 5.0,
              kNear_mm);
  EXPECT_NEAR(proven(target, flat_end(5.0), upright(0.0, 0.0)), 5.0 * slope, kNear_mm);
}

TEST(PatchTarget, GapNarrowerThanTheTip) {
  const PatchTarget target({plane_patch({-40, -40, 0}, {39.9, 0, 0}, {0, 80, 0}),
                            plane_patch({0.1, -40, 0}, {39.9, 0, 0}, {0, 80, 0})});
  EXPECT_NEAR(proven(target, ball_end(5.0), upright(0.0, 0.0)), -(5.0 - std::sqrt(25.0 - 0.01)), 1e-9);
  EXPECT_EQ(proven(target, flat_end(5.0), upright(0.0, 0.0)), 0.0);
}

// A wall beside the tool is left out by one line that parts them, however near the flank comes to it: a step
// would else cost thousands of cells in a cycle.
TEST(PatchTarget, AWallAtTheFlankCostsFewCells) {
  const PatchTarget target({plane_patch({0, -15, 4.5}, {-16, 0, 0}, {0, 30, 0}),
                            plane_patch({0, -15, 0.5}, {0, 0, 4}, {0, 30, 0}),
                            plane_patch({0, -15, 0.5}, {18, 0, 0}, {0, 30, 0})});
  for (const ToolProfile& tool : {ball_end(3.0), nose_end(3.0, 2.0), flat_end(5.0)})
    for (const double beyond : {1e-1, 1e-4, 1e-7, 1.1e-9, 0.0, -1e-12, -1e-9, -1e-7, -1e-4}) {
      Rest rest;
      PatchHint near;
      PatchWork work;
      target.raise(tool, upright(tool.radius() + beyond, 1.7), rest, near, work);
      EXPECT_LE(work.cells, 100) << tool.radius() << " mm, " << beyond << " mm from the flank";
      EXPECT_EQ(work.gap, kPatchProof_mm);
      if (beyond > kRim_mm) {
        EXPECT_NEAR(rest.height, 0.5, 1e-9) << beyond;
      } else {
        EXPECT_GT(rest.height, 0.5) << beyond;
      }
    }
}

// The same of walls that bend along the flank, to either side: by the quadratic form of the squared distance.
TEST(PatchTarget, ABentWallAtTheFlankCostsFewCells) {
  for (const double side : {1.0, -1.0}) {
    // x = side y^2 / 40 over |y| <= 15, 4 mm high
    const double bulge = side * 225.0 / 40.0;
    const PatchTarget target(
        {polynomial(
             2, 1,
             {{bulge, -15, 0}, {0, 0, 4}, {-4 * bulge, 30, 0}, {0, 0, 0}, {4 * bulge, 0, 0}, {0, 0, 0}}),
         plane_patch({-30, -30, 0}, {60, 0, 0}, {0, 60, 0})});
    for (const ToolProfile& tool : {ball_end(3.0), nose_end(3.0, 2.0), flat_end(5.0)})
      for (const double beyond : {1e-1, 1e-3, 1e-5, 1e-7, 2e-9, 0.0, -1e-9, -1e-5, -1e-3}) {
        Rest rest;
        PatchHint near;
        PatchWork work;
        target.raise(tool, upright(-side * (tool.radius() + beyond), 0.0), rest, near, work);
        EXPECT_LE(work.cells, 100) << side << ": " << tool.radius() << " mm, " << beyond
                                   << " mm from the flank";
        EXPECT_EQ(work.gap, kPatchProof_mm);
        if (beyond > kRim_mm) {
          EXPECT_NEAR(rest.height, 0.0, 1e-9) << beyond;
        } else {
          EXPECT_GT(rest.height, 0.9) << beyond;
        }
      }
  }
}

TEST(PatchTarget, NothingUnderTheTool) {
  const PatchTarget none(std::vector<Patch>{});
  EXPECT_FALSE(rest_on(none, ball_end(5.0), upright(0.0, 0.0)).touches());
  const PatchTarget target({dome_patch()});
  EXPECT_FALSE(rest_on(target, ball_end(5.0), upright(200.0, 0.0)).touches());
}

}  // namespace
}  // namespace swarf::position
