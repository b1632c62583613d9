// NURBS surfaces against closed forms, exact polynomials and their own promises.
#include "surface/nurbs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "base/units.h"
#include "surface/curvature.h"
#include "unit/surface/test_surfaces.h"

namespace swarf::surface {
namespace {

/// Points and weights of arcs of 90 degrees each about z, at radius 1 and height 0.
struct Arcs {
  std::vector<double> knots;
  std::vector<Vec2> points;
  std::vector<double> weights;
};

Arcs quarter_arcs(int count) {
  const double c = std::sqrt(0.5);
  Arcs arcs{{0, 0, 0}, {{1, 0}}, {1}};
  for (int k = 0; k < count; ++k) {
    const double a = k * kPi / 2, b = a + kPi / 2;
    arcs.points.emplace_back(std::cos(a) - std::sin(a), std::sin(a) + std::cos(a));
    arcs.points.emplace_back(std::cos(b), std::sin(b));
    arcs.weights.insert(arcs.weights.end(), {c, 1});
    arcs.knots.insert(arcs.knots.end(), {k + 1.0, k + 1.0});
  }
  arcs.knots.push_back(count);
  return arcs;
}

/// A meridian (radius, height) of arcs turned about z by quarters.
NurbsData revolved(int quarters, const Arcs& meridian, double ring, double tube) {
  const Arcs round = quarter_arcs(quarters);
  NurbsData data{2, 2, round.knots, meridian.knots, {}, {}, 1};
  for (size_t i = 0; i < round.points.size(); ++i) {
    for (size_t j = 0; j < meridian.points.size(); ++j) {
      const double r = ring + tube * meridian.points[j].x();
      data.poles.emplace_back(r * round.points[i].x(), r * round.points[i].y(),
                              tube * meridian.points[j].y());
      data.weights.push_back(round.weights[i] * meridian.weights[j]);
    }
  }
  return data;
}

NurbsData cylinder(int quarters, double radius, double height) {
  const Arcs round = quarter_arcs(quarters);
  NurbsData data{2, 1, round.knots, {0, 0, 3, 3}, {}, {}, 1};
  for (size_t i = 0; i < round.points.size(); ++i) {
    for (const double z : {0.0, height}) {
      data.poles.emplace_back(radius * round.points[i].x(), radius * round.points[i].y(), z);
      data.weights.push_back(round.weights[i]);
    }
  }
  return data;
}

std::vector<double> random_knots(Rng& rng, int degree, bool clamped) {
  std::vector<double> knots;
  double x = rng.uniform(-2, 2);
  for (int i = 0; i <= degree; ++i) knots.push_back(x += clamped && i > 0 ? 0.0 : rng.uniform(0.2, 1));
  const int inner = static_cast<int>(rng.uniform(0, 4));
  for (int i = 0; i < inner; ++i) {
    x += rng.uniform(0.1, 2);
    const int times = 1 + static_cast<int>(rng.uniform(0, std::max(1, degree - 1)));
    knots.insert(knots.end(), static_cast<size_t>(std::min(times, std::max(1, degree - 1))), x);
  }
  x += rng.uniform(0.1, 2);
  for (int i = 0; i <= degree; ++i) knots.push_back(x += clamped || i == 0 ? 0.0 : rng.uniform(0.2, 1));
  return knots;
}

NurbsData random_nurbs(Rng& rng, int least_degree = 2) {
  NurbsData data;
  data.degree_u = least_degree + static_cast<int>(rng.uniform(0, 4));
  data.degree_v = least_degree + static_cast<int>(rng.uniform(0, 4));
  data.knots_u = random_knots(rng, data.degree_u, rng.uniform() < 0.7);
  data.knots_v = random_knots(rng, data.degree_v, rng.uniform() < 0.7);
  const bool rational = rng.uniform() < 0.6;
  for (int i = 0; i < data.count_u(); ++i) {
    for (int j = 0; j < data.count_v(); ++j) {
      data.poles.emplace_back(20.0 * i + rng.uniform(-5, 5), 15.0 * j + rng.uniform(-5, 5),
                              rng.uniform(-20, 20));
      if (rational) data.weights.push_back(std::exp(rng.uniform(-1.5, 1.5)));
    }
  }
  return data;
}

std::string text(const NurbsData& d) {
  std::string poles;
  for (const Vec3& P : d.poles) poles += fmt::format("{{{}, {}, {}}}, ", P.x(), P.y(), P.z());
  return fmt::format("NurbsData{{{}, {}, {{{}}}, {{{}}}, {{{}}}, {{{}}}}}", d.degree_u, d.degree_v,
                     fmt::join(d.knots_u, ", "), fmt::join(d.knots_v, ", "), poles,
                     fmt::join(d.weights, ", "));
}

/// N_i of degree p by the recurrence that defines it (Cox, de Boor), in long double.
long double basis(const std::vector<double>& U, int i, int p, long double t, double last) {
  const auto at = [&](int k) { return static_cast<long double>(U[static_cast<size_t>(k)]); };
  if (p == 0)
    return at(i) <= t && (t < at(i + 1) || (t == last && at(i) < at(i + 1) && at(i + 1) == last)) ? 1 : 0;
  long double sum = 0;
  if (at(i + p) > at(i)) sum += (t - at(i)) / (at(i + p) - at(i)) * basis(U, i, p - 1, t, last);
  if (at(i + p + 1) > at(i + 1))
    sum += (at(i + p + 1) - t) / (at(i + p + 1) - at(i + 1)) * basis(U, i + 1, p - 1, t, last);
  return sum;
}

/// The definition itself, at (u, v) of the unit square.
Vec3 by_definition(const NurbsData& d, double u, double v) {
  const auto map = [](const std::vector<double>& U, int p, double x) {
    const double a = U[static_cast<size_t>(p)], b = U[U.size() - 1 - static_cast<size_t>(p)];
    return std::pair(a + x * (b - a), b);
  };
  const auto [s, last_u] = map(d.knots_u, d.degree_u, u);
  const auto [t, last_v] = map(d.knots_v, d.degree_v, v);
  std::array<long double, 4> H{};
  for (int i = 0; i < d.count_u(); ++i) {
    for (int j = 0; j < d.count_v(); ++j) {
      const auto n = static_cast<size_t>(i * d.count_v() + j);
      const long double w = (d.weights.empty() ? 1.0 : d.weights[n]) *
                            basis(d.knots_u, i, d.degree_u, s, last_u) *
                            basis(d.knots_v, j, d.degree_v, t, last_v);
      for (int k = 0; k < 3; ++k) H[static_cast<size_t>(k)] += w * d.poles[n][k];
      H[3] += w;
    }
  }
  return {static_cast<double>(H[0] / H[3]), static_cast<double>(H[1] / H[3]),
          static_cast<double>(H[2] / H[3])};
}

TEST(Nurbs, PointsAreThoseOfTheDefinition) {
  Rng rng(811);
  for (int trial = 0; trial < 60; ++trial) {
    const NurbsData data = random_nurbs(rng, 1);
    for (const NurbsPart& part : smooth_parts(data)) {
      for (int k = 0; k < 5; ++k) {
        const Vec2 in(rng.uniform(), rng.uniform());
        const Vec2 uv = part.low + in.cwiseProduct(part.high - part.low);
        const Vec3 expected = by_definition(data, uv.x(), uv.y());
        EXPECT_LT((part.surface->point(in.x(), in.y()) - expected).norm(), 1e-11)
            << text(data) << in.transpose();
        EXPECT_LT((part.surface->derivatives(in.x(), in.y()).S - expected).norm(), 1e-11) << text(data);
      }
    }
  }
}

TEST(Nurbs, DerivativesAgreeWithFiniteDifferences) {
  Rng rng(812);
  constexpr double h = 1e-5;
  for (int trial = 0; trial < 60; ++trial) {
    const NurbsData data = random_nurbs(rng);
    const NurbsSurface S(data);
    const double u = rng.uniform(-0.02, 1.02), v = rng.uniform(-0.02, 1.02);
    const Derivatives d = S.derivatives(u, v);
    // No break within the step: the second derivatives jump there.
    bool smooth = true;
    for (const double b : S.grid().breaks_u) smooth = smooth && (std::abs(b - u) > h || b == 0.0 || b == 1.0);
    for (const double b : S.grid().breaks_v) smooth = smooth && (std::abs(b - v) > h || b == 0.0 || b == 1.0);
    if (!smooth) continue;
    const Derivatives right = S.derivatives(u + h, v), left = S.derivatives(u - h, v);
    const Derivatives above = S.derivatives(u, v + h), below = S.derivatives(u, v - h);
    const auto near = [&](const Vec3& exact, const Vec3& a, const Vec3& b, const char* what) {
      EXPECT_LT((exact - (a - b) / (2 * h)).norm(), 2e-5 * (10.0 + exact.norm()))
          << what << " at " << u << ", " << v << " of " << text(data);
    };
    near(d.Su, right.S, left.S, "Su");
    near(d.Sv, above.S, below.S, "Sv");
    near(d.Suu, right.Su, left.Su, "Suu");
    near(d.Suv, right.Sv, left.Sv, "Suv");
    near(d.Suv, above.Su, below.Su, "Suv");
    near(d.Svv, above.Sv, below.Sv, "Svv");
  }
}

TEST(Nurbs, ABezierPatchIsThePolynomialBeyondItsEdgesToo) {
  Rng rng(813);
  for (int trial = 0; trial < 30; ++trial) {
    const int p = 1 + static_cast<int>(rng.uniform(0, 6)), q = 1 + static_cast<int>(rng.uniform(0, 6));
    NurbsData data{p, q, {}, {}, random_points(rng, p, q, 40), {}, 1};
    for (const double x : {-3.0, 5.0}) {
      data.knots_u.insert(data.knots_u.end(), static_cast<size_t>(p) + 1, x);
      data.knots_v.insert(data.knots_v.end(), static_cast<size_t>(q) + 1, x);
    }
    const NurbsSurface S(data);
    const PolynomialSurface exact = PolynomialSurface::from_bezier(p, q, data.poles, 1);
    const double u = rng.uniform(-0.1, 1.1), v = rng.uniform(-0.1, 1.1);
    const Derivatives a = S.derivatives(u, v), b = exact.derivatives(u, v);
    const double tolerance = 1e-10;
    EXPECT_LT((a.S - b.S).norm(), tolerance) << text(data);
    EXPECT_LT((a.Su - b.Su).norm(), tolerance) << text(data);
    EXPECT_LT((a.Sv - b.Sv).norm(), tolerance) << text(data);
    EXPECT_LT((a.Suu - b.Suu).norm(), 10 * tolerance) << text(data);
    EXPECT_LT((a.Suv - b.Suv).norm(), 10 * tolerance) << text(data);
    EXPECT_LT((a.Svv - b.Svv).norm(), 10 * tolerance) << text(data);
  }
}

TEST(Nurbs, CylinderSphereAndTorusAreThoseOfTheClosedForms) {
  Rng rng(814);
  for (int trial = 0; trial < 40; ++trial) {
    const double R = rng.uniform(20, 60), r = rng.uniform(2, 15), u = rng.uniform(), v = rng.uniform();
    const int quarters = 1 + static_cast<int>(rng.uniform(0, 4));
    const NurbsSurface tube(cylinder(quarters, R, 30)), ball(revolved(quarters, quarter_arcs(1), 0, R)),
        ring(revolved(quarters, quarter_arcs(4), R, r));
    const auto radial = [](const Vec3& P) { return Vec3(P.x(), P.y(), 0.0); };
    const auto kappa = [&](const NurbsSurface& S) {
      return principal_curvatures(shape_at(S.derivatives(u, v), 1));
    };
    const auto normal = [&](const NurbsSurface& S) { return outward_normal(S, S.derivatives(u, v), {u, v}); };
    const Vec3 A = tube.point(u, v), B = ball.point(u, v), C = ring.point(u, v);
    EXPECT_NEAR(radial(A).norm(), R, 1e-12 * R);
    EXPECT_LT((normal(tube) - radial(A) / R).norm(), 1e-12);
    EXPECT_NEAR(kappa(tube).high * R, 1.0, 1e-12);
    EXPECT_NEAR(kappa(tube).low * R, 0.0, 1e-12);
    EXPECT_NEAR(B.norm(), R, 1e-12 * R);
    EXPECT_LT((normal(ball) - B / R).norm(), 1e-12);
    EXPECT_NEAR(kappa(ball).high * R, 1.0, 1e-11);
    EXPECT_NEAR(kappa(ball).low * R, 1.0, 1e-11);
    const Vec3 centre = R * radial(C).normalized();
    EXPECT_NEAR((C - centre).norm(), r, 1e-12 * R);
    EXPECT_LT((normal(ring) - (C - centre) / r).norm(), 1e-11);
    const double cosine = (radial(C).norm() - R) / r;
    EXPECT_NEAR(kappa(ring).high * r, 1.0, 1e-11);
    EXPECT_NEAR(kappa(ring).low * R, R * cosine / (R + r * cosine), 1e-11);
  }
}

TEST(Nurbs, ThePoleOfASphereHasItsNormal) {
  const double R = 12;
  const NurbsSurface ball(revolved(4, quarter_arcs(1), 0, R));
  for (const double u : {0.0, 0.13, 0.5, 0.77, 1.0}) {
    EXPECT_LT((outward_normal(ball, ball.derivatives(u, 1.0), {u, 1.0}) - Vec3::UnitZ()).norm(), 1e-8) << u;
    const double v = 1.0 - 1e-6;
    const Vec3 near = outward_normal(ball, ball.derivatives(u, v), {u, v});
    EXPECT_LT((near - ball.point(u, v) / R).norm(), 1e-7) << u;
  }
  // A patch that is a line has none, and no number that is not one.
  const NurbsSurface line(
      NurbsData{1, 1, {0, 0, 1, 1}, {0, 0, 1, 1}, {{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 0, 0}}, {}, 1});
  EXPECT_EQ(outward_normal(line, line.derivatives(0.3, 0.4), {0.3, 0.4}), Vec3::Zero());
}

TEST(Nurbs, SecondDerivativesNeverLeaveTheirBounds) {
  Rng rng(815);
  for (int trial = 0; trial < 150; ++trial) {
    const NurbsData data = random_nurbs(rng);
    const NurbsSurface S(data);
    for (int box = 0; box < 4; ++box) {
      const double size = std::pow(10.0, rng.uniform(-4, 0));
      const Vec2 low(rng.uniform(0, 1 - size), rng.uniform(0, 1 - size));
      const Vec2 high = low + size * Vec2(rng.uniform(), rng.uniform());
      const BendBounds bounds = S.bend_bounds(low, high);
      for (int k = 0; k < 25; ++k) {
        // Corners and sides among them: that is where bounds are touched.
        const auto in = [&](double a, double b) {
          const double share = rng.uniform(-0.3, 1.3);
          return a + std::clamp(share, 0.0, 1.0) * (b - a);
        };
        const double u = in(low.x(), high.x()), v = in(low.y(), high.y());
        const Derivatives d = S.derivatives(u, v);
        const auto holds = [&](const Vec3& second, const Bend& bend, const char* what) {
          EXPECT_LE((second - bend.mean).norm(), bend.stray + 1e-12 * (second.norm() + 1.0))
              << fmt::format("{} at {}, {} in [{}, {}] x [{}, {}] of {}", what, u, v, low.x(), high.x(),
                             low.y(), high.y(), text(data));
        };
        holds(d.Suu, bounds.uu, "Suu");
        holds(d.Suv, bounds.uv, "Suv");
        holds(d.Svv, bounds.vv, "Svv");
      }
    }
  }
}

TEST(Nurbs, BoundsShrinkWithTheRectangle) {
  Rng rng(816);
  for (int trial = 0; trial < 30; ++trial) {
    const NurbsData data = random_nurbs(rng);
    const NurbsSurface S(data);
    const Vec2 centre(rng.uniform(0.2, 0.8), rng.uniform(0.2, 0.8));
    const auto breaks = [&](const std::vector<double>& all, double x) {
      double nearest = 1.0;
      for (const double b : all) nearest = std::min(nearest, std::abs(b - x));
      return nearest;
    };
    const double half =
        0.5 * std::min(breaks(S.grid().breaks_u, centre.x()), breaks(S.grid().breaks_v, centre.y()));
    const auto stray = [&](double h) {
      const BendBounds b = S.bend_bounds(centre - Vec2(h, h), centre + Vec2(h, h));
      return b.uu.stray + b.uv.stray + b.vv.stray;
    };
    // Of the second derivative the first order: halved with the rectangle once it is small.
    EXPECT_LT(stray(half / 64), 0.6 * stray(half / 32) + 1e-9) << text(data);
    EXPECT_LT(stray(half / 64), 0.1 * stray(half) + 1e-9) << text(data);
  }
}

TEST(Nurbs, BoundsOfAQuarterOfACylinderAreNotLoose) {
  const NurbsSurface S(cylinder(1, 50, 30));
  // 5 mm of the arc: the bend hardly changes.
  const BendBounds b = S.bend_bounds({0.4, 0.0}, {0.46, 1.0});
  EXPECT_LT(b.uu.stray, 0.6 * b.uu.mean.norm());
  EXPECT_LT(b.vv.most(), 1e-9);
}

TEST(Nurbs, IsCutWhereItHasACreaseAndNowhereElse) {
  // A roof: degree 1 with a kink at x = 10, and a straight knot at x = 20.
  NurbsData roof{1, 1, {0, 0, 1, 2, 3, 3}, {0, 0, 1, 1}, {}, {}, 1};
  for (const double x : {0, 10, 20, 30}) {
    for (const double y : {0, 5}) roof.poles.emplace_back(x, y, x < 10 ? 0 : x - 10);
  }
  roof.knots_u = {0, 0, 1, 2, 3, 3};
  const std::vector<NurbsPart> parts = smooth_parts(roof);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_NEAR(parts[0].high.x(), 1.0 / 3, 1e-15);
  EXPECT_EQ(parts[1].low.x(), parts[0].high.x());
  EXPECT_LT((parts[1].surface->point(0.5, 0.5) - Vec3(20, 2.5, 10)).norm(), 1e-12);
  // Circles have knots as often as their degree, and no crease.
  EXPECT_EQ(smooth_parts(revolved(4, quarter_arcs(4), 30, 5)).size(), 1U);
  // Arcs of 90 and 45 degrees over knots of equal width meet with one tangent, but not with one speed.
  NurbsData uneven = cylinder(2, 10, 5);
  uneven.knots_u = {0, 0, 0, 1, 1, 3, 3, 3};
  EXPECT_EQ(smooth_parts(uneven).size(), 2U);
}

TEST(Nurbs, WhatIsNoSurfaceIsTold) {
  const NurbsData good = cylinder(1, 10, 5);
  const auto problem = [&](auto&& spoil) {
    NurbsData data = good;
    spoil(data);
    const auto found = nurbs_problems(data);
    return found.empty() ? std::string() : found.front();
  };
  EXPECT_EQ(problem([](NurbsData&) {}), "");
  EXPECT_NE(problem([](NurbsData& d) { d.degree_u = 12; }).find("1 to 11"), std::string::npos);
  EXPECT_NE(problem([](NurbsData& d) { d.degree_u = 0; }).find("degree 0"), std::string::npos);
  EXPECT_NE(problem([](NurbsData& d) { d.knots_u.pop_back(); }).find("knots in u"), std::string::npos);
  EXPECT_NE(problem([](NurbsData& d) { d.knots_u[1] = -1; }).find("must not fall"), std::string::npos);
  EXPECT_NE(problem([](NurbsData& d) { d.knots_v = {0, 0, 0, 0}; }).find("no parameters"), std::string::npos);
  EXPECT_NE(problem([](NurbsData& d) { d.poles.pop_back(); }).find("3 x 2 = 6"), std::string::npos);
  EXPECT_NE(problem([](NurbsData& d) { d.weights[2] = 0; }).find("weight 3"), std::string::npos);
  EXPECT_NE(problem([](NurbsData& d) { d.weights.pop_back(); }).find("5 weights"), std::string::npos);
  EXPECT_NE(problem([](NurbsData& d) { d.poles[0].x() = NAN; }).find("not a number"), std::string::npos);
  EXPECT_NE(problem([](NurbsData& d) { d.outward_sign = 0; }).find("+1 or -1"), std::string::npos);
  NurbsData gap = good;
  gap.knots_u = {0, 0, 0, 1, 1, 1, 2, 2, 2};
  gap.poles.resize(12, Vec3::Ones());
  gap.weights.resize(12, 1.0);
  EXPECT_NE(nurbs_problems(gap).front().find("gap"), std::string::npos);
}

}  // namespace
}  // namespace swarf::surface
