// How one body moves as seen from another while the axes go straight from q0 to q1.
//
//   floor --E1--> . --E2--> link of b        pose(t) = (F2)^-1 (F1)^-1 E1 E2     b's home drawing -> a's
//        \--F1--> . --F2--> link of a        steps, in the order in which they are applied: E2 E1 F1 F2
//
// Every bound holds for all points of the moving body and all instants. With levers r_i (how far a point may
// come from rotary axis i, mm), speeds w_i = |q1_i - q0_i| per unit of t, and steps in order:
//   |p'|   <=  sum of speed_i  with  speed_i = w_i r_i (rotary) or w_i (linear)
//   p''    =   sum of a_i  over rotary i,  |a_i| <= w_i^2 r_i + 2 w_i (speed of the steps before i),  and
//   each
//              a_i is perpendicular to axis i
// so that p(t) strays from the straight line between p(t0) and p(t1) by no more than (t1 - t0)^2 / 8 times
// the sum of |a_i| sin(n, axis i) in the direction n: a table that turns under a parallel face does not come
// nearer to it, whatever its radius.
#pragma once

#include <vector>

#include "collision/body.h"
#include "kinematics/machine_model.h"

namespace swarf::collision {

using kinematics::AxisValues;

/// The axes go straight from q0 to q1; where `stray` is not 0 each may besides lie this far off (mm, rad).
struct AxisSegment {
  AxisValues q0 = AxisValues::Zero(), q1 = AxisValues::Zero();
  AxisValues stray = AxisValues::Zero();
  AxisValues at(double t) const { return (1.0 - t) * q0 + t * q1; }
};

/// One axis between two bodies.
struct RelativeStep {
  int axis = 0;       ///< index into MachineModel::axes
  bool back = false;  ///< the axis carries the body that is seen from
};

/// Axes between two links, in the order in which they move a point of link b as seen from link a. -1: floor.
std::vector<RelativeStep> steps_between(const machine::MachineScene& scene, int link_a, int link_b);

/// What one axis contributes, as seen from the other body.
struct StepBound {
  bool rotary = false;
  Vec3 axis = Vec3::UnitX();  ///< unit; its direction in the middle of the segment
  double wobble = 0.0;        ///< rad by which the steps behind it may turn that direction
  double acceleration = 0.0;  ///< mm per unit of t squared
  double stray = 0.0;         ///< mm by which AxisSegment::stray of this axis may displace a point
  /// Share of a displacement by this axis that may lie along the unit vector n.
  double share(const Vec3& n) const;
};

struct MotionBounds {
  double speed = 0.0;  ///< mm per unit of t
  std::vector<StepBound> steps;
  /// Least upper bounds of acceleration and stray in any direction, and of what lies along the unit vector n,
  /// the first times `square` (of a span of t, over 8).
  double slack(double square) const;
  double slack(const Vec3& n, double square) const;
};

class RelativeMotion {
 public:
  /// Scene must outlive it.
  RelativeMotion(const machine::MachineScene& scene, int link_a, int link_b)
      : scene_(&scene), steps_(steps_between(scene, link_a, link_b)) {}

  /// No axis lies between the two.
  bool rigid() const { return steps_.empty(); }
  const std::vector<RelativeStep>& steps() const { return steps_; }
  /// Home drawing of b into that of a at axis values q.
  Pose pose(const AxisValues& q) const;
  /// Of the points of a ball in b's home drawing.
  MotionBounds bounds(const AxisSegment& segment, const Vec3& centre, double radius) const;

 private:
  const machine::MachineScene* scene_;
  std::vector<RelativeStep> steps_;
};

/// Where a link's home drawing stands in M at axis values q; -1: the floor.
Pose link_pose(const machine::MachineScene& scene, int link, const AxisValues& q);

}  // namespace swarf::collision
