// The raw stock as a body: distances, lines, bounds of its surface and volumes against closed forms, and
// against each other at random places.
#include "stock/raw/raw_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/rng.h"
#include "base/units.h"
#include "stock_test_support.h"
#include "support/solids.h"

namespace swarf::stock::raw_shape_test {
namespace {

RawTube askew(double inner_radius) {
  return {{3.0, -2.0, 1.0}, Vec3(1.0, 2.0, 2.0) / 3.0, 6.0, inner_radius, 20.0};
}
/// An L with a notch, clockwise.
RawOutline bracket() {
  return {{{0, 0}, {0, 20}, {6, 20}, {6, 8}, {9, 8}, {9, 6}, {30, 6}, {30, 0}}, -4.0, 7.0};
}

Pose leaning() {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(0.7, Vec3(2.0, -1.0, 2.0) / 3.0).toRotationMatrix();
  pose.translation() = Vec3(5.0, -7.0, 3.0);
  return pose;
}

struct Named {
  const char* name;
  RawShape shape;
};
std::vector<Named> shapes() {
  return {{"box", RawShape::of_box({{-3, -4, -5}, {6, 2, 7}})},
          {"cylinder", RawShape::of_tube(askew(0.0))},
          {"tube", RawShape::of_tube(askew(4.5))},
          {"outline", RawShape::of_outline(bracket())},
          {"sphere", RawShape::of_mesh(test::sphere(8.0, {1, 2, 3}, 48, 24), "sphere")},
          {"torus", RawShape::of_mesh(test::torus(9.0, 3.0, {0, 0, 1}, 48, 24), "torus")},
          {"leaning box", RawShape::of_box({{-3, -4, -5}, {6, 2, 7}}).moved(leaning())},
          {"leaning tube", RawShape::of_tube(askew(4.5)).moved(leaning())},
          {"leaning outline", RawShape::of_outline(bracket()).moved(leaning())},
          {"leaning torus",
           RawShape::of_mesh(test::torus(9.0, 3.0, {0, 0, 1}, 48, 24), "torus").moved(leaning())}};
}

/// In and around the box of the shape.
Vec3 random_place(Rng& rng, const RawShape& shape) {
  const Vec3 size = 1.6 * shape.box().size();
  return shape.box().centre() +
         Vec3(rng.uniform(-0.5, 0.5), rng.uniform(-0.5, 0.5), rng.uniform(-0.5, 0.5)).cwiseProduct(size);
}

TEST(RawShape, VolumesAndAreasInClosedForm) {
  const RawShape tube = RawShape::of_tube(askew(4.5));
  EXPECT_NEAR(tube.volume_mm3(), kPi * (36.0 - 20.25) * 20.0, 1e-9);
  EXPECT_NEAR(tube.area_mm2(), 2.0 * kPi * (36.0 - 20.25) + 2.0 * kPi * (6.0 + 4.5) * 20.0, 1e-9);
  const RawShape outline = RawShape::of_outline(bracket());
  EXPECT_NEAR(outline.volume_mm3(), (120.0 + 24.0 * 6.0 + 3.0 * 2.0) * 11.0, 1e-9);
  EXPECT_NEAR(outline.area_mm2(), 2.0 * 270.0 + 100.0 * 11.0, 1e-9);
  const RawShape box = RawShape::of_mesh(test::block({-1, -2, -3}, {4, 5, 6}), "block");
  EXPECT_NEAR(box.volume_mm3(), 5.0 * 7.0 * 9.0, 1e-9);
  EXPECT_NEAR(box.area_mm2(), 2.0 * (35.0 + 63.0 + 45.0), 1e-9);
}

TEST(RawShape, TheBoxOfALeaningCylinderTouchesIt) {
  const RawShape shape = RawShape::of_tube(askew(0.0));
  Rng rng(11);
  Vec3 low = Vec3::Constant(1e9), high = -low;
  const RawTube tube = askew(0.0);
  const Vec3 e = tube.axis_W.cross(Vec3::UnitX()).normalized(), f = tube.axis_W.cross(e);
  for (int n = 0; n < 20000; ++n) {
    const double a = rng.uniform(0.0, 2.0 * kPi);
    const Vec3 p = tube.base_W + (n % 2) * 20.0 * tube.axis_W + 6.0 * (std::cos(a) * e + std::sin(a) * f);
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  EXPECT_LT((shape.box().lower - low).cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_LT((shape.box().upper - high).cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_LE((shape.box().lower - low).maxCoeff(), 1e-12);
}

TEST(RawShape, MovedItIsTheSameBodyElsewhere) {
  const Pose X_WF = leaning();
  for (const Named& one : shapes()) {
    const RawShape there = one.shape.moved(X_WF);
    EXPECT_NEAR(there.volume_mm3(), one.shape.volume_mm3(), 1e-9) << one.name;
    EXPECT_NEAR(there.area_mm2(), one.shape.area_mm2(), 1e-9) << one.name;
    const RawShape back = there.moved(X_WF.inverse());
    EXPECT_LT((back.box().lower - one.shape.box().lower).norm(), 1e-9) << one.name;
    EXPECT_LT((back.box().upper - one.shape.box().upper).norm(), 1e-9) << one.name;
    Rng rng(17);
    for (int n = 0; n < 200; ++n) {
      const Vec3 p = random_place(rng, one.shape);
      EXPECT_NEAR(there.distance_mm(X_WF * p), one.shape.distance_mm(p), 1e-9)
          << one.name << " " << p.transpose();
      const Vec3 inside = (X_WF * p).cwiseMax(there.box().lower).cwiseMin(there.box().upper);
      if (there.distance_mm(X_WF * p) < 0.0) {
        EXPECT_LT((inside - X_WF * p).norm(), 1e-12) << one.name << ": its box holds it";
      }
    }
  }
}

TEST(RawShape, ABoxByQuarterTurnsIsABoxOfTheSameNumbers) {
  Pose over = Pose::Identity();
  over.linear() = Eigen::DiagonalMatrix<double, 3>(1.0, -1.0, -1.0).toDenseMatrix();
  over.translation() = Vec3(0.0, 0.0, -15.1);
  const RawShape box = RawShape::of_box({{-20.3, -10.7, -15.1}, {20.3, 10.7, 0.0}}).moved(over);
  EXPECT_TRUE(box.is_box());
  EXPECT_EQ(box.box().lower, Vec3(-20.3, -10.7, -15.1));
  EXPECT_EQ(box.box().upper, Vec3(20.3, 10.7, 0.0));
  EXPECT_EQ(box.text().find("-0,"), std::string::npos) << box.text();
  EXPECT_FALSE(RawShape::of_box({{0, 0, 0}, {1, 1, 1}}).moved(leaning()).is_box());
}

TEST(RawShape, AFootLiesAtTheDistanceOnTheSurfaceAndNoPlaceIsNearer) {
  for (const Named& one : shapes()) {
    Rng rng(5);
    for (int n = 0; n < 300; ++n) {
      const Vec3 p = random_place(rng, one.shape), q = random_place(rng, one.shape);
      const RawPoint at = one.shape.at(p);
      const std::string where = std::string(one.name) + " " + text(p) + " " + text(q);
      EXPECT_NEAR((p - at.foot).norm(), std::abs(at.distance_mm), 1e-9) << where;
      EXPECT_NEAR(one.shape.distance_mm(at.foot), 0.0, 1e-9) << where;
      EXPECT_NEAR(at.normal.norm(), 1.0, 1e-9) << where;
      EXPECT_LE(std::abs(one.shape.distance_mm(q) - at.distance_mm), (p - q).norm() + 1e-9) << where;
      // The ball of the distance holds no surface: no line through it crosses there.
      const Vec3 way = rng.direction();
      for (const RawInterval& material : one.shape.along(p, way)) {
        EXPECT_GE(std::abs(material.low), std::abs(at.distance_mm) - 2e-6) << where;
        EXPECT_GE(std::abs(material.high), std::abs(at.distance_mm) - 2e-6) << where;
      }
    }
  }
}

TEST(RawShape, ALineIsInTheMaterialWhereTheDistanceSaysSo) {
  for (const Named& one : shapes()) {
    Rng rng(7);
    for (int n = 0; n < 200; ++n) {
      const Vec3 p = random_place(rng, one.shape),
                 way = n % 5 == 0 ? Vec3(Vec3::Unit(n % 3)) : rng.direction();
      const std::vector<RawInterval> material = one.shape.along(p, way);
      for (double s = -40.0; s < 40.0; s += 0.37) {
        const double distance = one.shape.distance_mm(p + s * way);
        if (std::abs(distance) < 1e-5) continue;
        bool inside = false;
        for (const RawInterval& m : material) inside |= s > m.low && s < m.high;
        ASSERT_EQ(inside, distance < 0.0) << one.name << " " << text(p) << " " << text(way) << " at " << s;
      }
    }
  }
}

TEST(RawShape, LinesThroughEdgesAndCornersOfAMeshLoseNothing) {
  const RawShape mesh = RawShape::of_mesh(test::block({0, 0, 0}, {10, 20, 30}), "block");
  const RawShape box = RawShape::of_box(mesh.box());
  for (const Vec3& from : {Vec3(0, 0, 0), Vec3(5, 10, 0), Vec3(0, 10, 15), Vec3(10, 20, 0), Vec3(5, 0, 0)}) {
    for (const Vec3& to : {Vec3(10, 20, 30), Vec3(5, 10, 30), Vec3(10, 10, 15), Vec3(0, 0, 30)}) {
      const Vec3 way = (to - from).normalized();
      const std::vector<RawInterval> material = mesh.along(from, way), expected = box.along(from, way);
      ASSERT_EQ(material.size(), 1U) << text(from) << text(to);
      ASSERT_EQ(expected.size(), 1U) << text(from) << text(to);
      EXPECT_NEAR(material[0].low, expected[0].low, 1e-9) << text(from) << text(to);
      EXPECT_NEAR(material[0].high, expected[0].high, 1e-9) << text(from) << text(to);
    }
  }
}

TEST(RawShape, NoPlaceOfTheSurfaceInABallLiesBeyondItsExtent) {
  for (const Named& one : shapes()) {
    Rng rng(13);
    for (int n = 0; n < 60; ++n) {
      const Vec3 foot = one.shape.at(random_place(rng, one.shape)).foot, m = rng.direction();
      const double radius = rng.uniform(0.05, 4.0);
      const Vec3 centre = foot + 0.9 * radius * rng.uniform() * rng.direction();
      const RawExtent extent = one.shape.extent(centre, radius, m);
      ASSERT_FALSE(extent.empty()) << one.name << text(centre) << radius;
      for (int k = 0; k < 60; ++k) {
        const Vec3 place = one.shape.at(centre + radius * rng.uniform() * rng.direction()).foot;
        if ((place - centre).norm() > radius) continue;
        EXPECT_LE(m.dot(place), extent.greatest + 1e-9) << one.name << text(centre) << text(m) << radius;
        EXPECT_GE(m.dot(place), extent.least - 1e-9) << one.name << text(centre) << text(m) << radius;
      }
    }
  }
}

TEST(RawShape, TheExtentIsSharpOnFlatFacesAndSecondOrderOnCurvedOnes) {
  const RawShape mesh = RawShape::of_mesh(test::block({0, 0, 0}, {100, 100, 30}), "block");
  EXPECT_EQ(mesh.extent({50, 50, 30}, 2.0, Vec3::UnitZ()).least, 30.0);
  EXPECT_EQ(mesh.extent({50, 50, 30}, 2.0, Vec3::UnitZ()).greatest, 30.0);
  const RawShape outline = RawShape::of_outline(bracket());
  EXPECT_EQ(outline.extent({2, 12, 7}, 1.0, Vec3::UnitZ()).least, 7.0);
  EXPECT_EQ(outline.extent({6, 14, 2}, 1.0, Vec3::UnitX()).greatest, 6.0);
  EXPECT_EQ(outline.extent({6, 14, 6.8}, 0.5, Vec3::UnitX()).greatest, 6.0);  // beside the rim of its end
  RawTube bar{Vec3::Zero(), Vec3::UnitZ(), 10.0, 5.0, 40.0};
  const RawShape tube = RawShape::of_tube(bar);
  for (const double radius : {1.0, 0.1, 0.01}) {
    const RawExtent outer = tube.extent({10, 0, 20}, radius, Vec3::UnitX());
    EXPECT_NEAR(outer.greatest, 10.0, 1e-12);
    EXPECT_GT(outer.least, 10.0 - radius * radius / 10.0);
    const RawExtent inner = tube.extent({5, 0, 20}, radius, -Vec3::UnitX());
    EXPECT_LT(inner.greatest, -5.0 + radius * radius / 5.0);
  }
}

TEST(RawShape, AColumnOverADesignSeesWhatItBeginsInAndWhatHangsAbove) {
  RawTube pipe{{0, 0, 0}, Vec3::UnitX(), 10.0, 8.0, 50.0};
  const RawShape shape = RawShape::of_tube(pipe);
  const RawColumn in_wall = raw_column(shape, {20, 0, -9}, Vec3::UnitZ());
  EXPECT_NEAR(in_wall.height_mm, 1.0, 1e-12);
  ASSERT_EQ(in_wall.above.size(), 1U);
  EXPECT_NEAR(in_wall.above[0].low, 17.0, 1e-12);
  EXPECT_NEAR(in_wall.above[0].high, 19.0, 1e-12);
  // In the bore the design lacks material, down to the wall below it.
  EXPECT_NEAR(raw_column(shape, {20, 0, -5}, Vec3::UnitZ()).height_mm, -3.0, 1e-12);
  EXPECT_NEAR(raw_column(shape, {20, 30, 0}, Vec3::UnitZ()).height_mm, -20.0, 1e-12);
  EXPECT_NEAR(raw_column(shape, {20, 0, -10}, Vec3::UnitZ()).height_mm, 2.0, 1e-12);  // on its face
}

TEST(RawShape, TheThinnestWallIsMetAndNamed) {
  const ThinnestWall tube = RawShape::of_tube(askew(5.8)).thinnest_wall(0.5);
  EXPECT_NEAR(tube.mm, 0.2, 1e-9);
  // A trough with one wall of 0.15 mm among walls of 3.
  const TriMesh trough =
      test::towers({0, 3, 20, 20.15}, {0, 30}, 0.0, [](int i, int) { return i == 1 ? 4.0 : 25.0; });
  const ThinnestWall mesh = RawShape::of_mesh(trough, "trough").thinnest_wall(0.5);
  EXPECT_NEAR(mesh.mm, 0.15, 1e-5);
  EXPECT_GT(mesh.place_W.x(), 19.9);
  EXPECT_NEAR(RawShape::of_outline(bracket()).thinnest_wall(0.5).mm, 6.0, 1e-9);
}

TEST(RawShape, TextsNameWhatDiffers) {
  EXPECT_EQ(RawShape::of_tube({Vec3::Zero(), Vec3::UnitZ(), 25.0, 0.0, 80.0}).text(),
            "cylinder D 50 mm, 80 mm long, base (0, 0, 0) mm, axis (0, 0, 1)");
  const auto mesh = [](double height) {
    return RawShape::of_mesh(test::block({0, 0, 0}, {1, 1, height}), "a.stl");
  };
  EXPECT_EQ(mesh(2.0).text(), mesh(2.0).text());
  EXPECT_NE(mesh(2.0).text(), mesh(2.5).text());
}

}  // namespace
}  // namespace swarf::stock::raw_shape_test
