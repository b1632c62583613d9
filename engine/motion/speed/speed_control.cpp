#include "motion/speed/speed_control.h"

#include <algorithm>
#include <cmath>

namespace swarf::motion {
namespace {

/// Ways are compared with this much slack, mm: below what any axis resolves, above what adding up rounds.
constexpr double kSlack_mm = 1e-9;
/// Speeds are compared with this.
constexpr double kTickRounding = 1.0 + 1e-12;
/// Halvings of the range of jerk: what they leave, a millionth of it, is taken up in the next cycle.
constexpr int kJerkHalvings = 22;

/// The speed where the acceleration passes from above to below 0 under this jerk; 0 where it does not.
double crest(const SpeedState& from, const SpeedState& to, double jerk) {
  return from.acceleration > 0.0 && to.acceleration <= 0.0 ? settled_speed(from, jerk) : 0.0;
}

}  // namespace

SpeedTick SpeedControl::along(const SpeedState& now, double target) const {
  const SpeedChange change(now, target, limits_);
  const SpeedState after = change.at(period_s_);
  return {change.way(period_s_), after, std::max({now.speed, after.speed, crest(now, after, limits_.jerk)})};
}

SpeedTick SpeedControl::constant_jerk(const SpeedState& now, double jerk) const {
  const Phase phase{period_s_, now.speed, now.acceleration, jerk};
  const SpeedState after{now.speed + (now.acceleration + 0.5 * jerk * period_s_) * period_s_,
                         now.acceleration + jerk * period_s_};
  return {phase.way(period_s_), after, std::max({now.speed, after.speed, crest(now, after, -jerk)})};
}

bool SpeedControl::is_safe(const SpeedTick& tick, const ClampSpeeds& clamps, const ClampPlace& place,
                           double* lowest) const {
  const SpeedState& after = tick.after;
  const double settled = std::max(after.speed, settled_speed(after, limits_.jerk));
  // Landing softly on a low speed can take longer than coming to rest, but no more than this.
  const double reach =
      SpeedChange(after, 0.0, limits_).length() + settled * limits_.acceleration / limits_.jerk;
  // As fast as this at a way on: acceleration only falls from now on.
  const auto fastest = [&](double way) {
    const double rise = 2.0 * std::max(0.0, after.acceleration) * std::max(0.0, way);
    return std::min(settled, std::sqrt(after.speed * after.speed + rise));
  };
  const auto lands = [&](double speed, double way) {
    return landing_length(after, speed, limits_) <= std::max(0.0, way) + kSlack_mm;
  };
  bool safe = true;
  const auto require = [&](bool kept, double speed) {
    if (kept) return;
    safe = false;
    if (lowest != nullptr) *lowest = std::min(*lowest, speed);
  };
  // Ways from the end of the cycle to where the cell begins and ends; below 0: the cycle has passed there.
  double begin = 0.0, end = place.to_node_mm - tick.way_mm;
  for (size_t cell = place.cell; cell < clamps.speed.size() && (safe || lowest != nullptr); ++cell) {
    const double top = clamps.speed[cell], node = clamps.at[cell + 1];
    if (begin <= 0.0) require(tick.fastest <= top * kTickRounding, top);
    if (end > 0.0) require(fastest(end) <= top * kTickRounding || lands(top, begin), top);
    if (end < -kSlack_mm) {
      require(tick.fastest <= node * kTickRounding, node);
    } else {
      require(fastest(end) <= node * kTickRounding || lands(node, end), node);
    }
    if (end > reach) break;
    begin = end;
    end += cell + 2 < clamps.s.size() ? clamps.s[cell + 2] - clamps.s[cell + 1] : 0.0;
  }
  return safe;
}

/// Between the fastest change, which is not safe, and landing on the lowest of the clamps that it would miss:
/// the greatest constant jerk that is safe.
SpeedTick SpeedControl::latest(const SpeedState& now, double set_speed, const SpeedTick& landing,
                               const ClampSpeeds& clamps, const ClampPlace& place) const {
  const double T = period_s_, A = limits_.acceleration, J = limits_.jerk;
  double low = std::max(-J, (-A - now.acceleration) / T), high = std::min(J, (A - now.acceleration) / T);
  SpeedTick best = landing;
  bool found = false;
  for (int i = 0; i < kJerkHalvings && low < high; ++i) {
    const double jerk = 0.5 * (low + high);
    const SpeedTick tick = constant_jerk(now, jerk);
    const double settled = settled_speed(tick.after, J);
    if (settled < 0.0 || tick.after.speed < 0.0) {
      low = jerk;  // it would move backwards
    } else if ((tick.after.acceleration > 0.0 && settled > set_speed) ||
               !is_safe(tick, clamps, place, nullptr)) {
      high = jerk;
    } else {
      best = tick;
      found = true;
      low = jerk;
    }
  }
  return found && best.way_mm >= landing.way_mm ? best : landing;
}

SpeedTick SpeedControl::next(const SpeedState& now, double set_speed, const ClampSpeeds& clamps,
                             const ClampPlace& place) const {
  double lowest = std::min(set_speed, clamps.speed[place.cell]);
  SpeedTick tick = along(now, lowest);
  if (is_safe(tick, clamps, place, &lowest)) return tick;
  // Landing on the lowest clamp that would be missed may show that a lower one is near.
  for (double before = -1.0; before != lowest;) {
    before = lowest;
    tick = along(now, lowest);
    if (is_safe(tick, clamps, place, &lowest)) break;
  }
  return latest(now, set_speed, tick, clamps, place);
}

}  // namespace swarf::motion
