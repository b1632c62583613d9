// Constant scallop of balls and bull noses, judged by the ridges that their poses truly leave.
#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"
#include "base/units.h"
#include "ridge.h"

namespace swarf::toolpath::round_ends_test {
namespace {

using program::StartBoundary;

constexpr double kScallop = 0.01;

/// The part 0.15 <= u <= 0.55, 0.2 <= v <= 0.5 of DOME.
surface::SurfacePtr piece_of_dome() {
  const std::vector<Vec3> coefficients{{-35, -24, 19.8}, {0, 24, 10.8}, {0, 0, -5.4},
                                       {40, 0, 22.4},    {0, 0, 0},     {0, 0, 0},
                                       {0, 0, -12.8},    {0, 0, 0},     {0, 0, 0}};
  return std::make_shared<surface::PolynomialSurface>(2, 2, coefficients, 1);
}

/// Hollow in both directions, least radius 1/(2 * 30/40^2) = 26.7 mm.
surface::SurfacePtr hollow() {
  return test::quadric(40.0, 30.0, -30.0, 30.0, -12.0, 12.0);
}

cutter::Cutter round_cutter(double diameter, double corner) {
  cutter::Cutter cutter;
  cutter.shape = 2.0 * corner == diameter ? cutter::Shape::kBall : cutter::Shape::kBullNose;
  cutter.diameter_mm = diameter;
  cutter.corner_radius_mm = corner;
  return cutter;
}

struct Asked {
  surface::SurfacePtr surface;
  cutter::Cutter cutter;
  StartBoundary start = StartBoundary::kV0;
  double lead_deg = 0.0, tilt_deg = 0.0;
  Planner planner = Planner::kConstantScallop;
};

struct Left {
  test::RidgeSummary ridges;
  double theory_mm = 0.0;
};

Left left_by(const Asked& asked, int lines = 6) {
  Diagnostics diagnostics;
  program::Program program = test::area_program(asked.surface, asked.start, kScallop);
  program.operations[0].lead_rad = rad_from_deg(asked.lead_deg);
  program.operations[0].tilt_rad = rad_from_deg(asked.tilt_deg);
  const ToolPath path = plan(program, asked.cutter, test::options_for(asked.planner), diagnostics);
  for (const Diagnostic& d : diagnostics.list())
    if (d.severity == Severity::kError) ADD_FAILURE() << format(d);
  const std::vector<SurfacePass> passes = test::passes_of(path);
  Left left{test::summary(test::ridges(passes, contact_end(asked.cutter), lines)), 0.0};
  for (const SurfacePass& pass : passes) left.theory_mm = std::max(left.theory_mm, pass.scallop_theory_mm);
  return left;
}

constexpr StartBoundary kStarts[] = {StartBoundary::kV0, StartBoundary::kU1};

TEST(RoundEnds, ABallLeavesTheSameCuspEverywhere) {
  for (const StartBoundary start : kStarts) {
    const Left left = left_by({piece_of_dome(), round_cutter(6.0, 3.0), start});
    EXPECT_NEAR(left.ridges.highest.height_mm, kScallop, 1e-4 * kScallop) << static_cast<int>(start);
    EXPECT_NEAR(left.ridges.p05_mm, kScallop, 1e-4 * kScallop);
    EXPECT_NEAR(left.theory_mm, kScallop, 5e-3 * kScallop);
  }
}

TEST(RoundEnds, ABallDoesSoInAHollow) {
  const Left left = left_by({hollow(), round_cutter(10.0, 5.0)});
  EXPECT_NEAR(left.ridges.highest.height_mm, kScallop, 1e-4 * kScallop);
  EXPECT_NEAR(left.ridges.p05_mm, kScallop, 1e-4 * kScallop);
}

TEST(RoundEnds, TheBallsAxisDoesNotMatter) {
  const Left left = left_by({piece_of_dome(), round_cutter(6.0, 3.0), StartBoundary::kV0, 8.0, 15.0});
  EXPECT_NEAR(left.ridges.highest.height_mm, kScallop, 1e-4 * kScallop);
}

TEST(RoundEnds, OtherPlannersStayBelowTheScallopOfABall) {
  for (const Planner planner : {Planner::kLinKoren, Planner::kIsoparametric}) {
    const Left left =
        left_by({piece_of_dome(), round_cutter(10.0, 5.0), StartBoundary::kV0, 0.0, 0.0, planner});
    EXPECT_LE(left.ridges.highest.height_mm, kScallop * (1.0 + 1e-3)) << planner_name(planner);
    EXPECT_NEAR(left.ridges.highest.height_mm / left.theory_mm, 1.0, 0.01) << planner_name(planner);
  }
}

TEST(RoundEnds, ABullNoseOnTheNormalIsItsFlatBottom) {
  const Left left = left_by({test::dome(), round_cutter(10.0, 2.0)});
  EXPECT_NEAR(left.ridges.highest.height_mm, kScallop, 5e-3 * kScallop);
  EXPECT_NEAR(left.ridges.p05_mm, kScallop, 5e-3 * kScallop);
}

TEST(RoundEnds, ALeanedBullNoseKeepsTheScallop) {
  for (const double lead : {3.0, 8.0}) {
    const Left left = left_by({piece_of_dome(), round_cutter(10.0, 2.0), StartBoundary::kV0, lead});
    EXPECT_NEAR(left.ridges.highest.height_mm, kScallop, 2e-3 * kScallop) << lead;
    EXPECT_NEAR(left.ridges.p05_mm, kScallop, 5e-3 * kScallop) << lead;
  }
}

TEST(RoundEnds, WithYawToo) {
  const Left left = left_by({piece_of_dome(), round_cutter(10.0, 2.0), StartBoundary::kV0, 8.0, 4.0});
  EXPECT_NEAR(left.ridges.highest.height_mm, kScallop, 5e-3 * kScallop);
}

}  // namespace
}  // namespace swarf::toolpath::round_ends_test
