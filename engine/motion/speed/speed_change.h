// The way from one speed and acceleration to another speed without acceleration, as fast as acceleration and
// jerk allow: at most four phases of constant jerk, in closed form.
//
//   a ^                      braking from (v, a):  -J until -p, hold while p = A, +J until 0
//     |\                     p^2 = J (v - V) + a|a|.../2, see peak(); speeding up is the mirror image
//   0 +-\--------/--> t
//     |  \______/
#pragma once

#include <array>
#include <cmath>

#include "motion/speed/s_curve.h"

namespace swarf::motion {

/// How fast, and how that changes; mm/s and mm/s^2.
struct SpeedState {
  double speed = 0.0, acceleration = 0.0;
};

class SpeedChange {
 public:
  /// From a state whose acceleration is within the limits to `target` at no acceleration. Where the speed
  /// must pass the target before its acceleration is gone, it does, and comes back.
  SpeedChange(const SpeedState& from, double target, const RampLimits& limits);

  /// Seconds, and millimetres, until the target is held.
  double duration() const { return duration_; }
  double length() const { return length_; }
  /// t seconds later; beyond duration() the target is held.
  SpeedState at(double t) const;
  double way(double t) const;

 private:
  std::array<Phase, 4> phases_{};
  int count_ = 0;
  double target_, duration_ = 0.0, length_ = 0.0;

  void add(double duration, double jerk, SpeedState& state);
};

/// Way that a state which slows down needs until it holds `target`; where it rises first, with that. Of a
/// state that is slower before its acceleration is gone: until the target is passed.
double landing_length(const SpeedState& from, double target, const RampLimits& limits);

/// The speed that a state comes to when its acceleration is taken away at the limit of jerk.
inline double settled_speed(const SpeedState& state, double jerk) {
  return state.speed + 0.5 * state.acceleration * std::abs(state.acceleration) / jerk;
}

}  // namespace swarf::motion
