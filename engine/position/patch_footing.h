// A place of a patch under a tool: the height at which it stops the tip, and steps uphill from there.
//
// In coordinates about the tool's line, f(u,v) = z - w(rho), rho the distance from the axis: the height of
// the tip that the place asks for. Where w is smooth, Newton on f. Where its slope jumps (the rim of a flat
// end, the tip of a drill) the greatest f may lie on the ring rho = r_k itself: Newton on z along the ring,
// while the multiplier lambda of rho = r_k lies between the two slopes of w there.
#pragma once

#include <limits>

#include "position/patch_cells.h"
#include "position/rest.h"
#include "position/tool_profile.h"

namespace swarf::position {

/// Points up to this far beyond the radius of the cutter count as under its rim: a wall that the flank
/// touches exactly holds the tool at its upper edge in spite of rounding. mm
inline constexpr double kRim_mm = 1e-9;

/// Of w, as Footing::slope gives it: at the equator of a ball and on a rim it has no bound.
inline constexpr double kSteepestSlope = 1e9;

/// Coordinates about the tool's line of a place and of its derivatives, mm.
struct Footing {
  int patch = -1;
  Vec2 uv = Vec2::Zero();
  surface::Derivatives d;     ///< in coordinates about the line
  double rho = 0.0;           ///< from the axis
  Vec2 out = Vec2::UnitX();   ///< unit, from the axis to the place; any on the axis itself
  double height = 0.0;        ///< f; -infinity beyond the rim
  Vec2 slope = Vec2::Zero();  ///< of w, as a vector: a subgradient of w(|x|) at the place
  int ring = -1;              ///< the piece of the profile whose outer end it stands on; -1: none
  bool tip = false;           ///< on the axis, where the cutter has a point

  bool under() const { return height > -std::numeric_limits<double>::infinity(); }
};

/// A rectangle of parameters.
struct UvBox {
  Vec2 low = Vec2::Zero(), high = Vec2::Ones();
  Vec2 nearest(const Vec2& uv) const { return uv.cwiseMax(low).cwiseMin(high); }
};

/// Tool, line and patches that footings are sought for; all borrowed.
struct Setting {
  const std::vector<Patch>& patches;
  const ToolProfile& profile;
  const GuideLine& line;
};

/// First and second derivative of w at rho, and w' / rho, inside one piece of the profile.
struct ProfileBend {
  double first = 0.0, second = 0.0, round = 0.0;
};
ProfileBend profile_bend(const ProfilePiece& piece, double rho);

/// The place (u,v) of a patch; `box`: what may be left only inwards, for the choice of `slope` among the
/// subgradients where w has several: that for which f falls off in the box, if there is one.
Footing footing_at(const Setting& setting, int patch, const UvBox& box, const Vec2& uv);

/// Uphill from uv inside the box to where f is greatest near by, at most 16 steps; `steps` counts them. What
/// it returns is a place like any other: that nothing is higher is for others to prove.
Footing settle(const Setting& setting, int patch, const UvBox& box, const Vec2& uv, int& steps);

/// From uv inside the box to where the patch comes nearest to the tool's axis near by, at most 8 steps.
Footing nearest_to_axis(const Setting& setting, int patch, const UvBox& box, const Vec2& uv, int& steps);

}  // namespace swarf::position
