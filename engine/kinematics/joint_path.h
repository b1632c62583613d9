// The tool between two sets of axis values while every axis moves linearly from the first to the second.
#pragma once

#include "kinematics/machine_model.h"

namespace swarf::kinematics {

/// A point of the path with its first and second derivative by the path's parameter u.
struct Jet {
  Vec3 value, first = Vec3::Zero(), second = Vec3::Zero();
};

/// q(u) = from + u (to - from), u in [0,1]. The machine must outlive the path.
///
/// Derivatives are carried along the chain link by link: for a link that turns by w = dq/du about its
/// direction, x = R y gives x' = R (y' + w x y), x'' = R (y'' + 2 w x y' + w x (w x y)).
class JointPath {
 public:
  JointPath(const MachineModel& machine, const AxisValues& from, const AxisValues& to);

  /// Tip (mm) and unit tool axis with their derivatives, as the work sees them, in M: the work's own frame
  /// adds a constant pose (MachineModel::X_MW) only.
  void derivatives(double u, Jet& tip, Jet& axis) const;

  /// Sum of the turns of all rotary axes, rad: bounds |a'|, its powers |a''| and |a'''|.
  double turn() const { return turn_; }
  /// Upper bounds over the path of |p'|, |p''| and |p'''|, mm.
  double speed() const { return speed_; }
  double acceleration() const { return acceleration_; }
  double jerk() const { return jerk_; }

 private:
  void carry(int i, double way, double u, Jet& tip, Jet& axis) const;
  void find_tip_bounds();

  const MachineModel& machine_;
  AxisValues q_, dq_;
  double turn_ = 0.0, speed_ = 0.0, acceleration_ = 0.0, jerk_ = 0.0;
};

/// Pieces of equal length whose ends are so dense that a bound from values there, plus half a piece times a
/// bound of the next derivative, stays near the true maximum.
int node_cells(const JointPath& path);

/// Upper bound of |p''|, mm: the greatest at the nodes plus what may lie between them. An eighth of it bounds
/// how far the tip leaves its chord (theory 2).
double tip_acceleration_bound(const JointPath& path);

}  // namespace swarf::kinematics
