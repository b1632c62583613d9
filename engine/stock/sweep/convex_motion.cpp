#include "stock/sweep/convex_motion.h"

#include <algorithm>
#include <cmath>

namespace swarf::stock {
namespace {

/// Of three steps one halves the bracket: enough for 60 halvings, where doubles end.
constexpr int kMostSteps = 180;

struct Tangent {
  double t, value, slope;
  Vec3 normal;
};

Tangent tangent(const cutter::ConvexPiece& piece, const Vec3& P, const Vec3& D, double t) {
  const Vec3 X = P + t * D;
  const double rho = X.head<2>().norm();
  const cutter::Support support = cutter::support(piece, rho, X.z());
  // On the axis the sideways part of the gradient is free between all directions; none of them is their mean.
  const double sideways = rho > 0.0 ? support.normal.x() / rho : 0.0;
  const Vec3 normal(sideways * X.x(), sideways * X.y(), support.normal.y());
  return {t, support.value, normal.dot(D), normal};
}

Nearest exactly(const Tangent& at) {
  return {at.t, at.value, at.value, at.normal};
}

/// Across the axis: F grows with rho, so it is least where the point comes nearest to the axis. What is left
/// of the motion along the axis changes F by no more than its length.
Nearest nearest_across(const cutter::ConvexPiece& piece, const Vec3& P, const Vec3& D, double t_low,
                       double t_high) {
  const double length2 = D.head<2>().squaredNorm();
  const double t = length2 > 0.0 ? -P.head<2>().dot(D.head<2>()) / length2 : t_low;
  Nearest nearest = exactly(tangent(piece, P, D, std::clamp(t, t_low, t_high)));
  nearest.floor -= std::abs(D.z());
  return nearest;
}

struct Bracket {
  Tangent low, high;  ///< low.slope < 0 < high.slope
  double width() const { return high.t - low.t; }
  double slope_change() const { return high.slope - low.slope; }
  double crossing() const {
    return std::clamp((low.value - high.value + high.slope * width()) / slope_change(), 0.0, width());
  }
  double step_of(int kind) const {
    if (kind == 0) return crossing();
    return kind == 1 ? -low.slope / slope_change() * width() : 0.5 * width();
  }
  const Tangent& least() const { return low.value <= high.value ? low : high; }
};

}  // namespace

Nearest nearest_instant(const cutter::ConvexPiece& piece, const Vec3& P, const Vec3& D, double t_low,
                        double t_high, double gap_mm) {
  if (std::abs(D.z()) <= gap_mm) return nearest_across(piece, P, D, t_low, t_high);
  Bracket bracket{tangent(piece, P, D, t_low), {}};
  if (bracket.low.slope >= 0.0) return exactly(bracket.low);
  bracket.high = tangent(piece, P, D, t_high);
  if (bracket.high.slope <= 0.0) return exactly(bracket.high);
  double floor = bracket.low.value;
  for (int step = 0; step < kMostSteps; ++step) {
    floor = bracket.low.value + bracket.low.slope * bracket.crossing();
    if (bracket.least().value - floor <= gap_mm) break;
    const double t = bracket.low.t + bracket.step_of(step % 3);
    if (!(t > bracket.low.t && t < bracket.high.t)) {
      if (step % 3 == 2) break;  // no double lies between the ends
      continue;
    }
    const Tangent next = tangent(piece, P, D, t);
    if (next.slope == 0.0) return exactly(next);
    (next.slope < 0.0 ? bracket.low : bracket.high) = next;
  }
  const Tangent& least = bracket.least();
  const Vec3 normal = (bracket.high.slope * bracket.low.normal - bracket.low.slope * bracket.high.normal) /
                      bracket.slope_change();
  return {least.t, least.value, std::min(floor, least.value), normal};
}

}  // namespace swarf::stock
