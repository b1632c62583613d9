// The flank of a cutter as balls along its axis: what a flank can cut is what the balls inscribed in it cut.
//
//      | c |   a ball of radius rho(c), its centre c above the tip, touches the flank in one circle;
//      |( )|   a swept flank is the union of its swept balls, so its distance to a point is the least of
//      |___|   |x - A(c)| - rho(c), for cylinder, cone and barrel alike
#pragma once

#include <optional>

#include "base/frames.h"
#include "cutter/cutter.h"

namespace swarf::flank {

/// A straight flank, or one that is an arc (barrel). Heights above the tip, mm.
struct FlankProfile {
  double low = 0.0, high = 0.0;  ///< centres of the balls that touch its lower and its upper end
  double radius = 0.0;           ///< straight: of the flank, continued to the height of the tip
  double taper_rad = 0.0;        ///< straight: above 0 it widens upwards
  double arc_radius = 0.0;       ///< barrel: of the arc; 0: straight
  double arc_offset = 0.0;       ///< barrel: its centre lies this far beyond the axis
  double arc_height = 0.0;       ///< barrel: and this high
};

/// The longest line or outward arc of the outline that is no end of the cutter; none: it has no flank, or a
/// hollow one.
std::optional<FlankProfile> flank_profile(const cutter::Cutter& cutter);

/// Radius of the ball at c, mm; its derivative by c. Continued beyond low and high.
double ball_radius(const FlankProfile& profile, double c);
double ball_slope(const FlankProfile& profile, double c);

/// Distance of a point from the flank (below 0: inside), the point given by its height above the tip and its
/// distance from the axis; beyond the ends of the flank that from the last ball. mm.
double flank_distance(const FlankProfile& profile, double height, double from_axis);
/// Centre of the ball that is nearest there.
double nearest_ball(const FlankProfile& profile, double height, double from_axis);

}  // namespace swarf::flank
