// Changes of speed that start and end without acceleration, with bounded acceleration and jerk, in closed
// form.
//
//   a ^     ____            v0 -> v1 takes  2 sqrt(dv/J)    while dv = |v1 - v0| <= A^2/J,
//     |    /    \                           dv/A + A/J      beyond,
//     +---/------\---> t    and by symmetry goes its mean speed (v0 + v1)/2 times that.
#pragma once

#include <vector>

namespace swarf::motion {

/// Bounds along a path, mm/s^2 and mm/s^3, above zero; infinity where nothing limits.
struct RampLimits {
  double acceleration = 0.0;
  double jerk = 0.0;
};

/// Seconds from one speed to another.
double ramp_time(double from, double to, const RampLimits& limits);
/// Millimetres that the change takes.
double ramp_length(double from, double to, const RampLimits& limits);
/// Greatest speed that can be reached from `from` within `length`, not above `most`; never below `from`.
double reachable_speed(double from, double length, double most, const RampLimits& limits);

/// Motion with constant jerk.
struct Phase {
  double duration = 0.0;                               ///< s
  double speed = 0.0, acceleration = 0.0, jerk = 0.0;  ///< at its start
  double way(double t) const { return ((jerk / 6.0 * t + 0.5 * acceleration) * t + speed) * t; }
};

/// Appends what leads from v0 to v1 over `length` as fast as the limits and the top speed allow, at rest of
/// acceleration at both ends: up to a peak, along it, and down. Needs ramp_length(v0, v1) <= length.
/// Returns the peak.
double append_hop(double v0, double v1, double length, double top, const RampLimits& limits,
                  std::vector<Phase>& phases);

/// Greatest speed between two places of what append_hop has made, mm from its start: it rises to its peak and
/// falls.
double greatest_speed(const std::vector<Phase>& hop, double from, double to);

}  // namespace swarf::motion
