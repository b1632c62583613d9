// A vertex or a straight edge under a tool, exactly.
//
//      z ^    Q       A point of the edge at the place t from the foot of the axis, d beside the axis, holds
//      the
//        |   /        tip at f(t) = h + s t - w(sqrt(d^2 + t^2)). w is convex and never falls, so f is
//        concave: |  / o tool  it has one greatest value, on the side of t that rises, where s = w'(rho) t /
//        rho, in a | P          kink of w where that lies between its two slopes, or at an end of the edge.
//        +------> t
//
// For a line of slope k: t = s d / sqrt(k^2 - s^2). For an arc about the axis: t = s sqrt((r^2 - d^2)/(1 +
// s^2)). For an arc about c off the axis, with u = t / rho, the slope w' = s/u stands where rho - c = r s /
// sqrt(s^2 + u^2): a function of rho that rises and is concave, so Newton's steps from below stay below.
#pragma once

#include "base/frames.h"
#include "position/tool_profile.h"

namespace swarf::position {

/// Where the tip comes to rest on a point, mm; -infinity beyond the cutter's radius. `p`: coordinates about
/// the tool's line (GuideLine::local). A point at the radius itself, to the last bit, is touched.
double rest_on_point(const ToolProfile& profile, const Vec3& p);

struct EdgeRest {
  double height;  ///< of the tip, mm; -infinity: the edge is nowhere under the tool
  double part;    ///< of the way from p to q, where it touches: 0 and 1 are the ends themselves
};

/// Highest rest on the segment from p to q, in coordinates about the tool's line. Of a vertical one its upper
/// end, where p == q that point. The height is f at the place found, so it is never above the true one but
/// for the rounding of f; the place itself is exact to 1e-12 of the radius.
EdgeRest rest_on_edge(const ToolProfile& profile, const Vec3& p, const Vec3& q);

/// How the height that this contact gives changes as the line is moved: mm per mm. By the envelope theorem
/// w'(rho) towards the contact; where w has a kink, as on the rim of a flat end, with the slope between its
/// two that balances an edge, of direction `along`; zero for a vertex, which takes the inner slope. Steeper
/// than kSteepestGradient, at the equator of a ball and on a rim, it is given as that.
Vec2 gradient_at(const ToolProfile& profile, const Vec3& contact, const Vec3& along);
inline constexpr double kSteepestGradient = 1e12;

}  // namespace swarf::position
