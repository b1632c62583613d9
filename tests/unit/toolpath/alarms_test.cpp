// Alarms of theory 1.6 that need the cutter: stable code, place in the program, numbers, and a way out that
// works.
#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "base/units.h"
#include "ridge.h"

namespace swarf::toolpath::alarms_test {
namespace {

using program::StartBoundary;

struct Outcome {
  ToolPath path;
  Diagnostics diagnostics;
};
Outcome plan_with(const program::Program& program, double diameter = 10.0,
                  Planner planner = Planner::kConstantScallop) {
  cutter::Cutter cutter;
  cutter.diameter_mm = diameter;
  Outcome outcome;
  outcome.path = plan(program, cutter, test::options_for(planner), outcome.diagnostics);
  return outcome;
}

/// The only diagnostic, which must have this code and stand at the program's block.
Diagnostic only_error(const Outcome& outcome, const std::string& code) {
  EXPECT_EQ(outcome.diagnostics.list().size(), 1u);
  if (outcome.diagnostics.list().empty()) return {};
  const Diagnostic& d = outcome.diagnostics.list().front();
  EXPECT_EQ(d.code, code) << format(d);
  EXPECT_EQ(d.severity, Severity::kError);
  EXPECT_EQ(d.where.file, "test.nc");
  EXPECT_EQ(d.where.line, 11);
  EXPECT_FALSE(d.fix.empty());
  EXPECT_TRUE(outcome.path.elements.empty());
  return d;
}

/// The number that follows `key` in a text.
double number_after(const std::string& text, const std::string& key) {
  std::smatch match;
  if (!std::regex_search(text, match, std::regex(key + "([0-9.eE-]+)"))) return std::nan("");
  return std::stod(match[1]);
}

/// Saddle: z = 50 at the middle of u sinking both ways along u, rising along v.
surface::SurfacePtr saddle() {
  return test::quadric(100, 80, 80, -80, -30, 30);
}

TEST(Alarms, ASaddleNeedsALean) {
  const Outcome outcome = plan_with(test::area_program(saddle(), StartBoundary::kV0, 0.01));
  const Diagnostic d = only_error(outcome, "saddle-or-concave");
  EXPECT_NE(d.text.find("a saddle"), std::string::npos) << d.text;
  // Concave along v with z'' = 60/80^2 at the apex of u: Rc = 106.7 mm, gouge r^2/2Rc, phi = asin(r/Rc).
  EXPECT_NEAR(number_after(d.text, "concave radius "), 6400.0 / 60.0, 0.1) << d.text;
  EXPECT_NEAR(number_after(d.text, "gouges "), 12.5 / (6400.0 / 60.0), 1e-3) << d.text;
  EXPECT_NEAR(number_after(d.fix, "at least "), deg_from_rad(std::asin(5.0 * 60.0 / 6400.0)), 0.0101)
      << d.fix;
}

TEST(Alarms, TheGougeDepthOfTheory) {
  // Cylinder-like trough of radius 50: theory 1.2 gives .250628 for r = 5. The parabola 2 z = y^2/50 has it
  // at its bottom.
  const surface::SurfacePtr trough = test::quadric(100, 40, 0, 0, -16, 16);
  const Diagnostic d =
      only_error(plan_with(test::area_program(trough, StartBoundary::kV0, 0.01)), "saddle-or-concave");
  EXPECT_NEAR(number_after(d.text, "concave radius "), 50.0, 1e-4) << d.text;
  EXPECT_NEAR(number_after(d.text, "gouges "), 0.250628, 1e-6) << d.text;
}

TEST(Alarms, TheAdvisedLeanIsAcceptedAndLessIsNot) {
  program::Program program = test::area_program(saddle(), StartBoundary::kV0, 0.01);
  const double needed = number_after(plan_with(program).diagnostics.list().at(0).fix, "at least ");
  program.operations[0].lead_rad = rad_from_deg(needed - 0.05);
  only_error(plan_with(program), "saddle-or-concave");
  program.operations[0].lead_rad = rad_from_deg(needed);
  const Outcome enough = plan_with(program, 10.0, Planner::kIsoparametric);
  EXPECT_FALSE(enough.diagnostics.has_errors()) << format(enough.diagnostics.list().front());
  EXPECT_GT(enough.path.passes, 10);
}

TEST(Alarms, APathThatFoldsNamesThePlace) {
  // Lean and hollow cancel at the middle of the saddle only: there the interval is three times as long, and
  // the passes bend until they run across the others.
  program::Program program = test::area_program(saddle(), StartBoundary::kV0, 0.01);
  program.operations[0].lead_rad =
      rad_from_deg(number_after(plan_with(program).diagnostics.list().at(0).fix, "at least "));
  const Diagnostic d = only_error(plan_with(program), "path-folds");
  EXPECT_NE(d.text.find("near u="), std::string::npos) << d.text;
}

TEST(Alarms, AHollowSmallerThanTheCutterTakesNoLean) {
  const surface::SurfacePtr bowl = test::quadric(20, 20, -50, 50, -50, 50);
  const Diagnostic d =
      only_error(plan_with(test::area_program(bowl, StartBoundary::kU0, 0.01)), "saddle-or-concave");
  // z'' = 100/20^2: Rc = 4 mm, less than r = 5.
  EXPECT_NE(d.text.find("does not fit in"), std::string::npos) << d.text;
  EXPECT_NEAR(number_after(d.fix, "below "), 8.0, 1e-4) << d.fix;
}

TEST(Alarms, AnIntervalBeyondTheCutterNamesTheLargestScallop) {
  for (const Planner planner : {Planner::kConstantScallop, Planner::kLinKoren, Planner::kIsoparametric}) {
    program::Program program = test::area_program(test::dome(), StartBoundary::kV0, 0.5);
    const Diagnostic d = only_error(plan_with(program, 10.0, planner), "interval-beyond-cutter");
    EXPECT_GT(number_after(d.text, "path interval of "), number_after(d.text, "only up to ")) << d.text;
    program.operations[0].scallop_mm = number_after(d.fix, "about E");
    EXPECT_GT(program.operations[0].scallop_mm, 0.05);
    const Outcome mended = plan_with(program, 10.0, planner);
    EXPECT_FALSE(mended.diagnostics.has_errors()) << format(mended.diagnostics.list().front());
  }
}

TEST(Alarms, ATiltWithoutLeadCutsWithTheCorner) {
  program::Program program = test::area_program(test::dome(), StartBoundary::kV0, 0.01);
  program.operations[0].tilt_rad = rad_from_deg(10.0);
  const Diagnostic d = only_error(plan_with(program), "tilt-without-lead");
  program.operations[0].lead_rad = rad_from_deg(number_after(d.fix, "at least "));
  EXPECT_FALSE(plan_with(program).diagnostics.has_errors());
}

TEST(Alarms, ScallopsTooSmallToCountThePasses) {
  const Outcome outcome = plan_with(test::area_program(test::dome(), StartBoundary::kV0, 1e-9));
  only_error(outcome, "too-many-passes");
}

TEST(Alarms, AllOperationsAreChecked) {
  program::Program program = test::area_program(saddle(), StartBoundary::kV0, 0.01);
  program.operations.push_back(program.operations[0]);
  program.operations[1].where.line = 12;
  const Outcome outcome = plan_with(program);
  ASSERT_EQ(outcome.diagnostics.list().size(), 2u);
  EXPECT_EQ(outcome.diagnostics.list()[1].where.line, 12);
}

TEST(Plane, TheFlatEndLeavesNoScallopAndTheIntervalIsTheDiameter) {
  const surface::SurfacePtr plane = test::quadric(100, 80, 10, 0, 5, 0);
  for (const Planner planner : {Planner::kConstantScallop, Planner::kLinKoren, Planner::kIsoparametric}) {
    const Outcome outcome = plan_with(test::area_program(plane, StartBoundary::kV0, 0.01), 10.0, planner);
    EXPECT_FALSE(outcome.diagnostics.has_errors()) << format(outcome.diagnostics.list().front());
    const std::vector<SurfacePass> passes = test::passes_of(outcome.path);
    ASSERT_GT(passes.size(), 1u);
    for (size_t i = 1; i < passes.size(); ++i) {
      EXPECT_LE(passes[i].interval_mm, 10.0 + 1e-9);
      if (planner != Planner::kIsoparametric) {
        EXPECT_NEAR(passes[i].interval_mm, 10.0, 1e-9);
      }
      EXPECT_EQ(passes[i].scallop_theory_mm, 0.0);
    }
    // 80.16 mm: nine passes reach 5 mm beyond the last at 80 mm; iso-parametric ones end on the boundary.
    EXPECT_EQ(outcome.path.passes, planner == Planner::kIsoparametric ? 10 : 9);
  }
}

TEST(Cylinder, OnlyTheDirectionAcrossTheRulingsIsCurved) {
  // z = 60v - 60v^2: straight along u.
  const surface::SurfacePtr cylinder = test::quadric(100, 80, 0, 0, 60, -60);
  const Outcome along = plan_with(test::area_program(cylinder, StartBoundary::kV0, 0.01));
  ASSERT_FALSE(along.diagnostics.has_errors()) << format(along.diagnostics.list().front());
  const test::RidgeSummary found = test::summary(test::ridges(test::passes_of(along.path), {5.0}, 10));
  EXPECT_NEAR(found.highest.height_mm, 0.01, 1e-6);
  EXPECT_NEAR(found.p05_mm, 0.01, 1e-6);
  const Outcome across = plan_with(test::area_program(cylinder, StartBoundary::kU0, 0.01));
  ASSERT_FALSE(across.diagnostics.has_errors()) << format(across.diagnostics.list().front());
  // Feeding across the rulings every bottom touches a whole ruling: no cusp, 100 mm by 10 mm and the first.
  EXPECT_EQ(across.path.passes, 11);
}

/// z = -66 (u^2 + v^2) + b (u^3 + v^3): the curvature ends where u or v is 22/b.
surface::SurfacePtr flattening(double b) {
  std::vector<Vec3> c(16, Vec3::Zero());
  c[0] = {-50, -40, 0};
  c[1] = {0, 80, 0};
  c[4] = {100, 0, 0};
  c[2] = c[8] = {0, 0, -66};
  c[3] = c[12] = {0, 0, b};
  return std::make_shared<surface::PolynomialSurface>(3, 3, c, 1);
}

TEST(Edges, PartsOfAPassThatAreDoneDoNotStopTheRest) {
  // The middle of the family is over the boundary long before its ends, and reaches places that turn concave.
  const Outcome outcome = plan_with(test::area_program(flattening(20.0), StartBoundary::kV0, 0.002), 6.0);
  EXPECT_TRUE(outcome.diagnostics.list().empty()) << format(outcome.diagnostics.list().at(0));
  const test::RidgeSummary found = test::summary(test::ridges(test::passes_of(outcome.path), {3.0}, 6));
  EXPECT_LE(found.highest.height_mm, 1.01 * 0.002) << "u " << found.highest.u << " v " << found.highest.v;
}

TEST(Edges, WhereTheSurfaceDoesNotContinuePassesEndOnTheBoundary) {
  const surface::SurfacePtr surface = flattening(22.0 / 1.005);
  for (const Planner planner : {Planner::kConstantScallop, Planner::kLinKoren}) {
    const Outcome outcome = plan_with(test::area_program(surface, StartBoundary::kV0, 0.0001), 6.0, planner);
    ASSERT_EQ(outcome.diagnostics.list().size(), 2u) << format(outcome.diagnostics.list().at(0));
    for (const Diagnostic& d : outcome.diagnostics.list())
      ASSERT_EQ(d.severity, Severity::kNote) << format(d);
    EXPECT_EQ(outcome.diagnostics.list()[0].code, "no-overrun");
    EXPECT_EQ(outcome.diagnostics.list()[1].code, "no-continuation");
    const std::vector<SurfacePass> passes = test::passes_of(outcome.path);
    for (const SurfacePass& pass : passes) {
      EXPECT_GE(test::low_t(pass), 0.0);
      EXPECT_LE(test::high_t(pass), 1.0);
      for (double t = 0.0; t <= 1.0; t += 0.01) EXPECT_LE(pass.curve.w.at(t).w, 1.0 + 1e-3) << t;
    }
    const test::RidgeSummary found = test::summary(test::ridges(passes, {3.0}, 4));
    EXPECT_LE(found.highest.height_mm, 1.01 * 0.0001) << "u " << found.highest.u << " v " << found.highest.v;
  }
}

}  // namespace
}  // namespace swarf::toolpath::alarms_test
