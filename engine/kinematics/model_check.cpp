#include "kinematics/model_check.h"

#include <fmt/format.h>

#include <cmath>

namespace swarf::kinematics {
namespace {

using Problems = std::vector<ModelProblem>;

void check_counts(const MachineModel& machine, Problems& problems) {
  int linear = 0, rotary = 0, last_rotary = -1, last_linear = -1;
  for (int i = 0; i < static_cast<int>(machine.axes.size()); ++i) {
    if (machine.axes[i].kind == AxisKind::kLinear) {
      ++linear;
      last_linear = i;
    } else {
      ++rotary;
      last_rotary = i;
    }
  }
  if (linear != 3) {
    problems.push_back({"wrong-axis-count", linear > 3 ? last_linear : -1,
                        fmt::format("the machine has {} linear axes", linear), "give it exactly three"});
  }
  if (rotary > 2) {
    problems.push_back({"wrong-axis-count", last_rotary,
                        fmt::format("the machine has {} rotary axes", rotary), "give it at most two"});
  }
}

void check_chains(const MachineModel& machine, Problems& problems) {
  std::vector<int> uses(machine.axes.size(), 0);
  for (const int i : machine.table_chain) ++uses.at(i);
  for (const int i : machine.head_chain) ++uses.at(i);
  for (int i = 0; i < static_cast<int>(machine.axes.size()); ++i) {
    if (uses[i] == 1) continue;
    problems.push_back(
        {"axis-not-in-chain", i,
         fmt::format("axis {} stands {} times between work and tool", machine.axes[i].name, uses[i]),
         "each axis must move exactly one link on the way from the work to the tool"});
  }
}

void check_directions(const MachineModel& machine, Problems& problems) {
  for (int i = 0; i < static_cast<int>(machine.axes.size()); ++i) {
    const double length = machine.axes[i].direction_M.norm();
    if (std::abs(length - 1.0) <= kUnitTolerance) continue;
    problems.push_back(
        {"direction-not-unit", i,
         fmt::format("the direction of axis {} has the length {:.9g}", machine.axes[i].name, length),
         "it must be a unit vector"});
  }
  const double length = machine.tool_axis_M.norm();
  if (std::abs(length - 1.0) > kUnitTolerance) {
    problems.push_back({"direction-not-unit", -1, fmt::format("the tool axis has the length {:.9g}", length),
                        "it must be a unit vector"});
  }
}

void check_linear(const MachineModel& machine, Problems& problems) {
  Mat3 directions;
  int count = 0, last = -1;
  for (int i = 0; i < static_cast<int>(machine.axes.size()); ++i) {
    if (machine.axes[i].kind != AxisKind::kLinear) continue;
    directions.col(count++) = machine.axes[i].direction_M;
    last = i;
  }
  const double volume = std::abs(directions.determinant());
  if (volume >= kParallelTolerance) return;
  problems.push_back({"linear-axes-dependent", last,
                      fmt::format("the three linear directions lie in one plane (volume {:.3g})", volume),
                      "give the linear axes three independent directions"});
}

void check_rotary(const MachineModel& machine, Problems& problems) {
  const std::vector<int> order = rotary_order(machine);
  if (order.empty()) return;
  const Axis& inner = machine.axes[order.back()];
  if (inner.direction_M.cross(machine.tool_axis_M).norm() < kParallelTolerance) {
    problems.push_back({"rotary-axis-spins-tool", order.back(),
                        fmt::format("axis {} lies along the tool and does not tilt it", inner.name),
                        "leave it out, or correct its direction or its place in the chain"});
  }
  if (order.size() < 2) return;
  const Axis& outer = machine.axes[order.front()];
  if (outer.direction_M.cross(inner.direction_M).norm() >= kParallelTolerance) return;
  problems.push_back({"rotary-axes-parallel", order.back(),
                      fmt::format("the rotary axes {} and {} are parallel", outer.name, inner.name),
                      "two rotary axes must have different directions"});
}

}  // namespace

std::vector<int> rotary_order(const MachineModel& machine) {
  std::vector<int> order;
  for (auto it = machine.table_chain.rbegin(); it != machine.table_chain.rend(); ++it) order.push_back(*it);
  order.insert(order.end(), machine.head_chain.begin(), machine.head_chain.end());
  std::erase_if(order, [&](int i) { return machine.axes[i].kind != AxisKind::kRotary; });
  return order;
}

std::vector<ModelProblem> check_model(const MachineModel& machine) {
  Problems problems;
  check_counts(machine, problems);
  check_chains(machine, problems);
  check_directions(machine, problems);
  if (!problems.empty()) return problems;  // the checks below rely on those above
  check_linear(machine, problems);
  check_rotary(machine, problems);
  return problems;
}

}  // namespace swarf::kinematics
