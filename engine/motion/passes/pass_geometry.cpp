#include "motion/passes/pass_geometry.h"

#include <algorithm>
#include <cmath>

namespace swarf::motion {
namespace {

using toolpath::SurfacePass;

/// Between nodes away from the pole; small against the radii of surfaces that a cutter can follow.
constexpr double kNodeSpacing = 0.25;
/// A pass has at least so many cells, however short it is: it starts and stops in them.
constexpr double kCellsMin = 64.0;

}  // namespace

ToolPose contact_pose(const SurfacePass& pass, const toolpath::CurvePoint& at, double direction,
                      const toolpath::ContactEnd& end) {
  const Vec3 normal = outward_normal(*pass.surface, at.surface);
  if (pass.lead_rad == 0.0 && pass.tilt_rad == 0.0) return {at.C, normal};
  return toolpath::pose_in_contact(at.C, normal, direction * at.dC.normalized(), pass.lead_rad, pass.tilt_rad,
                                   end);
}

ToolPose contact_pose(const SurfacePass& pass, double t, const toolpath::ContactEnd& end) {
  const double direction = pass.t_end >= pass.t_start ? 1.0 : -1.0;
  return contact_pose(pass, curve_at(*pass.surface, pass.curve, t), direction, end);
}

double pass_length(const SurfacePass& pass, double from, double to) {
  // Gauss, five points: over a node spacing the error is below the last bit. Not base/quadrature.h: this is
  // asked once for each control cycle, and Boost's five weights, made at run time, are off by a last bit,
  // which would move every cycle of a pass.
  constexpr double kNode[3] = {0.0, 0.53846931010568309, 0.90617984593866399};
  constexpr double kWeight[3] = {0.56888888888888889, 0.47862867049936647, 0.23692688505618909};
  const double middle = 0.5 * (from + to);
  const double half = 0.5 * (to - from);
  const auto speed = [&](double x) {
    return curve_at(*pass.surface, pass.curve, middle + half * x).dC.norm();
  };
  double sum = kWeight[0] * speed(0.0);
  for (int i = 1; i < 3; ++i) sum += kWeight[i] * (speed(kNode[i]) + speed(-kNode[i]));
  return std::abs(half) * sum;
}

double path_curvature(const SurfacePass& pass, double t) {
  const toolpath::CurvePoint at = curve_at(*pass.surface, pass.curve, t);
  const double speed = at.dC.norm();
  return at.dC.cross(at.ddC).norm() / (speed * speed * speed);
}

double curve_parameter(const SurfacePass& pass, double u, double v) {
  return pass.curve.along_u ? u : v;
}

std::vector<PathNode> pass_nodes(const SurfacePass& pass, const toolpath::ContactEnd& end,
                                 const kinematics::MachineModel& machine,
                                 const kinematics::InverseKinematics& inverse,
                                 const kinematics::AxisValues& hint) {
  const PathShape shape{[&](double t) { return contact_pose(pass, t, end); },
                        [&](double from, double to) { return pass_length(pass, from, to); }};
  const kinematics::Branch start = inverse.solve_nearest(shape.pose(pass.t_start), hint);
  const bool reached = start.outcome != kinematics::InverseOutcome::kUnreachable;
  std::vector<PathNode> nodes{{pass.t_start, 0.0, reached ? start.q : hint, false, reached}};
  const double length = pass_length(pass, pass.t_start, pass.t_end);
  append_nodes(shape, inverse, machine, pass.t_end, std::min(kNodeSpacing, length / kCellsMin), nodes);
  return nodes;
}

}  // namespace swarf::motion
