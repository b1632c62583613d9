#include "collision/convex_distance.h"

#include <gtest/gtest.h>

#include "unit/collision/brute_distance.h"
#include "unit/collision/toy_machine.h"

namespace swarf::collision {
namespace {

Body triangle_body(const Triangle& triangle) {
  Body body;
  body.triangles = {triangle};
  return body;
}

Body body_of_solid(const RevolvedSolid& solid) {
  return solid_body("solid", BodyKind::kToolPart, -1, {solid});
}

ConvexDistance between(const Body& a, const Body& b) {
  return convex_distance(view_of(a, 0), view_of(b, 0), INFINITY);
}

/// Of every shape: plump, needle, thin, doubled corner, a point; sizes over six decades.
Triangle random_triangle(Rng& rng) {
  const double size = std::pow(10.0, rng.uniform(-3.0, 3.0));
  const Vec3 centre = 20.0 * rng.uniform() * rng.direction();
  Triangle t;
  for (Vec3& p : t) p = centre + size * rng.direction();
  const auto shape = static_cast<int>(rng.uniform(0.0, 6.0));
  if (shape == 1) t[2] = t[0] + 1e-6 * size * rng.direction();
  if (shape == 2) t[2] = 0.5 * (t[0] + t[1]) + 1e-7 * size * rng.direction();
  if (shape == 3) t[2] = t[1];
  if (shape == 4) t[2] = t[1] = t[0];
  if (shape == 5) t[2].z() = t[1].z() = t[0].z();
  return t;
}

TEST(ConvexDistance, TrianglesAgreeWithAllTheirFeatures) {
  Rng rng(1);
  for (int i = 0; i < 100000; ++i) {
    const Triangle a = random_triangle(rng), b = random_triangle(rng);
    const double truth = brute_triangles(a, b);
    const ConvexDistance found = between(triangle_body(a), triangle_body(b));
    EXPECT_LE(found.lower, truth + 1e-9) << i;
    EXPECT_GE(found.upper, truth - 1e-9) << i;
    EXPECT_LE(found.upper - found.lower, 2e-7) << i;
    EXPECT_NEAR((found.home_a - found.home_b).norm(), found.upper, 1e-9) << i;
  }
}

TEST(ConvexDistance, CylinderOverAPlaneAndBesideIt) {
  const Body plane = triangle_body({Vec3(-100, -100, 0), Vec3(100, -100, 0), Vec3(0, 100, 0)});
  const Body upright = body_of_solid(frustum({3, 4, 2.5}, Vec3::UnitZ(), 0, 10, 6, 6));
  EXPECT_NEAR(between(plane, upright).upper, 2.5, 1e-7);
  EXPECT_NEAR(between(plane, upright).lower, 2.5, 1e-6);
  // Lying along X: its flank is the radius away.
  const Body lying = body_of_solid(frustum({0, 0, 9}, Vec3::UnitX(), 0, 10, 6, 6));
  EXPECT_NEAR(between(plane, lying).lower, 3.0, 1e-6);
  EXPECT_NEAR(between(plane, lying).upper, 3.0, 1e-6);
  // Leaning by 30 degrees: the rim of radius 6 hangs 6 sin 30 below its centre.
  const Body leaning = body_of_solid(frustum({0, 0, 9}, Vec3(0.5, 0, std::sqrt(0.75)), 0, 10, 6, 6));
  EXPECT_NEAR(between(plane, leaning).lower, 6.0, 1e-6);
  EXPECT_NEAR(between(plane, leaning).upper, 6.0, 1e-6);
}

TEST(ConvexDistance, TwoCylindersWithCrossedAxes) {
  const Body one = body_of_solid(frustum({-50, 0, 0}, Vec3::UnitX(), 0, 100, 3, 3));
  const Body other = body_of_solid(frustum({0, -50, 10}, Vec3::UnitY(), 0, 100, 4, 4));
  EXPECT_NEAR(between(one, other).lower, 3.0, 1e-6);
  EXPECT_NEAR(between(one, other).upper, 3.0, 1e-6);
}

/// From a point the distance is that in the half plane through it, exact.
TEST(ConvexDistance, PointsAgreeWithTheProfile) {
  Rng rng(10);
  for (int i = 0; i < 20000; ++i) {
    const RevolvedSolid solid = frustum(10.0 * rng.direction(), rng.direction(), rng.uniform(-5.0, 0.0),
                                        rng.uniform(0.01, 5.0), rng.uniform(0.0, 4.0), rng.uniform(0.0, 4.0));
    const Vec3 p = rng.uniform(0.0, 40.0) * rng.direction();
    const double z = (p - solid.foot).dot(solid.axis), rho = (p - solid.foot - z * solid.axis).norm();
    const auto to_side = [&](const Vec2& from, const Vec2& to) {
      const double share =
          std::clamp((Vec2(rho, z) - from).dot(to - from) / (to - from).squaredNorm(), 0.0, 1.0);
      return (Vec2(rho, z) - from - share * (to - from)).norm();
    };
    const Vec2 low = solid.corners[0], high = solid.corners[1];
    double truth =
        std::min({to_side(low, high), to_side(Vec2(0, low.y()), low), to_side(Vec2(0, high.y()), high)});
    const double wide = low.x() + (z - low.y()) / (high.y() - low.y()) * (high.x() - low.x());
    if (z >= low.y() && z <= high.y() && rho <= wide) truth = 0.0;
    const Body one = body_of_solid(solid), point = triangle_body({p, p, p});
    for (const ConvexDistance& found : {between(one, point), between(point, one)}) {
      EXPECT_LE(found.lower, truth + 1e-9) << i;
      EXPECT_NEAR(found.upper, truth, 1e-6) << i;
      EXPECT_LE(found.upper - found.lower, 1e-6) << i;
    }
  }
}

/// Slim cones, discs, cylinders of any size against triangles and each other: the bounds meet, and the points
/// lie in their solids.
TEST(ConvexDistance, BoundsMeetForSolidsOfAnyShape) {
  Rng rng(9);
  const auto random_solid = [&rng]() {
    const double size = std::pow(10.0, rng.uniform(-2.0, 2.0)), low = rng.uniform(-1.0, 1.0);
    const double high = low + std::pow(10.0, rng.uniform(-3.0, 1.0));
    return frustum(60.0 * rng.uniform() * rng.direction(), rng.direction(), size * low, size * high,
                   size * std::max(0.0, rng.uniform(-0.5, 1.0)), size * rng.uniform());
  };
  double widest = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const Body a = body_of_solid(random_solid());
    const Body b = i % 2 == 0 ? body_of_solid(random_solid()) : triangle_body(random_triangle(rng));
    const ConvexDistance found = between(a, b), other = between(b, a);
    widest = std::max(widest, found.upper - found.lower);
    EXPECT_LE(found.upper - found.lower, 1e-5) << i;
    EXPECT_NEAR(found.upper, other.upper, 2e-5) << i;
    EXPECT_NEAR((found.home_a - found.home_b).norm(), found.upper, 1e-9) << i;
    EXPECT_LE(std::abs((found.home_a - a.nodes[0].centre).dot(Vec3::UnitX())), a.nodes[0].half.x() + 1e-9)
        << i;
  }
  RecordProperty("widest_mm", std::to_string(widest));
  EXPECT_LE(widest, 1e-5) << widest;
}

TEST(ConvexDistance, HullOfTwoPosesTellsTheInstant) {
  // A point flies past a corner: nearest at a quarter of its way.
  const Body still = triangle_body({Vec3(0, 0, 0), Vec3(0, 0, -1), Vec3(0, -1, -1)});
  const Body point = triangle_body({Vec3(-1, 2, 0), Vec3(-1, 2, 0), Vec3(-1, 2, 0)});
  const Pose start = Pose::Identity();
  Pose end = Pose::Identity();
  end.translation() = Vec3(4, 0, 0);
  const ConvexDistance found = convex_distance(view_of(still, 0), view_of(point, 0, start, &end), INFINITY);
  EXPECT_NEAR(found.t, 0.25, 1e-9);
  EXPECT_NEAR(found.lower, 2.0, 1e-7);
  EXPECT_NEAR(found.upper, 2.0, 1e-7);
}

}  // namespace
}  // namespace swarf::collision
