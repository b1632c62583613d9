#include "surface/polynomial.h"

#include <cmath>
#include <utility>

#include "base/check.h"

namespace swarf::surface {
namespace {

/// Value and first two derivatives of one polynomial, gathered by Horner's rule.
struct Jet {
  Vec3 value = Vec3::Zero(), first = Vec3::Zero(), second = Vec3::Zero();
  void push(const Vec3& coefficient, double x) {
    second = second * x + 2.0 * first;
    first = first * x + value;
    value = value * x + coefficient;
  }
};

/// Binomial coefficient n over k.
double binomial(int n, int k) {
  double value = 1.0;
  for (int i = 1; i <= k; ++i) value = value * (n - k + i) / i;
  return value;
}

}  // namespace

PolynomialSurface::PolynomialSurface(int degree_u, int degree_v, std::vector<Vec3> coefficients,
                                     int outward_sign)
    : degree_u_(degree_u),
      degree_v_(degree_v),
      coefficients_(std::move(coefficients)),
      outward_sign_(outward_sign) {
  SWARF_CHECK(degree_u >= 0 && degree_v >= 0, "degrees of a polynomial surface");
  SWARF_CHECK(coefficients_.size() == static_cast<size_t>((degree_u + 1) * (degree_v + 1)),
              "a polynomial surface needs (degree_u + 1)(degree_v + 1) coefficients");
  SWARF_CHECK(outward_sign == 1 || outward_sign == -1, "outward sign is +1 or -1");
}

PolynomialSurface PolynomialSurface::from_bezier(int degree_u, int degree_v,
                                                 const std::vector<Vec3>& control_points, int outward_sign) {
  // Power-basis coefficient of t^i in B_k^n(t) is (-1)^(i-k) C(n,i) C(i,k), for k <= i.
  const auto index = [&](int i, int j) { return static_cast<size_t>(i) * (degree_v + 1) + j; };
  std::vector<Vec3> power(control_points.size(), Vec3::Zero());
  for (int i = 0; i <= degree_u; ++i) {
    for (int j = 0; j <= degree_v; ++j) {
      for (int k = 0; k <= i; ++k) {
        for (int l = 0; l <= j; ++l) {
          const double sign = (i - k + j - l) % 2 == 0 ? 1.0 : -1.0;
          power[index(i, j)] += sign * binomial(degree_u, i) * binomial(i, k) * binomial(degree_v, j) *
                                binomial(j, l) * control_points[index(k, l)];
        }
      }
    }
  }
  return {degree_u, degree_v, std::move(power), outward_sign};
}

Vec3 PolynomialSurface::point(double u, double v) const {
  Vec3 S = Vec3::Zero();
  const Vec3* end = coefficients_.data() + coefficients_.size();
  for (int i = degree_u_; i >= 0; --i) {
    Vec3 row = Vec3::Zero();
    const Vec3* first = end - (degree_v_ + 1);
    for (const Vec3* c = end; c != first;) row = row * v + *--c;
    end = first;
    S = S * u + row;
  }
  return S;
}

Derivatives PolynomialSurface::derivatives(double u, double v) const {
  Jet along, across, across2;  // in u: of the row's value, of its v-derivative, of its second v-derivative
  const Vec3* end = coefficients_.data() + coefficients_.size();
  for (int i = degree_u_; i >= 0; --i) {
    Jet row;
    const Vec3* first = end - (degree_v_ + 1);
    for (const Vec3* c = end; c != first;) row.push(*--c, v);
    end = first;
    along.push(row.value, u);
    across.push(row.first, u);
    across2.push(row.second, u);
  }
  return {along.value, along.first, across.value, along.second, across.first, across2.value};
}

BendBounds PolynomialSurface::bend_bounds(const Vec2& low, const Vec2& high) const {
  const Vec2 centre = 0.5 * (low + high), half = 0.5 * (high - low);
  BendBounds bounds;
  // S_uu = sum over the Taylor coefficients b_kl of S about the centre of b_kl k (k-1) du^(k-2) dv^l: the
  // constant term is the mean, the others are no greater than at the rectangle's corner.
  for (int k = 0; k <= degree_u_; ++k) {
    for (int l = 0; l <= degree_v_; ++l) {
      Vec3 b = Vec3::Zero();
      for (int i = k; i <= degree_u_; ++i) {
        for (int j = l; j <= degree_v_; ++j) {
          b += coefficients_[static_cast<size_t>(i) * (degree_v_ + 1) + j] * binomial(i, k) * binomial(j, l) *
               std::pow(centre.x(), i - k) * std::pow(centre.y(), j - l);
        }
      }
      const auto add = [&](surface::Bend& bend, int factor, int power_u, int power_v) {
        if (power_u == 0 && power_v == 0) {
          bend.mean = factor * b;
        } else {
          bend.stray += factor * b.norm() * std::pow(half.x(), power_u) * std::pow(half.y(), power_v);
        }
      };
      if (k >= 2) add(bounds.uu, k * (k - 1), k - 2, l);
      if (k >= 1 && l >= 1) add(bounds.uv, k * l, k - 1, l - 1);
      if (l >= 2) add(bounds.vv, l * (l - 1), k, l - 2);
    }
  }
  return bounds;
}

}  // namespace swarf::surface
