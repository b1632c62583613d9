// The block of So et al., Table 2, and random blocks near a pole.
#pragma once

#include <fmt/format.h>

#include <string>

#include "kinematics/joint_path.h"
#include "kinematics/singularity.h"
#include "unit/kinematics/test_machines.h"

namespace swarf::kinematics {

inline ToolPose so_p0() {
  return {{75.2110, -51.4295, 228.6808}, Vec3(0.0095944, 0.0159479, 0.9998268).normalized()};
}
inline ToolPose so_p1() {
  return {{74.5130, -50.5510, 228.6857}, Vec3(0.0175393, 0.0107682, 0.9997882).normalized()};
}

inline AxisValues axis_values(double x, double y, double z, double first_deg, double second_deg) {
  AxisValues q;
  q << rad_from_deg(first_deg), rad_from_deg(second_deg), x, y, z;  // the order of table_table_ac()
  return q;
}

/// Exact axis values: A up, C within a turn of 135 degrees, as Table 2 prints them.
inline BlockEnds so_block(const MachineModel& machine) {
  const InverseKinematics inverse(machine);
  BlockEnds ends{so_p0(), so_p1(), {}, {}};
  ends.q_from = inverse.solve_nearest(ends.from, axis_values(0, 0, 0, 1.0, 149.0)).q;
  ends.q_to = inverse.solve_nearest(ends.to, ends.q_from).q;
  return ends;
}

/// The NC data as printed, rounded to four digits; the line is between where they lead.
inline BlockEnds so_block_rounded(const MachineModel& machine) {
  BlockEnds ends;
  ends.q_from = axis_values(-90.9595, 7.3103, 227.6341, 1.0664, 148.9685);
  ends.q_to = axis_values(-82.0656, -34.8175, 228.3975, 1.1793, 121.5477);
  ends.from = forward(machine, ends.q_from);
  ends.to = forward(machine, ends.q_to);
  return ends;
}

/// A block whose axes move by up to `turn` rad on any machine with two rotary axes.
inline BlockEnds random_ends(Rng& rng, const MachineModel& machine, double turn, double way) {
  BlockEnds ends;
  for (size_t i = 0; i < machine.axes.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const bool rotary = machine.axes[i].kind == AxisKind::kRotary;
    ends.q_from[row] = rotary ? rng.uniform(-kPi, kPi) : rng.uniform(-100, 100);
    ends.q_to[row] = ends.q_from[row] + (rotary ? rng.uniform(-turn, turn) : rng.uniform(-way, way));
  }
  ends.from = forward(machine, ends.q_from);
  ends.to = forward(machine, ends.q_to);
  return ends;
}

inline MachineModel random_two_rotary_machine(Rng& rng) {
  const auto side = [&] { return rng.uniform() < 0.5 ? Side::kTable : Side::kHead; };
  const auto point = [&] { return Vec3(rng.direction() * rng.uniform(0, 150)); };
  Axis axes[5] = {make_axis("X", side(), Vec3::UnitX()), make_axis("Y", side(), Vec3::UnitY()),
                  make_axis("Z", side(), Vec3::UnitZ()),
                  make_axis("A", side(), rng.direction(), point(), rng.uniform() < 0.5),
                  make_axis("C", side(), rng.direction(), point(), rng.uniform() < 0.5)};
  for (int i = 4; i > 0; --i) std::swap(axes[i], axes[static_cast<int>(rng.uniform(0, i + 1))]);
  MachineModel machine = make_machine("random", {axes[0], axes[1], axes[2], axes[3], axes[4]});
  machine.tip_M = point();
  machine.X_MW.translation() = point();
  machine.X_MW.linear() = Eigen::AngleAxisd(rng.uniform(-kPi, kPi), rng.direction()).toRotationMatrix();
  return machine;
}

/// Ready to paste: the machine's axes in the order base to work, base to tool, and the axis values.
inline std::string text_of(const MachineModel& machine, const BlockEnds& ends) {
  std::string text;
  const auto vec = [](const Vec3& v) { return fmt::format("Vec3({}, {}, {})", v.x(), v.y(), v.z()); };
  const auto chain = [&](const std::vector<int>& indices) {
    for (const int i : indices) {
      const Axis& a = machine.axes[static_cast<size_t>(i)];
      text += fmt::format("\n  make_axis(\"{}\", Side::{}, {}, {}, {}),  // q {} -> {}", a.name,
                          a.side == Side::kTable ? "kTable" : "kHead", vec(a.direction_M), vec(a.origin_M),
                          a.reversed, ends.q_from[i], ends.q_to[i]);
    }
  };
  chain(machine.table_chain);
  chain(machine.head_chain);
  const Eigen::AngleAxisd turn(machine.X_MW.linear());
  text += fmt::format("\n  tip_M = {}; X_MW = translation {} then AngleAxisd({}, {})", vec(machine.tip_M),
                      vec(machine.X_MW.translation()), turn.angle(), vec(turn.axis()));
  return text;
}

}  // namespace swarf::kinematics
