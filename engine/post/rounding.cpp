#include "post/rounding.h"

#include <algorithm>
#include <cmath>

#include "kinematics/joint_path.h"

namespace swarf::post {
namespace {

using kinematics::AxisKind;
using kinematics::AxisValues;

/// Half a digit of every axis.
AxisValues half_digits(const Follower& follower) {
  AxisValues half = AxisValues::Zero();
  for (size_t i = 0; i < follower.machine.axes.size(); ++i) {
    const bool rotary = follower.machine.axes[i].kind == AxisKind::kRotary;
    half[static_cast<long>(i)] = rotary ? follower.rules.rotary_half : follower.rules.linear_half;
  }
  return half;
}

}  // namespace

double rounding_rad(const Follower& follower) {
  double sum = 0.0;
  for (const kinematics::Axis& axis : follower.machine.axes)
    sum += axis.kind == AxisKind::kRotary ? follower.rules.rotary_half : 0.0;
  return sum;
}

double rounding_mm(const Follower& follower, bool tcp, const AxisValues& from, const AxisValues& to) {
  if (tcp) return std::sqrt(3.0) * follower.rules.linear_half;
  const AxisValues half = half_digits(follower);
  // The bound of the way of a path that changes every axis by a digit around the place, halved.
  const auto at = [&](const AxisValues& q) {
    return 0.5 * kinematics::JointPath(follower.machine, q - half, q + half).speed();
  };
  double bound = at(from);
  if (from != to) bound = std::max(bound, at(to));
  if (greatest_turn(follower.machine, from, to) > kTurned)
    bound += rounding_rad(follower) * kinematics::JointPath(follower.machine, from, to).speed();
  return bound;
}

}  // namespace swarf::post
