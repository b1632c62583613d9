// Surface driven interpolation on parts whose resting heights are closed forms.
#include "motion/passes/driven_interpolator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/units.h"
#include "dome.h"

namespace swarf::motion {
namespace {

using position::GuideLine;
using position::Near;
using position::Rest;
using toolpath::DrivenPass;
using toolpath::GuidePiece;

/// The height of the tip over (x, y), of an upright tool.
class Heights final : public position::Target {
 public:
  explicit Heights(std::function<double(double, double)> height) : height_(std::move(height)) {}
  void raise(const position::ToolProfile&, const GuideLine& line, Rest& best, Near&) const override {
    const double height = height_(line.point_W.x(), line.point_W.y()) - line.point_W.z();
    if (height <= best.height) return;
    best.height = height;
    best.what = position::Touched::kFace;
    best.contact_W = line.world({0.0, 0.0, height});
  }

 private:
  std::function<double(double, double)> height_;
};

cutter::Cutter ball() {
  cutter::Cutter tool;
  tool.shape = cutter::Shape::kBall;
  tool.diameter_mm = 10.0;
  tool.corner_radius_mm = 5.0;
  return tool;
}

DrivenPass pass_over(std::function<double(double, double)> height, std::vector<GuidePiece> pieces) {
  auto on = std::make_shared<toolpath::DrivenPart>(toolpath::DrivenPart{
      {{std::make_shared<Heights>(std::move(height))}, {}}, position::ToolProfile(ball())});
  DrivenPass pass;
  pass.on = on;
  pass.guide = std::make_shared<toolpath::PlaneGuide>(toolpath::GuideCurve(std::move(pieces)), GuideLine{});
  pass.feed_mm_s = 50.0;
  return pass;
}

struct Driven {
  std::vector<DrivenOutput> cycles;
  std::vector<Vec3> tips;
  EvaluatedPass ahead;
};

Driven run(
    const DrivenPass& pass, const std::function<double(size_t)>& share = [](size_t) { return 1.0; },
    const kinematics::MachineModel& machine = paper_machine()) {
  const kinematics::InverseKinematics inverse(machine);
  DrivenInterpolator interpolator(pass, machine, inverse, {}, kinematics::AxisValues::Zero());
  Driven out;
  out.ahead = interpolator.ahead();
  out.tips.push_back(interpolator.start().pose.tip_W);
  while (out.cycles.empty() || !out.cycles.back().finished) {
    out.cycles.push_back(interpolator.step({share(out.cycles.size())}));
    out.tips.push_back(out.cycles.back().at.pose.tip_W);
    if (out.cycles.size() > 100000) {
      ADD_FAILURE() << "the pass does not end; it stands at x = " << out.cycles.back().x;
      break;
    }
  }
  return out;
}

void expect_driven_kept(const Driven& run) {
  double v0 = 0.0, a0 = 0.0;
  for (size_t k = 0; k < run.cycles.size(); ++k) {
    const DrivenOutput& cycle = run.cycles[k];
    const bool on_node = std::any_of(run.ahead.nodes.begin(), run.ahead.nodes.end(), [&](const auto& node) {
      return node.corner && (node.pose.tip_W - cycle.at.pose.tip_W).norm() < 1e-6;
    });
    if (!on_node) {
      ASSERT_NEAR(cycle.chord_mm, cycle.feed_mm_s * 1e-3, 1e-8 * cycle.chord_mm + 5e-12) << "cycle " << k;
    }
    const double v = cycle.chord_mm / 1e-3, a = (v - v0) / 1e-3;
    ASSERT_LE(std::abs(a), 2000.0) << "cycle " << k;
    ASSERT_LE(std::abs(a - a0) / 1e-3, 50000.0) << "cycle " << k;
    v0 = v;
    a0 = a;
  }
}

TEST(DrivenInterpolator, KeepsItsChordOverASphere) {
  // Ball 5 on a sphere of 20: the tip moves on a sphere of 25 about a centre 5 below the sphere's.
  const auto height = [](double x, double y) { return std::sqrt(625.0 - x * x - y * y) - 5.0; };
  const Driven out = run(pass_over(height, {toolpath::guide_line({-15.0, 3.0}, {15.0, 3.0})}));
  expect_driven_kept(out);
  for (const Vec3& tip : out.tips) ASSERT_NEAR((tip - Vec3(0, 0, -5)).norm(), 25.0, 1e-11);
  EXPECT_EQ(out.tips.back(), Vec3(15.0, 3.0, height(15.0, 3.0)));
  EXPECT_NEAR(out.cycles[out.cycles.size() / 2].feed_mm_s, 50.0, 1e-9);
}

/// Holds the tip on the guide itself, however it leans.
class HeldOnGuide final : public position::Target {
 public:
  void raise(const position::ToolProfile&, const GuideLine& line, Rest& best, Near&) const override {
    if (0.0 <= best.height) return;
    best.height = 0.0;
    best.what = position::Touched::kFace;
    best.contact_W = line.point_W;
  }
};

/// Straight along X, leaning towards Y by kSway sin(kWave x), rad.
class SwayingGuide final : public toolpath::Guide {
 public:
  static constexpr double kSway = 0.05, kWave = 1.5;

  static double lean(double x) { return kSway * std::sin(kWave * x); }
  GuideLine line(double x) const override {
    const double s = std::sin(lean(x)), c = std::cos(lean(x));
    return {{x, 0, 0}, Vec3::UnitX(), {0, c, -s}, {0, s, c}};
  }
  double end() const override { return 30.0; }
  std::vector<double> joints() const override { return {}; }
};

// The tip goes straight, so that nothing but the axis bends the way of the cutter's rim, by reach phi'' (F
// T)^2 / 8 between two cycles: 2.5 times the tolerance at the set feed.
TEST(DrivenInterpolator, TheRimKeepsTheChordWhereTheAxisTurnsUnevenly) {
  DrivenPass pass =
      pass_over([](double, double) { return 0.0; }, {toolpath::guide_line({0.0, 0.0}, {30.0, 0.0})});
  pass.on = std::make_shared<toolpath::DrivenPart>(
      toolpath::DrivenPart{{{std::make_shared<HeldOnGuide>()}, {}}, position::ToolProfile(ball())});
  pass.guide = std::make_shared<SwayingGuide>();
  kinematics::MachineModel machine = paper_machine();
  for (kinematics::Axis& axis : machine.axes) axis.speed_max = axis.acceleration_max = axis.jerk_max = 1e9;
  const Driven out = run(
      pass, [](size_t) { return 1.0; }, machine);
  expect_driven_kept(out);
  const double reach = std::hypot(5.0, 5.0);
  double worst = 0.0, slowest = 50.0, fastest = 0.0;
  for (size_t k = 1; k < out.tips.size(); ++k) {
    const double a = out.tips[k - 1].x(), b = out.tips[k].x();
    const double even = 0.5 * (SwayingGuide::lean(a) + SwayingGuide::lean(b));
    worst = std::max(worst, reach * std::abs(SwayingGuide::lean(0.5 * (a + b)) - even));
    if (a < 5.0 || b > 25.0) continue;
    slowest = std::min(slowest, out.cycles[k - 1].feed_mm_s);
    fastest = std::max(fastest, out.cycles[k - 1].feed_mm_s);
  }
  EXPECT_LE(worst, 1.02 * pass.chord_tolerance_mm);
  EXPECT_GE(worst, 0.9 * pass.chord_tolerance_mm);
  EXPECT_LT(slowest, 35.0);
  EXPECT_GT(fastest, slowest);
}

TEST(DrivenInterpolator, StandsExactlyOnACrease) {
  const double slope = std::tan(rad_from_deg(25.0)), lift = 5.0 / std::cos(rad_from_deg(25.0)) - 5.0;
  // Ball on two planes that meet in a valley: its tip follows both, raised by its lift on the slope.
  const auto height = [&](double x, double) { return std::max(0.0, slope * (x - 3.2) + lift); };
  const Driven out = run(pass_over(height, {toolpath::guide_line({-10.0, 0.0}, {10.0, 0.0})}));
  expect_driven_kept(out);
  const double x = 3.2 - lift / slope;
  double nearest = 1e9;
  for (const Vec3& tip : out.tips) nearest = std::min(nearest, (tip - Vec3(x, 0.0, 0.0)).norm());
  EXPECT_LT(nearest, 1e-6);
  // No chord cuts the corner.
  for (size_t k = 1; k < out.tips.size(); ++k) {
    const Vec3 middle = 0.5 * (out.tips[k] + out.tips[k - 1]);
    ASSERT_NEAR(middle.z(), height(middle.x(), 0.0), 1e-6);
  }
}

// Creases as the edges of a mesh are, far below what makes a corner of a curve: chords across them keep the
// tolerance too. On a plane, and on a sphere, whose own turning hides them.
TEST(DrivenInterpolator, SmallCreasesKeepTheChordsTolerance) {
  const double at = 3.21;
  for (const double turn : {0.018, 0.012, 0.006})
    for (const bool on_sphere : {false, true}) {
      const auto height = [&](double x, double) {
        const double smooth = on_sphere ? std::sqrt(2500.0 - x * x) - 50.0 : 0.0;
        return smooth + (x > at ? turn * (x - at) : 0.0);
      };
      const Driven out = run(pass_over(height, {toolpath::guide_line({-10.0, 0.0}, {10.0, 0.0})}));
      expect_driven_kept(out);
      double worst = 0.0;
      for (size_t k = 1; k < out.tips.size(); ++k) {
        const Vec3 &a = out.tips[k - 1], &b = out.tips[k];
        if (a.x() > at || b.x() < at) continue;
        const double there = a.z() + (b.z() - a.z()) * (at - a.x()) / (b.x() - a.x());
        worst = std::max(worst, std::abs(there - height(at, 0.0)));
      }
      EXPECT_LE(worst, 1.0e-4) << turn << (on_sphere ? " on a sphere" : " on a plane");
    }
}

TEST(DrivenInterpolator, ClimbsAStepStraightUp) {
  const auto height = [](double x, double) { return x > 1.23456 ? 4.0 : 0.0; };
  for (const bool down : {false, true}) {
    const Vec2 from(-8.0, 0.0), to(8.0, 0.0);
    const Driven out =
        run(pass_over(height, {down ? toolpath::guide_line(to, from) : toolpath::guide_line(from, to)}));
    expect_driven_kept(out);
    int on_wall = 0;
    for (const Vec3& tip : out.tips) {
      if (tip.z() > 0.0 && tip.z() < 4.0) {
        ++on_wall;
        ASSERT_NEAR(tip.x(), 1.23456, 1e-6);
      }
    }
    EXPECT_GT(on_wall, 50);
  }
}

TEST(DrivenInterpolator, FeedHoldStandsAndGoesOn) {
  const auto height = [](double x, double y) { return std::sqrt(625.0 - x * x - y * y) - 5.0; };
  const DrivenPass pass = pass_over(height, {toolpath::guide_line({-15.0, 3.0}, {15.0, 3.0})});
  const Driven out = run(pass, [](size_t k) {
    return k > 200 && k < 600 ? 0.0 : k > 700 && k < 800 ? 1.2 : 1.0;
  });
  expect_driven_kept(out);
  EXPECT_EQ(out.cycles[500].feed_mm_s, 0.0);
  EXPECT_NEAR(out.cycles[790].feed_mm_s, 60.0, 10.0);
  EXPECT_EQ(out.tips.back(), Vec3(15.0, 3.0, height(15.0, 3.0)));
}

// The same as rows of a scene have it: held at .2 s, half the feed from .5 s on.
TEST(DrivenInterpolator, OverridesOfThePassCountFromItsBeginning) {
  const auto height = [](double x, double y) { return std::sqrt(625.0 - x * x - y * y) - 5.0; };
  DrivenPass pass = pass_over(height, {toolpath::guide_line({-15.0, 3.0}, {15.0, 3.0})});
  pass.overrides = {{0, 0.2, 0.0}, {0, 0.5, 0.5}};
  const Driven out = run(pass);
  expect_driven_kept(out);
  EXPECT_NEAR(out.cycles[199].feed_mm_s, 50.0, 1e-9);
  EXPECT_EQ(out.cycles[480].feed_mm_s, 0.0);
  EXPECT_NEAR(out.cycles[700].feed_mm_s, 25.0, 1e-9);
  EXPECT_EQ(out.tips.back(), Vec3(15.0, 3.0, height(15.0, 3.0)));
}

TEST(DrivenInterpolator, CornersOfTheGuideAreStops) {
  const Driven out =
      run(pass_over([](double, double) { return 1.0; },
                    {toolpath::guide_line({0, 0}, {10, 0}), toolpath::guide_line({10, 0}, {10, 5}),
                     toolpath::guide_spiral({0, 5}, 10.0, 4.0, 0.0, 2.0 * kPi)}));
  expect_driven_kept(out);
  double nearest = 1e9;
  for (const Vec3& tip : out.tips) nearest = std::min(nearest, (tip - Vec3(10, 0, 1)).norm());
  EXPECT_LT(nearest, 1e-6);
}

// Beside the wall the path is as steep as the step itself, and nothing comes after it: it is a step all the
// same.
TEST(DrivenInterpolator, SeesAStepInItsOwnDirectionAtTheEnd) {
  const auto height = [](double x, double) {
    const double d =
        x - 3.0;  // a ball 5 that rolls over an edge at x = 3, z = 7 down to a floor 1 mm too low
    return d >= 5.0 ? 1.0 : d <= 0.0 ? 7.0 : 2.0 + std::sqrt(25.0 - d * d);
  };
  const Driven out = run(pass_over(height, {toolpath::guide_line({-5.0, 0.0}, {8.0, 0.0})}));
  expect_driven_kept(out);
  EXPECT_EQ(std::count(out.ahead.steps.begin(), out.ahead.steps.end(), true), 1);
}

/// The expected code, thrown by a run over these heights.
void expect_refused(const DrivenPass& pass, const std::string& code) {
  try {
    run(pass);
    ADD_FAILURE() << code << " is not thrown";
  } catch (const InputError& error) {
    ASSERT_TRUE(error.diagnostics.has_errors());
    EXPECT_EQ(error.diagnostics.list().front().code, code) << error.what();
  }
}

/// Any number in [-1, 1], the same for the same x.
double noise_at(double x) {
  const auto bits = static_cast<uint64_t>(static_cast<int64_t>(std::llround(x * 1e12)));
  uint64_t z = bits * 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
  return static_cast<double>((z ^ (z >> 31U)) >> 11U) * 0x1.0p-52 - 1.0;
}

// Heights that are random within any share of a micrometre turn the path at every scale below it: each cell
// would be divided down to a tenth of a nanometre, a million lines for each 0.1 mm.
TEST(DrivenInterpolator, RandomHeightsAreRefusedBeforeTheyTakeTheMemory) {
  for (const double amplitude : {1e-2, 1e-3, 5e-4}) {
    const auto height = [&](double x, double) { return amplitude * noise_at(x); };
    expect_refused(pass_over(height, {toolpath::guide_line({-5.0, 0.0}, {5.0, 0.0})}), "part-too-rough");
  }
}

// Thousands of cycles that move the tool by less than what a position is known to: the pass would never end.
TEST(DrivenInterpolator, APassThatGetsNoFartherIsRefusedWithItsPlace) {
  DrivenPass pass =
      pass_over([](double, double) { return 1.0; }, {toolpath::guide_line({-5.0, 0.0}, {5.0, 0.0})});
  pass.overrides = {{0, 0.1, 1e-7}};
  expect_refused(pass, "pass-stands");
}

TEST(DrivenInterpolator, RestingOnNothingIsRefused) {
  const auto height = [](double x, double) {
    return x < 5.0 ? 0.0 : -std::numeric_limits<double>::infinity();
  };
  EXPECT_THROW(run(pass_over(height, {toolpath::guide_line({0, 0}, {10, 0})})), InputError);
}

}  // namespace
}  // namespace swarf::motion
