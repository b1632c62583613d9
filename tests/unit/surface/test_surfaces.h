// Surfaces that the tests share.
#pragma once

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "base/rng.h"
#include "surface/polynomial.h"

namespace swarf::surface {

/// DOME of theory 1.6, written in the power basis.
inline PolynomialSurface dome() {
  std::vector<Vec3> c(9, Vec3::Zero());
  c[0] = {-50, -40, 0};
  c[1] = {0, 80, 60};
  c[2] = {0, 0, -60};
  c[3] = {100, 0, 80};
  c[6] = {0, 0, -80};
  return {2, 2, c, 1};
}

/// z = x^2 a/2 + x y b + y^2 c/2 over x = u, y = v: at u = v = 0 its second fundamental form is (a, b; b, c).
inline PolynomialSurface quadric(double a, double b, double c, int outward_sign) {
  std::vector<Vec3> p(9, Vec3::Zero());
  p[3] = {1, 0, 0};
  p[1] = {0, 1, 0};
  p[6] = {0, 0, a / 2};
  p[4] = {0, 0, b};
  p[2] = {0, 0, c / 2};
  return {2, 2, p, outward_sign};
}

inline std::vector<Vec3> random_points(Rng& rng, int degree_u, int degree_v, double size) {
  std::vector<Vec3> points(static_cast<size_t>(degree_u + 1) * (degree_v + 1));
  // Braces fix the order of the three draws.
  for (Vec3& p : points)
    p = Vec3{rng.uniform(-size, size), rng.uniform(-size, size), rng.uniform(-size, size)};
  return points;
}

/// The surface ready to paste into a test.
inline std::string pasted(const PolynomialSurface& surface) {
  std::ostringstream text;
  text.precision(17);
  text << "PolynomialSurface(" << surface.degree_u() << ", " << surface.degree_v() << ", {";
  for (const Vec3& c : surface.coefficients())
    text << "{" << c.x() << ", " << c.y() << ", " << c.z() << "}, ";
  text << "}, " << surface.outward_sign() << ")";
  return text.str();
}

}  // namespace swarf::surface
