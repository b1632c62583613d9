// Random programs of blocks for the tests of look-ahead, and what is asked of every trajectory.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/rng.h"
#include "unit/motion/dome.h"
#include "unit/motion/interpolated.h"

namespace swarf::motion {

/// Feed blocks of mixed laws, lengths and feeds, arcs, turns in place, tolerances, stops and rapids.
inline toolpath::ToolPath random_program(const kinematics::MachineModel& machine, Rng& rng, int blocks) {
  using toolpath::BlockLaw;
  toolpath::ToolPath path;
  path.planner = "cl";
  kinematics::AxisValues q = kinematics::AxisValues::Zero();
  q << rng.uniform(-50, 50), rng.uniform(-50, 50), rng.uniform(50, 150), rng.uniform(0.1, 0.8),
      rng.uniform(-1, 1);
  const double size = std::exp(rng.uniform(std::log(0.05), std::log(5.0)));  // mm, of this program's blocks
  const bool smooth = rng.uniform() < 0.4;
  kinematics::AxisValues way = kinematics::AxisValues::Zero();
  double feed = rng.uniform(10.0, 200.0);
  for (int i = 0; i < blocks; ++i) {
    const double length = size * std::exp(rng.uniform(-1.0, 1.0));
    const double turn = rng.uniform() < 0.5 ? 0.0 : rng.uniform(0.0, 0.03);  // rad per mm
    kinematics::AxisValues step = kinematics::AxisValues::Zero();
    const Vec3 direction = rng.direction();
    for (int k = 0; k < 3; ++k) step[k] = direction[k];
    for (int k = 3; k < 5; ++k) step[k] = turn * rng.uniform(-1.0, 1.0);
    way = smooth && i > 0 ? kinematics::AxisValues(way + 0.1 * step) : step;
    way /= way.head<3>().norm();
    kinematics::AxisValues next = q + length * way;
    if (rng.uniform() < 0.03) next.head<3>() = q.head<3>();  // turns in place, or does not move at all
    next[3] = std::clamp(next[3], 0.05, 1.2);
    toolpath::BlockMove block;
    const double law = rng.uniform();
    // A great circle follows the shorter way round the pole; more than that only the axes can say.
    const bool great_circle = std::abs(next[4] - q[4]) < 2.5;
    block.law = !great_circle ? (law < 0.5 ? BlockLaw::kTcpAxes : BlockLaw::kJoint)
                : law < 0.4   ? BlockLaw::kTcp
                : law < 0.6   ? BlockLaw::kTcpAxes
                : law < 0.9   ? BlockLaw::kJoint
                              : BlockLaw::kEnds;
    block.axes = toolpath::AxisSpan{q, next};
    block.from =
        i > 0 ? std::get<toolpath::BlockMove>(path.elements.back().what).to : kinematics::forward(machine, q);
    block.to = kinematics::forward(machine, next);
    if (rng.uniform() < 0.2) feed = rng.uniform(10.0, 200.0);
    block.feed_mm_s = rng.uniform() < 0.02 ? 0.0 : feed;
    if (rng.uniform() < 0.02) block.duration_s = rng.uniform(0.05, 0.5);
    block.exact_stop = rng.uniform() < 0.02;
    if (rng.uniform() < 0.01) block.dwell_s = 0.05;
    if (rng.uniform() < 0.3) block.corner_tolerance_mm = std::exp(rng.uniform(std::log(1e-4), std::log(1.0)));
    const Vec3 chord = block.to.tip_W - block.from.tip_W;
    if (block.law == BlockLaw::kTcp && rng.uniform() < 0.2 && chord.norm() > 1e-3) {
      const Vec3 normal = chord.unitOrthogonal();
      const double offset = rng.uniform(0.3, 3.0) * chord.norm();
      block.arc =
          program::Arc{block.from.tip_W + 0.5 * chord + offset * normal.cross(chord).normalized(), normal};
    }
    path.elements.push_back({block, 0, {"random.cl", i + 1, 1}});
    q = next;
  }
  return path;
}

/// Greatest excess of any axis' speed, acceleration or jerk over its limit, relative, from differences of the
/// sampled axis values alone; rounding of the values themselves is taken off.
struct Excess {
  double relative = -1.0;
  std::string text;
};
inline Excess axis_excess(const Trajectory& trajectory, const kinematics::MachineModel& machine) {
  Excess worst;
  const double T = trajectory.period_s;
  const auto& q = trajectory.axes;
  const auto at = [&](long k, Eigen::Index i) {
    return q[static_cast<size_t>(std::clamp(k, 0L, static_cast<long>(q.size()) - 1))][i];
  };
  for (size_t i = 0; i < machine.axes.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const kinematics::Axis& axis = machine.axes[i];
    for (long k = 0; k < static_cast<long>(q.size()) + 3; ++k) {
      const double q0 = at(k, row), q1 = at(k - 1, row), q2 = at(k - 2, row), q3 = at(k - 3, row);
      // Half a unit in the last place for each value, and as much for sine and cosine behind it.
      const double rounding = 4.0 * 2.2e-16 * (std::abs(q0) + 200.0);
      const double values[3] = {
          (std::abs(q0 - q1) - rounding) / (T * axis.speed_max),
          (std::abs(q0 - 2 * q1 + q2) - 2 * rounding) / (T * T * axis.acceleration_max),
          (std::abs(q0 - 3 * q1 + 3 * q2 - q3) - 4 * rounding) / (T * T * T * axis.jerk_max)};
      for (int n = 0; n < 3; ++n) {
        if (values[n] - 1.0 <= worst.relative) continue;
        const int element =
            trajectory.samples[static_cast<size_t>(std::min<long>(k, static_cast<long>(q.size()) - 1))]
                .element;
        worst = {values[n] - 1.0,
                 fmt::format("axis {}, derivative {}, sample {}, element {}", axis.name, n + 1, k, element)};
      }
    }
  }
  return worst;
}

}  // namespace swarf::motion
