// Speed control before interpolation (Kato et al., section 2.2, Fig. 4): each cycle looks at the clamp speeds
// within the way that it would take to stop, and speeds up, keeps its speed or slows down.
//
//   v ^   set speed . . . . . . . . .            clamps: no faster than `speed` within a cell, and than `at`
//     |      ____           ______               at the node between two cells
//     |     /    \_________/      |
//     |____/                       `--           A state is safe when it can land on every clamp ahead, at
//     +----------|----------|---------|-> s      the limits of acceleration and jerk, before it gets there.
//
// A cycle takes the fastest change that leaves a safe state; from a safe state there always is one, for
// landing on the lowest clamp in question is slower everywhere than landing on any other. Override, feed hold
// and clamps that are not reached therefore need no plan: what lies ahead is looked at anew in every cycle.
#pragma once

#include <cstddef>
#include <vector>

#include "motion/speed/speed_change.h"

namespace swarf::motion {

/// Clamp speeds along a path, mm and mm/s.
struct ClampSpeeds {
  std::vector<double> s;      ///< nodes, rising
  std::vector<double> speed;  ///< one per cell between two nodes
  std::vector<double> at;     ///< one per node: no faster there than this; 0: a stop
};

/// Where a cycle stands on the path.
struct ClampPlace {
  size_t cell = 0;          ///< that holds the place
  double to_node_mm = 0.0;  ///< up to the cell's end, along the path
};

/// What a cycle does.
struct SpeedTick {
  double way_mm = 0.0;
  SpeedState after;
  double fastest = 0.0;  ///< within the cycle
};

class SpeedControl {
 public:
  /// Both limits above zero and finite; mm/s^2, mm/s^3, s.
  SpeedControl(const RampLimits& limits, double period_s) : limits_(limits), period_s_(period_s) {}

  /// The next cycle from `now`, which the control has brought about itself (or a standing tool), with the set
  /// speed of this very cycle (override included; 0: feed hold).
  SpeedTick next(const SpeedState& now, double set_speed, const ClampSpeeds& clamps,
                 const ClampPlace& place) const;

 private:
  /// Whether every clamp is kept in the cycle and can be kept after it. `lowest`, when given, falls to the
  /// lowest of those that are not.
  bool is_safe(const SpeedTick& tick, const ClampSpeeds& clamps, const ClampPlace& place,
               double* lowest) const;
  SpeedTick along(const SpeedState& now, double target) const;
  SpeedTick constant_jerk(const SpeedState& now, double jerk) const;
  SpeedTick latest(const SpeedState& now, double set_speed, const SpeedTick& safe, const ClampSpeeds& clamps,
                   const ClampPlace& place) const;

  RampLimits limits_;
  double period_s_;
};

}  // namespace swarf::motion
