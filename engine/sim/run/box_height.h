// How far up a box reaches along a tool.
#pragma once

#include <optional>

#include "base/frames.h"

namespace swarf::sim {

/// The highest point of the box, above the tip along the axis, within `radius_mm` of the axis; none: the
/// cylinder passes the box by. Exact: it lies at a corner, where an edge enters the cylinder, or on a face.
std::optional<double> height_in_cylinder(const Box& box, const ToolPose& pose, double radius_mm);

/// The highest point of the whole box, above the tip along the axis: no cylinder finds a higher one.
double height_of_box(const Box& box, const ToolPose& pose);

}  // namespace swarf::sim
