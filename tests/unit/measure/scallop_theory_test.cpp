// Scallops of theory 1.1, measured on rays; on parametric surfaces and on meshes of them.
#include <gtest/gtest.h>

#include "base/units.h"
#include "measure/measure.h"
#include "test_surfaces.h"

namespace swarf::measure::scallop_theory_test {
namespace {

const MeasureLimits kLimits{1.0, 1e-4};
const Box kBox{{-30, -30, -60}, {30, 30, 60}};

/// Ridges of which the foot lies inside the box, cut by `passes`; with and without pass numbers.
std::vector<Ridge> ridges_of(stock::SurfaceDexels dexels, const Passes& passes,
                             const stock::CutterSolid& cutter, bool numbered) {
  dexels.cut(passes.sweeps, cutter);
  std::vector<Ridge> ridges;
  const std::vector<int> none;
  const SurfaceMetrics m = measure_surface(dexels, passes.sweeps, numbered ? passes.pass_of_sweep : none,
                                           cutter, kLimits, &ridges);
  EXPECT_LT(m.gouge_max_um, 0.03);  // the chords of the facets and of the sweeps
  return ridges;
}

void expect_ridges(const stock::SurfaceDexels& dexels, const Passes& passes, const stock::CutterSolid& cutter,
                   double expected_mm, double tolerance, size_t least) {
  for (const bool numbered : {true, false}) {
    const std::vector<Ridge> ridges = ridges_of(dexels, passes, cutter, numbered);
    size_t counted = 0;
    for (const Ridge& ridge : ridges) {
      ASSERT_NEAR(ridge.height_um, um_from_mm(expected_mm), tolerance * um_from_mm(expected_mm))
          << ridge.point.transpose() << " numbered " << numbered;
      ++counted;
    }
    EXPECT_GE(counted, least);
  }
}

/// Passes along x over a plane or a cylinder about the x axis, at chords `interval_mm` of the contact points.
/// The axis stands on the normal, leaned by `lead` along the feed about the rim's contact.
Passes lengthwise(double radius, double interval_mm, double phase, int passes, double lead, double rim) {
  return passes_along(
      [=](int pass, double t) {
        const double x = -14.0 + 28.0 * t;
        const double place = (pass - 0.5 * (passes - 1)) * interval_mm + phase;
        Vec3 contact(x, place, 0.0), normal = Vec3::UnitZ();
        if (radius != 0.0) {
          const double a = 2.0 * std::asin(0.5 * interval_mm / radius) * place / interval_mm;
          normal = Vec3(0, std::sin(a), std::cos(a));
          contact = Vec3(x, 0, 0) + radius * normal;
        }
        const Vec3 axis = std::cos(lead) * normal + std::sin(lead) * Vec3::UnitX();
        const Vec3 forward = std::cos(lead) * Vec3::UnitX() - std::sin(lead) * normal;
        return ToolPose{contact - (lead == 0.0 ? 0.0 : rim) * forward, axis};
      },
      passes, 14);
}

stock::SurfaceDexels plane_dexels(double pitch) {
  return stock::SurfaceDexels(std::make_shared<Paraboloid>(0.0, 0.0, 3.0), pitch, kBox);
}

TEST(ScallopTheory, FlatWithLeadOnAPlane) {
  struct Case {
    double lead_deg, interval, expected;
  };
  for (const Case& c : {Case{5, 2, .0088045}, Case{10, 4, .0724850}, Case{20, 2, .0345511}}) {
    const Passes passes = lengthwise(0.0, c.interval, 0.123, 9, rad_from_deg(c.lead_deg), 5.0);
    expect_ridges(plane_dexels(0.3), passes, {5.0, 60.0}, c.expected, 1e-5, 20);
  }
}

TEST(ScallopTheory, BallOnAPlane) {
  expect_ridges(plane_dexels(0.2), lengthwise(0.0, 1.0, 0.077, 11, 0.0, 0.0), ball(5.0, 60.0), .025062814,
                1e-5, 100);
}

TEST(ScallopTheory, BallOnAConvexCylinder) {
  const stock::SurfaceDexels dexels(std::make_shared<Cylinder>(50.0, 6.0, 0.1), 0.2, kBox);
  expect_ridges(dexels, lengthwise(50.0, 1.0, 0.077, 13, 0.0, 0.0), ball(5.0, 60.0), .027591995, 1e-5, 100);
}

/// R < 0: contact and normal of the bore's inside.
TEST(ScallopTheory, BallOnAConcaveCylinder) {
  const stock::SurfaceDexels dexels(std::make_shared<Cylinder>(-50.0, 6.0, 0.1), 0.2, kBox);
  expect_ridges(dexels, lengthwise(-50.0, 1.0, 0.077, 13, 0.0, 0.0), ball(5.0, 60.0), .022541229, 1e-5, 100);
}

// h = w^2 / 2 det K / (t'Kt) to second order, w the cross distance between the ridge and a pass: the oracle's
// figures are those of w = 2; a tenth of that leaves errors of third order only. Sweeps of 5 um keep the
// chords of the path 1e-7 mm from it.
TEST(ScallopTheory, ObliqueFeedOnTheEllipticPatch) {
  const double kx = 1.0 / 40.0, ky = 1.0 / 120.0, w = 0.2;
  struct Case {
    double feed_deg, oracle;  // of w = 2
  };
  const std::vector<Case> cases{{0, .016667}, {20, .018076}, {45, .025000}, {70, .040520}, {90, .050000}};
  const stock::SurfaceDexels dexels(std::make_shared<Paraboloid>(kx, ky, 1.0), 0.05, kBox);
  for (const Case& c : cases) {
    const Vec2 along(std::cos(rad_from_deg(c.feed_deg)), std::sin(rad_from_deg(c.feed_deg)));
    const auto pose_at = [&](int pass, double t) {
      const Vec2 at = (2.0 * t - 1.0) * along + (pass == 0 ? -w : w) * Vec2(-along.y(), along.x());
      const Vec3 point(at.x(), at.y(), -0.5 * (kx * at.x() * at.x() + ky * at.y() * at.y()));
      return ToolPose{point, Vec3(kx * at.x(), ky * at.y(), 1.0).normalized()};
    };
    const double theory = 0.5 * w * w * kx * ky / (kx * along.x() * along.x() + ky * along.y() * along.y());
    ASSERT_NEAR(theory * 100.0, c.oracle, 1e-6);
    const Passes passes = passes_along(pose_at, 2, 400);
    for (const bool numbered : {true, false}) {
      size_t near_apex = 0;
      for (const Ridge& ridge : ridges_of(dexels, passes, {8.0, 60.0}, numbered)) {
        if (ridge.point.head<2>().norm() > 0.3) continue;
        ++near_apex;
        ASSERT_NEAR(ridge.height_um, um_from_mm(theory), 5e-3 * um_from_mm(theory))
            << c.feed_deg << " deg at " << ridge.point.transpose();
      }
      EXPECT_GE(near_apex, 8u) << c.feed_deg << " deg";
    }
  }
}

/// A strip of a cylinder of radius R about the x axis, in facets of `width` mm across and `length` mm along.
TriMesh cylinder_mesh(double radius, double angle, double width, double length, int along) {
  TriMesh mesh;
  const int across = static_cast<int>(angle * std::abs(radius) / width);
  for (int i = 0; i <= across; ++i) {
    const double a = angle * (static_cast<double>(i) / across - 0.5);
    for (int k = 0; k <= along; ++k) {
      mesh.positions.push_back({static_cast<float>(length * k), static_cast<float>(radius * std::sin(a)),
                                static_cast<float>(radius * std::cos(a))});
    }
  }
  const auto row = static_cast<uint32_t>(along + 1);
  for (uint32_t i = 0; i < static_cast<uint32_t>(across); ++i) {
    for (uint32_t k = 0; k + 1 < row; ++k) {
      const uint32_t n = i * row + k;
      mesh.triangles.push_back({n, n + row + 1, n + row});
      mesh.triangles.push_back({n, n + 1, n + row + 1});
    }
  }
  if (radius < 0.0) {
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  }
  return mesh;
}

// The facets' chords are w^2 / (8 R) = 2.5e-5 mm deep, the float positions good to 2e-6 mm.
TEST(ScallopTheory, MeshesOfTheSameShapes) {
  const double step = 2.0 * std::acos(50.0 / 50.01);
  const Passes flat = lengthwise(50.0, 100.0 * std::sin(0.5 * step), 0.077, 9, 0.0, 0.0);
  const stock::SurfaceDexels convex(stock::rays_on_mesh(cylinder_mesh(50.0, 0.1, 0.1, 1.0, 4), 0.4), kBox,
                                    {});
  EXPECT_GT(convex.normals().front().z(), 0.9);
  expect_ridges(convex, flat, {5.0, 60.0}, 0.01, 5e-3, 10);
  expect_ridges(convex, lengthwise(50.0, 1.0, 0.077, 13, 0.0, 0.0), ball(5.0, 60.0), .027591995, 5e-3, 20);
  const stock::SurfaceDexels concave(stock::rays_on_mesh(cylinder_mesh(-50.0, 0.1, 0.1, 1.0, 4), 0.4), kBox,
                                     {});
  EXPECT_GT(concave.normals().front().z(), 0.9);
  expect_ridges(concave, lengthwise(-50.0, 1.0, 0.077, 13, 0.0, 0.0), ball(5.0, 60.0), .022541229, 5e-3, 20);
}

}  // namespace
}  // namespace swarf::measure::scallop_theory_test
