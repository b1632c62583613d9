// The three planners on the reference dome (theory 1.6), judged by the ridges that their poses truly leave.
#include <gtest/gtest.h>

#include <cmath>

#include "ridge.h"
#include "toolpath/area.h"

namespace swarf::toolpath::dome_test {
namespace {

using program::StartBoundary;

constexpr double kScallop = 0.01;

Area dome_area() {
  Area area;
  area.surface = test::dome();
  area.scallop_mm = kScallop;
  return area;
}

struct Planned {
  ToolPath path;
  std::vector<SurfacePass> passes;
};
Planned planned(Planner planner, StartBoundary start, double scallop = kScallop) {
  Diagnostics diagnostics;
  const program::Program program = test::area_program(test::dome(), start, scallop);
  Planned result;
  result.path = plan(program, cutter::Cutter{}, test::options_for(planner), diagnostics);
  for (const Diagnostic& d : diagnostics.list()) ADD_FAILURE() << format(d);
  result.passes = test::passes_of(result.path);
  return result;
}

double greatest_theory(const std::vector<SurfacePass>& passes) {
  double greatest = 0.0;
  for (const SurfacePass& pass : passes) greatest = std::max(greatest, pass.scallop_theory_mm);
  return greatest;
}

constexpr StartBoundary kBoundaries[] = {StartBoundary::kV0, StartBoundary::kV1, StartBoundary::kU0,
                                         StartBoundary::kU1};

TEST(Dome, IntervalsOfTheFirstPass) {
  const Area area = dome_area();
  const CubicSpline first = CubicSpline::constant(0.0);
  const auto chord = [&](double u, IntervalRule rule) {
    const PassFrame frame = pass_frame(area.pass_surface(), first, u);
    return interval_at(area, frame.shape, frame.unit_feed, rule).chord_mm;
  };
  EXPECT_NEAR(chord(0.00, IntervalRule::kPaper), 2.762423, 5e-7);
  EXPECT_NEAR(chord(0.25, IntervalRule::kPaper), 2.804457, 5e-7);
  EXPECT_NEAR(chord(0.50, IntervalRule::kPaper), 2.886544, 5e-7);
  EXPECT_NEAR(chord(0.00, IntervalRule::kExact), 2.915941, 5e-7);
  EXPECT_NEAR(chord(0.25, IntervalRule::kExact), 2.883390, 5e-7);
  EXPECT_NEAR(chord(0.50, IntervalRule::kExact), 2.886544, 5e-7);
  const MinimumInterval least = minimum_interval(area, first, IntervalRule::kPaper);
  EXPECT_NEAR(least.chord_mm, 2.758973, 5e-7);
  // The minimum is flat: the printed place comes from samples; 1e-4 of u changes P by 1e-9 mm.
  EXPECT_NEAR(std::min(least.t, 1.0 - least.t), 0.0535, 1e-4);
}

TEST(Dome, TheFirstPassLiesOnTheBoundaryAndRunsOverTheEdges) {
  for (const Planner planner : {Planner::kConstantScallop, Planner::kLinKoren, Planner::kIsoparametric}) {
    for (const StartBoundary start : kBoundaries) {
      const std::vector<SurfacePass> passes = planned(planner, start).passes;
      const SurfacePass& first = passes.front();
      const bool along_u = start == StartBoundary::kV0 || start == StartBoundary::kV1;
      const bool at_one = start == StartBoundary::kV1 || start == StartBoundary::kU1;
      EXPECT_EQ(first.curve.along_u, along_u);
      EXPECT_EQ(first.pass, 0);
      EXPECT_EQ(first.interval_mm, 0.0);
      for (const double t : {0.0, 0.3, 1.0}) EXPECT_EQ(first.curve.w.at(t).w, at_one ? 1.0 : 0.0);
      for (const SurfacePass& pass : passes) {
        if (test::low_t(pass) > 0.0 || test::high_t(pass) < 1.0) continue;
        const auto edge = [&](double t) { return curve_point(*pass.surface, pass.curve, t); };
        EXPECT_NEAR((edge(test::low_t(pass)) - edge(0.0)).norm(), 1.5, 0.01);
        EXPECT_NEAR((edge(test::high_t(pass)) - edge(1.0)).norm(), 1.5, 0.01);
      }
    }
  }
}

TEST(Dome, ConstantScallopLeavesTheSameCuspEverywhere) {
  for (const StartBoundary start : kBoundaries) {
    const Planned p = planned(Planner::kConstantScallop, start);
    const test::RidgeSummary found = test::summary(test::ridges(p.passes, {5.0}, 12));
    EXPECT_NEAR(found.highest.height_mm, kScallop, 0.005 * kScallop)
        << "boundary " << static_cast<int>(start);
    EXPECT_NEAR(found.p05_mm, kScallop, 0.005 * kScallop);
    EXPECT_NEAR(greatest_theory(p.passes), kScallop, 0.005 * kScallop);
  }
}

TEST(Dome, LinKorenStaysBelowTheScallopAndAgreesWithItsOwnTheory) {
  for (const StartBoundary start : kBoundaries) {
    const Planned p = planned(Planner::kLinKoren, start);
    const test::RidgeSummary found = test::summary(test::ridges(p.passes, {5.0}, 12));
    EXPECT_LE(found.highest.height_mm, kScallop) << "boundary " << static_cast<int>(start);
    EXPECT_NEAR(found.highest.height_mm / greatest_theory(p.passes), 1.0, 0.01);
  }
}

TEST(Dome, LinKorenOffsetsByTheLeastIntervalOfThePreviousPath) {
  const std::vector<SurfacePass> passes = planned(Planner::kLinKoren, StartBoundary::kV0).passes;
  EXPECT_NEAR(passes[1].interval_mm, 2.758973, 5e-7);
  // Every point of the second pass lies that far from the first, in the plane square to it.
  for (double t = 0.0; t <= 1.0; t += 0.05) {
    const Vec3 q = curve_point(*passes[1].surface, passes[1].curve, t);
    double s = t;
    for (int i = 0; i < 20; ++i) {
      const CurvePoint foot = curve_at(*passes[0].surface, passes[0].curve, s);
      s += (q - foot.C).dot(foot.dC) / foot.dC.squaredNorm();
    }
    EXPECT_NEAR((q - curve_point(*passes[0].surface, passes[0].curve, s)).norm(), 2.758973, 1e-6) << t;
  }
}

TEST(Dome, IsoparametricPassesAreConstantAndEndOnTheOppositeBoundary) {
  for (const StartBoundary start : kBoundaries) {
    const Planned p = planned(Planner::kIsoparametric, start);
    for (const SurfacePass& pass : p.passes)
      EXPECT_DOUBLE_EQ(pass.curve.w.at(0.0).w, pass.curve.w.at(0.77).w);
    EXPECT_EQ(p.passes.back().curve.w.at(0.5).w, 1.0 - p.passes.front().curve.w.at(0.5).w);
    const test::RidgeSummary found = test::summary(test::ridges(p.passes, {5.0}, 12));
    EXPECT_LE(found.highest.height_mm, kScallop);
    EXPECT_NEAR(found.highest.height_mm / greatest_theory(p.passes), 1.0, 0.01);
    // Every strip is as coarse as any other: no step is wasted.
    for (size_t i = 1; i < p.passes.size(); ++i)
      EXPECT_NEAR(p.passes[i].scallop_theory_mm / greatest_theory(p.passes), 1.0, 1e-3) << i;
  }
}

TEST(Dome, ConstantScallopIsTheShortestPath) {
  const double constant = planned(Planner::kConstantScallop, StartBoundary::kV0).path.pass_length_mm;
  const double lin_koren = planned(Planner::kLinKoren, StartBoundary::kV0).path.pass_length_mm;
  const double iso = planned(Planner::kIsoparametric, StartBoundary::kV0).path.pass_length_mm;
  EXPECT_LT(constant, lin_koren);
  EXPECT_LT(lin_koren, iso);
  // Strips of width P cover the area: length * mean interval = area of the dome, 10.4 k mm^2 and more.
  EXPECT_GT(constant * 2.95, 10400.0);
}

TEST(Dome, AFineScallopNeedsAboutAHundredPasses) {
  const Planned p = planned(Planner::kConstantScallop, StartBoundary::kV0, 1e-3);
  EXPECT_GT(p.path.passes, 100);
  EXPECT_LT(p.path.passes, 140);
  std::vector<test::Ridge> ridges;
  test::ridges_on_line(p.passes, {5.0}, 0.03, ridges);
  const test::RidgeSummary found = test::summary(ridges);
  EXPECT_NEAR(found.highest.height_mm, 1e-3, 5e-6);
  EXPECT_NEAR(found.p05_mm, 1e-3, 5e-6);
}

TEST(Dome, TotalsAreTheSumsOfTheElements) {
  const Planned p = planned(Planner::kLinKoren, StartBoundary::kV0);
  EXPECT_EQ(p.path.planner, "lin_koren");
  EXPECT_EQ(p.path.passes, p.passes.back().pass + 1);
  double length = 0.0;
  for (const SurfacePass& pass : p.passes) {
    const int n = 2000;
    Vec3 before = curve_point(*pass.surface, pass.curve, pass.t_start);
    for (int i = 1; i <= n; ++i) {
      const double t = pass.t_start + (pass.t_end - pass.t_start) * i / n;
      const Vec3 here = curve_point(*pass.surface, pass.curve, t);
      length += (here - before).norm();
      before = here;
    }
  }
  EXPECT_NEAR(p.path.pass_length_mm / length, 1.0, 1e-6);
}

TEST(Dome, OneIsoPassIsAsLongAsItsCurve) {
  program::Program program = test::area_program(test::dome(), StartBoundary::kV0, kScallop);
  program.operations[0].kind = program::OperationKind::kIsoPass;
  program.operations[0].iso_v = 0.0;
  PlanOptions options = test::options_for(Planner::kConstantScallop);
  options.overrun_mm = 0.0;
  Diagnostics diagnostics;
  const ToolPath path = plan(program, cutter::Cutter{}, options, diagnostics);
  EXPECT_EQ(path.passes, 1);
  EXPECT_NEAR(path.pass_length_mm, 109.823008377, 1e-9);
  const std::vector<SurfacePass> passes = test::passes_of(path);
  ASSERT_EQ(passes.size(), 1u);
  EXPECT_EQ(passes[0].t_start, 0.0);
  EXPECT_EQ(passes[0].t_end, 1.0);
}

TEST(Dome, CurveDerivativesMatchDifferences) {
  const std::vector<SurfacePass> passes = planned(Planner::kConstantScallop, StartBoundary::kU1).passes;
  const SurfacePass& pass = passes[7];
  const double step = 1e-4;
  for (const double t : {0.11, 0.52, 0.93}) {
    const CurvePoint c = curve_at(*pass.surface, pass.curve, t);
    const Vec3 after = curve_point(*pass.surface, pass.curve, t + step);
    const Vec3 before = curve_point(*pass.surface, pass.curve, t - step);
    EXPECT_EQ(c.v, t);
    EXPECT_LT((c.C - curve_point(*pass.surface, pass.curve, t)).norm(), 1e-12);
    EXPECT_LT((c.dC - (after - before) / (2.0 * step)).norm(), 1e-5);
    EXPECT_LT((c.ddC - (after - 2.0 * c.C + before) / (step * step)).norm(), 1e-3);
  }
}

}  // namespace
}  // namespace swarf::toolpath::dome_test
