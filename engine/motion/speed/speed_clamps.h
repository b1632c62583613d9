// How fast a path may be travelled: by its chord error, and by what it asks of each axis.
//
// With q(s) the axis values along the path and v, a the speed and acceleration along it (theory 1.3):
//   speed         v |q'|             <= qdot_max
//   acceleration  |q'' v^2 + q' a|   <= qddot_max, split:  |q''| v^2 <= beta qddot_max,
//                                                          |q'| a    <= (1 - beta) qddot_max
// q(s) is sampled on a grid that closes in on the pole, where q' grows without bound: the turn of the outer
// rotary from one node to the next stays a small share of a radian however near the pole is passed.
// Known limit: what passes within a few nanometres of the pole counts as passing through it.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "kinematics/machine_model.h"

namespace swarf::motion {

/// Upper bounds along a path, constant within each cell between two nodes.
struct SpeedLimits {
  std::vector<double> s;             ///< nodes, mm along the path, rising from 0
  std::vector<double> speed;         ///< one per cell, mm/s
  std::vector<double> acceleration;  ///< one per cell, mm/s^2

  double length() const { return s.back(); }
};

/// Axis values at one node of a path.
struct PathNode {
  double x = 0.0;  ///< parameter of the path
  double s = 0.0;  ///< mm along it
  kinematics::AxisValues q = kinematics::AxisValues::Zero();
  bool corner = false;  ///< the path's direction breaks here: no second derivative is taken across
  bool reached = true;  ///< false: out of reach (q repeats the node before) or after a jump; gives no rates
};

/// A path as the grid needs it; x rises or falls.
struct PathShape {
  std::function<ToolPose(double x)> pose;
  std::function<double(double from, double to)> length;  ///< mm, positive
  /// Axis values of a pose after others; none: InverseKinematics::solve_nearest().
  std::function<kinematics::Branch(const ToolPose&, const kinematics::AxisValues&)> solve = {};
};

/// Greatest feed whose chord over one period leaves a curve of this radius by no more than the tolerance:
/// (2/T) sqrt(2 R e - e^2), mm/s. Infinite when the whole circle is within the tolerance.
double chord_speed_limit(double radius_mm, double tolerance_mm, double period_s);

/// Appends nodes after the last of `nodes` (which must hold at least the start) up to x_end, no further apart
/// than `spacing_mm` and closer where an axis turns fast. Poses out of reach and jumps at the very pole
/// limit nothing: they are reported where they are commanded.
void append_nodes(const PathShape& shape, const kinematics::InverseKinematics& inverse,
                  const kinematics::MachineModel& machine, double x_end, double spacing_mm,
                  std::vector<PathNode>& nodes);

/// append_nodes() where even steps up to x = 1 are close enough, their inverse side by side; false, and no
/// node, where one is not or is out of reach. `poses`: that of the last node, and one for each step.
bool append_even_nodes(std::span<const ToolPose> poses, const kinematics::InverseKinematics& inverse,
                       const kinematics::MachineModel& machine, double step_mm, std::vector<PathNode>& nodes);

/// One cell per pair of nodes with the given speed and acceleration everywhere.
SpeedLimits uniform_limits(const std::vector<PathNode>& nodes, double speed, double acceleration);

/// Lowers the limits to what the axes can follow.
void clamp_by_axes(const std::vector<PathNode>& nodes, const kinematics::MachineModel& machine,
                   SpeedLimits& limits);

/// Greatest |q'| of one axis over all cells.
double greatest_rate(const std::vector<PathNode>& nodes, int axis);

}  // namespace swarf::motion
