#include "motion/speed/s_curve.h"

#include <algorithm>
#include <cmath>

namespace swarf::motion {
namespace {

/// Steps that an interval of speeds is narrowed by, to the last bits.
constexpr int kNarrowings = 120;

/// Greatest x in [low, high] whose excess, which rises, is not above 0; that of low must not be. Secants,
/// each third step a half; the end that stays counts half (the Illinois rule).
template <typename Excess>
double greatest(double low, double high, const Excess& excess) {
  double above = excess(high);
  if (above <= 0.0) return high;
  double below = excess(low);
  bool rose_before = false;
  for (int i = 1; i < kNarrowings; ++i) {
    if (high - low <= 2e-16 * high) break;
    double x = low + below / (below - above) * (high - low);
    if (i % 3 == 0 || !(x > low && x < high)) x = 0.5 * (low + high);
    if (!(x > low && x < high)) break;
    const double at = excess(x);
    const bool rose = at <= 0.0;
    (rose ? low : high) = x;
    (rose ? below : above) = at;
    if (i > 1 && rose == rose_before) (rose ? above : below) *= 0.5;
    rose_before = rose;
  }
  return low;
}

/// The three phases of a change of speed.
void append_ramp(double from, double to, const RampLimits& limits, std::vector<Phase>& phases) {
  const double change = std::abs(to - from);
  if (change == 0.0) return;
  const double sign = to > from ? 1.0 : -1.0;
  const double rise = std::min(limits.acceleration / limits.jerk, std::sqrt(change / limits.jerk));
  const double hold = std::max(0.0, change / (limits.jerk * rise) - rise);
  const double a = sign * limits.jerk * rise, j = sign * limits.jerk;
  const double knee = 0.5 * j * rise * rise;
  phases.push_back({rise, from, 0.0, j});
  if (hold > 0.0) phases.push_back({hold, from + knee, a, 0.0});
  phases.push_back({rise, to - knee, a, -j});
}

/// Speed of the phase `way` after its start, held at its ends.
double speed_at(const Phase& phase, double way) {
  double low = 0.0, high = phase.duration;
  if (way >= phase.way(high)) low = high;
  if (way <= 0.0) high = 0.0;
  for (int i = 0; i < 50 && high > low; ++i) {
    const double middle = 0.5 * (low + high);
    (phase.way(middle) <= way ? low : high) = middle;
  }
  return phase.speed + (phase.acceleration + 0.5 * phase.jerk * low) * low;
}

}  // namespace

double ramp_time(double from, double to, const RampLimits& limits) {
  const double change = std::abs(to - from);
  if (change == 0.0) return 0.0;
  const double rise = limits.acceleration / limits.jerk;
  if (change <= limits.acceleration * rise) return 2.0 * std::sqrt(change / limits.jerk);
  return change / limits.acceleration + rise;
}

double ramp_length(double from, double to, const RampLimits& limits) {
  return 0.5 * (from + to) * ramp_time(from, to, limits);
}

double reachable_speed(double from, double length, double most, const RampLimits& limits) {
  if (most <= from) return from;
  return greatest(from, most, [&](double v) { return ramp_length(from, v, limits) - length; });
}

double append_hop(double v0, double v1, double length, double top, const RampLimits& limits,
                  std::vector<Phase>& phases) {
  const auto both = [&](double peak) {
    return ramp_length(v0, peak, limits) + ramp_length(peak, v1, limits);
  };
  const double least = std::max(v0, v1);
  const double peak = top > least ? greatest(least, top, [&](double v) { return both(v) - length; }) : least;
  const double cruise = length - both(peak);
  append_ramp(v0, peak, limits, phases);
  if (cruise > 0.0 && peak > 0.0) phases.push_back({cruise / peak, peak, 0.0, 0.0});
  append_ramp(peak, v1, limits, phases);
  return peak;
}

double greatest_speed(const std::vector<Phase>& hop, double from, double to) {
  double s = 0.0, result = 0.0;
  for (const Phase& phase : hop) {
    const double end = s + phase.way(phase.duration);
    if (end >= from && s <= to) {
      result = std::max({result, speed_at(phase, from - s), speed_at(phase, to - s)});
      if (phase.acceleration == 0.0 && phase.jerk == 0.0) result = std::max(result, phase.speed);
    }
    s = end;
  }
  return result;
}

}  // namespace swarf::motion
