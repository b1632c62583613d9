#include "surface/curvature.h"

#include <cmath>

#include "base/units.h"
#include "unit/surface/test_surfaces.h"

namespace swarf::surface {
namespace {

/// Sphere of radius R by longitude a and latitude b; Su x Sv points outwards.
Derivatives sphere(double R, double a, double b) {
  const double ca = std::cos(a), sa = std::sin(a), cb = std::cos(b), sb = std::sin(b);
  return {R * Vec3(ca * cb, sa * cb, sb),  R * Vec3(-sa * cb, ca * cb, 0), R * Vec3(-ca * sb, -sa * sb, cb),
          R * Vec3(-ca * cb, -sa * cb, 0), R * Vec3(sa * sb, -ca * sb, 0), R * Vec3(-ca * cb, -sa * cb, -sb)};
}

/// Torus with tube radius r on a circle of radius R; b = 0 is its outer equator. Su x Sv points outwards.
Derivatives torus(double R, double r, double a, double b) {
  const double ca = std::cos(a), sa = std::sin(a), cb = std::cos(b), sb = std::sin(b);
  const double q = R + r * cb;
  return {Vec3(q * ca, q * sa, r * sb),       Vec3(-q * sa, q * ca, 0),
          r * Vec3(-sb * ca, -sb * sa, cb),   Vec3(-q * ca, -q * sa, 0),
          Vec3(r * sb * sa, -r * sb * ca, 0), r * Vec3(-cb * ca, -cb * sa, -sb)};
}

TEST(Curvature, OfASphereIsOneOverItsRadiusInEveryDirection) {
  Rng rng(21);
  for (int trial = 0; trial < 100; ++trial) {
    const double R = rng.uniform(0.5, 500);
    const Shape shape = shape_at(sphere(R, rng.uniform(0, 2 * kPi), rng.uniform(-1.5, 1.5)), 1);
    EXPECT_NEAR(principal_curvatures(shape).low * R, 1.0, 1e-12) << "R " << R;
    EXPECT_NEAR(principal_curvatures(shape).high * R, 1.0, 1e-12) << "R " << R;
    EXPECT_NEAR(gaussian_curvature(shape) * R * R, 1.0, 1e-12) << "R " << R;
    const double angle = rng.uniform(0, kPi);
    EXPECT_NEAR(normal_curvature(shape, {std::cos(angle), std::sin(angle)}) * R, 1.0, 1e-12);
    EXPECT_LT((shape.normal - shape.point / R).norm(), 1e-12) << "a sphere's normal points outwards";
  }
}

TEST(Curvature, OfATorusChangesSignOverItsTop) {
  const double R = 40, r = 10;
  for (const double b : {0.0, 0.4, kPi / 2, 2.2, kPi}) {
    const auto kappa = principal_curvatures(shape_at(torus(R, r, 0.7, b), 1));
    EXPECT_NEAR(kappa.high, 1 / r, 1e-14) << "b " << b;
    EXPECT_NEAR(kappa.low, std::cos(b) / (R + r * std::cos(b)), 1e-14) << "b " << b;
  }
}

TEST(Curvature, OfAQuadricAtItsApexIsItsForm) {
  // Seen from above, z = -x^2/(2 R) is a cylinder of radius R; a rise is concave.
  const Derivatives cylinder = quadric(-1 / 25.0, 0, 0, 1).derivatives(0, 0);
  EXPECT_NEAR(principal_curvatures(shape_at(cylinder, 1)).high, 0.04, 1e-16);
  EXPECT_NEAR(principal_curvatures(shape_at(cylinder, 1)).low, 0.0, 1e-16);
  EXPECT_NEAR(principal_curvatures(shape_at(cylinder, -1)).low, -0.04, 1e-16);
  const Shape saddle = shape_at(quadric(0.02, 0, -0.03, 1).derivatives(0, 0), 1);
  EXPECT_NEAR(gaussian_curvature(saddle), -6e-4, 1e-17);
  const Shape twisted = shape_at(quadric(0, 0.05, 0, 1).derivatives(0, 0), 1);
  EXPECT_NEAR(principal_curvatures(twisted).low, -0.05, 1e-16);
  EXPECT_NEAR(principal_curvatures(twisted).high, 0.05, 1e-16);
}

TEST(Curvature, FollowsEulersFormula) {
  const Shape shape = shape_at(quadric(-0.025, 0, -1 / 120.0, 1).derivatives(0, 0), 1);
  for (const double degrees : {0, 20, 45, 70, 90}) {
    const double angle = rad_from_deg(degrees);
    const Vec2 t = shape.in_tangent({std::cos(angle), std::sin(angle), 0});
    const double expected = 0.025 * std::pow(std::cos(angle), 2) + std::pow(std::sin(angle), 2) / 120.0;
    EXPECT_NEAR(normal_curvature(shape, t), expected, 1e-16) << degrees << " deg";
  }
}

TEST(Curvature, FrameIsRightHandedAndTangent) {
  Rng rng(22);
  for (int trial = 0; trial < 50; ++trial) {
    const Derivatives d = dome().derivatives(rng.uniform(), rng.uniform());
    for (const int sign : {1, -1}) {
      const Shape shape = shape_at(d, sign);
      EXPECT_LT((shape.e1.cross(shape.e2) - shape.normal).norm(), 1e-14);
      EXPECT_NEAR(shape.normal.dot(d.Su) / d.Su.norm(), 0.0, 1e-14);
      EXPECT_NEAR(shape.normal.dot(d.Sv) / d.Sv.norm(), 0.0, 1e-14);
      EXPECT_NEAR(shape.K(0, 1), shape.K(1, 0), 1e-16);
      const Vec3 tangent = 0.3 * d.Su - 0.2 * d.Sv;
      const Vec2 inside = shape.in_tangent(tangent);
      EXPECT_LT((inside.x() * shape.e1 + inside.y() * shape.e2 - tangent).norm(), 1e-12);
    }
  }
}

/// The derivatives after u = u(p,q), v = v(p,q), by the chain rule: first derivatives in J = (u_p u_q; v_p
/// v_q), second ones of u and v in Hu and Hv.
Derivatives reparametrised(const Derivatives& d, const Mat2& J, const Mat2& Hu, const Mat2& Hv) {
  const auto second = [&](int a, int b) -> Vec3 {
    return d.Suu * (J(0, a) * J(0, b)) + d.Suv * (J(0, a) * J(1, b) + J(1, a) * J(0, b)) +
           d.Svv * (J(1, a) * J(1, b)) + d.Su * Hu(a, b) + d.Sv * Hv(a, b);
  };
  return {d.S,
          d.Su * J(0, 0) + d.Sv * J(1, 0),
          d.Su * J(0, 1) + d.Sv * J(1, 1),
          second(0, 0),
          second(0, 1),
          second(1, 1)};
}

Mat2 random_symmetric(Rng& rng) {
  const double a = rng.uniform(-2, 2);
  const double b = rng.uniform(-2, 2);
  const double c = rng.uniform(-2, 2);
  Mat2 H;
  H << a, b, b, c;
  return H;
}

TEST(Curvature, DoesNotDependOnTheParameters) {
  Rng rng(23);
  int tried = 0;
  while (tried < 500) {
    const double u = rng.uniform();
    const double v = rng.uniform();
    Mat2 J;
    J << rng.uniform(-2, 2), rng.uniform(-2, 2), rng.uniform(-2, 2), rng.uniform(-2, 2);
    if (std::abs(J.determinant()) < 0.1) continue;
    ++tried;
    const Derivatives d = dome().derivatives(u, v);
    const Derivatives e = reparametrised(d, J, random_symmetric(rng), random_symmetric(rng));
    const Shape original = shape_at(d, 1);
    // Parameters that swap the sides of the surface turn Su x Sv.
    const Shape changed = shape_at(e, J.determinant() > 0 ? 1 : -1);
    EXPECT_LT((original.normal - changed.normal).norm(), 1e-12) << "u " << u << " v " << v << " J " << J;
    EXPECT_NEAR(principal_curvatures(original).low, principal_curvatures(changed).low, 1e-12)
        << "u " << u << " v " << v;
    EXPECT_NEAR(principal_curvatures(original).high, principal_curvatures(changed).high, 1e-12)
        << "u " << u << " v " << v;
    const Vec3 t = original.e1 * std::cos(u) + original.e2 * std::sin(u);
    EXPECT_NEAR(normal_curvature(original, original.in_tangent(t)),
                normal_curvature(changed, changed.in_tangent(t)), 1e-12);
  }
}

}  // namespace
}  // namespace swarf::surface
