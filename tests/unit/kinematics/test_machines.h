// Machines that the kinematics tests are run on, and the independent forward by 4x4 poses.
#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <ostream>
#include <string>

#include "base/rng.h"
#include "base/units.h"
#include "kinematics/machine_model.h"

namespace swarf::kinematics {

inline Axis make_axis(const std::string& name, Side side, const Vec3& direction,
                      const Vec3& origin = Vec3::Zero(), bool reversed = false) {
  Axis axis;
  axis.name = name;
  axis.kind = std::string("ABC").find(name) != std::string::npos ? AxisKind::kRotary : AxisKind::kLinear;
  axis.side = side;
  axis.direction_M = direction.normalized();
  axis.origin_M = origin;
  axis.reversed = reversed;
  axis.min = axis.kind == AxisKind::kLinear ? -5000.0 : -40.0 * kPi;
  axis.max = -axis.min;
  return axis;
}

/// Axes in the order base to work, then base to tool.
inline MachineModel make_machine(const std::string& name, std::initializer_list<Axis> axes) {
  MachineModel machine;
  machine.name = name;
  for (const Axis& axis : axes) {
    (axis.side == Side::kTable ? machine.table_chain : machine.head_chain)
        .push_back(static_cast<int>(machine.axes.size()));
    machine.axes.push_back(axis);
  }
  return machine;
}

/// Fig. 7 of Lin & Koren with R = (8,0,0), T = (0,96,120), OT = 0 (theory 1.5). Axis order X A B Y Z.
inline MachineModel lin_koren_machine() {
  MachineModel machine =
      make_machine("Lin & Koren Fig. 7",
                   {make_axis("X", Side::kTable, Vec3::UnitX()),
                    make_axis("A", Side::kTable, Vec3::UnitX(), Vec3::Zero(), true),
                    make_axis("B", Side::kTable, Vec3::UnitZ(), Vec3(0.0, 96.0, 120.0), true),
                    make_axis("Y", Side::kHead, Vec3::UnitY()), make_axis("Z", Side::kHead, Vec3::UnitZ())});
  machine.X_MW.translation() = Vec3(8.0, 96.0, 120.0);
  return machine;
}

/// So et al., Table 2: trunnion A on the bed, table C on it; t = (0, 49.93, -120).
inline MachineModel table_table_ac() {
  const Vec3 pivot(0.0, -49.93, 120.0);
  MachineModel machine =
      make_machine("table-table A/C",
                   {make_axis("A", Side::kTable, Vec3::UnitX(), pivot),
                    make_axis("C", Side::kTable, Vec3::UnitZ()), make_axis("X", Side::kHead, Vec3::UnitX()),
                    make_axis("Y", Side::kHead, Vec3::UnitY()), make_axis("Z", Side::kHead, Vec3::UnitZ())});
  return machine;
}

inline MachineModel table_head_ba() {
  MachineModel machine =
      make_machine("table A, head B",
                   {make_axis("X", Side::kTable, Vec3::UnitX()),
                    make_axis("A", Side::kTable, Vec3::UnitX(), Vec3(10.0, 20.0, -30.0)),
                    make_axis("Y", Side::kHead, Vec3::UnitY()), make_axis("Z", Side::kHead, Vec3::UnitZ()),
                    make_axis("B", Side::kHead, Vec3::UnitY(), Vec3(1.0, 0.0, 250.0))});
  machine.X_MW.translation() = Vec3(5.0, -40.0, 60.0);
  return machine;
}

inline MachineModel head_head_ca() {
  return make_machine("head-head C/A",
                      {make_axis("X", Side::kTable, Vec3::UnitX()),
                       make_axis("Y", Side::kHead, Vec3::UnitY()), make_axis("Z", Side::kHead, Vec3::UnitZ()),
                       make_axis("C", Side::kHead, Vec3::UnitZ(), Vec3(0.0, 0.0, 300.0)),
                       make_axis("A", Side::kHead, Vec3::UnitX(), Vec3(0.0, 30.0, 200.0))});
}

/// Table C turning positively, head B about an axis 45 degrees between Y and Z: reaches the upper half space.
inline MachineModel nutating_head() {
  MachineModel machine =
      make_machine("nutating 45 deg",
                   {make_axis("C", Side::kTable, Vec3::UnitZ(), Vec3(3.0, 4.0, 0.0), true),
                    make_axis("X", Side::kHead, Vec3::UnitX()), make_axis("Y", Side::kHead, Vec3::UnitY()),
                    make_axis("Z", Side::kHead, Vec3::UnitZ()),
                    make_axis("B", Side::kHead, Vec3(0.0, 1.0, 1.0), Vec3(0.0, 0.0, 180.0))});
  machine.X_MW.linear() = Eigen::AngleAxisd(0.3, Vec3(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
  return machine;
}

/// Forward kinematics by multiplying poses, straight from the definition of the chains.
inline ToolPose forward_by_poses(const MachineModel& machine, const AxisValues& q) {
  Pose table = Pose::Identity(), head = Pose::Identity();
  for (const int i : machine.table_chain) table = table * axis_motion(machine.axes[i], q[i]);
  for (const int i : machine.head_chain) head = head * axis_motion(machine.axes[i], q[i]);
  const Pose X_WM = (table * machine.X_MW).inverse() * head;
  return {X_WM * machine.tip_M, X_WM.linear() * machine.tool_axis_M};
}

/// Angle between two directions without the lost digits of acos.
inline double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Linear values within 300 mm of zero, rotary ones within half a turn.
inline AxisValues random_values(const MachineModel& machine, Rng& rng) {
  AxisValues q = AxisValues::Zero();
  for (size_t i = 0; i < machine.axes.size(); ++i) {
    q[i] = machine.axes[i].kind == AxisKind::kLinear ? rng.uniform(-300.0, 300.0) : rng.uniform(-kPi, kPi);
  }
  return q;
}

/// The largest errors met so far, mm and rad.
struct Errors {
  double tip = 0.0, axis = 0.0;
  void add(const ToolPose& back, const ToolPose& pose) {
    tip = std::max(tip, (back.tip_W - pose.tip_W).norm());
    axis = std::max(axis, angle_between(back.axis_W, pose.axis_W));
  }
};

}  // namespace swarf::kinematics

namespace swarf {

/// For failure messages: ready to paste.
inline std::ostream& operator<<(std::ostream& out, const ToolPose& pose) {
  out.precision(17);
  return out << "{{" << pose.tip_W.x() << ", " << pose.tip_W.y() << ", " << pose.tip_W.z() << "}, {"
             << pose.axis_W.x() << ", " << pose.axis_W.y() << ", " << pose.axis_W.z() << "}}";
}

}  // namespace swarf
