// How often a closed surface winds around a point. Internal to this folder.
#pragma once

#include "collision/body.h"

namespace swarf::collision {

/// 0 outside, 1 inside, 2 where two shells overlap .. of the body's triangles, which are closed and turned
/// outward. A ray counts what it crosses outward less what it crosses inward, down the tree of boxes; where
/// it passes an edge or the point itself within rounding another ray is sent, and after three the solid
/// angles of all triangles are summed (van Oosterom & Strackee 1983), which is linear in them.
double winding_number(const Body& body, const Vec3& point);

}  // namespace swarf::collision
