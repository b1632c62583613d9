// How fast a tool whose axis lies along the rulings may go before a rotary axis is at its limit: C turns
// about Z, A tilts, O = (H - P) / |H - P| for guide curves P (v = 0) and H (v = 1).
//
//      C = atan2(Ox, -Oy)     dC/ds = |Rx R'y - Ry R'x| / ((Rx^2 + Ry^2) |P'|)      R = H - P
//      A = acos(Oz)           the feed of the tip at which the axis is at its limit: limit / |d axis / ds|
//
// s is the way of the tip along P. Near the pole, where Rx = Ry = 0, C limits the feed alone.
#pragma once

#include "surface/surface.h"

namespace swarf::flank {

/// Of one axis: rad/s, rad/s2.
struct RotaryLimit {
  double speed = 0.0, acceleration = 0.0;
};

/// Feed of the tip, mm/s; infinity where the axis stands.
struct RotaryFeed {
  double by_speed = 0.0;         ///< limit / |dC/ds|
  double by_acceleration = 0.0;  ///< sqrt(limit / |d2C/ds2|): at even feed
};

RotaryFeed c_limited_feed(const surface::Surface& surface, double u, const RotaryLimit& limit);
RotaryFeed a_limited_feed(const surface::Surface& surface, double u, const RotaryLimit& limit);

/// Where along the surface C limits the feed most, and to what (by_speed).
struct FeedLow {
  double mm_s = 0.0, u = 0.0;
};
FeedLow least_c_feed(const surface::Surface& surface, const RotaryLimit& limit);

}  // namespace swarf::flank
