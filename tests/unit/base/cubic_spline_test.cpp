#include "base/cubic_spline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/rng.h"

namespace swarf {
namespace {

CubicSpline sampled(size_t n, double first, double step, double (*f)(double)) {
  std::vector<double> values;
  for (size_t i = 0; i < n; ++i) values.push_back(f(first + static_cast<double>(i) * step));
  return {first, step, values};
}

class CubicSplineSize : public testing::TestWithParam<size_t> {};

TEST_P(CubicSplineSize, ReproducesCubicsAndTheirDerivatives) {
  Rng rng(5);
  const size_t n = GetParam();
  for (int trial = 0; trial < 20; ++trial) {
    const double a = rng.uniform(-2, 2);
    const double b = rng.uniform(-2, 2);
    const double c = rng.uniform(-2, 2);
    const double d = rng.uniform(-2, 2);
    const double first = rng.uniform(-1, 1);
    const double step = rng.uniform(0.1, 0.5);
    std::vector<double> values;
    for (size_t i = 0; i < n; ++i) {
      const double t = first + static_cast<double>(i) * step;
      values.push_back(a + t * (b + t * (c + t * d)));
    }
    const CubicSpline spline(first, step, values);
    double size = 1.0;  // rounding grows with the values
    for (const double value : values) size = std::max(size, std::abs(value));
    const double last = first + static_cast<double>(n - 1) * step;
    // Beyond both ends too: the end cubics continue.
    for (double t = first - step; t <= last + step; t += 0.17 * step) {
      const auto value = spline.at(t);
      EXPECT_NEAR(value.w, a + t * (b + t * (c + t * d)), 1e-13 * size) << "n " << n << " t " << t;
      EXPECT_NEAR(value.dw, b + t * (2 * c + t * 3 * d), 1e-12 * size) << "n " << n << " t " << t;
      EXPECT_NEAR(value.ddw, 2 * c + 6 * d * t, 1e-11 * size) << "n " << n << " t " << t;
    }
  }
}

TEST_P(CubicSplineSize, PassesThroughItsValuesWithContinuousDerivatives) {
  Rng rng(6);
  const size_t n = GetParam();
  std::vector<double> values;
  for (size_t i = 0; i < n; ++i) values.push_back(rng.uniform(-1, 1));
  const CubicSpline spline(2.0, 0.25, values);
  for (size_t i = 0; i < n; ++i) {
    const double t = 2.0 + 0.25 * static_cast<double>(i);
    EXPECT_NEAR(spline.at(t).w, values[i], 1e-13);
    const auto before = spline.at(t - 1e-9);
    const auto after = spline.at(t + 1e-9);
    EXPECT_NEAR(before.dw, after.dw, 1e-5);
    EXPECT_NEAR(before.ddw, after.ddw, 1e-4);
  }
}

TEST_P(CubicSplineSize, KeepsTheThirdDerivativeOverTheKnotsNextToTheEnds) {
  Rng rng(7);
  const size_t n = GetParam();
  std::vector<double> values;
  for (size_t i = 0; i < n; ++i) values.push_back(rng.uniform(-1, 1));
  const CubicSpline spline(0.0, 1.0, values);
  const auto third = [&](double knot) { return spline.at(knot + 0.75).ddw - spline.at(knot + 0.25).ddw; };
  EXPECT_NEAR(third(0.0), third(1.0), 1e-11);
  const auto last = static_cast<double>(n - 1);
  EXPECT_NEAR(third(last - 2.0), third(last - 1.0), 1e-11);
}

INSTANTIATE_TEST_SUITE_P(FourToSevenAndMore, CubicSplineSize, testing::Values(4, 5, 6, 7, 8, 33));

TEST(CubicSpline, ConvergesWithTheFourthPowerOfTheStep) {
  const auto error = [](size_t cells) {
    const double step = 2.0 / static_cast<double>(cells);
    const CubicSpline spline = sampled(cells + 1, 0.0, step, [](double t) { return std::sin(3.0 * t); });
    double worst = 0.0;
    for (int i = 0; i <= 5000; ++i)
      worst = std::max(worst, std::abs(spline.at(i * 4e-4).w - std::sin(3.0 * i * 4e-4)));
    return worst;
  };
  const double coarse = error(64);
  const double fine = error(128);
  EXPECT_NEAR(std::log2(coarse / fine), 4.0, 0.35) << coarse << " -> " << fine;
  EXPECT_LT(fine, 1e-6);
}

TEST(CubicSpline, ConstantIsTheSameEverywhere) {
  for (const double t : {-5.0, 0.0, 0.3, 99.0}) {
    EXPECT_DOUBLE_EQ(CubicSpline::constant(7.25).at(t).w, 7.25);
    EXPECT_EQ(CubicSpline::constant(7.25).at(t).dw, 0.0);
    EXPECT_EQ(CubicSpline::constant(7.25).at(t).ddw, 0.0);
  }
}

TEST(CubicSpline, RefusesTooFewValuesAndBadSteps) {
  EXPECT_THROW(CubicSpline(0.0, 1.0, {1, 2, 3}), InternalError);
  EXPECT_THROW(CubicSpline(0.0, 0.0, {1, 2, 3, 4}), InternalError);
}

}  // namespace
}  // namespace swarf
