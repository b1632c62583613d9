// The real-time core against theory 1.3 and DOME.
#include "motion/passes/surface_interpolator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <new>

#include "base/rng.h"
#include "dome.h"
#include "motion/passes/pass_geometry.h"

namespace {
std::atomic<size_t> allocations{0};
}  // namespace

// Every form is replaced, so that none is paired with the library's. Not inlined: the compiler would see
// malloc paired with delete and warn.
#define COUNTED __attribute__((noinline))

COUNTED void* operator new(size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size);
}
COUNTED void* operator new(size_t size) {
  if (void* memory = operator new(size, std::nothrow)) return memory;
  throw std::bad_alloc();
}
COUNTED void* operator new[](size_t size) {
  return operator new(size);
}
COUNTED void operator delete(void* memory) noexcept {
  std::free(memory);
}
COUNTED void operator delete(void* memory, size_t) noexcept {
  std::free(memory);
}
COUNTED void operator delete[](void* memory) noexcept {
  std::free(memory);
}
COUNTED void operator delete[](void* memory, size_t) noexcept {
  std::free(memory);
}

namespace swarf::motion {
namespace {

struct Fixture {
  kinematics::MachineModel machine = paper_machine();
  kinematics::InverseKinematics inverse{machine};
  cutter::Cutter cutter;

  SurfaceInterpolator make(Mode mode, double period = 1e-3) const {
    MotionOptions options;
    options.mode = mode;
    options.period_s = period;
    return {machine, inverse, cutter, options};
  }
};

struct ConstantFeed {
  double error_max = 0.0;  ///< of full ticks, relative
  double chord_error_um = 0.0;
  int full_ticks = 0;
};

ConstantFeed run_at_constant_feed(const toolpath::SurfacePass& pass, Mode mode, double period) {
  const Fixture with;
  SurfaceInterpolator interpolator = with.make(mode, period);
  interpolator.begin_unplanned(pass);
  const double length = pass.feed_mm_s * period;
  ConstantFeed result;
  StepInput input;
  input.feed_mm_s = pass.feed_mm_s;
  StepOutput out;
  double before = pass.t_start;
  for (interpolator.step(input, out); !out.finished; interpolator.step(input, out)) {
    ++result.full_ticks;
    result.error_max = std::max(result.error_max, std::abs(out.chord_mm / length - 1.0));
    const Vec3 a = curve_point(*pass.surface, pass.curve, before);
    const Vec3 direction = (out.contact_W - a) / out.chord_mm;
    const Vec3 gap = curve_point(*pass.surface, pass.curve, 0.5 * (before + out.t)) - a;
    result.chord_error_um =
        std::max(result.chord_error_um, 1e3 * (gap - gap.dot(direction) * direction).norm());
    before = out.t;
  }
  return result;
}

/// |value - oracle| within half a unit of the last printed digit.
void expect_digits(double value, double oracle, double unit) {
  EXPECT_NEAR(value, oracle, 0.5001 * unit);
}

TEST(SurfaceInterpolator, Taylor1ColumnOfTheTable) {
  const auto error = [](double V, double T) {
    return run_at_constant_feed(iso_pass(cylinder_of_eq8(), 0.0, V), Mode::kTaylor1, T).error_max;
  };
  expect_digits(error(50.0, 1e-3), 5.01e-3, 1e-5);
  expect_digits(error(200.0, 1e-3), 2.02e-2, 1e-4);
  expect_digits(error(2000.0 / 3.0, 1e-3), 6.90e-2, 1e-4);
  expect_digits(error(50.0, 1e-2), 5.13e-2, 1e-4);
}

TEST(SurfaceInterpolator, TwoNewtonStepsColumnOfTheTable) {
  const auto error = [](double V, double T) {
    return run_at_constant_feed(iso_pass(cylinder_of_eq8(), 0.0, V), Mode::kSurface, T).error_max;
  };
  // The first two are rounding of positions of 30 mm against steps of .05 and .2 mm.
  EXPECT_LT(error(50.0, 1e-3), 5e-13);
  EXPECT_LT(error(200.0, 1e-3), 1e-13);
  expect_digits(error(2000.0 / 3.0, 1e-3), 3.5e-10, 1e-11);
  expect_digits(error(50.0, 1e-2), 3e-11, 1e-11);
}

TEST(SurfaceInterpolator, ChordErrorColumnOfTheTable) {
  const auto error = [](double V, double T) {
    return run_at_constant_feed(iso_pass(cylinder_of_eq8(), 0.0, V), Mode::kSurface, T).chord_error_um;
  };
  expect_digits(error(50.0, 1e-3), .062, 1e-3);
  expect_digits(error(200.0, 1e-3), .971, 1e-3);
  expect_digits(error(2000.0 / 3.0, 1e-3), 10.09, 1e-2);
  expect_digits(error(50.0, 1e-2), 5.81, 1e-2);
}

TEST(SurfaceInterpolator, DomeTaylor1Takes4392FullTicks) {
  EXPECT_EQ(run_at_constant_feed(iso_pass(dome(), 0.0, 25.0), Mode::kTaylor1, 1e-3).full_ticks, 4392);
  EXPECT_EQ(run_at_constant_feed(iso_pass(dome(), 0.0, 25.0), Mode::kSurface, 1e-3).full_ticks, 4392);
}

TEST(SurfaceInterpolator, AxisIsTheExactNormalOfTheDomeOracle) {
  const Fixture with;
  toolpath::SurfacePass pass = iso_pass(dome(), 0.6, 50.0);
  pass.t_end = 0.3;
  SurfaceInterpolator interpolator = with.make(Mode::kSurface);
  interpolator.begin(pass, kinematics::AxisValues::Zero());
  StepOutput out;
  while (!out.finished) interpolator.step({}, out);
  EXPECT_LT((out.contact_W - Vec3(-20, 8, 31.2)).norm(), 1e-12);
  EXPECT_LT((out.pose.axis_W - Vec3(-.3017123, .14142764, .94285095)).norm(), 1e-7);
}

/// Runs a planned pass and holds it to all its limits.
void expect_limits_kept(const toolpath::SurfacePass& pass, Mode mode) {
  const Fixture with;
  const MotionOptions defaults;
  SurfaceInterpolator interpolator = with.make(mode);
  interpolator.begin(pass, kinematics::AxisValues::Zero());
  const double T = 1e-3;
  double v1 = 0.0, v2 = 0.0;
  StepOutput out;
  // Rounding of positions in v: 1e-13 mm / T.
  const double rounding = 1e-10;
  while (!out.finished) {
    interpolator.step({}, out);
    const double v = out.feed_mm_s;
    ASSERT_LE(v, pass.feed_mm_s * (1.0 + 1e-9) + rounding);
    ASSERT_LE(std::abs(v - v1), defaults.path_acceleration_max * T * (1.0 + 1e-9) + rounding);
    ASSERT_LE(std::abs(v - 2 * v1 + v2), defaults.path_jerk_max * T * T * (1.0 + 1e-9) + rounding);
    if (mode == Mode::kSurface) {
      ASSERT_LT(std::abs(out.chord_mm - v * T), 1e-9 * pass.feed_mm_s * T);
    }
    v2 = v1;
    v1 = v;
  }
  ASSERT_LE(std::abs(v1), defaults.path_acceleration_max * T);
  ASSERT_LE(std::abs(-2 * v1 + v2), defaults.path_jerk_max * T * T * (1.0 + 1e-9) + rounding);
  ASSERT_EQ(out.t, pass.t_end);
  ASSERT_EQ(out.contact_W, curve_point(*pass.surface, pass.curve, pass.t_end));
}

TEST(SurfaceInterpolator, PlannedDomePassesKeepTheirLimitsAndLandOnTheEnd) {
  for (const double v : {0.0, 0.25, 0.45, 0.49, 0.5, 1.0}) {
    SCOPED_TRACE(v);
    for (const Mode mode : {Mode::kSurface, Mode::kTaylor1}) {
      toolpath::SurfacePass pass = iso_pass(dome(), v, 50.0);
      expect_limits_kept(pass, mode);
      std::swap(pass.t_start, pass.t_end);
      expect_limits_kept(pass, mode);
    }
  }
}

TEST(SurfaceInterpolator, RandomPassesKeepTheirLimits) {
  constexpr int kCases = 60;
  Rng rng(7);
  for (int i = 0; i < kCases; ++i) {
    std::vector<double> w(8);
    for (double& value : w) value = rng.uniform(0.3, 0.7);
    for (double& value : w) value = 0.5 + 0.3 * (value - 0.5);
    toolpath::SurfacePass pass = iso_pass(dome(), 0.0, rng.uniform(5.0, 150.0));
    pass.curve = {rng.uniform() < 0.5, CubicSpline(-0.1, 1.2 / 7.0, w)};
    pass.t_start = rng.uniform();
    pass.t_end = rng.uniform();
    if (rng.uniform() < 0.3) pass.lead_rad = rng.uniform(0.01, 0.2);
    if (rng.uniform() < 0.3) pass.tilt_rad = rng.uniform(-0.2, 0.2);
    expect_limits_kept(pass, Mode::kSurface);
    if (HasFatalFailure()) {
      std::string knots;
      for (const double value : w) knots += std::to_string(value) + ", ";
      FAIL() << "case " << i << ": w {" << knots << "}, along_u " << pass.curve.along_u << ", t "
             << pass.t_start << " .. " << pass.t_end << ", feed " << pass.feed_mm_s << ", lead "
             << pass.lead_rad << ", tilt " << pass.tilt_rad;
    }
  }
}

TEST(SurfaceInterpolator, ChordToleranceClampsTheFeed) {
  const Fixture with;
  toolpath::SurfacePass pass = iso_pass(cylinder_of_eq8(), 0.0, 200.0);
  pass.chord_tolerance_mm = 1e-5;
  SurfaceInterpolator interpolator = with.make(Mode::kSurface);
  interpolator.begin(pass, kinematics::AxisValues::Zero());
  double greatest = 0.0, before = pass.t_start;
  StepOutput out;
  while (!out.finished) {
    interpolator.step({}, out);
    const Vec3 a = curve_point(*pass.surface, pass.curve, before);
    const Vec3 gap = curve_point(*pass.surface, pass.curve, 0.5 * (before + out.t)) - a;
    const Vec3 direction = (out.contact_W - a) / out.chord_mm;
    greatest = std::max(greatest, (gap - gap.dot(direction) * direction).norm());
    before = out.t;
  }
  EXPECT_LT(greatest, 1.001e-5);
  EXPECT_GT(greatest, 0.9e-5);  // it is this clamp that binds somewhere
}

TEST(SurfaceInterpolator, StepAllocatesNothing) {
#ifdef __has_feature
#if __has_feature(thread_sanitizer)
  GTEST_SKIP() << "NOT CHECKED: the thread sanitizer puts its own operator new in the counter's place";
#endif
#endif
  const Fixture with;
  SurfaceInterpolator interpolator = with.make(Mode::kSurface);
  const toolpath::SurfacePass pass = iso_pass(dome(), 0.49, 50.0);
  size_t before = allocations;
  interpolator.begin(pass, kinematics::AxisValues::Zero());
  EXPECT_GT(allocations, before);  // the counter counts
  StepOutput out;
  StepInput timed;
  timed.timed = true;
  kinematics::AxisValues q = kinematics::AxisValues::Zero();
  before = allocations;
  while (!out.finished) {
    interpolator.step(timed, out);
    q = with.inverse.solve_nearest(out.pose, q).q;
  }
  EXPECT_EQ(allocations, before);
  EXPECT_GT(out.tick_ns, 0.0);
}

}  // namespace
}  // namespace swarf::motion
