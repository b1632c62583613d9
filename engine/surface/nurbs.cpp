#include "surface/nurbs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/check.h"

namespace swarf::surface {
namespace {

constexpr size_t kMostCoefficients = kMostNurbsDegree + 1;
using Row = std::array<double, kMostCoefficients>;

/// Bernstein polynomials of one degree at t, with their first two derivatives.
struct Bernstein {
  Row value, first, second;

  Bernstein(int degree, double t) {
    const auto p = static_cast<size_t>(degree);
    Row below{}, below2{};  // of degree p - 1 and p - 2
    value.fill(0.0);
    value[0] = 1.0;
    for (size_t d = 1; d <= p; ++d) {
      below2 = below;
      below = value;
      for (size_t i = d; i > 0; --i) value[i] = t * value[i - 1] + (1.0 - t) * value[i];
      value[0] *= 1.0 - t;
    }
    const auto n = static_cast<double>(degree);
    for (size_t i = 0; i <= p; ++i) {
      first[i] = n * ((i > 0 ? below[i - 1] : 0.0) - (i < p ? below[i] : 0.0));
      const double two = i >= 2 ? below2[i - 2] : 0.0, one = i >= 1 && i < p ? below2[i - 1] : 0.0;
      second[i] = degree < 2 ? 0.0 : n * (n - 1.0) * (two - 2.0 * one + (i + 2 <= p ? below2[i] : 0.0));
    }
  }
};

/// Value and derivatives of the homogeneous surface.
struct Homogeneous {
  Vec4 H = Vec4::Zero(), u = Vec4::Zero(), v = Vec4::Zero(), uu = Vec4::Zero(), uv = Vec4::Zero(),
       vv = Vec4::Zero();
};

Homogeneous evaluate(const Vec4* net, int degree_u, int degree_v, double s, double t) {
  const Bernstein along(degree_u, s), across(degree_v, t);
  Homogeneous at;
  for (size_t i = 0; i <= static_cast<size_t>(degree_u); ++i) {
    Vec4 value = Vec4::Zero(), first = Vec4::Zero(), second = Vec4::Zero();
    for (size_t j = 0; j <= static_cast<size_t>(degree_v); ++j, ++net) {
      value += across.value[j] * *net;
      first += across.first[j] * *net;
      second += across.second[j] * *net;
    }
    at.H += along.value[i] * value;
    at.u += along.first[i] * value;
    at.uu += along.second[i] * value;
    at.v += along.value[i] * first;
    at.uv += along.first[i] * first;
    at.vv += along.value[i] * second;
  }
  return at;
}

/// In place: coefficients of (x - 1/2)^k from Bezier poles. f(1/2 + d) = sum C(p,k) d^k (Delta^k b)(1/2),
/// where the differences Delta^k b are the poles of a polynomial of degree p - k.
void bezier_to_power(Vec4* poles, int degree, size_t stride) {
  const auto p = static_cast<size_t>(degree);
  std::array<Vec4, kMostCoefficients> difference, power;
  for (size_t i = 0; i <= p; ++i) difference[i] = poles[i * stride];
  double binomial = 1.0;
  for (size_t k = 0; k <= p; ++k) {
    std::array<Vec4, kMostCoefficients> d = difference;
    for (size_t r = p - k; r > 0; --r) {
      for (size_t i = 0; i < r; ++i) d[i] = 0.5 * (d[i] + d[i + 1]);
    }
    power[k] = binomial * d[0];
    binomial *= static_cast<double>(p - k) / static_cast<double>(k + 1);
    for (size_t i = 0; i + k < p; ++i) difference[i] = difference[i + 1] - difference[i];
  }
  for (size_t i = 0; i <= p; ++i) poles[i * stride] = power[i];
}

/// Coefficients about a place that lies `by` further (Horner's scheme).
void shift(Vec4* power, int degree, size_t stride, double by) {
  const auto p = static_cast<size_t>(degree);
  for (size_t k = 0; k < p; ++k) {
    for (size_t i = p; i > k; --i) power[(i - 1) * stride] += by * power[i * stride];
  }
}

/// k (k-1) .. (k-m+1) h^(k-m) for m = 0, 1, 2: what (x^k)^(m) is at most for |x| <= h.
std::array<Row, 3> growth(int degree, double h) {
  std::array<Row, 3> most{};
  double power = 1.0;
  for (size_t k = 0; k <= static_cast<size_t>(degree); ++k, power *= h) {
    const auto n = static_cast<double>(k);
    most[0][k] = power;
    if (k + 1 <= static_cast<size_t>(degree)) most[1][k + 1] = (n + 1.0) * power;
    if (k + 2 <= static_cast<size_t>(degree)) most[2][k + 2] = (n + 2.0) * (n + 1.0) * power;
  }
  return most;
}

/// A number or a vector within `radius` of `centre`.
struct Ball {
  Vec3 centre = Vec3::Zero();
  double radius = 0.0;
};
struct Ball1 {
  double centre = 0.0, radius = 0.0;
  double most() const { return std::abs(centre) + radius; }
};

/// Numerator and denominator with their derivatives over a rectangle.
struct QuotientBalls {
  Ball Q, Qu, Qv, Quu, Quv, Qvv;
  Ball1 w, wu, wv, wuu, wuv, wvv;
  double least_w = 0.0;  ///< above 0
};

/// (N - x y)/w for N in `numerator`, |x y| <= less: |N/W - n/w| = |(N - n) - (n/w)(W - w)|/W.
Ball divided(const Ball& numerator, double less, const QuotientBalls& q) {
  const Vec3 centre = numerator.centre / q.w.centre;
  return {centre, (numerator.radius + less + centre.norm() * q.w.radius) / q.least_w};
}

/// The quotient rule on balls. The numerator is taken about the place of the rectangle's centre, Q = P - S_c
/// w, so that S - S_c = Q/w vanishes there; then
///   S_u = (Q_u - (S - S_c) w_u)/w,  S_uu = (Q_uu - 2 S_u w_u - (S - S_c) w_uu)/w,
///   S_uv = (Q_uv - S_u w_v - S_v w_u - (S - S_c) w_uv)/w.
/// Centres are the values at the rectangle's centre, so that radii fall with its size.
BendBounds bend_of(const QuotientBalls& q) {
  const double s = q.Q.radius / q.least_w;  // |S - S_c|
  const Ball Su = divided(q.Qu, s * q.wu.most(), q), Sv = divided(q.Qv, s * q.wv.most(), q);
  /// x in S's ball times y in w's: its centre, and how far it strays from that.
  const auto stray = [](const Ball& x, const Ball1& y) {
    return x.centre.norm() * y.radius + x.radius * y.most();
  };
  const auto bend = [&](const Ball& second, const Ball& x, const Ball1& y, const Ball& x2, const Ball1& y2,
                        double less) {
    const Ball numerator{second.centre - x.centre * y.centre - x2.centre * y2.centre,
                         second.radius + stray(x, y) + stray(x2, y2)};
    const Ball result = divided(numerator, less, q);
    return Bend{result.centre, result.radius};
  };
  return {bend(q.Quu, Su, q.wu, Su, q.wu, s * q.wuu.most()),
          bend(q.Quv, Su, q.wv, Sv, q.wu, s * q.wuv.most()),
          bend(q.Qvv, Sv, q.wv, Sv, q.wv, s * q.wvv.most())};
}

/// Radii of a function's value and derivatives over |x| <= hu, |y| <= hv from its Taylor coefficients: the
/// sums of what every other term is at most.
template <typename Magnitude>
std::array<double, 6> radii(int degree_u, int degree_v, const std::array<Row, 3>& gu,
                            const std::array<Row, 3>& gv, const Magnitude& magnitude) {
  constexpr std::array<std::array<size_t, 2>, 6> kOrders{{{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}}};
  std::array<double, 6> sums{};
  const size_t q = static_cast<size_t>(degree_v) + 1;
  for (size_t k = 0; k <= static_cast<size_t>(degree_u); ++k) {
    for (size_t l = 0; l < q; ++l) {
      const double size = magnitude(k * q + l);
      for (size_t n = 0; n < 6; ++n) {
        const auto& order = kOrders[n];
        if (k != order[0] || l != order[1]) sums[n] += size * gu[order[0]][k] * gv[order[1]][l];
      }
    }
  }
  return sums;
}

/// The least bend that holds all of them: about the middle of their means.
Bend hull(const Bend& a, const Bend& b) {
  const Vec3 way = b.mean - a.mean;
  const double distance = way.norm();
  if (a.stray >= distance + b.stray) return a;
  if (b.stray >= distance + a.stray) return b;
  const double radius = 0.5 * (a.stray + b.stray + distance);
  return {Vec3(a.mean + (radius - a.stray) / distance * way), radius};
}

BendBounds hull(const BendBounds& a, const BendBounds& b) {
  return {hull(a.uu, b.uu), hull(a.uv, b.uv), hull(a.vv, b.vv)};
}

/// Slightly more than what rounding adds: evaluation errs by some 1e-15 of the whole patch's bend.
BendBounds widened(const BendBounds& bounds, const BendBounds& whole) {
  const auto widen = [](const Bend& bend, double most) {
    return Bend{bend.mean, bend.stray * (1.0 + 1e-12) + 1e-13 * most};
  };
  return {widen(bounds.uu, whole.uu.most()), widen(bounds.uv, whole.uv.most()),
          widen(bounds.vv, whole.vv.most())};
}

size_t span_at(const std::vector<double>& breaks, double x) {
  const auto inner = std::upper_bound(breaks.begin() + 1, breaks.end() - 1, x);
  return static_cast<size_t>(inner - breaks.begin()) - 1;
}

/// The first span that [low, high] meets and the one behind the last.
std::pair<size_t, size_t> spans_between(const std::vector<double>& breaks, double low, double high) {
  const size_t first = span_at(breaks, low);
  const auto end = std::lower_bound(breaks.begin() + 1, breaks.end() - 1, high);
  return {first, std::max(static_cast<size_t>(end - breaks.begin()), first + 1)};
}

}  // namespace

NurbsSurface::NurbsSurface(const NurbsData& data) : NurbsSurface(bezier_grid(data), data.outward_sign) {
  SWARF_CHECK(smooth_parts(data).size() == 1, "a NURBS surface with creases has several smooth parts");
}

NurbsSurface::NurbsSurface(BezierGrid grid, int outward_sign)
    : grid_(std::move(grid)), outward_sign_(outward_sign), powers_(grid_.poles) {
  SWARF_CHECK(outward_sign == 1 || outward_sign == -1, "outward sign is +1 or -1");
  const size_t size = grid_.patch_size(), q = static_cast<size_t>(grid_.degree_v) + 1;
  const size_t nu = grid_.breaks_u.size() - 1, nv = grid_.breaks_v.size() - 1;
  SWARF_CHECK(grid_.poles.size() == nu * nv * size, "poles of a grid of Bezier patches");
  const double weight = grid_.poles.front().w();
  for (const Vec4& pole : grid_.poles) rational_ = rational_ || std::abs(pole.w() - weight) > 1e-14 * weight;
  for (size_t n = 0; n < nu * nv; ++n) {
    Vec4* net = powers_.data() + n * size;
    double least = net->w();
    for (size_t k = 0; k < size; ++k) least = std::min(least, net[k].w());
    least_weight_.push_back(least);
    for (size_t j = 0; j < q; ++j) bezier_to_power(net + j, grid_.degree_u, q);
    for (size_t i = 0; i < size; i += q) bezier_to_power(net + i, grid_.degree_v, 1);
  }
  for (size_t n = 0; n < nu * nv; ++n) {
    const size_t i = n / nv, j = n % nv;
    whole_.push_back(patch_bounds(
        i, j, {{grid_.breaks_u[i], grid_.breaks_v[j]}, {grid_.breaks_u[i + 1], grid_.breaks_v[j + 1]}}));
  }
}

NurbsSurface::Place NurbsSurface::find(double u, double v) const {
  const size_t i = span_at(grid_.breaks_u, u), j = span_at(grid_.breaks_v, v);
  const double du = grid_.breaks_u[i + 1] - grid_.breaks_u[i], dv = grid_.breaks_v[j + 1] - grid_.breaks_v[j];
  return {i * (grid_.breaks_v.size() - 1) + j, (u - grid_.breaks_u[i]) / du, (v - grid_.breaks_v[j]) / dv, du,
          dv};
}

Vec3 NurbsSurface::point(double u, double v) const {
  const Place at = find(u, v);
  const Bernstein along(grid_.degree_u, at.s), across(grid_.degree_v, at.t);
  const Vec4* net = grid_.poles.data() + at.patch * grid_.patch_size();
  Vec4 H = Vec4::Zero();
  for (size_t i = 0; i <= static_cast<size_t>(grid_.degree_u); ++i) {
    Vec4 row = Vec4::Zero();
    for (size_t j = 0; j <= static_cast<size_t>(grid_.degree_v); ++j) row += across.value[j] * *net++;
    H += along.value[i] * row;
  }
  return H.head<3>() / H.w();
}

Derivatives NurbsSurface::derivatives(double u, double v) const {
  const Place at = find(u, v);
  const Homogeneous h = evaluate(grid_.poles.data() + at.patch * grid_.patch_size(), grid_.degree_u,
                                 grid_.degree_v, at.s, at.t);
  const double w = h.H.w();
  Derivatives d;
  d.S = h.H.head<3>() / w;
  d.Su = (h.u.head<3>() - d.S * h.u.w()) / w;
  d.Sv = (h.v.head<3>() - d.S * h.v.w()) / w;
  d.Suu = (h.uu.head<3>() - 2.0 * d.Su * h.u.w() - d.S * h.uu.w()) / (w * at.du * at.du);
  d.Suv = (h.uv.head<3>() - d.Su * h.v.w() - d.Sv * h.u.w() - d.S * h.uv.w()) / (w * at.du * at.dv);
  d.Svv = (h.vv.head<3>() - 2.0 * d.Sv * h.v.w() - d.S * h.vv.w()) / (w * at.dv * at.dv);
  d.Su /= at.du;
  d.Sv /= at.dv;
  return d;
}

BendBounds NurbsSurface::patch_bounds(size_t i, size_t j, const Rect& rect) const {
  const double du = grid_.breaks_u[i + 1] - grid_.breaks_u[i], dv = grid_.breaks_v[j + 1] - grid_.breaks_v[j];
  const size_t patch = i * (grid_.breaks_v.size() - 1) + j, q = static_cast<size_t>(grid_.degree_v) + 1;
  // Taylor coefficients about the rectangle's centre, in the patch's own parameters.
  std::array<Vec4, kMostCoefficients * kMostCoefficients> c;
  const Vec4* powers = powers_.data() + patch * grid_.patch_size();
  std::copy(powers, powers + grid_.patch_size(), c.begin());
  const double s = (0.5 * (rect.low.x() + rect.high.x()) - grid_.breaks_u[i]) / du - 0.5;
  const double t = (0.5 * (rect.low.y() + rect.high.y()) - grid_.breaks_v[j]) / dv - 0.5;
  for (size_t k = 0; k < q; ++k) shift(c.data() + k, grid_.degree_u, q, s);
  for (size_t k = 0; k < grid_.patch_size(); k += q) shift(c.data() + k, grid_.degree_v, 1, t);
  const auto gu = growth(grid_.degree_u, 0.5 * (rect.high.x() - rect.low.x()) / du);
  const auto gv = growth(grid_.degree_v, 0.5 * (rect.high.y() - rect.low.y()) / dv);
  const Vec3 Sc = c[0].head<3>() / c[0].w();
  const auto at = [&](size_t k, size_t l) -> Vec4 {
    return k <= static_cast<size_t>(grid_.degree_u) && l < q ? c[k * q + l] : Vec4::Zero();
  };
  const auto Q_of = [&](const Vec4& x) -> Vec3 { return x.head<3>() - Sc * x.w(); };
  const auto rQ = radii(grid_.degree_u, grid_.degree_v, gu, gv, [&](size_t n) { return Q_of(c[n]).norm(); });
  const Vec4 cu = at(1, 0), cv = at(0, 1), cuu = 2.0 * at(2, 0), cuv = at(1, 1), cvv = 2.0 * at(0, 2);
  BendBounds bounds;
  if (rational_) {
    const auto rw =
        radii(grid_.degree_u, grid_.degree_v, gu, gv, [&](size_t n) { return std::abs(c[n].w()); });
    bounds = bend_of({{Vec3::Zero(), rQ[0]},
                      {Q_of(cu), rQ[1]},
                      {Q_of(cv), rQ[2]},
                      {Q_of(cuu), rQ[3]},
                      {Q_of(cuv), rQ[4]},
                      {Q_of(cvv), rQ[5]},
                      {c[0].w(), rw[0]},
                      {cu.w(), rw[1]},
                      {cv.w(), rw[2]},
                      {cuu.w(), rw[3]},
                      {cuv.w(), rw[4]},
                      {cvv.w(), rw[5]},
                      std::max(least_weight_[patch], c[0].w() - rw[0])});
  } else {
    const double w = c[0].w();
    bounds = {{Q_of(cuu) / w, rQ[3] / w}, {Q_of(cuv) / w, rQ[4] / w}, {Q_of(cvv) / w, rQ[5] / w}};
  }
  const auto scale = [](Bend& bend, double by) { bend = {bend.mean / by, bend.stray / by}; };
  scale(bounds.uu, du * du);
  scale(bounds.uv, du * dv);
  scale(bounds.vv, dv * dv);
  return bounds;
}

BendBounds NurbsSurface::bend_bounds(const Vec2& low, const Vec2& high) const {
  const auto& bu = grid_.breaks_u;
  const auto& bv = grid_.breaks_v;
  const auto [i0, i1] = spans_between(bu, low.x(), high.x());
  const auto [j0, j1] = spans_between(bv, low.y(), high.y());
  BendBounds all;
  for (size_t i = i0; i < i1; ++i) {
    for (size_t j = j0; j < j1; ++j) {
      const Rect patch{{bu[i], bv[j]}, {bu[i + 1], bv[j + 1]}};
      const Rect rect{low.cwiseMax(patch.low), high.cwiseMin(patch.high)};
      const BendBounds& whole = whole_[i * (bv.size() - 1) + j];
      const bool is_whole = rect.low == patch.low && rect.high == patch.high;
      const BendBounds part = widened(is_whole ? whole : patch_bounds(i, j, rect), whole);
      all = i == i0 && j == j0 ? part : hull(all, part);
    }
  }
  return all;
}

}  // namespace swarf::surface
