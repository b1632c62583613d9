// A tool on its straight way from one pose to another: the tip on a line, the axis on a great circle.
#pragma once

#include "base/frames.h"

namespace swarf {

/// Axis on the great circle from a to b at share x of the way, 0 to 1; both are unit vectors. Opposite axes,
/// between which no great circle is the shortest, turn about the coordinate direction that is least along a.
Vec3 slerp(const Vec3& a, const Vec3& b, double x);

/// Pose at share x of the way, 0 to 1.
ToolPose pose_between(const ToolPose& from, const ToolPose& to, double x);

}  // namespace swarf
