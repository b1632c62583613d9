// Sines and arc tangents of several numbers at once, against the library in long double.
#include "kinematics/lanes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "base/rng.h"
#include "base/units.h"

namespace swarf::kinematics {
namespace {

constexpr double kUnit = std::numeric_limits<double>::epsilon();  // 2.2e-16

/// Greatest error of sine and cosine.
double sine_error(double angle) {
  const double angles[4] = {angle, -angle, 0.5 * angle, 0.0};
  double sine[4], cosine[4];
  lane_sines<4>(angles, sine, cosine);
  double worst = 0.0;
  for (int i = 0; i < 4; ++i) {
    worst = std::max(
        {worst, std::abs(static_cast<double>(sine[i] - std::sin(static_cast<long double>(angles[i])))),
         std::abs(static_cast<double>(cosine[i] - std::cos(static_cast<long double>(angles[i]))))});
  }
  return worst;
}

TEST(Lanes, SinesAreWithinOneUnitOfTheTrueOnes) {
  Rng rng(71);
  for (const double range : {1e-8, 0.1, kPi, 2e1, 700.0, 1e5}) {
    for (int i = 0; i < 50'000; ++i) {
      const double angle = range * rng.uniform(-1.0);
      ASSERT_LE(sine_error(angle), kUnit) << std::hexfloat << angle;
    }
  }
}

TEST(Lanes, SinesAtTheEdgesOfTheQuarters) {
  for (int n = -1000; n <= 1000; ++n) {
    const double edge = n * 0.25 * kPi;
    for (const double angle : {edge, std::nextafter(edge, 1e9), std::nextafter(edge, -1e9)})
      ASSERT_LE(sine_error(angle), kUnit) << n << " eighths";
  }
  const double still[2] = {0.0, -0.0};
  double sine[2], cosine[2];
  lane_sines<2>(still, sine, cosine);
  EXPECT_EQ(sine[0], 0.0);
  EXPECT_EQ(cosine[0], 1.0);
  EXPECT_EQ(cosine[1], 1.0);
}

TEST(Lanes, FarAnglesGoToTheLibrary) {
  const double angles[2] = {1e9, 1.0};
  double sine[2], cosine[2];
  lane_sines<2>(angles, sine, cosine);
  EXPECT_EQ(sine[0], std::sin(1e9));
  EXPECT_EQ(cosine[1], std::cos(1.0));
  const double none[2] = {std::numeric_limits<double>::quiet_NaN(), 1.0};
  lane_sines<2>(none, sine, cosine);
  EXPECT_TRUE(std::isnan(sine[0]));
}

/// Greatest error relative to the angle, of the four quadrants.
double tangent_error(double y, double x) {
  const double ys[4] = {y, -y, y, -y}, xs[4] = {x, x, -x, -x};
  double angle[4];
  lane_atan2<4>(ys, xs, angle);
  double worst = 0.0;
  for (int i = 0; i < 4; ++i) {
    const long double exact = std::atan2(static_cast<long double>(ys[i]), static_cast<long double>(xs[i]));
    const auto error = static_cast<double>(angle[i] - exact);
    worst = std::max(worst, exact == 0.0L ? std::abs(error) : std::abs(error / static_cast<double>(exact)));
  }
  return worst;
}

TEST(Lanes, ArcTangentsAreWithinTwoUnitsOfTheTrueOnes) {
  Rng rng(72);
  for (int i = 0; i < 200'000; ++i) {
    const double y = rng.uniform() * std::pow(10.0, 20.0 * rng.uniform(-1.0)), x = rng.uniform();
    ASSERT_LE(tangent_error(y, x), 2.0 * kUnit) << std::hexfloat << y << ", " << x;
  }
  for (const double t : {1.0, std::sqrt(2.0) - 1.0, std::nextafter(std::sqrt(2.0) - 1.0, 1.0), 0.5, 1e-300})
    EXPECT_LE(tangent_error(t, 1.0), 2.0 * kUnit) << t;
}

TEST(Lanes, ArcTangentsOnTheAxes) {
  const double y[4] = {0.0, -0.0, 0.0, -0.0}, x[4] = {2.0, 2.0, -2.0, -2.0};
  double angle[4];
  lane_atan2<4>(y, x, angle);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(angle[i], std::atan2(y[i], x[i])) << i;
    EXPECT_EQ(std::signbit(angle[i]), std::signbit(y[i])) << i;
  }
  const double up[2] = {3.0, -3.0}, none[2] = {0.0, 0.0};
  double quarter[2];
  lane_atan2<2>(up, none, quarter);
  EXPECT_EQ(quarter[0], 0.5 * kPi);
  EXPECT_EQ(quarter[1], -0.5 * kPi);
}

}  // namespace
}  // namespace swarf::kinematics
