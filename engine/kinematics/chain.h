// The walk along the chain, with the sines and cosines of the rotary values given: what forward() and the
// proof of the inverse share.
#pragma once

#include <cmath>

#include "kinematics/machine_model.h"
#include "kinematics/rotation.h"

namespace swarf::kinematics {

/// Sine and cosine of every rotary value, by axis index; the entries of linear axes mean nothing.
struct Sines {
  double sine[kMaxAxes], cosine[kMaxAxes];
};

/// How far the link of the axis moves per unit of its value, along or about the direction: +1 or -1.
/// ISO 841: positive values move the tool positively against the work, so table links move the other way.
inline double link_sense(const Axis& axis) {
  return (axis.side == Side::kTable) == axis.reversed ? 1.0 : -1.0;
}

/// Carries point and tool axis along with the link of axis `i`; `way` is +1 outwards, -1 back.
inline void carry(const Axis& axis, double way, double value, double sine, double cosine, Vec3& point,
                  Vec3& tool_axis) {
  const double sense = way * link_sense(axis);
  if (axis.kind == AxisKind::kLinear) {
    point += (sense * value) * axis.direction_M;
    return;
  }
  point = axis.origin_M + rotate(axis.direction_M, sense * sine, cosine, point - axis.origin_M);
  tool_axis = rotate(axis.direction_M, sense * sine, cosine, tool_axis);
}

/// Tool tip and axis in M as the work sees them: both vectors wander from the tool to the base with the head
/// links, then against the table links to where the work stands at zero axes.
inline void carry_tool_to_work(const MachineModel& machine, const AxisValues& q, const Sines& of, Vec3& point,
                               Vec3& tool_axis) {
  point = machine.tip_M;
  tool_axis = machine.tool_axis_M;
  for (size_t n = machine.head_chain.size(); n-- > 0;) {
    const int i = machine.head_chain[n];
    carry(machine.axes[i], 1.0, q[i], of.sine[i], of.cosine[i], point, tool_axis);
  }
  for (const int i : machine.table_chain) {
    carry(machine.axes[i], -1.0, q[i], of.sine[i], of.cosine[i], point, tool_axis);
  }
}

}  // namespace swarf::kinematics
