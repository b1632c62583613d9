#include "kinematics/round_trip.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/rng.h"
#include "base/units.h"

namespace swarf::kinematics {
namespace {

/// Nearer to the pole than this the outer rotary value is badly conditioned, and need not come back.
constexpr double kWellConditioned = 1e-3;
/// mm or rad: conditioning by 1/sin(kWellConditioned) of what rounding does to a direction, with room.
constexpr double kSameValue = 1e-6;

AxisValues random_values(const MachineModel& machine, Rng& rng) {
  AxisValues q = AxisValues::Zero();
  for (size_t i = 0; i < machine.axes.size(); ++i) {
    const Axis& axis = machine.axes[i];
    const double middle = 0.5 * (axis.min + axis.max);
    double half = 0.5 * (axis.max - axis.min);
    if (axis.kind == AxisKind::kRotary) half = std::min(half, 2.0 * kPi);
    q[static_cast<Eigen::Index>(i)] = rng.uniform(middle - half, middle + half);
  }
  return q;
}

}  // namespace

RoundTrip round_trip(const MachineModel& machine, int poses, uint64_t seed) {
  const InverseKinematics inverse(machine);
  Rng rng(seed);
  RoundTrip result;
  result.poses = poses;
  for (int i = 0; i < poses; ++i) {
    const AxisValues q = random_values(machine, rng);
    const ToolPose pose = forward(machine, q);
    const InverseSolutions solutions = inverse.solve(pose, q);
    if (solutions.count == 0) ++result.unsolved;
    double nearest = std::numeric_limits<double>::infinity();
    for (int k = 0; k < solutions.count; ++k) {
      const ToolPose back = forward(machine, solutions.branch[k].q);
      result.tip_mm = std::max(result.tip_mm, (back.tip_W - pose.tip_W).norm());
      result.axis_rad = std::max(result.axis_rad, (back.axis_W - pose.axis_W).norm());
      nearest = std::min(nearest, (solutions.branch[k].q - q).cwiseAbs().maxCoeff());
      ++result.branches;
    }
    if (nearest > kSameValue && inverse.pole_distance(pose.axis_W) > kWellConditioned) ++result.not_found;
  }
  return result;
}

}  // namespace swarf::kinematics
