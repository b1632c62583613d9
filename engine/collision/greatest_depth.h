// How deep any place can lie in a body. Internal to this folder.
#pragma once

#include "collision/body.h"

namespace swarf::collision {

/// No place lies deeper in the body, mm. A place that lies r deep is the centre of a ball of radius r inside:
/// of a convex solid of revolution the greatest such ball has its centre on the axis, and is found exactly;
/// of a mesh it is at most half as wide as the mesh in any direction: along some of its facets' normals,
/// which is exact for plates, bars and boxes.
double greatest_depth(const Body& body);

}  // namespace swarf::collision
