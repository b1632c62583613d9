#include "motion/cycles/time_envelope.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"

namespace swarf::motion {
namespace {

TEST(TimeEnvelope, KeepsEveryMinimumAndMaximumInFewPoints) {
  Rng rng(3);
  TimeEnvelope envelope(1, 1e-3);
  double low = 1e9, high = -1e9, fastest = 0.0, before = 0.0;
  constexpr size_t kCycles = 1'000'000;
  std::vector<Cycle> window(1);
  for (size_t k = 0; k < kCycles; ++k) {
    Cycle& cycle = window.front();
    cycle.sample.kind = k % 100'000 < 60'000 ? SampleKind::kCutting : SampleKind::kRapid;
    cycle.q[0] = rng.uniform(-1.0, 1.0) + (k == 777'777 ? 50.0 : 0.0);
    low = std::min(low, cycle.q[0]);
    high = std::max(high, cycle.q[0]);
    if (k > 0) fastest = std::max(fastest, std::abs(cycle.q[0] - before) / 1e-3);
    before = cycle.q[0];
    cycle.sample.feed_mm_s = 20.0;
    envelope.add(window);
  }
  const std::vector<Vec2> position = envelope.position(0), speed = envelope.speed(0), feed = envelope.feed();
  EXPECT_LE(position.size(), 2 * TimeEnvelope::kSpansMost);
  EXPECT_GE(position.size(), TimeEnvelope::kSpansMost);
  const auto by_value = [](const Vec2& a, const Vec2& b) { return a.y() < b.y(); };
  EXPECT_EQ(std::min_element(position.begin(), position.end(), by_value)->y(), low);
  const auto top = std::max_element(position.begin(), position.end(), by_value);
  EXPECT_EQ(top->y(), high);
  EXPECT_NEAR(top->x(), 777.777, 1e-9);
  double shown = 0.0;
  for (const Vec2& point : speed) shown = std::max(shown, std::abs(point.y()));
  EXPECT_EQ(shown, fastest);
  for (size_t i = 1; i < position.size(); ++i) ASSERT_GE(position[i].x(), position[i - 1].x());
  const auto gaps = std::count_if(feed.begin(), feed.end(), [](const Vec2& p) { return std::isnan(p.y()); });
  EXPECT_EQ(gaps, 10) << "one for each row of rapids";
}

TEST(TimeEnvelope, ShowsAShortProgramAsItIs) {
  TimeEnvelope envelope(1, 0.5);
  std::vector<Cycle> cycles(3);
  cycles[1].q[0] = 2.0;
  cycles[2].q[0] = 5.0;
  envelope.add(cycles);
  const std::vector<Vec2> position = envelope.position(0), speed = envelope.speed(0);
  ASSERT_EQ(position.size(), 3U);
  EXPECT_EQ(position[2], Vec2(1.0, 5.0));
  // No speed belongs to the first cycle.
  ASSERT_EQ(speed.size(), 3U);
  EXPECT_TRUE(std::isnan(speed[0].y()));
  EXPECT_EQ(speed[1], Vec2(0.5, 4.0));
  EXPECT_EQ(speed[2], Vec2(1.0, 6.0));
}

}  // namespace
}  // namespace swarf::motion
