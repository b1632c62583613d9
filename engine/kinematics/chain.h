// The walk along the chain, with the sines and cosines of the rotary values given: what forward() and the
// proof of the inverse share.
#pragma once

#include <cmath>

#include "kinematics/machine_model.h"

namespace swarf::kinematics {

/// A squared length this close to 1 is a unit vector up to rounding.
inline constexpr double kUnitRounding = 1e-15;

/// The tool axis of most poses is unit already: then nothing waits for a root and three divisions.
inline Vec3 unit_axis(const Vec3& axis) {
  const double squared = axis.squaredNorm();
  if (std::abs(squared - 1.0) <= kUnitRounding) return axis;
  return axis / std::sqrt(squared);
}

/// Sine and cosine of every rotary value, by axis index; the entries of linear axes mean nothing.
struct Sines {
  double sine[kMaxAxes], cosine[kMaxAxes];
};

/// Of the rotary values in q.
inline Sines sines_of(const MachineModel& machine, const AxisValues& q) {
  Sines of;
  for (size_t i = 0; i < machine.axes.size(); ++i) {
    if (machine.axes[i].kind == AxisKind::kLinear) continue;
    of.sine[i] = std::sin(q[static_cast<long>(i)]);
    of.cosine[i] = std::cos(q[static_cast<long>(i)]);
  }
  return of;
}

/// How far the link of the axis moves per unit of its value, along or about the direction: +1 or -1.
/// ISO 841: positive values move the tool positively against the work, so table links move the other way.
inline double link_sense(const Axis& axis) {
  return (axis.side == Side::kTable) == axis.reversed ? 1.0 : -1.0;
}

/// `way` is +1 outwards with the link, -1 back.
inline LinkStep link_step(const MachineModel& machine, int axis, double way) {
  const Axis& of = machine.axes[static_cast<size_t>(axis)];
  return {of.kind == AxisKind::kRotary, axis,           way * link_sense(of),
          along(of.direction_M),        of.direction_M, of.origin_M};
}

/// Carries point and tool axis along with the link.
inline void carry(const LinkStep& step, const AxisValues& q, const Sines& of, Vec3& point, Vec3& tool_axis) {
  if (!step.rotary) {
    point += (step.sense * q[step.axis]) * step.direction;
    return;
  }
  const double sine = step.sense * of.sine[step.axis], cosine = of.cosine[step.axis];
  point = step.origin + rotate(step.along, step.direction, sine, cosine, point - step.origin);
  tool_axis = rotate(step.along, step.direction, sine, cosine, tool_axis);
}

/// Calls `visit` with the steps from the tool to where the work stands at zero axes: to the base with the
/// head links, then back against the table links.
template <class Visit>
void from_tool_to_work(const MachineModel& machine, const Visit& visit) {
  for (size_t n = machine.head_chain.size(); n-- > 0;) visit(link_step(machine, machine.head_chain[n], 1.0));
  for (const int i : machine.table_chain) visit(link_step(machine, i, -1.0));
}

/// The tool axis of forward() alone, bit for bit.
inline Vec3 forward_axis(const MachineModel& machine, const AxisValues& q) {
  const Sines of = sines_of(machine, q);
  Vec3 axis = machine.tool_axis_M;
  from_tool_to_work(machine, [&](const LinkStep& step) {
    if (step.rotary)
      axis = rotate(step.along, step.direction, step.sense * of.sine[step.axis], of.cosine[step.axis], axis);
  });
  return machine.X_MW.linear().transpose() * axis;
}

}  // namespace swarf::kinematics
