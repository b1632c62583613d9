#include "program/siemens/polynomial.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/quadrature.h"
#include "base/roots.h"
#include "base/tool_axis.h"
#include "base/units.h"

namespace swarf::program::nc::siemens {
namespace {

/// Pieces of the table of ways.
constexpr int kPieces = 128;
const double kTurnToleranceRad = rad_from_deg(1e-3);
constexpr int kHalvings = 20;
/// Shorter curves have no way that anything could follow, mm.
constexpr double kNoWay = 1e-9;
/// Divides [0, 1] so that the points where chords are compared never all fall on the five zeros that the
/// distance of a polynomial of degree 5 from its chord can have.
constexpr double kUneven = 0.381966011250105;

}  // namespace

Coefficients read_coefficients(TokenReader& reader, Variables& variables, size_t offset, double& end) {
  Coefficients read;
  read.offset = offset;
  read.given = true;
  reader.expect("(", "PO");
  end = evaluate_number(reader, variables);
  size_t n = 0;
  while (reader.skip(",")) {
    if (n == read.a.size()) {
      refuse(reader.line(), reader.offset(), "too-many-coefficients",
             "a polynomial has its end and at most four coefficients, a2 to a5", "PO[X]=(10,1,2,3,4)");
    }
    read.a[n++] = evaluate_number(reader, variables);
  }
  reader.expect(")", "the coefficients");
  return read;
}

double PolynomialCurve::value(const Polynomial& c, double u) {
  double sum = 0.0;
  for (size_t k = c.size(); k-- > 0;) sum = sum * u + c[k];
  return sum;
}

double PolynomialCurve::slope(const Polynomial& c, double u) {
  double sum = 0.0;
  for (size_t k = c.size() - 1; k > 0; --k) sum = sum * u + static_cast<double>(k) * c[k];
  return sum;
}

/// Over u = p / PL.
PolynomialCurve::Polynomial PolynomialCurve::scaled(const std::array<double, 4>& a, double from, double to,
                                                    double interval) {
  Polynomial c{from, to - from};
  double power = interval;
  for (size_t k = 2; k < c.size(); ++k) {
    power *= interval;
    c[k] = a[k - 2] * power;
    c[1] -= c[k];
  }
  return c;
}

PolynomialCurve::PolynomialCurve(const PolynomialBlock& block) : block_(block) {
  double end = 1.0;
  if (block.divisor) {
    const auto& d = *block.divisor;
    end = d[0];
    divisor_ = scaled({d[1], d[2], d[3], d[4]}, 1.0, d[0], block.interval);
    degree_ = 5;
  }
  for (size_t i = 0; i < 3; ++i) {
    const PolynomialAxis& axis = block.linear[i];
    const bool bends = std::any_of(axis.a.begin(), axis.a.end(), [](double a) { return a != 0.0; });
    stands_[i] = !bends && axis.from == axis.to;  // under any divisor
    linear_[i] = scaled(axis.a, axis.from, axis.to * end, block.interval);
    for (int k = 2; k <= 5; ++k) {
      if (axis.a[static_cast<size_t>(k - 2)] != 0.0) degree_ = std::max(degree_, k);
    }
    if (block.rotary[i]) {
      const PolynomialAxis& turned = *block.rotary[i];
      rotary_[i] = scaled(turned.a, turned.from, turned.to, block.interval);
      turns_ = true;
    }
  }
  if (block.axis) {
    const auto& [from, to] = *block.axis;
    angle_ = angle_between(from, to);
    turns_ = true;
  }
  if (!turns_) return;
  way_.push_back(0.0);
  for (int n = 0; n < kPieces; ++n)
    way_.push_back(way_.back() + way_between(n / double{kPieces}, (n + 1) / double{kPieces}));
}

Vec3 PolynomialCurve::tip(double u) const {
  Vec3 p;
  const double d = value(divisor_, u);
  for (size_t i = 0; i < 3; ++i) {
    p[static_cast<long>(i)] = stands_[i] || u == 1.0 ? block_.linear[i].to : value(linear_[i], u) / d;
  }
  return p;
}

Vec3 PolynomialCurve::velocity(double u) const {
  const Vec3 p = tip(u);
  const double d = value(divisor_, u), dd = slope(divisor_, u);
  Vec3 v;
  for (size_t i = 0; i < 3; ++i) {
    const long n = static_cast<long>(i);
    v[n] = stands_[i] ? 0.0 : (slope(linear_[i], u) - p[n] * dd) / d;
  }
  return v;
}

double PolynomialCurve::way_between(double u, double v) const {
  return smooth_integral([this](double x) { return velocity(x).norm(); }, u, v);
}

double PolynomialCurve::way(double u) const {
  const int piece = std::clamp(static_cast<int>(u * kPieces), 0, kPieces - 1);
  return way_[static_cast<size_t>(piece)] + way_between(piece / double{kPieces}, u);
}

/// How far rotary axes and vectors have come, 0 to 1, in units of PL.
double PolynomialCurve::share(double u) const {
  if (u == 0.0 || u == 1.0) return u;
  return block_.by_way && way_.back() > kNoWay ? way(u) / way_.back() : u;
}

nc::CurvePoint PolynomialCurve::at(double u) const {
  nc::CurvePoint point;
  point.tip = tip(u);
  if (!turns_) return point;
  const double s = share(u);
  for (size_t i = 0; i < 3; ++i) {
    if (block_.rotary[i]) point.rotary[i] = s == 1.0 ? block_.rotary[i]->to : value(rotary_[i], s);
  }
  if (block_.axis) {
    const auto& [from, to] = *block_.axis;
    point.axis = s == 1.0 ? to : slerp(from, to, s);
  }
  return point;
}

/// By how much a rotary axis or the tool vector misses its law at t, rad, when it turns evenly over the way
/// from a to b.
double PolynomialCurve::off_straight(double a, double b, double t) const {
  const double piece = way(b) - way(a);
  const double along = piece > kNoWay ? (way(t) - way(a)) / piece : (t - a) / (b - a);
  const double s_a = share(a), s_b = share(b), s_t = share(t);
  double off = std::abs(angle_ * (s_t - s_a - along * (s_b - s_a)));
  for (size_t i = 0; i < 3; ++i) {
    if (!block_.rotary[i]) continue;
    const double from = value(rotary_[i], s_a), to = value(rotary_[i], s_b);
    off = std::max(off, std::abs(value(rotary_[i], s_t) - from - along * (to - from)));
  }
  return off;
}

void PolynomialCurve::divide(double a, double b, int depth, std::vector<double>& inner) const {
  bool even = true;
  for (const double t : {0.25, 0.5, 0.75})
    even = even && off_straight(a, b, a + t * (b - a)) <= kTurnToleranceRad;
  if (even || depth == 0) {
    inner.push_back(b);
    return;
  }
  const double middle = 0.5 * (a + b);
  divide(a, middle, depth - 1, inner);
  divide(middle, b, depth - 1, inner);
}

std::vector<double> PolynomialCurve::breaks() const {
  std::vector<double> inner;
  if (turns_) {
    divide(0.0, kUneven, kHalvings, inner);
    divide(kUneven, 1.0, kHalvings, inner);
    inner.pop_back();
  } else if (degree_ > 3) {
    inner.push_back(kUneven);
  }
  return inner;
}

double PolynomialCurve::divisor_min() const {
  std::array<double, 5> derivative;
  for (size_t k = 0; k < derivative.size(); ++k) derivative[k] = static_cast<double>(k + 1) * divisor_[k + 1];
  double least = std::min(1.0, value(divisor_, 1.0));
  const UnitRoots turns = unit_roots(derivative);
  for (const double u : turns.all()) least = std::min(least, value(divisor_, u));
  return least;
}

double PolynomialCurve::swing() const {
  double sum = 0.0;
  const auto add = [&](const Polynomial& c) {
    for (const double x : c) sum += std::abs(x);
  };
  for (size_t i = 0; i < 3; ++i) {
    add(linear_[i]);
    add(rotary_[i]);
  }
  add(divisor_);
  return sum;
}

}  // namespace swarf::program::nc::siemens
