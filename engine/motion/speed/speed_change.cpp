#include "motion/speed/speed_change.h"

#include <algorithm>
#include <cmath>

namespace swarf::motion {

void SpeedChange::add(double duration, double jerk, SpeedState& state) {
  if (!(duration > 0.0)) return;
  const Phase phase{duration, state.speed, state.acceleration, jerk};
  phases_[static_cast<size_t>(count_++)] = phase;
  length_ += phase.way(duration);
  duration_ += duration;
  state.speed += (state.acceleration + 0.5 * jerk * duration) * duration;
  state.acceleration += jerk * duration;
}

SpeedChange::SpeedChange(const SpeedState& from, double target, const RampLimits& limits) : target_(target) {
  const double A = limits.acceleration, J = limits.jerk;
  SpeedState state = from;
  // In units of the direction in which the speed must change once the acceleration is gone.
  const double sign = settled_speed(from, J) > target ? -1.0 : 1.0;
  const double a = sign * from.acceleration;
  const double change = sign * (target - from.speed);
  // J up to the peak p and down from it change the speed by p^2 / J - a^2 / (2 J).
  const double p = std::sqrt(std::max(0.0, J * change + 0.5 * a * a));
  const double peak = std::max(std::min(p, A), a);
  const double held = p > A ? (change - (A * A - 0.5 * a * a) / J) / A : 0.0;
  add((peak - a) / J, sign * J, state);
  add(held, 0.0, state);
  add(peak / J, -sign * J, state);
}

SpeedState SpeedChange::at(double t) const {
  for (int i = 0; i < count_; ++i) {
    const Phase& phase = phases_[static_cast<size_t>(i)];
    if (t < phase.duration)
      return {phase.speed + (phase.acceleration + 0.5 * phase.jerk * t) * t,
              phase.acceleration + phase.jerk * t};
    t -= phase.duration;
  }
  return {target_, 0.0};
}

double SpeedChange::way(double t) const {
  double way = 0.0;
  for (int i = 0; i < count_; ++i) {
    const Phase& phase = phases_[static_cast<size_t>(i)];
    if (t < phase.duration) return way + phase.way(t);
    way += phase.way(phase.duration);
    t -= phase.duration;
  }
  return way + target_ * t;
}

double landing_length(const SpeedState& from, double target, const RampLimits& limits) {
  if (from.acceleration >= 0.0 || settled_speed(from, limits.jerk) >= target)
    return SpeedChange(from, target, limits).length();
  // Slower than the target in any case: it is passed while the acceleration is taken away.
  const double drop = from.speed - target;
  if (drop <= 0.0) return 0.0;
  const double b = -from.acceleration;
  const double t = (b - std::sqrt(std::max(0.0, b * b - 2.0 * limits.jerk * drop))) / limits.jerk;
  return Phase{t, from.speed, from.acceleration, limits.jerk}.way(t);
}

}  // namespace swarf::motion
