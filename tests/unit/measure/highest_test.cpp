// The highest material is found between the rays: answers in closed form at places where no ray stands.
#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "base/units.h"
#include "measure/measure.h"
#include "surface/analytic.h"
#include "test_surfaces.h"

namespace swarf::measure {
namespace {

constexpr double kExactUm = 1e-3;
const MeasureLimits kTenMicrometres{0.01, 0.001};

SurfaceMetrics measured(const stock::SurfaceDexels& dexels, const Passes& passes,
                        const stock::CutterSolid& cutter, const Box& raw, bool between) {
  const std::vector<stock::RayFieldPtr> fields{dexels.field_ptr()};
  const stock::FreeRange ranges(fields);
  const stock::RawShape shape = stock::RawShape::of_box(raw);
  const RayMaterial material{shape, ranges};
  return measure_surface(dexels, passes.sweeps, passes.pass_of_sweep, cutter, kTenMicrometres, nullptr,
                         between ? &material : nullptr);
}

/// Rows of a ball in X, and rows in Y across them: a point stands where four ridges meet.
Passes crossed_rows(double interval) {
  constexpr int kRows = 9;
  return passes_along(
      [=](int pass, double t) {
        const double across = (pass % kRows - kRows / 2) * interval + (pass < kRows ? 0.077 : -0.31);
        const double along = -6.0 + 12.0 * t;
        return ToolPose{pass < kRows ? Vec3(along, across, 0.0) : Vec3(across, along, 0.0), Vec3::UnitZ()};
      },
      2 * kRows, 4);
}

// Theory 8: ball D10, rows 1 apart in X and in Y.
TEST(HighestMaterial, StandsWhereRidgesCross) {
  const Passes passes = crossed_rows(1.0);
  const stock::CutterSolid cutter = ball(5.0, 60.0);
  const Box raw{{-30, -30, -60}, {30, 30, 60}};
  for (const double pitch : {0.23, 0.7}) {
    stock::SurfaceDexels dexels(std::make_shared<Paraboloid>(0.0, 0.0, 3.0), pitch, raw);
    dexels.cut(passes.sweeps, cutter);
    EXPECT_LT(measured(dexels, passes, cutter, raw, false).excess_max_um, 25.0628 - 10.0 * kExactUm) << pitch;
    set_thread_count(1);
    const SurfaceMetrics one = measured(dexels, passes, cutter, raw, true);
    set_thread_count(0);
    const SurfaceMetrics found = measured(dexels, passes, cutter, raw, true);
    EXPECT_EQ(found.excess_max_um, one.excess_max_um);
    EXPECT_EQ(found.excess_top, one.excess_top);
    EXPECT_NEAR(found.excess_max_um, 25.0628, kExactUm) << pitch;
    EXPECT_NEAR(found.excess_top.z(), 0.0250628, 1e-6);
    const auto off = [](double x, double shift) { return std::abs(x - shift - std::floor(x - shift) - 0.5); };
    EXPECT_LT(off(found.excess_top.x(), -0.31), 1e-4) << found.excess_top.transpose();
    EXPECT_LT(off(found.excess_top.y(), 0.077), 1e-4) << found.excess_top.transpose();
    ASSERT_FALSE(found.excesses.empty());
    EXPECT_EQ(found.excesses.front().worst_um, found.excess_max_um);
  }
}

/// Over a slope nothing was cut: the corner of the raw block that is farthest from it.
TEST(HighestMaterial, OfAnUncutBlockIsItsCorner) {
  const Vec3 origin(-3, -3, 0), u(6, 0, 1), v(0, 6, 0.5);
  const Box raw{{-2.17, -2.4, -5}, {2.23, 1.9, 4}};
  const Vec3 corner(raw.lower.x(), raw.lower.y(), raw.upper.z());
  const double exact = um_from_mm((corner - origin).dot(u.cross(v).normalized()));
  stock::SurfaceDexels dexels(std::make_shared<surface::PlaneSurface>(origin, u, v), 0.5, raw);
  EXPECT_LT(measured(dexels, {}, kCutter, raw, false).excess_max_um, exact - 10.0);
  const SurfaceMetrics found = measured(dexels, {}, kCutter, raw, true);
  EXPECT_NEAR(found.excess_max_um, exact, 0.01);
  EXPECT_LE(found.excess_max_um, exact + kExactUm);
  EXPECT_LT((found.excess_top - corner).norm(), 1e-4) << found.excess_top.transpose();
}

/// The same over the facets of a mesh, beside a wall: higher than half way to it nothing is the floor's.
TEST(HighestMaterial, OfAMeshEndsWhereAnotherFaceIsAsNear) {
  TriMesh step;  // a floor at z = 0 and a wall at x = 4, as the inner faces of a body under and beside them
  const auto quad = [&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const auto first = static_cast<uint32_t>(step.positions.size());
    for (const Vec3& p : {a, b, c, d})
      step.positions.push_back(
          {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
    step.triangles.push_back({first, first + 1, first + 2});
    step.triangles.push_back({first, first + 2, first + 3});
  };
  quad({-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0});
  quad({4, -4, 0}, {4, -4, 9}, {4, 4, 9}, {4, 4, 0});
  const Box raw{{1, -4, -1}, {4, 4, 9}};
  const stock::RayFieldPtr field = stock::rays_on_mesh(step, 0.7);
  const std::vector<stock::RayFieldPtr> fields{field};
  stock::SurfaceDexels dexels(field, raw, stock::free_ranges(fields, 0));
  const SurfaceMetrics found = measured(dexels, {}, kCutter, raw, true);
  // As far from the wall as the block reaches; rays know the wall by its own rays (free_ranges.h).
  constexpr double kPitch = 0.7;
  EXPECT_GE(found.excess_max_um, 3000.0 - 0.01);
  EXPECT_LE(found.excess_max_um, 3000.0 + 1e3 * 0.25 * kPitch * kPitch / (2.0 * 3.0));
}

}  // namespace
}  // namespace swarf::measure
