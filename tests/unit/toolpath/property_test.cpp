// Random convex patches: whatever the planner, the start boundary and the parametrisation, the ridges that
// the poses truly leave stay below the scallop.
#include <gtest/gtest.h>

#include <sstream>

#include "base/rng.h"
#include "base/units.h"
#include "ridge.h"
#include "surface/curvature.h"

namespace swarf::toolpath {
namespace {

/// A biquadratic patch over a skewed, bent rectangle, convex with curvature radii of about 20 to 200 mm.
std::vector<Vec3> random_patch(Rng& rng) {
  const double width = rng.uniform(30, 80);
  const double depth = rng.uniform(30, 80);
  std::vector<Vec3> c(9);
  for (Vec3& value : c) value = {rng.uniform(-2, 2), rng.uniform(-2, 2), rng.uniform(-1, 1)};
  c[1] += Vec3(rng.uniform(-0.4, 0.4) * depth, depth, rng.uniform(-10, 10));
  c[3] += Vec3(width, rng.uniform(-0.2, 0.2) * width, rng.uniform(-10, 10));
  c[2].z() -= depth * depth / rng.uniform(60, 200);
  c[6].z() -= width * width / rng.uniform(60, 200);
  return c;
}

bool is_convex(const surface::Surface& surface) {
  for (int i = -2; i <= 22; ++i) {
    for (int j = -2; j <= 22; ++j) {
      const surface::Derivatives d = surface.derivatives(i / 20.0, j / 20.0);
      if (d.Su.cross(d.Sv).norm() < 100.0) return false;
      const surface::PrincipalCurvatures k =
          surface::principal_curvatures(surface::shape_at(d, surface.outward_sign()));
      if (k.low < 2e-3 || k.high > 0.05) return false;
    }
  }
  return true;
}

surface::SurfacePtr random_convex(Rng& rng, std::vector<Vec3>& coefficients) {
  while (true) {
    coefficients = random_patch(rng);
    auto surface = std::make_shared<surface::PolynomialSurface>(2, 2, coefficients, 1);
    if (is_convex(*surface)) return surface;
  }
}

/// The case as a program fragment, ready to paste.
std::string as_text(const std::vector<Vec3>& c, const program::Operation& operation, Planner planner) {
  std::ostringstream text;
  text.precision(17);
  text << "planner " << planner_name(planner) << "\nG10 L70 P1 Q2 R2\n";
  for (int i = 0; i < 9; ++i)
    text << "G10 L71 P1 I" << i / 3 << " J" << i % 3 << " X" << c[i].x() << " Y" << c[i].y() << " Z"
         << c[i].z() << "\n";
  text << "G10 L79 P1 D1\nG06.3 P1 B" << static_cast<int>(operation.start) << " E" << operation.scallop_mm
       << " K0.001 F3000 L" << operation.zigzag << " I" << deg_from_rad(operation.lead_rad) << " J"
       << deg_from_rad(operation.tilt_rad) << "\n";
  return text.str();
}

void check_case(const std::vector<Vec3>& coefficients, Planner planner, program::Program program,
                double share) {
  const std::string text = as_text(coefficients, program.operations[0], planner);
  Diagnostics diagnostics;
  const ToolPath path = plan(program, cutter::Cutter{}, test::options_for(planner), diagnostics);
  for (const Diagnostic& d : diagnostics.list())
    if (d.severity == Severity::kError) ADD_FAILURE() << format(d) << "\n" << text;
  if (path.elements.empty()) return;
  const double h = program.operations[0].scallop_mm;
  const test::RidgeSummary found = test::summary(test::ridges(test::passes_of(path), {5.0}, 6));
  EXPECT_LE(found.highest.height_mm, share * h)
      << "at u " << found.highest.u << " v " << found.highest.v << " pass " << found.highest.pass << " edge "
      << found.highest.edge << "\n"
      << text;
  if (planner == Planner::kConstantScallop && program.operations[0].lead_rad == 0.0) {
    EXPECT_GE(found.p05_mm, 0.995 * h) << text;
  }
}

constexpr Planner kPlanners[] = {Planner::kConstantScallop, Planner::kLinKoren, Planner::kIsoparametric};

TEST(RandomConvexPatches, RidgesOnTheNormalStayBelowTheScallop) {
  Rng rng(20260);
  for (int i = 0; i < 12; ++i) {
    std::vector<Vec3> c;
    const surface::SurfacePtr surface = random_convex(rng, c);
    for (const Planner planner : kPlanners) {
      const auto start = static_cast<program::StartBoundary>((i + static_cast<int>(planner)) % 4);
      check_case(c, planner, test::area_program(surface, start, 0.01), 1.01);
    }
  }
}

TEST(RandomConvexPatches, RidgesOfALeanedToolStayBelowTheScallop) {
  Rng rng(77);
  for (int i = 0; i < 6; ++i) {
    std::vector<Vec3> c;
    const surface::SurfacePtr surface = random_convex(rng, c);
    program::Program program = test::area_program(surface, static_cast<program::StartBoundary>(i % 4), 0.01);
    program.operations[0].lead_rad = rad_from_deg(rng.uniform(3.0, 15.0));
    program.operations[0].tilt_rad = rad_from_deg(rng.uniform(-3.0, 3.0));
    for (const Planner planner : kPlanners) check_case(c, planner, program, 1.03);
  }
}

}  // namespace
}  // namespace swarf::toolpath
