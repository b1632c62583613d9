#include "kinematics/joint_path.h"

#include <algorithm>
#include <cmath>

#include "kinematics/chain.h"

namespace swarf::kinematics {
namespace {

/// Nodes per radian that all rotary axes turn together: the part added for what lies between the nodes then
/// stays a small share.
constexpr double kNodesPerRadian = 48.0;

/// Calls f(axis, way) from the tool to the base, then from the base to the work.
template <typename F>
void each_link(const MachineModel& machine, const F& f) {
  for (size_t n = machine.head_chain.size(); n-- > 0;) f(machine.head_chain[n], 1.0);
  for (const int i : machine.table_chain) f(i, -1.0);
}

}  // namespace

JointPath::JointPath(const MachineModel& machine, const AxisValues& from, const AxisValues& to)
    : machine_(machine), q_(from), dq_(to - from) {
  for (size_t i = 0; i < machine_.axes.size(); ++i) {
    if (machine_.axes[i].kind == AxisKind::kRotary) turn_ += std::abs(dq_[static_cast<Eigen::Index>(i)]);
  }
  find_tip_bounds();
}

void JointPath::derivatives(double u, Jet& tip, Jet& axis) const {
  tip = {machine_.tip_M};
  axis = {machine_.tool_axis_M};
  each_link(machine_, [&](int i, double way) { carry(i, way, u, tip, axis); });
}

void JointPath::carry(int i, double way, double u, Jet& tip, Jet& axis) const {
  const Axis& link = machine_.axes[static_cast<size_t>(i)];
  const double sense = way * link_sense(link);
  const double value = sense * (q_[i] + u * dq_[i]);
  const Vec3 rate = (sense * dq_[i]) * link.direction_M;
  if (link.kind == AxisKind::kLinear) {
    tip.value += value * link.direction_M;
    tip.first += rate;
    return;
  }
  const double sine = std::sin(value), cosine = std::cos(value);
  const auto turn = [&](const Vec3& v) { return rotate(link.direction_M, sine, cosine, v); };
  const auto carried = [&](const Jet& x) {
    const Vec3 across = rate.cross(x.value);
    return Jet{turn(x.value), turn(x.first + across),
               turn(x.second + 2.0 * rate.cross(x.first) + rate.cross(across))};
  };
  tip.value -= link.origin_M;
  tip = carried(tip);
  tip.value += link.origin_M;
  axis = carried(axis);
}

/// Bounds by the triangle inequality, link by link; a point's distance from an axis is that at mid path plus
/// half its way.
void JointPath::find_tip_bounds() {
  Jet tip{machine_.tip_M}, axis{machine_.tool_axis_M};
  each_link(machine_, [&](int i, double way) {
    const Axis& link = machine_.axes[static_cast<size_t>(i)];
    const double rate = std::abs(dq_[i]);
    if (link.kind == AxisKind::kLinear) {
      speed_ += rate;
    } else {
      const double arm = link.direction_M.cross(tip.value - link.origin_M).norm() + 0.5 * speed_;
      jerk_ += 3.0 * rate * acceleration_ + 3.0 * rate * rate * speed_ + rate * rate * rate * arm;
      acceleration_ += 2.0 * rate * speed_ + rate * rate * arm;
      speed_ += rate * arm;
    }
    carry(i, way, 0.5, tip, axis);
  });
}

int node_cells(const JointPath& path) {
  return path.turn() > 0.0 ? 2 + static_cast<int>(std::ceil(kNodesPerRadian * path.turn())) : 1;
}

double tip_acceleration_bound(const JointPath& path) {
  if (path.turn() == 0.0) return 0.0;
  const int cells = node_cells(path);
  double greatest = 0.0;
  Jet tip, axis;
  for (int i = 0; i <= cells; ++i) {
    path.derivatives(static_cast<double>(i) / cells, tip, axis);
    greatest = std::max(greatest, tip.second.norm());
  }
  return std::min(path.acceleration(), greatest + 0.5 / cells * path.jerk());
}

}  // namespace swarf::kinematics
