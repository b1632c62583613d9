// align_points() and best_fit() give a known motion back.
#include "measure/alignment.h"

#include <gtest/gtest.h>

#include "base/diagnostics.h"
#include "support/solids.h"

namespace swarf::measure {
namespace {

Pose motion(double angle, const Vec3& axis, const Vec3& shift) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  pose.translation() = shift;
  return pose;
}

/// A block with a boss away from its middle: no motion but the identity brings it onto itself.
TriMesh bossed() {
  return test::towers({-20, -10, -2, 3, 20}, {-15, -4, 6, 15}, 0.0,
                      [](int i, int j) { return i == 2 && j == 1 ? 17.0 : 10.0; });
}

TEST(Alignment, ThreePairsGiveTheMotionBack) {
  const Pose pose = motion(2.5, {1, -2, 0.5}, {30, -7, 120});
  std::vector<PointPair> pairs;
  for (const Vec3& p : {Vec3(0, 0, 0), Vec3(40, 1, 2), Vec3(3, 25, -4)}) pairs.emplace_back(p, pose * p);
  const Alignment found = align_points(pairs);
  EXPECT_LT((found.X_design_stock.matrix() - pose.matrix()).norm(), 1e-12 * 150.0);
  EXPECT_LT(found.rms_mm, 1e-12);
  EXPECT_GT(found.rms_before_mm, 100.0);
  EXPECT_GT(found.X_design_stock.linear().determinant(), 0.0);
}

TEST(Alignment, PairsThatDisagreeSayByHowMuch) {
  std::vector<PointPair> pairs{
      {Vec3(0, 0, 0), Vec3(0, 0, 0)}, {Vec3(10, 0, 0), Vec3(10.2, 0, 0)}, {Vec3(0, 10, 0), Vec3(0, 10, 0)}};
  const double rms = align_points(pairs).rms_mm;
  EXPECT_GT(rms, 0.02);
  EXPECT_LT(rms, 0.2);
}

TEST(Alignment, PointsOnALineAreRefused) {
  const auto code = [](const std::vector<PointPair>& pairs) {
    try {
      align_points(pairs);
    } catch (const InputError& error) {
      return error.diagnostics.list().front().code;
    }
    return std::string("none");
  };
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), o = Vec3::Zero();
  EXPECT_EQ(code({{o, o}, {x, x}, {2 * x, 2 * x}}), "points-on-a-line");
  EXPECT_EQ(code({{o, o}, {x, x}, {y, 2 * x}}), "points-on-a-line");
  EXPECT_EQ(code({{o, o}, {o, o}, {o, o}}), "points-on-a-line");
  EXPECT_EQ(code({{o, o}, {x, x}}), "points-on-a-line");
  EXPECT_EQ(code({{o, o}, {x, x}, {y, y}}), "none");
}

/// 0.1 um: floats of 40 mm.
TEST(Alignment, BestFitGivesTheMotionBack) {
  const TriMesh part = bossed();
  const mesh::SignedDistance design(part);
  for (const double angle : {0.0, 0.02, -0.08}) {
    const Pose pose = motion(angle, {1, 2, -1}, {0.8, -0.5, 0.3});
    const mesh::SignedDistance stock(moved(part, pose.inverse()));
    const Alignment found = best_fit(stock, design, Pose::Identity());
    EXPECT_LT((found.X_design_stock.matrix() - pose.matrix()).norm(), 1e-4) << angle << ": " << found.steps;
    EXPECT_LT(found.rms_mm, 1e-4);
    EXPECT_GT(found.rms_before_mm, 0.1);
  }
}

/// A plate without a boss may slide nowhere, but a plane against a plane leaves three freedoms: they stay.
TEST(Alignment, WhatTheShapesLeaveOpenStaysAsItIs) {
  const mesh::SignedDistance design(test::block({-500, -500, -500}, {500, 500, 0}));
  TriMesh top;
  top.positions = {{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}};
  top.triangles = {{0, 1, 2}, {0, 2, 3}};
  const Alignment found = best_fit(mesh::SignedDistance(moved(top, motion(0.01, {1, 0, 0}, {2, 3, 0.5}))),
                                   design, Pose::Identity());
  EXPECT_LT(found.rms_mm, 1e-5);
  const Vec3 middle = found.X_design_stock * Vec3(2, 3, 0.5);
  EXPECT_LT((middle - Vec3(2, 3, 0)).norm(), 2e-3) << middle.transpose();
}

}  // namespace
}  // namespace swarf::measure
