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

/// The terms with the rim's bend are small corrections: each round gains a digit or more.
constexpr int kRounds = 12;

/// Where lean and hollow all but cancel, the twist would outweigh the rest; it is trusted up to this share of
/// h.
constexpr double kTwistShare = 0.5;

double side_sign(RimSides sides) {
  if (sides == RimSides::kBalanced) return 0.0;
  return sides == RimSides::kBothLeft ? 1.0 : -1.0;
}

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

LeanedCurvature leaned_curvature(const Mat2& K, const Vec2& t, const Lean& lean) {
  const Vec2 towards = std::cos(lean.yaw) * t + std::sin(lean.yaw) * left_of(t);
  return {cross_curvature(K, towards), left_of(towards).dot(K * towards)};
}

double leaned_chord(const LeanedCurvature& curvature, double h, const Lean& lean, double r, RimSides sides) {
  const double H = r * std::sin(lean.angle);
  const double q = 0.5 * r * r * curvature.across;
  const double side = side_sign(sides);
  double x = 0.0;
  double back = 0.0;
  for (int i = 0; i < kRounds; ++i) {
    // With z = sqrt(1 - y) the equation of the header is the quadratic q z^2 + H z = H + q - h - twist term.
    const double twist = std::clamp(side * curvature.twist * x * back, -kTwistShare * h, kTwistShare * h);
    const double rest = H + q - h - twist;
    const double z = rest > 0.0 ? 2.0 * rest / (H + std::sqrt(H * H + 4.0 * q * rest)) : 0.0;
    x = r * std::sqrt(std::max(0.0, 1.0 - z * z));
    back = r * (1.0 - std::min(z, 1.0)) * std::cos(lean.angle);
  }
  return 2.0 * (x * std::abs(std::cos(lean.yaw)) - side * back * std::sin(lean.yaw));
}

double leaned_scallop(const LeanedCurvature& curvature, double P, const Lean& lean, double r,
                      RimSides sides) {
  const double side = side_sign(sides);
  double x = 0.0;
  double back = 0.0;
  for (int i = 0; i < kRounds; ++i) {
    x = std::clamp((0.5 * P + side * back * std::sin(lean.yaw)) / std::abs(std::cos(lean.yaw)), 0.0, r);
    back = (r - std::sqrt(r * r - x * x)) * std::cos(lean.angle);
  }
  return back * std::tan(lean.angle) + 0.5 * curvature.across * x * x - side * curvature.twist * x * back;
}

double ball_chord(double k, double h, double r) {
  // Centre of the circle, of the ball and the cusp make a triangle with the sides R + r, r and R + h.
  const double q = h * (2.0 * r - h) / (2.0 * (1.0 + r * k) * (1.0 + h * k));
  return 2.0 * std::sqrt(q * (2.0 - q * k * k));
}

double ball_scallop(double k, double P, double r) {
  const double half = 0.5 * P;
  const double cosine = std::sqrt(1.0 - half * half * k * k);
  const double aside = half * (1.0 + r * k);
  return r * cosine - half * half * k / (1.0 + cosine) - std::sqrt(r * r - aside * aside);
}

double ball_reach(double k, double r) {
  return 2.0 * r / (1.0 + r * k);
}

double ball_curvature(const Mat2& K, const Vec2& t, double r) {
  return strip_curvature(K + Mat2::Identity() / r, t) - 1.0 / r;
}

}  // namespace swarf::toolpath
