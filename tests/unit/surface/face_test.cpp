// Trimmed faces: places, rectangles and areas against closed forms.
#include "surface/face.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"
#include "base/units.h"
#include "surface/analytic.h"

namespace swarf::surface {
namespace {

TrimLoop polygon(const Vec2& centre, double radius, int sides, bool turned = false) {
  TrimLoop loop;
  for (int k = 0; k < sides; ++k) {
    const double angle = (turned ? -2 : 2) * kPi * k / sides;
    loop.emplace_back(centre + radius * Vec2(std::cos(angle), std::sin(angle)));
  }
  return loop;
}

SurfacePtr plane(double a, double b) {
  return std::make_shared<PlaneSurface>(Vec3(3, 4, 5), Vec3(a, 0, 0), Vec3(0, b, 0));
}

Face ring() {
  return {plane(100, 100), {polygon({0.5, 0.5}, 0.4, 500), polygon({0.45, 0.5}, 0.2, 300, true)}, 0.0, "", 1};
}

TEST(Face, PlacesOfARingAreThoseBetweenItsCircles) {
  Rng rng(91);
  const Face face = ring();
  const FaceDomain domain(face);
  for (int trial = 0; trial < 5000; ++trial) {
    const Vec2 uv(rng.uniform(), rng.uniform());
    const double outer = (uv - Vec2(0.5, 0.5)).norm(), inner = (uv - Vec2(0.45, 0.5)).norm();
    if (std::abs(outer - 0.4) < 1e-4 || std::abs(inner - 0.2) < 1e-4) continue;
    EXPECT_EQ(domain.inside(uv), outer < 0.4 && inner > 0.2) << uv.transpose();
  }
}

TEST(Face, RectanglesAreSideOrCrossing) {
  Rng rng(92);
  const Face face = ring();
  const FaceDomain domain(face);
  std::array<int, 3> met{};
  for (int trial = 0; trial < 3000; ++trial) {
    const double size = std::pow(10, rng.uniform(-3, -0.3));
    const Vec2 low(rng.uniform(-0.1, 1), rng.uniform(-0.1, 1)), high = low + size * Vec2(rng.uniform(), 1);
    const Region region = domain.classify(low, high);
    ++met[static_cast<size_t>(region)];
    int in = 0, out = 0;
    for (int k = 0; k < 60; ++k) {
      const Vec2 uv(rng.uniform(low.x(), high.x()), rng.uniform(low.y(), high.y()));
      ++(domain.inside(uv) ? in : out);
    }
    const std::string box = fmt::format("[{}, {}] x [{}, {}]", low.x(), high.x(), low.y(), high.y());
    EXPECT_TRUE(in == 0 || out == 0 || region == Region::kCrossing) << box;
    EXPECT_TRUE(region != Region::kInside || out == 0) << box;
    EXPECT_TRUE(region != Region::kOutside || in == 0) << box;
  }
  for (const int count : met) EXPECT_GT(count, 100);
}

TEST(Face, AThinSlitIsNotOverlooked) {
  // 1e-9 wide, between the places of every grid.
  Face face{
      plane(1, 1),
      {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{0.3, 0.1}, {0.3, 0.9}, {0.300000001, 0.9}, {0.300000001, 0.1}}},
      0,
      "",
      1};
  const FaceDomain domain(face);
  EXPECT_EQ(domain.classify({0.25, 0.2}, {0.5, 0.4}), Region::kCrossing);
  EXPECT_EQ(domain.classify({0.31, 0.2}, {0.5, 0.4}), Region::kInside);
  EXPECT_FALSE(domain.inside({0.3000000005, 0.5}));
  EXPECT_TRUE(domain.inside({0.2999, 0.5}));
}

TEST(Face, WithoutLoopsItIsTheSquare) {
  const FaceDomain domain(Face{plane(1, 1), {}, 0, "", 1});
  EXPECT_TRUE(domain.inside({1.0, 0.0}));
  EXPECT_FALSE(domain.inside({1.0001, 0.5}));
  EXPECT_EQ(domain.classify({0, 0}, {1, 1}), Region::kInside);
  EXPECT_EQ(domain.classify({-0.1, 0}, {1, 1}), Region::kCrossing);
  EXPECT_EQ(domain.classify({1.1, 0}, {1.2, 1}), Region::kOutside);
}

TEST(Face, AreasAndVolumesAreThoseOfTheClosedForms) {
  const auto circle = [](int sides, double r) { return 0.5 * sides * r * r * std::sin(2 * kPi / sides); };
  const FaceMeasure flat = measure_face(ring());
  EXPECT_NEAR(flat.area_mm2, 1e4 * (circle(500, 0.4) - circle(300, 0.2)), 1e-8);
  EXPECT_NEAR(flat.flux_mm3, 5.0 / 3.0 * flat.area_mm2, 1e-8) << "z = 5 and an upward normal";
  const double R = 20, h = 30;
  const Face wall{cylinder_surface(Turn{}, R, h, MaterialSide::kConvex), {}, 0, "", 1};
  EXPECT_NEAR(measure_face(wall).area_mm2, 2 * kPi * R * h, 1e-9);
  EXPECT_NEAR(measure_face(wall).flux_mm3, 2.0 / 3.0 * kPi * R * R * h, 1e-9);
  // Half of it, by a loop that leaves the square on the other side.
  Face half = wall;
  half.loops = {{{0.5, -0.2}, {1.4, -0.2}, {1.4, 1.3}, {0.5, 1.3}}};
  EXPECT_NEAR(measure_face(half).area_mm2, kPi * R * h, 1e-9);
}

TEST(Face, LoopsAreJoinedAndTurned) {
  const SurfacePtr S = plane(100, 50);
  TrimLoop loop;
  const LoopGap closed =
      join_loop(*S, {{{0, 0}, {1, 0}}, {{1, 0}, {1, 1}, {0.5, 1}}, {{0.5, 1}, {0, 0}}}, loop);
  EXPECT_EQ(closed.gap_mm, 0.0);
  EXPECT_EQ(loop.size(), 4U);
  const LoopGap open = join_loop(*S, {{{0, 0}, {1, 0}}, {{1, 0.02}, {0.5, 1}, {0, 0}}}, loop);
  EXPECT_NEAR(open.gap_mm, 1.0, 1e-12);
  EXPECT_LT((open.place - S->point(1, 0)).norm(), 1e-12);

  std::vector<TrimLoop> loops{polygon({0.5, 0.5}, 0.1, 12), polygon({0.5, 0.5}, 0.4, 12, true)};
  EXPECT_TRUE(orient_loops(loops));
  EXPECT_GT(measure_face({S, {loops[0]}, 0, "", 1}).area_mm2, 0);
  EXPECT_LT(measure_face({S, {loops[1]}, 0, "", 1}).area_mm2, 0);
  std::vector<TrimLoop> apart{polygon({0.2, 0.5}, 0.1, 12), polygon({0.7, 0.5}, 0.2, 12)};
  EXPECT_FALSE(orient_loops(apart)) << "a hole beside the outer loop";
}

}  // namespace
}  // namespace swarf::surface
