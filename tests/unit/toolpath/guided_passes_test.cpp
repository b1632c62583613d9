// Guides of the machining modes: they cover their area, no farther apart than asked.
#include <gtest/gtest.h>

#include <cmath>

#include "base/angles.h"
#include "toolpath/driven/driven_path.h"

namespace swarf::toolpath {
namespace {

DrivenPlan plan_of(GuideMode mode) {
  DrivenPlan plan;
  plan.mode = mode;
  plan.area = {Vec2(-20.0, -10.0), Vec2(20.0, 10.0)};
  plan.interval_mm = 3.0;
  return plan;
}

std::vector<GuidedPass> guides(const DrivenPlan& plan) {
  Diagnostics told;
  std::vector<GuidedPass> passes = guided_passes(plan, told);
  EXPECT_FALSE(told.has_errors());
  return passes;
}

/// Every place of the area lies within half the interval of a guide.
void expect_covered(const DrivenPlan& plan, const std::vector<GuidedPass>& passes, double reach) {
  std::vector<Vec2> places;
  for (const GuidedPass& pass : passes)
    for (double x = 0.0; x <= pass.curve.end(); x += 0.05) places.push_back(pass.curve.point(x));
  for (double x = plan.area[0].x(); x <= plan.area[1].x(); x += 0.7) {
    for (double y = plan.area[0].y(); y <= plan.area[1].y(); y += 0.7) {
      double nearest = 1e9;
      for (const Vec2& place : places) nearest = std::min(nearest, (place - Vec2(x, y)).norm());
      ASSERT_LE(nearest, reach) << x << ", " << y;
    }
  }
}

TEST(GuidedPasses, ScanLinesCoverTheAreaAtAnyAngle) {
  for (const double angle : {0.0, 30.0, 90.0, -45.0}) {
    DrivenPlan plan = plan_of(GuideMode::kScan);
    plan.angle_rad = rad_from_deg(angle);
    expect_covered(plan, guides(plan), 3.0);  // the interval, in the corners; half of it between lines
  }
  const std::vector<GuidedPass> passes = guides(plan_of(GuideMode::kScan));
  EXPECT_EQ(passes.size(), 8u);  // 20 mm in seven parts of 2.857
  EXPECT_FALSE(passes[0].joined);
  EXPECT_TRUE(passes[1].joined);
  EXPECT_EQ(passes[0].curve.point(passes[0].curve.end()), passes[1].curve.point(0.0));
}

TEST(GuidedPasses, OneWayScanIsNotJoined) {
  DrivenPlan plan = plan_of(GuideMode::kScan);
  plan.zigzag = false;
  for (const GuidedPass& pass : guides(plan)) {
    EXPECT_FALSE(pass.joined);
    EXPECT_EQ(pass.curve.point(0.0).x(), -20.0);
  }
}

TEST(GuidedPasses, ParallelsToTheBorderEndInItsMiddle) {
  const DrivenPlan plan = plan_of(GuideMode::kContour);
  const std::vector<GuidedPass> passes = guides(plan);
  expect_covered(plan, passes, 2.2);
  EXPECT_EQ(passes.back().curve.point(passes.back().curve.end()), Vec2(10.0, 0.0));
}

TEST(GuidedPasses, SpiralKeepsItsInterval) {
  DrivenPlan plan = plan_of(GuideMode::kSpiral);
  plan.radius_from_mm = 12.0;
  plan.radius_to_mm = 0.0;
  const std::vector<GuidedPass> passes = guides(plan);
  ASSERT_EQ(passes.size(), 1u);
  const GuideCurve& curve = passes[0].curve;
  // A circle, then four turns to the centre.
  EXPECT_NEAR(curve.end(), kTurn * 12.0 + 6.0 * 4.0 * kTurn, 1e-9);
  EXPECT_NEAR(curve.point(kTurn * 12.0).norm(), 12.0, 1e-12);
  EXPECT_NEAR(curve.point(curve.end()).norm(), 0.0, 1e-12);
  for (double x = 0.01; x < curve.end() - 0.02; x += 0.37) {
    const Vec2 difference = (curve.point(x + 1e-6) - curve.point(x - 1e-6)) / 2e-6;
    const bool joint = std::abs(x - kTurn * 12.0) < 1e-5;
    if (!joint) {
      ASSERT_LT((difference - curve.tangent(x)).norm(), 1e-6) << x;
    }
  }
}

TEST(GuidedPasses, AnAreaWithoutExtentIsRefused) {
  DrivenPlan plan = plan_of(GuideMode::kGuide);
  plan.guide = {Vec2(1.0, 1.0), Vec2(1.0, 1.0)};
  Diagnostics told;
  EXPECT_TRUE(guided_passes(plan, told).empty());
  EXPECT_TRUE(told.has_errors());
}

}  // namespace
}  // namespace swarf::toolpath
