// The motion of one CL block between its two poses, and into how many sweeps it has to be cut.
//
// A sweep (stock/sweep/sweep_map.h) moves every point of the work linearly in the tool's frame. Let p(s) and
// a(s) be tip and axis of the block, s in [0,1], w = a x a' the angular velocity of the tool frame that does
// not spin about its axis, x a fixed point of the work and y = x - p. In that frame X = R'(x - p) and
//
//     X'' = R' ( 2 w x p' - p''  -  (a x a'') x y  +  w x (w x y) ).
//
// A straight interpolation of X over a step h errs by at most h^2/8 max|X''| (theory 2). For a point that the
// cutter holds at some instant of the step |y| <= lever + h V, V = max|p'|. The end of the sweep's frame is R
// turned by the smallest rotation, which differs from the non-spinning frame by a turn eta about the axis,
// the area on the sphere between a(s) and its great circle. With W = max|a'| and G = max|a x a''| the curve
// leaves the great circle by at most delta, sin(delta) = (h^2 G/8) / (1 - h^2 W^2/8), and
// eta <= h W tan(delta). So, for any step with h W <= 1,
//
//     error <= h^2/8 ( bend + (G + W^2)(lever + h V) ) + eta (lever + h V),   bend = max|2 w x p' - p''|.
//
// Great circles (tcp, ends) have eta = 0; tcp has G = 0 as well; a translation has error 0. An arc of radius
// r and angle phi adds |p''| = r phi^2: an eighth of it is the sagitta's leading term.
#pragma once

#include <functional>
#include <vector>

#include "kinematics/machine_model.h"
#include "toolpath/tool_path.h"

namespace swarf::motion {

/// One block with what its law needs. The machine must outlive it.
struct BlockMotion {
  toolpath::BlockMove block;
  const kinematics::MachineModel* machine = nullptr;
  /// Axis values at both ends; used by the joint and tcp_axes laws only.
  kinematics::AxisValues q_from = kinematics::AxisValues::Zero();
  kinematics::AxisValues q_to = kinematics::AxisValues::Zero();
};

/// Pose at s in [0,1]: exactly the block's poses at both ends.
ToolPose pose_at(const BlockMotion& motion, double s);

/// Upper bounds over the block, per unit of s: mm, rad.
struct MotionBounds {
  double bend = 0.0;               ///< of |2 w x p' - p''|
  double turn_acceleration = 0.0;  ///< G, of |a x a''|
  double turn_rate = 0.0;          ///< W, of |a'|
  double speed = 0.0;              ///< V, of |p'|
  bool great_circle = true;        ///< the axis stays in one plane
};
/// Closed form for tcp and ends, of the splines for curve (PoseCurve::bounds). Joint: derivatives of the
/// chain at nodes, plus half a node spacing times a bound of the next derivative, so that nothing between the
/// nodes escapes.
MotionBounds motion_bounds(const BlockMotion& motion);

/// The bound above for `pieces` equal steps; infinity while a step turns the axis by more than a radian.
double split_error(const MotionBounds& bounds, int pieces, double lever_mm);

/// The least number of equal pieces for which split_error() stays within the tolerance, or a few more. Throws
/// InputError "too-many-sweeps" at `where` when more than ten million would be needed.
int pieces_within(const BlockMotion& motion, double lever_mm, double tolerance_mm,
                  const std::function<SourceLocation()>& where);

/// Poses at equal steps of s, both ends included, so close that every sweep between neighbours stays within
/// the tolerance for the part of the tool within `lever_mm` of the tip (pieces_within()).
std::vector<ToolPose> subdivide(const BlockMotion& motion, double lever_mm, double tolerance_mm,
                                const SourceLocation& where = {});

}  // namespace swarf::motion
