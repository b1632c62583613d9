// Cutters on planes, edges, vertices and single triangles: against closed forms and against a search.
#include <gtest/gtest.h>

#include "brute_force.h"
#include "position/edge_rest.h"
#include "position/triangle_rest.h"

namespace swarf::position {
namespace {

constexpr double kTolerance = 1e-9;  // mm; the task asks for .05 um = 5e-5 mm

const NamedCutter& cutter_named(const std::string& name) {
  static const std::vector<NamedCutter> all = cutters_under_test();
  return *std::find_if(all.begin(), all.end(), [&](const NamedCutter& c) { return c.name == name; });
}

ToolProfile profile_of(const std::string& name) {
  return ToolProfile(cutter_named(name).cutter);
}

constexpr double kNever = -std::numeric_limits<double>::infinity();

double rest(const ToolProfile& profile, const Vec3& a, const Vec3& b, const Vec3& c) {
  return rest_on_triangle(profile, {a, b, c}, kNever).height;
}

// Theory 3: point at distance d.
TEST(PointRest, IsTheProfileTurnedOver) {
  EXPECT_DOUBLE_EQ(rest_on_point(profile_of("ball"), {3.0, 0.0, 7.0}), 7.0 - 1.0);
  EXPECT_DOUBLE_EQ(rest_on_point(profile_of("flat"), {3.0, 4.0, 7.0}), 7.0);
  EXPECT_EQ(rest_on_point(profile_of("flat"), {3.0, 4.000001, 7.0}), kNever);
  EXPECT_DOUBLE_EQ(rest_on_point(profile_of("bull_nose"), {0.0, -4.2, 1.0}), 1.0 - 0.4);
}

// A ball's centre lies on the cylinder of its radius round the edge: from the place at the foot of the axis.
TEST(EdgeRest, BallOnASlopedEdge) {
  const ToolProfile ball = profile_of("ball");
  for (const double slope : {0.0, 0.1, 1.0, 5.0, 100.0})
    for (const double d : {0.0, 1.0, 4.9}) {
      const Vec3 way(slope == 0.0 ? 10.0 : 10.0, 0.0, 10.0 * slope);
      const Vec3 p = Vec3(0.0, d, 2.0) - 3.0 * way, q = Vec3(0.0, d, 2.0) + 3.0 * way;
      const double expected = 2.0 - 5.0 + std::sqrt((25.0 - d * d) * (1.0 + slope * slope));
      EXPECT_NEAR(rest_on_edge(ball, p, q).height, expected, 1e-12 * (1.0 + slope)) << slope << " " << d;
      EXPECT_NEAR(rest_on_edge(ball, q, p).height, expected, 1e-12 * (1.0 + slope)) << slope << " " << d;
    }
}

// The rim of a flat end: the edge's highest place within the circle.
TEST(EdgeRest, FlatEndTouchesWithItsRim) {
  const ToolProfile flat = profile_of("flat");
  const EdgeRest rest = rest_on_edge(flat, {-20.0, 3.0, -10.0}, {20.0, 3.0, 10.0});
  EXPECT_NEAR(rest.height, 2.0, 1e-14);
  EXPECT_NEAR(rest.part, 0.6, 1e-14);
  const Vec2 gradient = gradient_at(flat, {4.0, 3.0, 2.0}, {40.0, 0.0, 20.0});
  EXPECT_NEAR(gradient.x(), 0.5, 1e-12);  // along the edge it rises with it
  EXPECT_NEAR(gradient.y(), 0.5 * 3.0 / 4.0, 1e-12);
}

// A cone of slope k: t = s d / sqrt(k^2 - s^2); steeper edges go up to the rim.
TEST(EdgeRest, ConeOnASlopedEdge) {
  const ToolProfile drill = profile_of("drill");
  const double k = 1.0 / std::tan(rad_from_deg(59.0)), s = 0.4, d = 2.0;
  const double t = s * d / std::sqrt(k * k - s * s);
  const EdgeRest rest = rest_on_edge(drill, {-10.0, -d, -10.0 * s}, {10.0, -d, 10.0 * s});
  EXPECT_NEAR(rest.height, s * t - k * std::hypot(d, t), 1e-13);
  const EdgeRest steep = rest_on_edge(drill, {-10.0, -d, -10.0}, {10.0, -d, 10.0});
  EXPECT_NEAR(steep.height, std::sqrt(21.0) - k * 5.0, 1e-13);
}

TEST(EdgeRest, VerticalAndShortAndBeside) {
  const ToolProfile ball = profile_of("ball");
  EXPECT_DOUBLE_EQ(rest_on_edge(ball, {3.0, 0.0, 9.0}, {3.0, 0.0, -9.0}).height, 8.0);
  EXPECT_DOUBLE_EQ(rest_on_edge(ball, {3.0, 0.0, 9.0}, {3.0, 0.0, -9.0}).part, 0.0);
  EXPECT_DOUBLE_EQ(rest_on_edge(ball, {3.0, 0.0, 9.0}, {3.0, 0.0, 9.0}).height, 8.0);
  EXPECT_EQ(rest_on_edge(ball, {-9.0, 5.1, 0.0}, {9.0, 5.1, 0.0}).height, kNever);
  EXPECT_EQ(rest_on_edge(ball, {5.1, 0.0, 0.0}, {9.0, 0.0, 3.0}).height, kNever);
  EXPECT_EQ(rest_on_edge(ball, {-9.0, 0.0, 0.0}, {-5.1, 0.0, 3.0}).height, kNever);
}

// From both sides of a wall that leans by less than rounding: never above its upper edge.
TEST(EdgeRest, NearlyVertical) {
  for (const NamedCutter& named : cutters_under_test()) {
    const ToolProfile profile(named.cutter);
    for (const double lean : {0.0, 1e-300, 1e-17, 1e-12, 1e-6}) {
      const EdgeRest rest = rest_on_edge(profile, {1.0, 0.5, -1000.0}, {1.0 + lean, 0.5, 4.0});
      EXPECT_NEAR(rest.height, 4.0 - profile.height(std::hypot(1.0, 0.5)), 2e-6) << named.name << lean;
    }
  }
}

// Theory 3 on planes of any slope: z = h + R0 tan b - rc + rc / cos b for the tools that it names.
TEST(FacetRest, PlanesOfAnySlope) {
  struct Tool {
    const char* name;
    double flat, corner;
  };
  for (const Tool& tool : {Tool{"flat", 5.0, 0.0}, Tool{"ball", 0.0, 5.0}, Tool{"bull_nose", 3.0, 2.0}}) {
    const ToolProfile profile = profile_of(tool.name);
    for (const double degrees : {0.0, 0.001, 10.0, 20.0, 45.0, 80.0, 89.0}) {
      const double b = rad_from_deg(degrees), slope = std::tan(b);
      const double expected = 1.5 + tool.flat * slope - tool.corner + tool.corner / std::cos(b);
      for (const double turn : {0.0, 0.7, 3.0}) {
        const auto on = [&](double x, double y) {
          return Vec3(x, y, 1.5 + slope * (x * std::cos(turn) + y * std::sin(turn)));
        };
        const Vec3 a = on(-100.0, -90.0), p = on(100.0, -80.0), q = on(3.0, 110.0);
        EXPECT_NEAR(rest(profile, a, p, q), expected, 1e-12 * (1.0 + slope)) << tool.name << degrees;
        EXPECT_NEAR(rest(profile, a, q, p), expected, 1e-12 * (1.0 + slope)) << "from below";
      }
    }
  }
  const double twenty = std::tan(rad_from_deg(20.0));
  EXPECT_NEAR(rest(profile_of("bull_nose"), {-50, -50, -50 * twenty}, {50, -50, 50 * twenty}, {0, 90, 0}),
              1.220266248, 5e-10);
}

TEST(FacetRest, GradientIsThePlanes) {
  const ToolProfile ball = profile_of("ball");
  const LocalTriangle t{{-50, -50, -5}, {50, -50, 15}, {0, 60, 38}};  // z = .2 x + .3 y + 20
  const TriangleRest found = rest_on_triangle(ball, t, kNever);
  EXPECT_EQ(found.what, Touched::kFace);
  const Vec2 gradient = triangle_gradient(ball, t, found);
  EXPECT_NEAR(gradient.x(), 0.2, 1e-12);
  EXPECT_NEAR(gradient.y(), 0.3, 1e-12);
}

TEST(TriangleRest, FloorOnlyLeavesOutWhatIsNotAbove) {
  const ToolProfile ball = profile_of("ball");
  const LocalTriangle t{{-1, -1, 0}, {2, -1, 0.1}, {0, 2, 0.3}};
  const double height = rest_on_triangle(ball, t, kNever).height;
  EXPECT_EQ(rest_on_triangle(ball, t, height - 1e-15).height, height);
  EXPECT_LE(rest_on_triangle(ball, t, height + 1e-6).height, height);
}

struct Draw {
  Rng rng;
  explicit Draw(uint64_t seed) : rng(seed) {}
  Vec3 within(double half) {
    return {rng.uniform(-half, half), rng.uniform(-half, half), rng.uniform(-half, half)};
  }
};

/// Plain, needle, tiny, far larger than the tool, level, upright, through the axis, without area, duplicates.
TriMesh random_triangle(Draw& draw, int kind) {
  TriMesh mesh;
  const double half = kind == 2 ? 1e-3 : kind == 3 ? 400.0 : 7.0;
  const Vec3 centre = kind == 2 ? draw.within(4.0) : Vec3(Vec3::Zero());
  Vec3 a = centre + draw.within(half), b = centre + draw.within(half), c = centre + draw.within(half);
  if (kind == 1) c = b + draw.within(1e-4);
  if (kind == 4) c.z() = b.z() = a.z();
  if (kind == 5) c = Vec3(0.3 * a.x() + 0.7 * b.x(), 0.3 * a.y() + 0.7 * b.y(), c.z());
  if (kind == 6) a.x() = a.y() = 0.0;
  if (kind == 7) c = a + 0.25 * (b - a);
  if (kind == 8) c = a;
  add_triangle(mesh, a, b, c);
  return mesh;
}

// All cutters, upright and tilted, on triangles of every kind.
TEST(TriangleRestProperty, AgreesWithASearch) {
  constexpr uint64_t kSeed = 20261;
  double worst = 0.0;
  int touched = 0;
  for (const NamedCutter& named : cutters_under_test()) {
    const ToolProfile profile(named.cutter);
    const ClosedForm tool(named.cutter);
    Draw draw(kSeed);
    for (int i = 0; i < 360; ++i) {
      const TriMesh mesh = random_triangle(draw, i % 9);
      const Vec3 at = draw.within(2.0), axis = i % 2 == 0 ? Vec3(Vec3::UnitZ()) : draw.rng.direction();
      const GuideLine line = i % 4 == 0 ? upright(at.x(), at.y()) : guide_line(at, axis);
      const auto local = [&](size_t k) { return line.local(corner_of(mesh, 0, k)); };
      const double found = rest_on_triangle(profile, {local(0), local(1), local(2)}, kNever).height;
      const double expected = brute_mesh(tool, line, mesh);
      if (std::isinf(expected) && std::isinf(found)) continue;
      ++touched;
      worst = std::max(worst, std::abs(found - expected));
      EXPECT_NEAR(found, expected, 1e-7)
          << named.name << " kind " << i % 9 << "\nline = " << paste(line) << ";\n"
          << paste(mesh, 0);
    }
  }
  EXPECT_GT(touched, 1500);
  RecordProperty("worst_nm", std::to_string(1e6 * worst));
}

/// Central differences of the rest along the line's x and y.
Vec2 difference(const ToolProfile& profile, const LocalTriangle& t, double h) {
  const auto moved = [&](double x, double y) {
    const Vec3 by(x, y, 0.0);
    return rest(profile, t.a - by, t.b - by, t.c - by);
  };
  return {(moved(h, 0) - moved(-h, 0)) / (2 * h), (moved(0, h) - moved(0, -h)) / (2 * h)};
}

TEST(TriangleRestProperty, GradientsAreDifferences) {
  int compared = 0;
  for (const NamedCutter& named : cutters_under_test()) {
    const ToolProfile profile(named.cutter);
    Draw draw(77);
    for (int i = 0; i < 400; ++i) {
      const LocalTriangle t{draw.within(6.0), draw.within(6.0), draw.within(6.0)};
      const TriangleRest found = rest_on_triangle(profile, t, kNever);
      if (found.what == Touched::kNothing) continue;
      const Vec2 fine = difference(profile, t, 1e-6), coarse = difference(profile, t, 1e-5);
      // Where the two differ a crease of the tips' surface lies between, or its curvature is great.
      if (!fine.allFinite() || !coarse.allFinite() || (fine - coarse).norm() > 1e-5) continue;
      ++compared;
      const Vec2 gradient = triangle_gradient(profile, t, found);
      EXPECT_LT((gradient - fine).norm(), 1e-4 * (1.0 + fine.norm()))
          << named.name << " what " << static_cast<int>(found.what) << " " << gradient.transpose() << " / "
          << fine.transpose();
    }
  }
  EXPECT_GT(compared, 1500);
}

}  // namespace
}  // namespace swarf::position
