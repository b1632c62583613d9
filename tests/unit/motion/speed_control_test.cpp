// Speed control cycle by cycle (Kato et al., Fig. 4): clamps are kept, limits are kept, nothing is wasted.
#include "motion/speed/speed_control.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/rng.h"

namespace swarf::motion {
namespace {

constexpr double kCycle = 1e-3;
constexpr RampLimits kLimits{2000.0, 50000.0};

ClampSpeeds clamps_of(const std::vector<double>& lengths, const std::vector<double>& speeds) {
  ClampSpeeds clamps{{0.0}, speeds, std::vector<double>(speeds.size() + 1, 1e9)};
  for (const double length : lengths) clamps.s.push_back(clamps.s.back() + length);
  clamps.at.back() = 0.0;
  return clamps;
}

struct Drive {
  std::vector<double> s{0.0};  ///< after each cycle
  std::vector<double> speed{0.0};
  bool arrived = false;
};

template <typename SetSpeed>
Drive drive(const ClampSpeeds& clamps, const SetSpeed& set, size_t cycles_max = 200000) {
  const SpeedControl control(kLimits, kCycle);
  Drive out;
  SpeedState state;
  double s = 0.0;
  size_t cell = 0;
  while (out.s.size() < cycles_max) {
    const SpeedTick tick = control.next(state, set(out.s.size() - 1), clamps, {cell, clamps.s[cell + 1] - s});
    s += tick.way_mm;
    state = tick.after;
    out.s.push_back(s);
    out.speed.push_back(state.speed);
    while (cell + 1 < clamps.speed.size() && s >= clamps.s[cell + 1] - 1e-9) ++cell;
    if (s >= clamps.s.back() - 1e-7) {
      out.arrived = true;
      return out;
    }
  }
  return out;
}

void expect_clamps_kept(const ClampSpeeds& clamps, const Drive& drive, const std::string& what) {
  const std::vector<double>& s = drive.s;
  EXPECT_LE(s.back(), clamps.s.back() + 1e-7) << what;
  double a0 = 0.0;
  for (size_t k = 1; k < s.size(); ++k) {
    const double v = (s[k] - s[k - 1]) / kCycle;
    const double v0 = k > 1 ? (s[k - 1] - s[k - 2]) / kCycle : 0.0;
    const double a = (v - v0) / kCycle;
    ASSERT_GE(v, -1e-9) << what << " cycle " << k;
    ASSERT_LE(std::abs(a), kLimits.acceleration * (1.0 + 1e-6)) << what << " cycle " << k;
    ASSERT_LE(std::abs(a - a0) / kCycle, kLimits.jerk * (1.0 + 1e-4)) << what << " cycle " << k;
    a0 = a;
    for (size_t c = 0; c < clamps.speed.size(); ++c) {
      // Chords that lie within the cell.
      if (s[k - 1] < clamps.s[c] || s[k] > clamps.s[c + 1]) continue;
      ASSERT_LE(v, clamps.speed[c] * (1.0 + 1e-9) + 1e-9) << what << " cycle " << k << " cell " << c;
    }
    for (size_t n = 1; n < clamps.s.size(); ++n) {
      if (s[k - 1] < clamps.s[n] - 1e-9 && s[k] > clamps.s[n] + 1e-9) {
        ASSERT_LE(std::min(drive.speed[k], drive.speed[k - 1]), clamps.at[n] * (1.0 + 1e-9))
            << what << " cycle " << k << " node " << n;
      }
    }
  }
}

TEST(SpeedChange, MeetsItsTargetWithinItsLimits) {
  Rng rng(7);
  for (int i = 0; i < 20000; ++i) {
    const SpeedState from{rng.uniform(0.0, 100.0), rng.uniform(-2000.0, 2000.0)};
    const double target = rng.uniform(0.0, 1.0) < 0.1 ? 0.0 : rng.uniform(0.0, 100.0);
    const SpeedChange change(from, target, kLimits);
    // Against the sum of small steps.
    SpeedState state = from;
    double way = 0.0;
    const int steps = 200;
    const double dt = change.duration() / steps;
    for (int k = 0; k < steps; ++k) {
      const SpeedState next = change.at((k + 1) * dt);
      ASSERT_LE(std::abs(next.acceleration), kLimits.acceleration * (1.0 + 1e-9));
      ASSERT_LE(std::abs(next.acceleration - state.acceleration), kLimits.jerk * dt * (1.0 + 1e-6) + 1e-9);
      ASSERT_NEAR(next.speed - state.speed, 0.5 * (next.acceleration + state.acceleration) * dt,
                  0.25 * kLimits.jerk * dt * dt + 1e-9);
      way += 0.5 * (state.speed + next.speed) * dt;
      state = next;
    }
    ASSERT_NEAR(state.speed, target, 1e-9);
    ASSERT_NEAR(change.length(), way, kLimits.acceleration * dt * change.duration() + 1e-9);
    ASSERT_NEAR(change.at(change.duration() - 1e-12).speed, target, 1e-7);
  }
}

// theory: from rest over 20 mm at 50 mm/s: the whole way is the two ramps and what is left between them.
TEST(SpeedControl, TakesNoLongerThanTheClosedForm) {
  const ClampSpeeds clamps = clamps_of({20.0}, {50.0});
  const Drive out = drive(clamps, [](size_t) { return 50.0; });
  ASSERT_TRUE(out.arrived);
  expect_clamps_kept(clamps, out, "one cell");
  const double ramp = ramp_time(0.0, 50.0, kLimits), ramp_way = ramp_length(0.0, 50.0, kLimits);
  const double best = 2.0 * ramp + (20.0 - 2.0 * ramp_way) / 50.0;
  EXPECT_LE(static_cast<double>(out.s.size() - 1) * kCycle, best + 3.0 * kCycle);
}

TEST(SpeedControl, KeepsRandomClamps) {
  for (uint64_t seed = 1; seed <= 300; ++seed) {
    Rng rng(seed);
    std::vector<double> lengths, speeds;
    const int cells = 1 + static_cast<int>(rng.uniform(0.0, 60.0));
    for (int i = 0; i < cells; ++i) {
      lengths.push_back(std::exp(rng.uniform(std::log(0.01), std::log(5.0))));
      speeds.push_back(std::exp(rng.uniform(std::log(2.0), std::log(150.0))));
    }
    ClampSpeeds clamps = clamps_of(lengths, speeds);
    for (size_t i = 1; i + 1 < clamps.at.size(); ++i)
      if (rng.uniform(0.0, 1.0) < 0.1)
        clamps.at[i] = rng.uniform(0.0, 1.0) < 0.5 ? 0.0 : rng.uniform(0.1, 20.0);
    const Drive out = drive(clamps, [](size_t) { return 100.0; });
    ASSERT_TRUE(out.arrived) << "seed " << seed << " stands at " << out.s.back();
    expect_clamps_kept(clamps, out, "seed " + std::to_string(seed));
    if (testing::Test::HasFatalFailure()) return;
  }
}

// Override and feed hold may come in any cycle.
TEST(SpeedControl, FollowsOverrideAndHoldAtAnyCycle) {
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    Rng rng(seed);
    ClampSpeeds clamps = clamps_of({10.0, 5.0, 10.0}, {80.0, 20.0, 60.0});
    double set = 50.0;
    const Drive out = drive(clamps, [&](size_t k) {
      if (rng.uniform(0.0, 1.0) < 0.02)
        set = rng.uniform(0.0, 1.0) < 0.3 && k < 3000 ? 0.0 : rng.uniform(10.0, 120.0);
      if (k > 3000) set = std::max(set, 10.0);
      return set;
    });
    ASSERT_TRUE(out.arrived) << "seed " << seed;
    expect_clamps_kept(clamps, out, "seed " + std::to_string(seed));
    if (testing::Test::HasFatalFailure()) return;
  }
}

// A falling staircase, as a curve that closes in, is descended at the limit of acceleration and not step by
// step.
TEST(SpeedControl, BrakesThroughManyClampsAtOnce) {
  std::vector<double> lengths, speeds;
  for (int i = 0; i < 200; ++i) {
    lengths.push_back(0.1);
    speeds.push_back(std::max(5.0, 100.0 - 1.0 * i));
  }
  const ClampSpeeds clamps = clamps_of(lengths, speeds);
  const Drive out = drive(clamps, [](size_t) { return 100.0; });
  ASSERT_TRUE(out.arrived);
  expect_clamps_kept(clamps, out, "staircase");
  // Half as fast as the clamps themselves would let it would take twice this.
  double least = 0.0;
  for (size_t i = 0; i < speeds.size(); ++i) least += lengths[i] / speeds[i];
  EXPECT_LE(static_cast<double>(out.s.size()) * kCycle, 1.6 * least);
}

}  // namespace
}  // namespace swarf::motion
