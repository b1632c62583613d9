#include "measure/measure.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/rng.h"
#include "base/units.h"
#include "dome_cut.h"
#include "test_surfaces.h"

namespace swarf::measure::measure_test {
namespace {

/// Swaps the parameters of a surface: ridges then run along v.
class Swapped final : public surface::Surface {
 public:
  explicit Swapped(surface::SurfacePtr base) : base_(std::move(base)) {}
  Vec3 point(double u, double v) const override { return base_->point(v, u); }
  surface::Derivatives derivatives(double u, double v) const override {
    const surface::Derivatives d = base_->derivatives(v, u);
    return {d.S, d.Sv, d.Su, d.Svv, d.Suv, d.Suu};
  }
  surface::BendBounds bend_bounds(const Vec2& low, const Vec2& high) const override {
    const surface::BendBounds b = base_->bend_bounds({low.y(), low.x()}, {high.y(), high.x()});
    return {b.vv, b.uv, b.uu};
  }
  int outward_sign() const override { return -base_->outward_sign(); }

 private:
  surface::SurfacePtr base_;
};

constexpr double kRadius = 50.0;
const MeasureLimits kLimits{0.01, 1e-5};

/// Passes along the cylinder's axis, the contact points `step` rad apart, the first at `phase`.
Passes cylinder_passes(double length, double first, double step, int passes) {
  Passes made;
  for (int pass = 0; pass < passes; ++pass) {
    const double a = first + pass * step;
    const Vec3 axis(0, std::sin(a), std::cos(a));
    const auto at = [&](double x) { return ToolPose{Vec3(x, 0, 0) + kRadius * axis, axis}; };
    constexpr int kSweeps = 40;
    for (int i = 0; i < kSweeps; ++i) {
      const double x0 = -2.0 + (length + 4.0) * i / kSweeps, x1 = -2.0 + (length + 4.0) * (i + 1) / kSweeps;
      made.sweeps.push_back({at(x0), at(x1), static_cast<uint32_t>(made.sweeps.size())});
      made.pass_of_sweep.push_back(pass);
    }
  }
  return made;
}

// theory 1.1: R = 50, h = 0.01; the angle between passes follows from h = R (1 / cos(theta) - 1).
void expect_ten_micrometres(double pitch, bool swapped) {
  const double step = 2.0 * std::acos(kRadius / (kRadius + 0.01));
  ASSERT_NEAR(2.0 * kRadius * std::tan(0.5 * step), 2.0001000, 5e-8);  // the oracle's distance in the plane
  const double length = 6.0, angle = 0.24;
  Rng rng(51);
  for (int n = 0; n < 10; ++n) {
    const double phase = rng.uniform() * step;
    const Passes passes = cylinder_passes(length, -0.16 + phase, step, 9);
    surface::SurfacePtr surface = std::make_shared<Cylinder>(kRadius, length, angle);
    if (swapped) surface = std::make_shared<Swapped>(surface);
    stock::SurfaceDexels dexels(surface, pitch, {{-10, -10, 0}, {20, 10, 60}});
    dexels.cut(passes.sweeps, kCutter);
    std::vector<Ridge> ridges;
    const SurfaceMetrics m =
        measure_surface(dexels, passes.sweeps, passes.pass_of_sweep, kCutter, kLimits, &ridges);
    const int lines = swapped ? dexels.nv() : dexels.nu();
    EXPECT_EQ(ridges.size() % static_cast<size_t>(lines), 0u);
    EXPECT_GE(ridges.size(), 5u * static_cast<size_t>(lines));
    EXPECT_NEAR(m.scallop_max_um, 10.0, 1e-6) << "phase " << phase;
    EXPECT_NEAR(m.scallop_p05_um, 10.0, 1e-6) << "phase " << phase;
    EXPECT_NEAR(m.scallop_mean_um, 10.0, 1e-6) << "phase " << phase;
    EXPECT_LT(m.gouge_max_um, 1e-6);
    EXPECT_LE(m.excess_max_um, 10.0 + 1e-6);  // no ray stands higher than the cusp
    EXPECT_EQ(m.uncut_samples, 0u);
    EXPECT_DOUBLE_EQ(m.within_tolerance_pct, 100.0);
  }
}

TEST(Scallops, TenMicrometresOnACylinderWithRandomGridPhase) {
  expect_ten_micrometres(0.4, false);
}
TEST(Scallops, RidgesAlongTheOtherParameter) {
  expect_ten_micrometres(0.25, true);
}

TEST(Scallops, DomePassesFollowTheIntervalFormula) {
  // h = P^2/8 det M/(t'Mt) at the middle of two iso-parametric passes, up to the change of curvature between
  // them.
  const surface::SurfacePtr surface = dome();
  for (const bool along_u : {true, false}) {
    const Passes passes = dome_passes(*surface, along_u, 33, 0.002, 0.05);
    stock::SurfaceDexels dexels(surface, 0.4, kDomeBox);
    dexels.cut(passes.sweeps, kCutter);
    std::vector<Ridge> ridges;
    measure_surface(dexels, passes.sweeps, passes.pass_of_sweep, kCutter, kLimits, &ridges);
    ASSERT_GT(ridges.size(), 4000u);
    for (const Ridge& ridge : ridges) {
      const surface::Derivatives d = surface->derivatives(ridge.u, ridge.v);
      const Vec3 normal = surface::outward_normal(*surface, d);
      const Vec3 along = along_u ? d.Su : d.Sv, other = along_u ? d.Sv : d.Su;
      const double E = along.squaredNorm(), F = along.dot(other), G = other.squaredNorm();
      const double L = -(along_u ? d.Suu : d.Svv).dot(normal), M = -d.Suv.dot(normal),
                   N = -(along_u ? d.Svv : d.Suu).dot(normal);
      const double gauss = (L * N - M * M) / (E * G - F * F);
      const double across = std::sqrt(G - F * F / E) * 1.1 / 32.0;
      const double theory_um = 1e3 * across * across / 8.0 * gauss / (L / E);
      ASSERT_NEAR(ridge.height_um, theory_um, 0.02 * theory_um) << "u " << ridge.u << " v " << ridge.v;
    }
  }
}

TEST(Scallops, RidgesDoNotDependOnThreads) {
  const surface::SurfacePtr surface = dome();
  const Passes passes = dome_passes(*surface, true, 33, 0.01, 0.05);
  stock::SurfaceDexels dexels(surface, 0.8, kDomeBox);
  dexels.cut(passes.sweeps, kCutter);
  std::vector<Ridge> one, many;
  set_thread_count(1);
  measure_surface(dexels, passes.sweeps, passes.pass_of_sweep, kCutter, kLimits, &one);
  set_thread_count(0);
  measure_surface(dexels, passes.sweeps, passes.pass_of_sweep, kCutter, kLimits, &many);
  ASSERT_EQ(one.size(), many.size());
  for (size_t n = 0; n < one.size(); ++n) {
    ASSERT_EQ(one[n].height_um, many[n].height_um);
    ASSERT_EQ(one[n].u, many[n].u);
  }
}

TEST(Gouge, PlantedDepthAndBlockAreFound) {
  const surface::SurfacePtr surface = dome();
  Passes passes = dome_passes(*surface, true, 33, 0.01, 0.05);
  for (const double depth_um : {20.0, 5.0, 1.0}) {
    Passes gouging = passes;
    const uint32_t planted = 16 * 110 + 55;  // the middle of the middle pass
    stock::Sweep& sweep = gouging.sweeps[planted];
    ASSERT_EQ(gouging.pass_of_sweep[planted], 16);
    sweep.start.tip_W -= depth_um * kMicrometre * sweep.start.axis_W;
    sweep.end.tip_W -= depth_um * kMicrometre * sweep.end.axis_W;
    stock::SurfaceDexels dexels(surface, 0.4, kDomeBox);
    dexels.cut(gouging.sweeps, kCutter);
    const SurfaceMetrics m =
        measure_surface(dexels, gouging.sweeps, gouging.pass_of_sweep, kCutter, {0.01, 0.0001}, nullptr);
    EXPECT_NEAR(m.gouge_max_um, depth_um, 0.2);
    EXPECT_EQ(m.gouge_block, planted);
    // The disc dips below an elliptic paraboloid: area 2 pi depth / sqrt(K), K = 3e-4 at the apex, drawn out
    // by the length of the sweep.
    EXPECT_GT(m.gouge_area_mm2, 2.0 * kPi * (depth_um - 0.1) * kMicrometre / std::sqrt(3.0e-4) * 0.8);
    EXPECT_LT(m.gouge_area_mm2, 2.0 * kPi * depth_um * kMicrometre / std::sqrt(3.0e-4) + 4.0);
  }
}

// A ball that runs 1 um too deep on a plane leaves a groove 0.2 mm wide; rays every 0.6 mm miss it
// altogether.
TEST(Gouge, BetweenTheRaysItIsFoundFromThePath) {
  const stock::CutterSolid cutter = ball(5.0, 60.0);
  const auto plane = std::make_shared<Paraboloid>(0.0, 0.0, 6.0);
  for (const double depth_um : {20.0, 5.0, 1.0}) {
    // Grid lines at y = -6 + 0.6 k; passes half way between them.
    Passes passes = passes_along(
        [](int pass, double t) {
          return ToolPose{{-7.0 + 14.0 * t, -6.3 + 1.2 * pass, 0.0}, Vec3::UnitZ()};
        },
        11, 28);
    const uint32_t first = 5 * 28 + 11;  // six sweeps of 0.5 mm on the middle pass
    for (uint32_t n = first; n < first + 6; ++n) {
      passes.sweeps[n].start.tip_W.z() -= depth_um * kMicrometre;
      passes.sweeps[n].end.tip_W.z() -= depth_um * kMicrometre;
    }
    stock::SurfaceDexels dexels(plane, 0.6, {{-6, -6, -9}, {6, 6, 9}});
    dexels.cut(passes.sweeps, cutter);
    const auto lowest = *std::min_element(dexels.heights_mm().begin(), dexels.heights_mm().end());
    EXPECT_EQ(lowest > 0.0, depth_um < 10.0);
    for (const bool numbered : {true, false}) {
      const SurfaceMetrics m =
          measure_surface(dexels, passes.sweeps, numbered ? passes.pass_of_sweep : std::vector<int>(), cutter,
                          {1.0, 1e-4}, nullptr);
      EXPECT_NEAR(m.gouge_max_um, depth_um, 0.002);
      EXPECT_GE(m.gouge_block, first);
      EXPECT_LT(m.gouge_block, first + 6);
      ASSERT_GE(m.gouges.size(), 1u);
      EXPECT_NEAR(m.gouges.front().worst_um, depth_um, 0.002);
      EXPECT_NEAR(m.gouges.front().place.y(), -0.3, 0.02);
      EXPECT_LT(std::abs(m.gouges.front().place.x()), 1.6);
    }
  }
}

// A gouge of 3 mm on a convex surface, by a tool that stands on the normal: the true depth is the planted
// one.
TEST(Gouge, ThreeMillimetresOnTheDomeAreOneRegion) {
  const surface::SurfacePtr surface = dome();
  for (const double depth_um : {20.0, 5.0, 1.0}) {
    Passes gouging = dome_passes(*surface, true, 33, 0.01, 0.05);
    const uint32_t planted = 16 * 110 + 55;
    for (uint32_t n = planted; n < planted + 3; ++n) {
      stock::Sweep& sweep = gouging.sweeps[n];
      sweep.start.tip_W -= depth_um * kMicrometre * sweep.start.axis_W;
      sweep.end.tip_W -= depth_um * kMicrometre * sweep.end.axis_W;
    }
    stock::SurfaceDexels dexels(surface, 0.5, kDomeBox);
    dexels.cut(gouging.sweeps, kCutter);
    // The chords of the sweeps, 1 mm long, cut up to 2 um into the dome everywhere: the limit lies above
    // them.
    const double limit_um = depth_um > 4.0 ? 3.0 : 0.5;
    const SurfaceMetrics m = measure_surface(dexels, gouging.sweeps, gouging.pass_of_sweep, kCutter,
                                             {0.01, limit_um * kMicrometre}, nullptr);
    EXPECT_NEAR(m.gouge_max_um, depth_um, 0.2);
    EXPECT_GE(m.gouge_block, planted);
    EXPECT_LE(m.gouge_block, planted + 2);
    ASSERT_GE(m.gouge_regions, 1u);
    EXPECT_EQ(m.gouges.front().block, m.gouge_block);
    EXPECT_LE(m.gouges.front().area_mm2, m.gouge_area_mm2 + 1e-9);
  }
}

TEST(Metrics, MaterialAboveAGapIsExcess) {
  stock::SurfaceDexels dexels(std::make_shared<Paraboloid>(0.0, 0.0, 5.0), 1.0, {{-5, -5, -5}, {5, 5, 10}});
  const stock::CutterSolid disc(20.0, 3.0);
  const std::vector<stock::Sweep> sweeps{{{{-4, 0, 0}, Vec3::UnitZ()}, {{4, 0, 0}, Vec3::UnitZ()}, 0}};
  dexels.cut(sweeps, disc);
  const SurfaceMetrics m = measure_surface(dexels, sweeps, std::vector<int>{0}, disc, kLimits, nullptr);
  EXPECT_DOUBLE_EQ(m.excess_max_um, 1e4);
  EXPECT_EQ(m.excess_block, 0u);  // the cutter that left it
  EXPECT_EQ(m.overhung_samples, m.samples);
  EXPECT_EQ(m.excess_regions, 1u);
  EXPECT_NEAR(m.excesses.front().area_mm2, 100.0, 1e-9);
  EXPECT_DOUBLE_EQ(m.within_tolerance_pct, 0.0);
  EXPECT_EQ(m.gouge_max_um, 0.0);
}

TEST(Metrics, UncutMaterialIsExcess) {
  const stock::SurfaceDexels dexels(dome(), 2.0, kDomeBox);
  const SurfaceMetrics m = measure_surface(dexels, {}, {}, kCutter, kLimits, nullptr);
  EXPECT_EQ(m.uncut_samples, m.samples);
  EXPECT_EQ(m.ridges, 0u);
  EXPECT_EQ(m.excess_block, stock::kUncut);
  EXPECT_GT(m.excess_max_um, 1e4);
  EXPECT_DOUBLE_EQ(m.within_tolerance_pct, 0.0);
}

TEST(Metrics, CombineWeighsByAreaAndKeepsTheWorst) {
  SurfaceMetrics a, b;
  a.samples = 300;
  a.area_mm2 = 10.0;
  a.within_tolerance_pct = 100.0;
  a.gouge_max_um = 2.0;
  a.gouge_block = 7;
  b.samples = 100;
  b.area_mm2 = 30.0;
  b.within_tolerance_pct = 50.0;
  b.excess_max_um = 30.0;
  b.excess_block = 9;
  const std::vector<Ridge> ridges{{0, 0, 9.0, 0, 1, Vec3::Zero()}, {0, 0, 11.0, 0, 1, Vec3::Zero()}};
  const SurfaceMetrics whole = combine({a, b}, ridges);
  EXPECT_EQ(whole.samples, 400u);
  EXPECT_DOUBLE_EQ(whole.within_tolerance_pct, 62.5);
  EXPECT_EQ(whole.gouge_block, 7u);
  EXPECT_EQ(whole.excess_block, 9u);
  EXPECT_DOUBLE_EQ(whole.scallop_max_um, 11.0);
  EXPECT_DOUBLE_EQ(whole.scallop_mean_um, 10.0);
  EXPECT_DOUBLE_EQ(whole.scallop_p05_um, 9.1);
  EXPECT_EQ(combine({}, {}).samples, 0u);
}

TEST(Metrics, HistogramCountsEverySample) {
  const surface::SurfacePtr surface = dome();
  const Passes passes = dome_passes(*surface, true, 33, 0.01, 0.05);
  stock::SurfaceDexels dexels(surface, 1.0, kDomeBox);
  dexels.cut(passes.sweeps, kCutter);
  const auto histogram = height_histogram(dexels, 0.0, 12.0, 24);
  size_t total = 0;
  for (const HistogramBin& bin : histogram) total += bin.count;
  EXPECT_EQ(total, dexels.heights_mm().size());
  EXPECT_DOUBLE_EQ(histogram.front().low_um, 0.0);
  EXPECT_DOUBLE_EQ(histogram.back().high_um, 12.0);
  size_t below = 0;
  for (const double height : dexels.heights_mm()) below += height < 0.5e-3 ? 1 : 0;
  EXPECT_EQ(histogram.front().count, below);
}

// theory 1.6: the volume under DOME over its base is 186666.6667; passes leave cusps above it.
TEST(CrossCheck, DomeLevelSetAgreesWithItsDexelsAndWithTheVolume) {
  const surface::SurfacePtr surface = dome();
  const Passes passes = dome_passes(*surface, true, 33, 0.005, 0.06);
  stock::Stock stock({{-50, -40, -10}, {50, 40, 45}}, 0.2);
  // Long enough for the 45 mm of stock above the edges: 25 mm of flutes would leave 2.9 cm3 hanging there.
  const stock::CutterSolid cutter{5.0, 60.0};
  stock.cut(passes.sweeps, cutter);
  EXPECT_EQ(stock.check(), "");
  const double exact = 186666.6667 + 10.0 * 100.0 * 80.0;
  EXPECT_NEAR(stock.volume_mm3(), exact, 1e-3 * 186666.6667);
  stock::SurfaceDexels dexels(surface, 0.2, stock.box());
  dexels.cut(passes.sweeps, cutter);
  const CrossCheck check = cross_check(stock, dexels, passes.sweeps, cutter, 0.0);
  EXPECT_TRUE(check.holds);
  EXPECT_GT(check.samples, 4 * check.excluded);
  EXPECT_LT(check.max_um, check.bound_um);
  EXPECT_LT(check.mean_abs_um, 1.0);
  std::string numbers = fmt::format(
      "mean {:.3f} p99 {:.3f} max {:.3f} bound {:.3f} um, {} samples, {} excluded", check.mean_abs_um,
      check.p99_um, check.max_um, check.bound_um, check.samples, check.excluded);
  RecordProperty("cross_check", numbers);
  RecordProperty("volume_error_mm3", fmt::format("{:.3f}", stock.volume_mm3() - exact));
  // A level set that was cut 20 um deeper in one place is noticed.
  stock::Sweep deeper = passes.sweeps[passes.sweeps.size() / 2];
  deeper.start.tip_W -= 0.02 * deeper.start.axis_W;
  deeper.end.tip_W -= 0.02 * deeper.end.axis_W;
  stock.cut(std::vector<stock::Sweep>{deeper}, cutter);
  EXPECT_FALSE(cross_check(stock, dexels, passes.sweeps, cutter, 0.0).holds);
}

// A hole of D 10 through a block under a finished plane: rays over it end 3 mm below the block, where the
// level set says nothing.
TEST(CrossCheck, ARayThatIsCutThroughTheBlockIsNotCompared) {
  const auto plane = std::make_shared<Paraboloid>(0.0, 0.0, 9.0);
  const auto down = [](double x, double y, double z) { return ToolPose{{x, y, z}, Vec3::UnitZ()}; };
  std::vector<stock::Sweep> sweeps;
  for (double y = -12.0; y <= 12.0; y += 6.0)
    sweeps.push_back({down(-20, y, 0), down(20, y, 0), static_cast<uint32_t>(sweeps.size())});
  sweeps.push_back({down(0, 0, 5), down(0, 0, -7), static_cast<uint32_t>(sweeps.size())});
  stock::Stock stock({{-10, -10, -4}, {10, 10, 1}}, 0.3);
  const stock::CutterSolid cutter{5.0, 60.0};
  stock.cut(sweeps, cutter);
  stock::SurfaceDexels dexels(plane, 0.5, stock.box());
  dexels.cut(sweeps, cutter);
  EXPECT_NEAR(*std::min_element(dexels.heights_mm().begin(), dexels.heights_mm().end()), -7.0, 1e-9);
  const CrossCheck check = cross_check(stock, dexels, sweeps, cutter, 0.0);
  EXPECT_TRUE(check.holds) << check.max_um << " of " << check.bound_um << " um";
  EXPECT_GT(check.samples, 0U);
  // Those around it are: a level set that was cut 20 um deeper is noticed.
  stock.cut(std::vector<stock::Sweep>{{down(-20, 0, -0.02), down(20, 0, -0.02), 0}}, cutter);
  EXPECT_FALSE(cross_check(stock, dexels, sweeps, cutter, 0.0).holds);
}

}  // namespace
}  // namespace swarf::measure::measure_test
