// Speed along a path, from rest to rest, under limits that vary along it and with bounded jerk.
//
//   limits ----- bidirectional scan -----> v_a(s): acceleration-limited, the fastest there is
//                                            |  sampled at the ticks: s_a[k]
//   v_f[k] <---- moving average of N ticks --+
//
// 1. |a| of an average is at most the greatest |a| in its window, and its jerk at most
//    (a - a')/(N T) for accelerations a, a' that stand N ticks apart: at most 2A/(N T), and A/(N T) where a
//    full braking never follows a full acceleration within the window. Both are exact for the differences of
//    the sampled speeds, not only for the continuous ones.
// 2. The average lags behind v_a, so where limits fall it may exceed them. Such places are found by checking
//    the averaged profile tick by tick, and v_a's own limits are lowered in the window that caused them until
//    none is left.
// 3. A shorter window needs a lower acceleration; of a row of accelerations the fastest profile is taken that
//    passes all checks.
// The distance is kept by the average, so the last tick ends on the end of the path.
#pragma once

#include <vector>

#include "motion/speed/speed_clamps.h"

namespace swarf::motion {

/// A profile that has passed its checks, still independent of the exact length.
struct SpeedPlan {
  SpeedLimits limits;  ///< of v_a
  int window = 1;      ///< N, ticks
};

/// Where each tick ends.
struct Profile {
  std::vector<double> position_mm;  ///< after each tick; the last one is the length of the path
  std::vector<double> step_mm;      ///< length of each tick
};

/// The fastest plan found whose sampled speed keeps `limits` and whose acceleration and jerk differences keep
/// them and `jerk_max`, to 1e-9 relative and rounding. Needs at least two cells and limits above zero.
SpeedPlan plan_speed(const SpeedLimits& limits, double jerk_max, double period_s);

/// The plan's ticks for a path of this length, which may differ a little from that of the limits: speeds and
/// accelerations stay, places scale.
Profile sample_plan(const SpeedPlan& plan, double length_mm, double period_s);

/// Rest to rest over a straight way with constant limits: the time-optimal seven-phase profile.
class RestToRest {
 public:
  /// All above zero; mm, mm/s, mm/s^2, mm/s^3.
  RestToRest(double length, double speed_max, double acceleration_max, double jerk_max);
  double duration() const { return 2.0 * ramp() + cruise_; }  ///< s
  double position(double t) const;                            ///< mm, t in [0, duration]

 private:
  double ramp() const { return 2.0 * jerk_time_ + hold_; }
  /// mm travelled t seconds into the acceleration.
  double accelerated(double t) const;

  double length_, jerk_, speed_;
  double jerk_time_, hold_, cruise_;  ///< s: of one jerk phase, of constant acceleration, of constant speed
};

}  // namespace swarf::motion
