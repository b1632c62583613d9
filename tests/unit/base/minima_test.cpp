#include "base/minima.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/quadrature.h"
#include "base/rng.h"
#include "base/roots.h"
#include "base/units.h"

namespace swarf {
namespace {

TEST(Minima, BetweenTwoPlaces) {
  Rng rng(7);
  for (int n = 0; n < 1000; ++n) {
    const double place = rng.uniform(-1.0, 1.0), depth = rng.uniform(-2.0, 2.0);
    const double wide = rng.uniform(0.1, 50.0), skew = rng.uniform(-0.2, 0.2);
    const auto f = [&](double x) {
      const double t = x - place;
      return depth + wide * t * t * (1.0 + skew * t);
    };
    const Minimum least = least_between(f, place - rng.uniform(0.01, 1.0), place + rng.uniform(0.01, 1.0));
    EXPECT_NEAR(least.at, place, 3e-8) << n;
    EXPECT_NEAR(least.value, depth, 1e-13) << n;
    EXPECT_EQ(least.value, f(least.at)) << n;
  }
}

/// The deeper of two hollows, a kink, and the ends of the range.
TEST(Minima, OfManyTheLeast) {
  const auto two = [](double x) { return std::cos(12.0 * x) - 0.1 * x; };
  const Minimum found = least_sampled(two, 0.0, 1.0, 32);
  // Where 12 x is near 3 pi; the hollow near pi is higher by 0.1 times their distance.
  EXPECT_NEAR(found.at, (3.0 * kPi + std::asin(0.1 / 12.0)) / 12.0, 1e-8);
  const Minimum kink = least_sampled([](double x) { return std::abs(x - 0.3); }, 0.0, 1.0, 8);
  EXPECT_NEAR(kink.value, 0.0, 3e-8);
  EXPECT_EQ(least_sampled([](double x) { return x; }, 2.0, 3.0, 8).at, 2.0);
  EXPECT_EQ(greatest_sampled([](double x) { return x; }, 2.0, 3.0, 8).value, 3.0);
  const Minimum flat = least_sampled([](double) { return 5.0; }, 2.0, 3.0, 8);
  EXPECT_EQ(flat.at, 2.0);
  EXPECT_EQ(flat.value, 5.0);
}

TEST(Quadrature, PolynomialsAndAnArc) {
  const auto power = [](double x) { return 14.0 * std::pow(x, 13); };
  EXPECT_NEAR(smooth_integral(power, 0.0, 2.0), std::pow(2.0, 14), 1e-11);
  EXPECT_NEAR(smooth_integral(power, 2.0, 0.0), -std::pow(2.0, 14), 1e-11);
  EXPECT_EQ(smooth_integral(power, 1.0, 1.0), 0.0);
  const auto arc = [](double x) { return 1.0 / std::sqrt(1.0 - x * x); };
  EXPECT_NEAR(smooth_integral(arc, 0.0, 0.25), std::asin(0.25), 1e-14);
}

TEST(BracketedRoot, ToTheLastBits) {
  Rng rng(11);
  for (int n = 0; n < 1000; ++n) {
    const double place = rng.uniform(1e-3, 1.0), bend = rng.uniform(0.0, 5.0);
    const auto f = [&](double x) { return std::expm1(bend * (x - place)) + (x - place); };
    const double root = bracketed_root(f, 0.0, 1.0, f(0.0), f(1.0));
    EXPECT_NEAR(root, place, 4.0 * 0x1p-52) << n;
  }
  // A jump has a place too.
  const auto step = [](double x) { return x < 0.7 ? -1.0 : 2.0; };
  EXPECT_NEAR(bracketed_root(step, 0.0, 1.0, -1.0, 2.0), 0.7, 1e-15);
}

}  // namespace
}  // namespace swarf
