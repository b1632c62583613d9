#include "toolpath/scallop_interval.h"

#include <algorithm>
#include <cmath>

namespace swarf::toolpath {
namespace {

/// Across a unit vector of the tangent plane: a quarter turn to the left, seen from outside.
Vec2 left_of(const Vec2& t) {
  return {-t.y(), t.x()};
}

/// Curvature along the feed below which it counts as straight: relative to the size of the matrix, rounding.
constexpr double kStraight = 1e-12;

}  // namespace

double chord_for_scallop(double R, double h) {
  return 2.0 * std::sqrt(2.0 * R * h + h * h) / (1.0 + h / R);
}

double scallop_for_chord(double R, double P) {
  const double sine = P / (2.0 * R);
  const double cosine = std::sqrt(1.0 - sine * sine);
  return 0.5 * P * sine / (cosine * (1.0 + cosine));
}

double reach_limit(double D, double R, double h) {
  return D / (1.0 + h / R);
}

double largest_reachable_scallop(double D, double R) {
  const double r = 0.5 * D;
  return r * (r / (std::hypot(R, r) + R));
}

double cross_curvature(const Mat2& K, const Vec2& t) {
  const Vec2 c = left_of(t);
  return c.dot(K * c);
}

double strip_curvature(const Mat2& M, const Vec2& t) {
  const double along = t.dot(M * t);
  const double twist = t.dot(M * left_of(t));
  if (std::abs(along) <= kStraight * M.norm()) return cross_curvature(M, t);
  return cross_curvature(M, t) - twist * twist / along;
}

double conjugate_stretch(const Mat2& K, const Vec2& t) {
  const double along = t.dot(K * t);
  if (std::abs(along) <= kStraight * K.norm()) return 1.0;
  return std::hypot(1.0, t.dot(K * left_of(t)) / along);
}

double effective_radius(double r, double rc, const Lean& lean) {
  const double cosine = std::cos(lean.yaw);
  const double sine = std::sin(lean.yaw);
  return (rc + r / std::sin(lean.angle)) * cosine * cosine + rc * sine * sine;
}

double relative_curvature(const Mat2& K, const Vec2& t, const Lean& lean, double r) {
  if (lean.on_normal()) return strip_curvature(K, t);
  const double cosine = std::cos(lean.yaw);
  const Vec2 towards = cosine * t + std::sin(lean.yaw) * left_of(t);
  return cross_curvature(K, towards) / (cosine * cosine) + 1.0 / effective_radius(r, 0.0, lean);
}

double leaned_chord(double curvature, double h, const Lean& lean, double r) {
  const double rim_height = r * std::sin(lean.angle);
  const double reach = 2.0 * r * std::abs(std::cos(lean.yaw));
  if (h >= rim_height || curvature <= 0.0) return reach;
  return std::min(reach, std::sqrt(8.0 * h / curvature * (1.0 - 0.5 * h / rim_height)));
}

}  // namespace swarf::toolpath
