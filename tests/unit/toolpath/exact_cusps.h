// Exact cusp geometry of theory 1.1 that only the tests need.
#pragma once

#include <cmath>

namespace swarf::toolpath::test {

/// Distance between adjacent contact points measured in the tangent planes: 2 sqrt(2Rh + h^2).
inline double tangent_plane_distance(double R, double h) {
  return 2.0 * std::sqrt(2.0 * R * h + h * h);
}

/// Arc between adjacent contact points, 2 R theta with cos(theta) = R/(R+h).
inline double arc_between_passes(double R, double h) {
  return 2.0 * R * std::acos(R / (R + h));
}

/// Flat end of radius r leaned by phi in the feed plane, on a plane: r sin(phi) (1 - sqrt(1 - (P/2r)^2)).
inline double leaned_flat_on_plane(double r, double phi, double P) {
  return r * std::sin(phi) * (1.0 - std::sqrt(1.0 - std::pow(P / (2.0 * r), 2)));
}

/// Radius of the cross section swept by a leaned tool with corner radius rc: (rc + r/sin phi) cos^2 w + rc
/// sin^2 w.
inline double effective_radius(double r, double rc, double phi, double omega) {
  return (rc + r / std::sin(phi)) * std::pow(std::cos(omega), 2) + rc * std::pow(std::sin(omega), 2);
}

/// Ball of radius r on a circle of radius R: convex > 0, concave < 0, a plane when infinite.
inline double ball_on_circle(double R, double r, double P) {
  if (std::isinf(R)) return r - std::sqrt(r * r - 0.25 * P * P);
  const double sine = P / (2.0 * std::abs(R));
  const double cosine = std::sqrt(1.0 - sine * sine);
  const double centre = R > 0.0 ? R + r : -R - r;
  const double root = std::sqrt(r * r - centre * centre * sine * sine);
  return R > 0.0 ? centre * cosine - root - R : -R - centre * cosine - root;
}

}  // namespace swarf::toolpath::test
