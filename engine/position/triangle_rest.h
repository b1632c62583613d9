// A triangle under a tool, exactly: its facet and its three sides.
//
// The tip's height z - w(rho) is a concave function on the plane of a triangle. Where its greatest value on
// the whole plane lies inside, that is the answer: the plane's slope tan b says at which rho it is touched
// (ToolProfile::touching), uphill from the axis. Else the answer lies on a side that has that place beyond
// it: from any point of the triangle the function does not fall on the way there. On a facet that stands
// along the tool's axis, and on one without area, it lies on a side or a corner.
//
// Facets have two sides: a tool must not pass through one, whichever way it is turned. A closed mesh never
// holds a tool on a facet seen from below; an open one may.
#pragma once

#include <limits>

#include "base/frames.h"
#include "position/rest.h"
#include "position/tool_profile.h"

namespace swarf::position {

/// Corners in coordinates about the tool's line (GuideLine::local), mm.
struct LocalTriangle {
  Vec3 a, b, c;
  const Vec3& corner(int i) const { return i == 0 ? a : i == 1 ? b : c; }
};

struct TriangleRest {
  double height = -std::numeric_limits<double>::infinity();  ///< of the tip, mm
  Touched what = Touched::kNothing;
  int place = 0;  ///< kVertex: the corner 0 to 2; kEdge: the side that starts there
  Vec3 contact = Vec3::Zero();
};

/// Where the triangle stops the tool. Nothing where it is sure to lie not above `floor`, mm: what comes above
/// it does not depend on it. The height is z - w(rho) of a point of the triangle, so it is exact for a mesh
/// whose points are moved by some 1e-15 of their distance from the line: 1e-12 mm on a part of 1 m, times the
/// slope there in the height.
TriangleRest rest_on_triangle(const ToolProfile& profile, const LocalTriangle& triangle, double floor);

/// Of the height of a rest on the triangle, as the line moves along its x and y.
Vec2 triangle_gradient(const ToolProfile& profile, const LocalTriangle& triangle, const TriangleRest& rest);

}  // namespace swarf::position
