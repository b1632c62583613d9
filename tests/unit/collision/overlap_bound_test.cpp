// How deep bodies stand in each other, between the cycles too: against closed forms, and no pose of a dense
// row is deeper than what is proven.
#include "collision/overlap_bound.h"

#include <gtest/gtest.h>

#include "base/angles.h"
#include "collision/greatest_depth.h"
#include "unit/collision/toy_machine.h"

namespace swarf::collision {
namespace {

struct DepthCase {
  machine::MachineScene scene = toy_machine();
  Body still, moving;

  DepthRange over(const std::vector<AxisValues>& places, size_t budget = 20000) const {
    std::vector<PathPose> poses(places.size());
    for (size_t i = 0; i < places.size(); ++i) poses[i].q = places[i];
    const BodyDepth in_still(still), in_moving(moving);
    return depth_over(encounter(scene, still, moving), in_still, in_moving, poses, 0, poses.size() - 1,
                      budget);
  }
};

Body floor_block(const Vec3& low, const Vec3& high) {
  return mesh_body("still", BodyKind::kLink, kColumn, box_mesh(low, high));
}

/// The deepest corner of the moving body in the still one, and of the still one in it.
double deepest_corner(const Encounter& pair, const BodyDepth& in_a, const BodyDepth& in_b,
                      const AxisValues& q) {
  double deepest = 0.0;
  const auto look = [&](const Body& of, const BodyDepth& in, const Pose& carried) {
    for (const Triangle& triangle : of.triangles)
      for (const Vec3& corner : triangle) deepest = std::max(deepest, in.depth(carried * corner));
    for (const RevolvedSolid& solid : of.solids)
      for (const Vec2& corner : solid.corners)
        for (int i = 0; i < 24; ++i) {
          const Vec3 x = solid.axis.unitOrthogonal(), y = solid.axis.cross(x);
          const double turn = kTurn * i / 24.0;
          deepest = std::max(
              deepest, in.depth(carried * Vec3(solid.foot + corner.y() * solid.axis +
                                               corner.x() * (std::cos(turn) * x + std::sin(turn) * y))));
        }
  };
  look(*pair.b, in_a, pair.b_from_a.pose(q));
  look(*pair.a, in_b, pair.a_from_b.pose(q));
  return deepest;
}

/// A block dips 2.5 mm into a face between two cycles of a V; at the cycles themselves it stands clear.
TEST(OverlapBound, TheDeepestPlaceLiesBetweenTheCycles) {
  DepthCase dip{toy_machine(), floor_block({-50, -50, -20}, {50, 50, 0}),
                mesh_body("moving", BodyKind::kLink, kZSlide, box_mesh({-4, -3, 10}, {4, 3, 30}))};
  const DepthRange found = dip.over({axes(-10), axes(0, 0, -12.5), axes(10)});
  EXPECT_NEAR(found.seen_mm, 2.5, 0.02);
  EXPECT_GE(found.bound_mm, 2.5);
  EXPECT_LE(found.bound_mm, 2.5 + 2.0 * kDepthTolerance);
  EXPECT_NEAR(found.at, 1.0, 0.01);
}

/// A long slide at one depth is as cheap as standing there.
TEST(OverlapBound, ASlideAlongAFaceKeepsItsDepth) {
  const DepthCase slide{
      toy_machine(), floor_block({-200, -50, -20}, {200, 50, 0}),
      mesh_body("moving", BodyKind::kLink, kZSlide, box_mesh({-4, -3, -1.25F}, {4, 3, 30}))};
  std::vector<AxisValues> places;
  for (int k = 0; k <= 1000; ++k) places.push_back(axes(-100.0 + 0.2 * k));
  const DepthRange found = slide.over(places, 8192);
  EXPECT_NEAR(found.seen_mm, 1.25, 0.02);
  EXPECT_GE(found.bound_mm, 1.25);
  EXPECT_LE(found.bound_mm, 1.3);
}

/// A cylinder across an edge, no corner of either in the other: as deep as its circle reaches into the block.
TEST(OverlapBound, ACylinderAcrossAnEdgeHasNoCornerInside) {
  const DepthCase across{toy_machine(), floor_block({0, -50, -20}, {50, 50, 20}),
                         solid_body("moving", BodyKind::kToolPart, kZSlide,
                                    {frustum(Vec3(-10, 0, -60), Vec3::UnitZ(), 0.0, 120.0, 5.0, 5.0)})};
  const DepthRange found = across.over({axes(0), axes(6), axes(0)});
  EXPECT_NEAR(found.seen_mm, 1.0, 0.02);
  EXPECT_GE(found.bound_mm, 1.0);
  EXPECT_LE(found.bound_mm, 1.0 + 2.0 * kDepthTolerance);
}

/// A needle on the table turns through a wall: its tip is deepest where the circle is farthest behind it.
TEST(OverlapBound, ATurnIsDeepestInItsMiddle) {
  DepthCase turn{toy_machine(), floor_block({95, -80, -20}, {200, 80, 20}),
                 mesh_body("moving", BodyKind::kFixture, kTable, box_mesh({0, -0.5, -1}, {100, 0.5, 1}))};
  const DepthRange found = turn.over({axes(0, 0, 0, 0, -0.6), axes(0, 0, 0, 0, 0.6)});
  EXPECT_NEAR(found.seen_mm, 5.0, 0.02);  // the middle of its end, and sqrt(100^2 + .5^2) at its corners
  EXPECT_GE(found.bound_mm, 5.0);
  EXPECT_LE(found.bound_mm, 5.0 + 3.0 * kDepthTolerance);
}

TEST(OverlapBound, NoPoseIsDeeperThanWhatIsProven) {
  for (int i = 0; i < 60; ++i) {
    Rng rng(4000 + i);
    DepthCase any{toy_machine(), floor_block({-20, -15, -10}, {20, 15, 10}), {}};
    any.moving = i % 2 == 0
                     ? mesh_body("moving", BodyKind::kLink, kZSlide, bumpy_ball(Vec3::Zero(), 8.0, 5, 7, rng))
                     : solid_body("moving", BodyKind::kToolPart, kZSlide,
                                  {frustum(Vec3::Zero(), rng.direction(), 0.0, 12.0, 3.0, 6.0)});
    std::vector<AxisValues> places;
    for (int k = 0; k < 4; ++k)
      places.push_back(axes(rng.uniform(-25, 25), rng.uniform(-20, 20), rng.uniform(-15, 15),
                            rng.uniform(-0.5, 0.5), rng.uniform(-0.5, 0.5)));
    const DepthRange found = any.over(places, 3000);
    const Encounter pair = encounter(any.scene, any.still, any.moving);
    const BodyDepth in_still(any.still), in_moving(any.moving);
    for (size_t w = 0; w + 1 < places.size(); ++w)
      for (int s = 0; s <= 20; ++s) {
        const AxisValues q = way(places[w], places[w + 1]).at(s / 20.0);
        ASSERT_LE(deepest_corner(pair, in_still, in_moving, q), found.bound_mm + 1e-9) << "seed " << 4000 + i;
      }
    ASSERT_LE(found.seen_mm, found.bound_mm);
  }
}

/// Two bars that cross: edges alone, no corner of either in the other.
TEST(OverlapBound, BarsThatCrossAreAsDeepAsTheThinner) {
  const DepthCase cross{toy_machine(), floor_block({-50, -5, -5}, {50, 5, 5}),
                        mesh_body("moving", BodyKind::kLink, kZSlide, box_mesh({-4, -50, -4}, {4, 50, 4}))};
  const BodyDepth in_still(cross.still), in_moving(cross.moving);
  const Depth found =
      deepest_overlap(encounter(cross.scene, cross.still, cross.moving), in_still, in_moving, axes(0));
  EXPECT_NEAR(found.depth_mm, 5.0, 0.02);
}

/// A cylinder goes through a plate of 8 mm on a long way: half the plate's thickness all the while, and no
/// deeper.
TEST(OverlapBound, ALongWayThroughAPlateIsHalfItsThicknessDeep) {
  const DepthCase plate{toy_machine(), floor_block({-200, -50, -8}, {200, 50, 0}),
                        solid_body("moving", BodyKind::kToolPart, kZSlide,
                                   {frustum(Vec3(0, 0, -20), Vec3::UnitZ(), 0.0, 60.0, 3.0, 3.0)})};
  std::vector<AxisValues> places;
  for (int k = 0; k <= 1000; ++k) places.push_back(axes(-100.0 + 0.2 * k, 0.01 * k));
  const DepthRange found = plate.over(places, 8192);
  EXPECT_NEAR(found.seen_mm, 4.0, 0.02);
  EXPECT_GE(found.bound_mm, found.seen_mm);
  EXPECT_LE(found.bound_mm, 4.001);
}

/// The ball that fits: of a cone, a rod, a disc; of boxes half their least side.
TEST(GreatestDepth, IsTheRadiusOfTheBallThatFits) {
  const auto of_frustum = [](double low, double high, double height) {
    return greatest_depth(solid_body("solid", BodyKind::kToolPart, -1,
                                     {frustum(Vec3(3, 4, 5), Vec3(2, 1, 2) / 3.0, 0.0, height, low, high)}));
  };
  EXPECT_NEAR(of_frustum(5.0, 0.0, 12.0), 60.0 / 18.0, 1e-12);
  EXPECT_NEAR(of_frustum(0.0, 5.0, 12.0), 60.0 / 18.0, 1e-12);
  EXPECT_NEAR(of_frustum(3.0, 3.0, 120.0), 3.0, 1e-12);
  EXPECT_NEAR(of_frustum(10.0, 10.0, 2.0), 1.0, 1e-12);
  const TriMesh box = box_mesh({-5, -10, -4}, {5, 10, 4});
  Pose turned = Pose::Identity();
  turned.linear() = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  EXPECT_NEAR(greatest_depth(mesh_body("box", BodyKind::kFixture, -1, box, turned)), 4.0, 2e-5);
}

/// A sheet has no inside, but may lie in a solid.
TEST(OverlapBound, NothingLiesInASheet) {
  TriMesh sheet = box_mesh({-1, -1, -3}, {1, 1, 5});
  sheet.triangles.resize(2);  // its foot
  const DepthCase in_block{toy_machine(), floor_block({-20, -15, -10}, {20, 15, 0}),
                           mesh_body("moving", BodyKind::kLink, kZSlide, sheet)};
  const DepthRange found = in_block.over({axes(0), axes(0)});
  EXPECT_NEAR(found.seen_mm, 3.0, 0.02);
  EXPECT_LE(found.bound_mm, 3.02);
}

}  // namespace
}  // namespace swarf::collision
