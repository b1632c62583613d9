// How far a surface strays from a flat facet, over all of it. Internal to this folder.
#pragma once

#include <array>

#include "surface/surface.h"

namespace swarf::brep {

/// From a point to a segment, mm.
double to_segment(const Vec3& p, const Vec3& a, const Vec3& b);

/// No place of the surface over the triangle x is farther from the facet than this. The distance from a
/// convex body is a convex function: over the hull of the triangle's corners it is greatest at one of them,
/// and the surface stays within its flatness of that hull. Divided until `enough` holds or nothing more is
/// won (at the pole of a sphere the parameters turn about one place).
double distance_bound(const surface::Surface& surface, const std::array<Vec2, 3>& x,
                      const std::array<Vec3, 3>& facet, double enough, int depth = 0);

}  // namespace swarf::brep
