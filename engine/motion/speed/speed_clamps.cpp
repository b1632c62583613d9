#include "motion/speed/speed_clamps.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace swarf::motion {
namespace {

using kinematics::AxisKind;
using kinematics::AxisValues;
using kinematics::Branch;
using kinematics::InverseOutcome;
using kinematics::MachineModel;

/// From node to node the tool axis turns by no more than this share of its distance from the pole, so that
/// the outer rotary turns by about as many radians.
constexpr double kPoleShare = 0.02;
/// No rotary turns by more than this from node to node, rad.
constexpr double kTurnMax = 0.05;
/// Nodes closer than this are not split further, mm: below, a turn takes place in no distance at all.
constexpr double kSpacingMin = 1e-6;
/// A rotary that turns by more than this between the closest nodes jumps, rad: it happens at the pole itself,
/// where the turn takes place in no distance. No feed is slow enough for it; the trajectory's check reports
/// it.
constexpr double kClampJump = 0.5;
/// Share of an axis' acceleration granted to the curvature of q(s); the rest is for changes of feed.
constexpr double kClampCurvatureShare = 0.5;
/// Share of an axis' limits that is planned with: the grid sees rates averaged over its cells.
constexpr double kAxisUse = 0.99;

/// Whether the step between two nodes is too coarse to take rates from.
bool is_coarse(const ToolPose& a, const ToolPose& b, const AxisValues& qa, const AxisValues& qb,
               const kinematics::InverseKinematics& inverse, const MachineModel& machine) {
  for (size_t i = 0; i < machine.axes.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (machine.axes[i].kind == AxisKind::kRotary && std::abs(qb[row] - qa[row]) > kTurnMax) return true;
  }
  const double turn = (b.axis_W - a.axis_W).norm();
  return turn > kPoleShare * inverse.pole_distance(b.axis_W) &&
         turn > kPoleShare * inverse.pole_distance(a.axis_W);
}

bool jumps(const AxisValues& qa, const AxisValues& qb, const MachineModel& machine) {
  for (size_t i = 0; i < machine.axes.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (machine.axes[i].kind == AxisKind::kRotary && std::abs(qb[row] - qa[row]) > kClampJump) return true;
  }
  return false;
}

/// q' of the cell between nodes i and i + 1.
AxisValues rate(const std::vector<PathNode>& nodes, size_t i) {
  if (!nodes[i].reached || !nodes[i + 1].reached) return AxisValues::Zero();
  return (nodes[i + 1].q - nodes[i].q) / (nodes[i + 1].s - nodes[i].s);
}

/// |q''| at node i; zero at the ends and at corners.
AxisValues bend(const std::vector<PathNode>& nodes, size_t i) {
  if (i == 0 || i + 1 == nodes.size() || nodes[i].corner) return AxisValues::Zero();
  if (!nodes[i - 1].reached || !nodes[i].reached || !nodes[i + 1].reached) return AxisValues::Zero();
  return (2.0 / (nodes[i + 1].s - nodes[i - 1].s) * (rate(nodes, i) - rate(nodes, i - 1))).cwiseAbs();
}

/// Greatest |q'| of a cell and of those beside it on the same smooth piece.
AxisValues rate_near(const std::vector<PathNode>& nodes, size_t cell) {
  AxisValues greatest = rate(nodes, cell).cwiseAbs();
  if (cell > 0 && !nodes[cell].corner) greatest = greatest.cwiseMax(rate(nodes, cell - 1).cwiseAbs());
  if (cell + 2 < nodes.size() && !nodes[cell + 1].corner)
    greatest = greatest.cwiseMax(rate(nodes, cell + 1).cwiseAbs());
  return greatest;
}

}  // namespace

double chord_speed_limit(double radius, double tolerance, double period) {
  if (tolerance >= 2.0 * radius) return std::numeric_limits<double>::infinity();
  return 2.0 / period * std::sqrt(tolerance * (2.0 * radius - tolerance));
}

void append_nodes(const PathShape& shape, const kinematics::InverseKinematics& inverse,
                  const MachineModel& machine, double x_end, double spacing, std::vector<PathNode>& nodes) {
  std::vector<double> pending{x_end};
  ToolPose from = shape.pose(nodes.back().x);
  while (!pending.empty()) {
    const PathNode& last = nodes.back();
    const double x = pending.back();
    const double step = shape.length(last.x, x);
    const double middle = 0.5 * (last.x + x);
    if (step > spacing) {
      pending.push_back(middle);
      continue;
    }
    const ToolPose pose = shape.pose(x);
    const Branch branch = shape.solve ? shape.solve(pose, last.q) : inverse.solve_nearest(pose, last.q);
    const bool reached = branch.outcome != InverseOutcome::kUnreachable;
    const AxisValues q = reached ? branch.q : last.q;
    if (step > kSpacingMin && last.reached && reached && is_coarse(from, pose, last.q, q, inverse, machine)) {
      pending.push_back(middle);
      continue;
    }
    pending.pop_back();
    const bool jump = last.reached && reached && jumps(last.q, q, machine);
    if (step > 0.0) nodes.push_back({x, last.s + step, q, false, reached && !jump});
    from = pose;
  }
}

bool append_even_nodes(std::span<const ToolPose> poses, const kinematics::InverseKinematics& inverse,
                       const MachineModel& machine, double step_mm, std::vector<PathNode>& nodes) {
  std::vector<Branch> found(poses.size() - 1);
  inverse.continued(poses.subspan(1), nodes.back().q, found);
  const AxisValues* before = &nodes.back().q;
  for (size_t i = 0; i < found.size(); ++i) {
    if (found[i].outcome == InverseOutcome::kUnreachable ||
        is_coarse(poses[i], poses[i + 1], *before, found[i].q, inverse, machine))
      return false;
    before = &found[i].q;
  }
  const double x = nodes.back().x, steps = static_cast<double>(found.size());
  for (size_t i = 0; i < found.size(); ++i)
    nodes.push_back(
        {x + (1.0 - x) * static_cast<double>(i + 1) / steps, nodes.back().s + step_mm, found[i].q});
  return true;
}

SpeedLimits uniform_limits(const std::vector<PathNode>& nodes, double speed, double acceleration) {
  SpeedLimits limits;
  for (const PathNode& node : nodes) limits.s.push_back(node.s - nodes.front().s);
  limits.speed.assign(nodes.size() - 1, speed);
  limits.acceleration.assign(nodes.size() - 1, acceleration);
  return limits;
}

void clamp_by_axes(const std::vector<PathNode>& nodes, const MachineModel& machine, SpeedLimits& limits) {
  for (size_t cell = 0; cell + 1 < nodes.size(); ++cell) {
    const AxisValues slope = rate_near(nodes, cell);
    const AxisValues curve = bend(nodes, cell).cwiseMax(bend(nodes, cell + 1));
    for (size_t i = 0; i < machine.axes.size(); ++i) {
      const kinematics::Axis& axis = machine.axes[i];
      const auto row = static_cast<Eigen::Index>(i);
      const double acceleration = kAxisUse * axis.acceleration_max;
      // Division by zero gives infinity: an axis at rest limits nothing.
      limits.speed[cell] = std::min({limits.speed[cell], kAxisUse * axis.speed_max / slope[row],
                                     std::sqrt(kClampCurvatureShare * acceleration / curve[row])});
      limits.acceleration[cell] =
          std::min(limits.acceleration[cell], (1.0 - kClampCurvatureShare) * acceleration / slope[row]);
    }
  }
}

double greatest_rate(const std::vector<PathNode>& nodes, int axis) {
  double greatest = 0.0;
  for (size_t cell = 0; cell + 1 < nodes.size(); ++cell)
    greatest = std::max(greatest, std::abs(rate(nodes, cell)[axis]));
  return greatest;
}

}  // namespace swarf::motion
