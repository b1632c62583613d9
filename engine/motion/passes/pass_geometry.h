// Geometry of a surface pass that the interpolators share.
#pragma once

#include <vector>

#include "motion/speed/speed_clamps.h"
#include "toolpath/tool_path.h"

namespace swarf::motion {

/// Pose in contact at a point of the pass' curve; `direction` is the sign of travel in t.
ToolPose contact_pose(const toolpath::SurfacePass& pass, const toolpath::CurvePoint& at, double direction,
                      const toolpath::ContactEnd& end);

/// The same from the curve parameter.
ToolPose contact_pose(const toolpath::SurfacePass& pass, double t, const toolpath::ContactEnd& end);

/// Arc length of the contact path between two parameters, mm, never negative.
double pass_length(const toolpath::SurfacePass& pass, double from, double to);

/// |C' x C''| / |C'|^3, 1/mm.
double path_curvature(const toolpath::SurfacePass& pass, double t);

/// Parameter of the pass' curve at a contact point: sample.u or sample.v.
double curve_parameter(const toolpath::SurfacePass& pass, double u, double v);

/// Nodes over the whole pass, in the direction of travel, for speed clamps.
std::vector<PathNode> pass_nodes(const toolpath::SurfacePass& pass, const toolpath::ContactEnd& end,
                                 const kinematics::MachineModel& machine,
                                 const kinematics::InverseKinematics& inverse,
                                 const kinematics::AxisValues& hint);

}  // namespace swarf::motion
