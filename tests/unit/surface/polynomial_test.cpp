#include "surface/polynomial.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "unit/surface/test_surfaces.h"

namespace swarf::surface {
namespace {

constexpr int kMaxDegree = 6;

/// k-th derivative of t^n.
double power(int n, int k, double t) {
  double factor = 1.0;
  for (int i = 0; i < k; ++i) factor *= n - i;
  return n < k ? 0.0 : factor * std::pow(t, n - k);
}

/// Eq. (3) as printed, differentiated term by term.
Vec3 direct_sum(const PolynomialSurface& surface, int du, int dv, double u, double v) {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i <= surface.degree_u(); ++i) {
    for (int j = 0; j <= surface.degree_v(); ++j) {
      const Vec3& a = surface.coefficients()[static_cast<size_t>(i) * (surface.degree_v() + 1) + j];
      sum += power(i, du, u) * power(j, dv, v) * a;
    }
  }
  return sum;
}

class RandomPolynomial : public testing::TestWithParam<int> {};

TEST_P(RandomPolynomial, DerivativesAreThoseOfEquation3) {
  Rng rng(300 + static_cast<uint64_t>(GetParam()));
  for (int n = 0; n <= kMaxDegree; ++n) {
    const int m = GetParam();
    const PolynomialSurface surface(m, n, random_points(rng, m, n, 50.0), 1);
    for (int trial = 0; trial < 20; ++trial) {
      const double u = rng.uniform(-0.1, 1.1);
      const double v = rng.uniform(-0.1, 1.1);
      const Derivatives d = surface.derivatives(u, v);
      // Largest term: 50 * 30 * 1.1^6 * 49 coefficients; rounding stays below 1e-9 of a millimetre.
      const double tolerance = 1e-9;
      const std::string where = pasted(surface) + " at " + std::to_string(u) + ", " + std::to_string(v);
      EXPECT_LT((surface.point(u, v) - direct_sum(surface, 0, 0, u, v)).norm(), tolerance) << where;
      EXPECT_LT((d.S - direct_sum(surface, 0, 0, u, v)).norm(), tolerance) << where;
      EXPECT_LT((d.Su - direct_sum(surface, 1, 0, u, v)).norm(), tolerance) << where;
      EXPECT_LT((d.Sv - direct_sum(surface, 0, 1, u, v)).norm(), tolerance) << where;
      EXPECT_LT((d.Suu - direct_sum(surface, 2, 0, u, v)).norm(), tolerance) << where;
      EXPECT_LT((d.Suv - direct_sum(surface, 1, 1, u, v)).norm(), tolerance) << where;
      EXPECT_LT((d.Svv - direct_sum(surface, 0, 2, u, v)).norm(), tolerance) << where;
    }
  }
}

TEST_P(RandomPolynomial, DerivativesAgreeWithFiniteDifferences) {
  Rng rng(400 + static_cast<uint64_t>(GetParam()));
  // Central differences with h = 1e-4: truncation h^2/6 |S'''| < 1e-8 * 120 * 50 * 49 / 6, rounding eps |S| /
  // h^2.
  const double h = 1e-4;
  const double tolerance = 1e-2;
  for (int n = 0; n <= kMaxDegree; ++n) {
    const int m = GetParam();
    const PolynomialSurface s(m, n, random_points(rng, m, n, 50.0), 1);
    for (int trial = 0; trial < 20; ++trial) {
      const double u = rng.uniform();
      const double v = rng.uniform();
      const Derivatives d = s.derivatives(u, v);
      const Vec3 S = s.point(u, v);
      EXPECT_LT((d.Su - (s.point(u + h, v) - s.point(u - h, v)) / (2 * h)).norm(), tolerance) << pasted(s);
      EXPECT_LT((d.Sv - (s.point(u, v + h) - s.point(u, v - h)) / (2 * h)).norm(), tolerance) << pasted(s);
      EXPECT_LT((d.Suu - (s.point(u + h, v) - 2 * S + s.point(u - h, v)) / (h * h)).norm(), tolerance)
          << pasted(s);
      EXPECT_LT((d.Svv - (s.point(u, v + h) - 2 * S + s.point(u, v - h)) / (h * h)).norm(), tolerance)
          << pasted(s);
      const Vec3 mixed =
          s.point(u + h, v + h) - s.point(u + h, v - h) - s.point(u - h, v + h) + s.point(u - h, v - h);
      EXPECT_LT((d.Suv - mixed / (4 * h * h)).norm(), tolerance) << pasted(s);
    }
  }
}

/// Bernstein polynomial k of degree n.
double bernstein(int n, int k, double t) {
  double value = 1.0;
  for (int i = 1; i <= k; ++i) value *= static_cast<double>(n - k + i) / i;
  return value * std::pow(t, k) * std::pow(1.0 - t, n - k);
}

TEST_P(RandomPolynomial, BezierNetsGiveTheBernsteinSum) {
  Rng rng(500 + static_cast<uint64_t>(GetParam()));
  for (int n = 0; n <= kMaxDegree; ++n) {
    const int m = GetParam();
    const std::vector<Vec3> net = random_points(rng, m, n, 50.0);
    const PolynomialSurface surface = PolynomialSurface::from_bezier(m, n, net, -1);
    EXPECT_EQ(surface.outward_sign(), -1);
    // Cancellation: coefficients grow with 3^(m+n).
    const double tolerance = 1e-13 * std::pow(3.0, m + n);
    for (int trial = 0; trial < 20; ++trial) {
      const double u = rng.uniform();
      const double v = rng.uniform();
      Vec3 sum = Vec3::Zero();
      for (int i = 0; i <= m; ++i) {
        for (int j = 0; j <= n; ++j) {
          sum += bernstein(m, i, u) * bernstein(n, j, v) * net[static_cast<size_t>(i) * (n + 1) + j];
        }
      }
      EXPECT_LT((surface.point(u, v) - sum).norm(), tolerance) << pasted(surface);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(DegreesInU, RandomPolynomial, testing::Range(0, kMaxDegree + 1));

TEST(PolynomialSurface, RefusesWhatItCannotBe) {
  EXPECT_THROW(PolynomialSurface(1, 1, std::vector<Vec3>(3, Vec3::Zero()), 1), InternalError);
  EXPECT_THROW(PolynomialSurface(1, 1, std::vector<Vec3>(4, Vec3::Zero()), 0), InternalError);
  EXPECT_THROW(PolynomialSurface(-1, 0, {}, 1), InternalError);
}

}  // namespace
}  // namespace swarf::surface
