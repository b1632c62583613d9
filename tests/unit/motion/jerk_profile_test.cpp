// Profiles keep their limits, exactly and tick by tick.
#include "motion/speed/jerk_profile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/rng.h"

namespace swarf::motion {
namespace {

constexpr double kPeriod = 1e-3;
constexpr double kBound = 1e-9;  // relative, as promised in the header

SpeedLimits random_limits(Rng& rng) {
  SpeedLimits limits;
  const auto cells = static_cast<size_t>(rng.uniform(2.0, 400.0));
  limits.s.push_back(0.0);
  double speed = rng.uniform(5.0, 100.0);
  double acceleration = rng.uniform(100.0, 3000.0);
  for (size_t i = 0; i < cells; ++i) {
    limits.s.push_back(limits.s.back() + rng.uniform(0.05, 0.5));
    if (rng.uniform() < 0.05) speed = std::exp(rng.uniform(std::log(0.5), std::log(100.0)));
    if (rng.uniform() < 0.05) acceleration = std::exp(rng.uniform(std::log(20.0), std::log(3000.0)));
    limits.speed.push_back(speed);
    limits.acceleration.push_back(acceleration);
  }
  return limits;
}

std::string paste(const SpeedLimits& limits) {
  std::ostringstream text;
  text.precision(17);
  const auto list = [&](const std::vector<double>& values) {
    text << "{";
    for (const double value : values) text << value << ", ";
    text << "}, ";
  };
  text << "SpeedLimits{";
  list(limits.s);
  list(limits.speed);
  list(limits.acceleration);
  text << "}";
  return text.str();
}

/// Least limit among the cells that [from, to] touches.
double least(const SpeedLimits& limits, const std::vector<double>& values, double from, double to) {
  double result = 1e300;
  for (size_t i = 0; i < values.size(); ++i)
    if (limits.s[i] <= to && limits.s[i + 1] >= from) result = std::min(result, values[i]);
  return result;
}

/// Greatest limit among those cells: a tick that ends on a node may be judged by either side.
double greatest(const SpeedLimits& limits, const std::vector<double>& values, double from, double to) {
  double result = 0.0;
  for (size_t i = 0; i < values.size(); ++i)
    if (limits.s[i] <= to && limits.s[i + 1] >= from) result = std::max(result, values[i]);
  return result;
}

void expect_kept(const SpeedLimits& limits, const Profile& profile, double jerk_max) {
  const double rounding = 1e-13 * limits.length();
  double position = 0.0, v1 = 0.0, v2 = 0.0, position1 = 0.0;
  for (size_t k = 0; k < profile.step_mm.size() + 2; ++k) {
    const double v = k < profile.step_mm.size() ? profile.step_mm[k] : 0.0;
    ASSERT_GE(v, 0.0);
    const double next = position + v;
    // Half a nanometre inside, so that a tick which ends on a node belongs to its own cell.
    const double skin = 5e-10;
    ASSERT_LE(v / kPeriod,
              least(limits, limits.speed, position + skin, std::max(position + skin, next - skin)) *
                      (1.0 + kBound) +
                  rounding / kPeriod)
        << "tick " << k << " at " << position << " mm";
    ASSERT_LE(std::abs(v - v1),
              greatest(limits, limits.acceleration, position1, next) * kPeriod * kPeriod * (1.0 + kBound) +
                  rounding)
        << "tick " << k << " at " << position << " mm";
    ASSERT_LE(std::abs(v - 2.0 * v1 + v2), jerk_max * std::pow(kPeriod, 3) * (1.0 + kBound) + rounding)
        << "tick " << k << " at " << position << " mm";
    position1 = position;
    position = next;
    v2 = v1;
    v1 = v;
  }
  EXPECT_NEAR(position, limits.length(), 1e-12 * limits.length() * std::sqrt(profile.step_mm.size()));
  EXPECT_EQ(profile.position_mm.back(), limits.length());
}

TEST(JerkProfile, RandomLimitsAreKeptEverywhere) {
  constexpr int kCases = 120;
  constexpr uint64_t kSeed = 1993;
  Rng rng(kSeed);
  for (int i = 0; i < kCases; ++i) {
    const SpeedLimits limits = random_limits(rng);
    const double jerk = std::exp(rng.uniform(std::log(5e3), std::log(2e5)));
    const SpeedPlan plan = plan_speed(limits, jerk, kPeriod);
    expect_kept(limits, sample_plan(plan, limits.length(), kPeriod), jerk);
    if (HasFatalFailure()) FAIL() << "case " << i << ", jerk " << jerk << "\n" << paste(limits);
  }
}

TEST(JerkProfile, ConstantLimitsReachThePlateauAndTakeTheOptimalTime) {
  SpeedLimits limits;
  for (int i = 0; i <= 400; ++i) limits.s.push_back(0.25 * i);
  limits.speed.assign(400, 50.0);
  limits.acceleration.assign(400, 2000.0);
  const Profile profile = sample_plan(plan_speed(limits, 5e4, kPeriod), 100.0, kPeriod);
  expect_kept(limits, profile, 5e4);
  EXPECT_NEAR(*std::max_element(profile.step_mm.begin(), profile.step_mm.end()), 0.05, 1e-13);
  const double optimal = RestToRest(100.0, 50.0, 2000.0, 5e4).duration();
  EXPECT_NEAR(static_cast<double>(profile.step_mm.size()) * kPeriod, optimal, 0.01);
}

TEST(JerkProfile, LengthMayDifferALittleFromTheLimits) {
  SpeedLimits limits{{0.0, 1.0, 2.0, 3.0}, {50.0, 40.0, 50.0}, {2000.0, 2000.0, 2000.0}};
  const SpeedPlan plan = plan_speed(limits, 5e4, kPeriod);
  EXPECT_EQ(sample_plan(plan, 3.0 - 1e-6, kPeriod).position_mm.back(), 3.0 - 1e-6);
}

TEST(JerkProfile, PoleDipCostsLittleMoreThanTheTurnItself) {
  // A rotary with 1 rad/s turns by half a turn while the path passes the pole at a distance of d: it cannot
  // be done in less than pi seconds, and the smoothing must not spread the slow stretch over its whole
  // window.
  for (const double d : {1.0, 0.1, 0.01, 1e-3}) {
    std::vector<double> right{0.0};
    while (right.back() < 20.0) right.push_back(right.back() + std::min(0.25, 0.02 * (d + right.back())));
    std::vector<double> nodes(right.rbegin(), right.rend() - 1);
    for (double& x : nodes) x = -x;
    nodes.insert(nodes.end(), right.begin(), right.end());
    SpeedLimits limits;
    for (const double x : nodes) limits.s.push_back(x - nodes.front());
    for (size_t i = 0; i + 1 < nodes.size(); ++i) {
      const double x = std::min(std::abs(nodes[i]), std::abs(nodes[i + 1]));
      limits.speed.push_back(std::min(50.0, (d * d + x * x) / d));
      limits.acceleration.push_back(2000.0);
    }
    const Profile profile = sample_plan(plan_speed(limits, 5e4, kPeriod), limits.length(), kPeriod);
    SCOPED_TRACE(d);
    expect_kept(limits, profile, 5e4);
    const double ideal =
        2.0 * (std::atan(std::sqrt(50.0 / d - 1.0)) + (20.0 - std::sqrt(d * (50.0 - d))) / 50.0);
    EXPECT_LT(static_cast<double>(profile.step_mm.size()) * kPeriod, ideal + 0.5);
  }
}

TEST(RestToRest, RandomProfilesCoverTheirLengthWithinTheirLimits) {
  Rng rng(41);
  for (int i = 0; i < 2000; ++i) {
    const double length = std::exp(rng.uniform(std::log(1e-3), std::log(500.0)));
    const double speed = rng.uniform(1.0, 500.0);
    const double acceleration = rng.uniform(50.0, 5000.0);
    const double jerk = rng.uniform(1e3, 1e6);
    SCOPED_TRACE(testing::Message() << "RestToRest(" << length << ", " << speed << ", " << acceleration
                                    << ", " << jerk << ")");
    const RestToRest profile(length, speed, acceleration, jerk);
    const double time = profile.duration();
    EXPECT_NEAR(profile.position(0.0), 0.0, 1e-12 * length);
    EXPECT_NEAR(profile.position(time), length, 1e-12 * length);
    const double h = time / 400.0;
    const double rounding = 1e-14 * length;
    for (int k = 3; k <= 400; ++k) {
      const double p0 = profile.position((k - 3) * h), p1 = profile.position((k - 2) * h);
      const double p2 = profile.position((k - 1) * h), p3 = profile.position(k * h);
      ASSERT_LE(p3 - p2, speed * h * (1 + kBound) + rounding);
      ASSERT_GE(p3 - p2, -rounding);
      ASSERT_LE(std::abs(p3 - 2 * p2 + p1), acceleration * h * h * (1 + kBound) + 4 * rounding);
      ASSERT_LE(std::abs(p3 - 3 * p2 + 3 * p1 - p0), jerk * h * h * h * (1 + kBound) + 8 * rounding);
    }
  }
}

TEST(RestToRest, KnownCases) {
  // Never at full acceleration: (32 L / J)^(1/3).
  EXPECT_NEAR(RestToRest(0.7, 50.0, 2000.0, 5e4).duration(), std::cbrt(32.0 * 0.7 / 5e4), 1e-12);
  // With all seven phases: L/V + V/A + A/J.
  EXPECT_NEAR(RestToRest(100.0, 200.0, 1000.0, 5e4).duration(), 0.5 + 0.2 + 0.02, 1e-12);
}

}  // namespace
}  // namespace swarf::motion
