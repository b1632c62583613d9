// Passes as one smooth curve: it follows the axis surface, its bounds hold, and its blocks join.
#include "flank/axis_curve.h"

#include <gtest/gtest.h>

#include <cmath>

#include "flank/flank_path.h"
#include "flank_surfaces.h"

namespace swarf::flank {
namespace {

FlankPass pass_over(surface::SurfacePtr surface, double radius, double limit_mm) {
  FlankPass pass;
  pass.task.surface = std::move(surface);
  pass.task.profile.radius = radius;
  pass.task.profile.high = 45.0;
  pass.task.tip_below_mm = 3.0;
  pass.motion.feed_mm_s = 400.0;
  pass.motion.limit_mm = limit_mm;
  pass.motion.on_curve = true;
  return pass;
}

TEST(AxisCurve, StaysBesideTheAxisSurface) {
  FlankPass pass = pass_over(test::jcde(), 3.0, 4e-4);
  pass.task.surface = std::make_shared<surface::NurbsSurface>(
      static_cast<const surface::NurbsSurface&>(*pass.task.surface).grid(), -1);
  plan_pass(pass);
  ASSERT_TRUE(pass.curve);
  const AxisFamily family(pass.task);
  const AxisCurve axis = axis_curve(pass.task, family, pass.motion.chord_mm, {});
  for (int i = 1; i < 400; ++i) {
    const double way = axis.curve->length_mm() * i / 400.0, u = axis.u_of_way.at(way).w;
    const AxisError on = axis_error(pass.task, axis.curve->pose(way), u);
    const AxisError exact = axis_error(pass.task, pose_at(pass.task, u), u);
    EXPECT_NEAR(on.least_mm, exact.least_mm, 1.5 * pass.motion.chord_mm) << u;
    EXPECT_NEAR(on.greatest_mm, exact.greatest_mm, 1.5 * pass.motion.chord_mm) << u;
  }
  // The way is that of the tip.
  double way = 0.0;
  for (int i = 0; i < 20000; ++i)
    way += (axis.curve->pose(axis.curve->length_mm() * (i + 1) / 20000).tip_W -
            axis.curve->pose(axis.curve->length_mm() * i / 20000).tip_W)
               .norm();
  EXPECT_NEAR(way, axis.curve->length_mm(), 1e-3);
}

TEST(AxisCurve, BoundsHoldEverywhere) {
  FlankPass pass = pass_over(test::f1(), 8.0, 0.0);
  plan_pass(pass);
  const toolpath::PoseCurve& curve = *pass.curve;
  const double length = curve.length_mm(), h = 1e-4;
  for (int k = 0; k < 40; ++k) {
    const double from = length * k / 41.0, to = from + length / (2.0 + k);
    const double end = std::min(to, length);
    const toolpath::PoseCurve::Bounds bounds = curve.bounds(from, end);
    for (int i = 1; i < 50; ++i) {
      const double s = from + (end - from) * i / 50.0;
      const ToolPose a = curve.pose(s - h), b = curve.pose(s), c = curve.pose(s + h);
      const Vec3 axis_bend = (c.axis_W - 2.0 * b.axis_W + a.axis_W) / (h * h);
      EXPECT_LE((c.tip_W - a.tip_W).norm() / (2 * h), bounds.tip_rate + 1e-6);
      EXPECT_LE((c.axis_W - a.axis_W).norm() / (2 * h), bounds.axis_rate + 1e-6);
      EXPECT_LE((c.tip_W - 2.0 * b.tip_W + a.tip_W).norm() / (h * h), bounds.tip_bend + 1e-4);
      EXPECT_LE(b.axis_W.cross(axis_bend).norm(), bounds.axis_bend + 1e-4);
    }
  }
}

TEST(AxisCurve, BlocksJoinAndKeepTheirCurve) {
  std::vector<FlankPass> passes{pass_over(test::f1(), 8.0, 2e-3)};
  plan_pass(passes[0]);
  const toolpath::ToolPath path = flank_path(passes, FeedRule::kBisected);
  int on_curve = 0;
  for (size_t i = 1; i < path.elements.size(); ++i) {
    const toolpath::BlockMove before = path.elements.block(i - 1), block = path.elements.block(i);
    if (!block.curve) continue;
    ++on_curve;
    EXPECT_EQ(block.law, toolpath::BlockLaw::kCurve);
    EXPECT_LT((block.to.tip_W - block.curve->curve->pose(block.curve->to).tip_W).norm(), 1e-12);
    if (before.curve) {
      EXPECT_TRUE(toolpath::continues(*before.curve, *block.curve));
    }
  }
  EXPECT_EQ(on_curve, static_cast<int>(passes[0].stations.size()) - 1);
  toolpath::Elements copy;
  copy.append(path.elements, 0, path.elements.size());
  ASSERT_EQ(copy.size(), path.elements.size());
  for (size_t i = 0; i < copy.size(); ++i)
    EXPECT_EQ(copy.block(i).curve.has_value(), path.elements.block(i).curve.has_value());
}

}  // namespace
}  // namespace swarf::flank
