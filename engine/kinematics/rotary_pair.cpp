#include "kinematics/rotary_pair.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/units.h"
#include "kinematics/lanes.h"

namespace swarf::kinematics {
namespace {

/// By how much a direction may lie outside the reach and still count as rounding, rad; the forward check has
/// the last word.
constexpr double kPairReachTolerance = 1e-12;

}  // namespace

RotaryPair::RotaryPair(const Vec3& e1, const Vec3& e2, const Vec3& v)
    : d_(e1.dot(e2)), s_(e1.cross(e2).norm()), c2_(e2.dot(v)) {
  const Vec3 k = e1.cross(e2) / s_;
  frame_ << e1.transpose(), k.cross(e1).transpose(), k.transpose();
  p_at_pole_[0] = (c2_ - d_) / s_;
  p_at_pole_[1] = (c2_ + d_) / s_;
  for (double& p : p_at_pole_) {
    if (std::abs(p) < kPoleTolerance) p = 0.0;
  }
  d_per_s_ = d_ / s_;
  per_s_ = 1.0 / s_;
  v_angle_ = std::atan2(-v.dot(k), v.dot(e2.cross(k)));
}

int RotaryPair::solve(const Vec3& w, TurnPair out[2]) const {
  const Vec3 in_frame = frame_ * w;
  const double c1 = in_frame[0], wn = in_frame[1], wk = in_frame[2];
  const double rho_squared = wn * wn + wk * wk;
  const double rho = std::sqrt(rho_squared);
  const bool upper = c1 >= 0.0;
  const double p_at_pole = p_at_pole_[upper ? 0 : 1];
  if (rho < kPoleTolerance) {
    if (p_at_pole != 0.0) return 0;
    // z = +-e1 has the components (+-s, 0) in the basis (m, -k).
    out[0] = {0.0, std::atan2(0.0, upper ? s_ : -s_) - v_angle_, true};
    return 1;
  }
  double p = p_at_pole;
  if (d_ != 0.0) {
    // c2 - d c1 without cancellation: 1 - |c1| = rho^2 / (1 + |c1|).
    const double from_pole = rho_squared / (1.0 + std::abs(c1));
    p += d_per_s_ * (upper ? from_pole : -from_pole);
  }
  if (!(std::abs(p) <= rho + kPairReachTolerance)) return 0;
  const double r = p == 0.0 ? rho : std::sqrt(std::max(0.0, (rho - p) * (rho + p)));
  const double across = (c1 - d_ * c2_) * per_s_;
  double angle[2];  // of w, the tilt
  lane_atan2<2>({wk, r}, {wn, across}, angle);
  double z_angle = 0.5 * kPi;
  if (p != 0.0) {
    double of_z[2];
    lane_atan2<2>({r, r}, {p, p}, of_z);
    z_angle = of_z[0];
  }
  out[0] = {angle[0] - z_angle, -angle[1] - v_angle_, false};
  out[1] = {angle[0] + z_angle, angle[1] - v_angle_, false};
  return r > 0.0 ? 2 : 1;
}

double RotaryPair::pole_distance(const Vec3& w) const {
  const Vec3 in_frame = frame_ * w;
  const double rho = std::hypot(in_frame[1], in_frame[2]);
  double distance = std::numeric_limits<double>::infinity();
  if (p_at_pole_[0] == 0.0) distance = std::atan2(rho, in_frame[0]);
  if (p_at_pole_[1] == 0.0) distance = std::min(distance, std::atan2(rho, -in_frame[0]));
  return distance;
}

}  // namespace swarf::kinematics
