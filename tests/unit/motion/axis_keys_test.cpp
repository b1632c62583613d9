// Keys of the axes: every cycle lies as near to the line between its keys as is said, whatever the axis does.
#include "motion/cycles/axis_keys.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/rng.h"
#include "base/units.h"

namespace swarf::motion {
namespace {

constexpr double kNoStep = std::numeric_limits<double>::infinity();

/// What a viewer does with the floats of a file: the greatest distance of any value from the line at its
/// time.
double greatest_distance(const std::vector<AxisKey>& keys, const std::vector<double>& values,
                         const std::vector<uint64_t>& cycles) {
  double greatest = 0.0;
  size_t at = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    while (at + 2 < keys.size() && keys[at + 1].cycle < cycles[i]) ++at;
    const AxisKey &a = keys[at], &b = keys[std::min(at + 1, keys.size() - 1)];
    const auto time = [](uint64_t cycle) { return static_cast<double>(static_cast<float>(cycle)); };
    const double span = time(b.cycle) - time(a.cycle);
    const double share =
        span > 0.0 ? std::clamp((static_cast<double>(cycles[i]) - time(a.cycle)) / span, 0.0, 1.0) : 0.0;
    const double from = static_cast<float>(a.q), to = static_cast<float>(b.q);
    const double line = from + share * (to - from);
    greatest = std::max(greatest, std::abs(line - values[i]));
  }
  return greatest;
}

/// Rests, straight moves, waves and noise of random sizes.
std::vector<double> random_motion(Rng& rng, size_t count) {
  std::vector<double> values;
  double q = rng.uniform(-500.0, 500.0);
  while (values.size() < count) {
    const auto part = static_cast<size_t>(rng.uniform(1.0, 2000.0));
    const double speed = rng.uniform() < 0.3 ? 0.0 : rng.uniform(-0.5, 0.5);
    const double wave = rng.uniform() < 0.5 ? 0.0 : rng.uniform(0.0, 2.0), rate = rng.uniform(0.001, 0.5);
    const double noise = rng.uniform() < 0.7 ? 0.0 : rng.uniform(0.0, 0.1);
    const double from = q;
    for (size_t i = 0; i < part && values.size() < count; ++i) {
      const auto t = static_cast<double>(i);
      q = from + speed * t + wave * std::sin(rate * t) + noise * rng.uniform(-1.0, 1.0);
      values.push_back(q);
    }
  }
  return values;
}

struct Keyed {
  KeyLine line;
  double distance = 0.0;
};

Keyed keyed(const std::vector<double>& values, uint64_t first, double tolerance, size_t most) {
  KeyLine line(tolerance, kNoStep, most);
  std::vector<uint64_t> cycles;
  for (size_t i = 0; i < values.size(); ++i) {
    cycles.push_back(i == 0 ? 0 : first + i);
    line.add(cycles.back(), values[i]);
  }
  line.finish();
  return {line, greatest_distance(line.keys(), values, cycles)};
}

TEST(AxisKeys, NoCycleIsFartherThanTheErrorSays) {
  for (uint64_t seed = 1; seed <= 40; ++seed) {
    Rng rng(seed);
    const double tolerance = std::exp(rng.uniform(std::log(1e-3), std::log(0.5)));
    const std::vector<double> values = random_motion(rng, 20'000);
    const Keyed out = keyed(values, 0, tolerance, 1 << 20);
    EXPECT_LE(out.distance, out.line.error() + 1e-9) << "Rng rng(" << seed << ")";
    EXPECT_NEAR(out.line.error(), tolerance, 1e-12) << "nothing forced it, Rng rng(" << seed << ")";
    EXPECT_LT(out.line.keys().size(), values.size()) << "Rng rng(" << seed << ")";
  }
}

/// Beyond 2^24 cycles, only every second, fourth ... number is a float.
TEST(AxisKeys, StandAtTimesThatFloatsHold) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    Rng rng(seed);
    const uint64_t first = (uint64_t{1} << 24U) << (seed % 6);
    const Keyed out = keyed(random_motion(rng, 20'000), first - 5000, 0.02, 1 << 20);
    for (const AxisKey& key : out.line.keys()) {
      ASSERT_EQ(static_cast<uint64_t>(static_cast<float>(key.cycle)), key.cycle);
      ASSERT_EQ(static_cast<double>(static_cast<float>(key.q)), key.q);
    }
    EXPECT_LE(out.distance, out.line.error() + 1e-9) << "Rng rng(" << seed << ")";
  }
}

TEST(AxisKeys, AreThinnedWhereThereAreTooMany) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    Rng rng(seed);
    const std::vector<double> values = random_motion(rng, 50'000);
    const Keyed out = keyed(values, 0, 1e-3, 100);
    EXPECT_LE(out.line.keys().size(), 102U) << "Rng rng(" << seed << ")";
    EXPECT_GT(out.line.error(), 1e-3) << "Rng rng(" << seed << ")";
    EXPECT_LE(out.distance, out.line.error() + 1e-9) << "Rng rng(" << seed << ")";
  }
}

TEST(AxisKeys, TurnLessThanAQuarterBetweenTwo) {
  KeyLine line(2e-4, 0.5 * kPi, 1 << 20);
  std::vector<double> values;
  std::vector<uint64_t> cycles;
  for (uint64_t k = 0; k < 10'000; ++k) {
    values.push_back(0.01 * static_cast<double>(k));
    cycles.push_back(k);
    line.add(k, values.back());
  }
  line.finish();
  for (size_t i = 1; i < line.keys().size(); ++i)
    ASSERT_LT(std::abs(line.keys()[i].q - line.keys()[i - 1].q), 0.5 * kPi);
  EXPECT_LT(line.keys().size(), 80U) << "100 rad in straight lines of a quarter turn";
  EXPECT_LE(greatest_distance(line.keys(), values, cycles), line.error() + 1e-9);
}

/// As Blender plays a turn: quaternions mixed and normalised.
double mixed(double from, double to, double share) {
  const double x = (1.0 - share) * std::cos(0.5 * from) + share * std::cos(0.5 * to),
               y = (1.0 - share) * std::sin(0.5 * from) + share * std::sin(0.5 * to);
  return 2.0 * std::atan2(y, x);
}

TEST(AxisKeys, MixedQuaternionsAreOffByNoMoreThanTheirErrorSays) {
  for (const double turn : {1e-3, 0.1, 0.21, 0.7, 1.5, 2.5, 3.1}) {
    double most = 0.0;
    for (int i = 0; i <= 20'000; ++i) {
      const double share = i / 20'000.0;
      most = std::max(most, std::abs(mixed(0.0, turn, share) - share * turn));
    }
    EXPECT_LE(most, mixing_error(turn) * (1.0 + 1e-9) + 1e-15) << turn;
    EXPECT_GE(most, mixing_error(turn) * (1.0 - 1e-6) - 1e-12) << turn;
  }
}

/// A table that turns evenly, for more turns than keys are wanted: no tolerance makes fewer lines of them.
TEST(AxisKeys, OfManyTurnsStayExactForEveryViewer) {
  kinematics::Axis table;
  table.kind = kinematics::AxisKind::kRotary;
  constexpr double kTolerance = 2e-4, kTurns = 300.0;
  AxisKeys keys(std::span(&table, 1), 0.02, kTolerance, 1000);
  constexpr uint64_t kCycles = 100'000;
  std::vector<Cycle> window(1);
  for (uint64_t k = 0; k <= kCycles; ++k) {
    window[0].number = k;
    window[0].q[0] = kTurns * 2.0 * kPi * static_cast<double>(k) / kCycles;
    keys.add(window);
  }
  keys.finish();
  const KeyLine& line = keys.axes().front();
  EXPECT_LE(line.error(), 1.01 * kTolerance);
  EXPECT_LT(static_cast<double>(line.keys().size()), 62.0 * kTurns);
  EXPECT_LT(mixing_error(line.longest_step()), 0.2 * kTolerance);
}

TEST(AxisKeys, OfOneCycleAndOfStandingAxes) {
  KeyLine one(0.02, kNoStep, 100);
  one.add(0, 7.25);
  one.finish();
  ASSERT_EQ(one.keys().size(), 1U);
  EXPECT_EQ(one.keys().front().q, 7.25);
  KeyLine still(0.02, kNoStep, 100);
  for (uint64_t k = 0; k < 1000; ++k) still.add(k, -3.5);
  still.finish();
  ASSERT_EQ(still.keys().size(), 2U);
  EXPECT_EQ(still.keys().back().cycle, 999U);
}

}  // namespace
}  // namespace swarf::motion
