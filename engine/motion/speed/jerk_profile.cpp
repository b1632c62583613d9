#include "motion/speed/jerk_profile.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"

namespace swarf::motion {
namespace {

/// Relative excess over a limit that counts as rounding.
constexpr double kRelative = 1e-9;
/// Where the average exceeds a limit, the window's speeds are lowered to this share of what would just do.
constexpr double kRelaxation = 0.98;
constexpr int kRelaxationsMax = 40;
/// Accelerations tried: full, then each 2^(-1/2) of the one before. The last window is 4096 times shorter.
constexpr int kAccelerationsTried = 25;

/// Squares of the speeds at the nodes, the fastest with |a| within each cell's limit.
std::vector<double> scan(const SpeedLimits& limits) {
  const size_t cells = limits.speed.size();
  std::vector<double> squared(cells + 1, 0.0);
  for (size_t i = 1; i < cells; ++i) {
    const double cap = std::min(limits.speed[i - 1], limits.speed[i]);
    squared[i] = std::min(
        cap * cap, squared[i - 1] + 2.0 * limits.acceleration[i - 1] * (limits.s[i] - limits.s[i - 1]));
  }
  for (size_t i = cells; i-- > 0;) {
    squared[i] =
        std::min(squared[i], squared[i + 1] + 2.0 * limits.acceleration[i] * (limits.s[i + 1] - limits.s[i]));
  }
  return squared;
}

double duration_of(const SpeedLimits& limits, const std::vector<double>& squared) {
  double time = 0.0;
  for (size_t i = 0; i + 1 < squared.size(); ++i)
    time += 2.0 * (limits.s[i + 1] - limits.s[i]) / (std::sqrt(squared[i]) + std::sqrt(squared[i + 1]));
  return time;
}

/// s at the ends of the ticks, from 0; each cell has constant acceleration.
std::vector<double> tick_positions(const SpeedLimits& limits, const std::vector<double>& squared,
                                   double period) {
  std::vector<double> positions{0.0};
  double before = 0.0;  // time at the start of the cell
  for (size_t i = 0; i + 1 < squared.size(); ++i) {
    const double width = limits.s[i + 1] - limits.s[i];
    const double v0 = std::sqrt(squared[i]);
    const double v1 = std::sqrt(squared[i + 1]);
    const double time = 2.0 * width / (v0 + v1);
    const double acceleration = (squared[i + 1] - squared[i]) / (2.0 * width);
    for (;;) {
      const double t = static_cast<double>(positions.size()) * period - before;
      if (t >= time) break;
      positions.push_back(limits.s[i] + (v0 + 0.5 * acceleration * t) * t);
    }
    before += time;
  }
  positions.push_back(limits.length());
  return positions;
}

/// Averages the last `window` positions of each tick.
Profile averaged(const std::vector<double>& unfiltered, int window) {
  const size_t ticks = unfiltered.size() - 1 + static_cast<size_t>(window) - 1;
  const double length = unfiltered.back();
  const auto at = [&](size_t k) { return k < unfiltered.size() ? unfiltered[k] : length; };
  Profile profile;
  profile.position_mm.reserve(ticks);
  profile.step_mm.reserve(ticks);
  double position = 0.0;
  for (size_t k = 1; k <= ticks; ++k) {
    const double first = k > static_cast<size_t>(window) ? unfiltered[k - static_cast<size_t>(window)] : 0.0;
    const double step = (at(k) - first) / window;
    position += step;
    profile.step_mm.push_back(step);
    profile.position_mm.push_back(position);
  }
  profile.position_mm.back() = length;
  return profile;
}

/// Least value over the cells that [from, to] touches; `cell` remembers where the search stands.
double least(const std::vector<double>& s, const std::vector<double>& values, double from, double to,
             size_t& cell) {
  while (cell + 1 < values.size() && s[cell + 1] <= from) ++cell;
  double result = values[cell];
  for (size_t i = cell + 1; i < values.size() && s[i] < to; ++i) result = std::min(result, values[i]);
  return result;
}

/// One attempt: the limits of v_a as they are lowered, and what follows from them.
class Attempt {
 public:
  Attempt(const SpeedLimits& limits, double acceleration, int window, double period)
      : limits_(limits), plan_{limits, window}, period_(period) {
    for (double& a : plan_.limits.acceleration) a = std::min(a, acceleration);
  }

  /// True when the averaged profile keeps all limits in the end.
  bool relax(double jerk_max) {
    for (int i = 0; i < kRelaxationsMax; ++i) {
      squared_ = scan(plan_.limits);
      unfiltered_ = tick_positions(plan_.limits, squared_, period_);
      profile_ = averaged(unfiltered_, plan_.window);
      if (i == 0 && !jerk_holds(jerk_max)) return false;
      if (lower_where_exceeded()) return jerk_holds(jerk_max);
    }
    return false;
  }

  const SpeedPlan& plan() const { return plan_; }

 private:
  double rounding() const {
    return 4.0 * std::numeric_limits<double>::epsilon() * limits_.length() / plan_.window;
  }

  bool jerk_holds(double jerk_max) const {
    const std::vector<double>& step = profile_.step_mm;
    const double bound = jerk_max * period_ * period_ * period_ * (1.0 + kRelative) + 4.0 * rounding();
    double before = 0.0, before2 = 0.0;
    for (size_t k = 0; k < step.size() + 2; ++k) {
      const double now = k < step.size() ? step[k] : 0.0;
      if (std::abs(now - 2.0 * before + before2) > bound) return false;
      before2 = before;
      before = now;
    }
    return true;
  }

  /// True when nothing had to be lowered.
  bool lower_where_exceeded() {
    bool holds = true;
    size_t speed_cell = 0, acceleration_cell = 0;
    const std::vector<double>& end = profile_.position_mm;
    const std::vector<double>& step = profile_.step_mm;
    for (size_t k = 0; k < step.size(); ++k) {
      const double start = k > 0 ? end[k - 1] : 0.0;
      const double speed = least(limits_.s, limits_.speed, start, end[k], speed_cell);
      if (step[k] > speed * period_ * (1.0 + kRelative) + rounding()) {
        lower_speed(k, speed);
        holds = false;
      }
      const double change = std::abs(step[k] - (k > 0 ? step[k - 1] : 0.0));
      const double earlier = k > 1 ? end[k - 2] : 0.0;
      const double most = least(limits_.s, limits_.acceleration, earlier, end[k], acceleration_cell);
      if (change > most * period_ * period_ * (1.0 + kRelative) + 2.0 * rounding()) {
        for_window(k, [&](size_t cell) {
          plan_.limits.acceleration[cell] = std::min(plan_.limits.acceleration[cell], most);
        });
        holds = false;
      }
    }
    return holds;
  }

  /// Scales what v_a has above the limit in tick k's window, so that the average comes down to the limit.
  void lower_speed(size_t k, double speed) {
    double above = 0.0, below = 0.0;
    for (size_t i = first_of(k); i <= k; ++i) {
      const double excess = (unfiltered(i + 1) - unfiltered(i)) / period_ - speed;
      (excess > 0.0 ? above : below) += std::abs(excess);
    }
    const double share = kRelaxation * std::min(1.0, below / above);
    for_window(k, [&](size_t cell) {
      const double now = std::sqrt(std::max(squared_[cell], squared_[cell + 1]));
      if (now <= speed) return;
      plan_.limits.speed[cell] = std::min(plan_.limits.speed[cell], speed + share * (now - speed));
    });
  }

  size_t first_of(size_t k) const {
    const auto window = static_cast<size_t>(plan_.window);
    return k + 1 > window ? k + 1 - window : 0;
  }
  double unfiltered(size_t i) const { return unfiltered_[std::min(i, unfiltered_.size() - 1)]; }

  /// Calls f for every cell that v_a touches during the window of tick k.
  template <typename F>
  void for_window(size_t k, const F& f) const {
    const double from = unfiltered(first_of(k));
    const double to = unfiltered(k + 1);
    const std::vector<double>& s = limits_.s;
    const auto begin = std::upper_bound(s.begin() + 1, s.end() - 1, from);
    for (auto cell = static_cast<size_t>(begin - s.begin()) - 1; cell + 1 < s.size() && s[cell] <= to; ++cell)
      f(cell);
  }

  const SpeedLimits& limits_;
  SpeedPlan plan_;
  double period_;
  std::vector<double> squared_, unfiltered_;
  Profile profile_;
};

/// An acceleration with its window, and how long its profile would take were nothing to be lowered.
struct Candidate {
  double acceleration = 0.0;
  int window = 1;
  double duration = 0.0;
};

std::vector<Candidate> candidates(const SpeedLimits& limits, double jerk_max, double period) {
  double acceleration = *std::max_element(limits.acceleration.begin(), limits.acceleration.end());
  std::vector<Candidate> list;
  for (int i = 0; i < kAccelerationsTried; ++i, acceleration *= std::sqrt(0.5)) {
    SpeedLimits lowered = limits;
    for (double& a : lowered.acceleration) a = std::min(a, acceleration);
    const double duration = duration_of(lowered, scan(lowered));
    for (const double swing : {1.0, 2.0}) {
      const double ticks = std::ceil(swing * acceleration / (jerk_max * period));
      list.push_back({acceleration, static_cast<int>(std::max(1.0, ticks)), duration + ticks * period});
    }
  }
  std::stable_sort(list.begin(), list.end(),
                   [](const Candidate& a, const Candidate& b) { return a.duration < b.duration; });
  return list;
}

}  // namespace

SpeedPlan plan_speed(const SpeedLimits& limits, double jerk_max, double period) {
  SWARF_CHECK(limits.speed.size() >= 2 && limits.acceleration.size() == limits.speed.size() &&
                  limits.s.size() == limits.speed.size() + 1,
              "a path needs two cells to start and stop in");
  const auto positive = [](double x) { return x > 0.0; };
  SWARF_CHECK(std::all_of(limits.speed.begin(), limits.speed.end(), positive) &&
                  std::all_of(limits.acceleration.begin(), limits.acceleration.end(), positive),
              "limits along a path are above zero");
  for (const Candidate& one : candidates(limits, jerk_max, period)) {
    Attempt attempt(limits, one.acceleration, one.window, period);
    if (attempt.relax(jerk_max)) return attempt.plan();
  }
  SWARF_CHECK(false, "no acceleration gives a profile that keeps the limits");
  return {};
}

Profile sample_plan(const SpeedPlan& plan, double length, double period) {
  SpeedLimits scaled = plan.limits;
  for (double& s : scaled.s) s *= length / plan.limits.length();
  scaled.s.back() = length;
  return averaged(tick_positions(scaled, scan(scaled), period), plan.window);
}

RestToRest::RestToRest(double length, double speed_max, double acceleration_max, double jerk_max)
    : length_(length), jerk_(jerk_max) {
  // A ramp to speed v takes 2 sqrt(v/J) while v <= A^2/J, else v/A + A/J; both ramps cover v times that.
  const double knee = acceleration_max * acceleration_max / jerk_max;
  double peak = std::cbrt(0.25 * length * length * jerk_max);
  if (peak > knee) {
    const double half = 0.5 * knee;
    peak = length * acceleration_max / (half + std::sqrt(half * half + length * acceleration_max));
  }
  speed_ = std::min(speed_max, peak);
  jerk_time_ = std::min(acceleration_max / jerk_max, std::sqrt(speed_ / jerk_max));
  hold_ = std::max(0.0, speed_ / (jerk_max * jerk_time_) - jerk_time_);
  cruise_ = std::max(0.0, length / speed_ - ramp());
}

double RestToRest::accelerated(double t) const {
  const double a = jerk_ * jerk_time_;
  if (t <= jerk_time_) return jerk_ * t * t * t / 6.0;
  if (t <= jerk_time_ + hold_) {
    const double x = t - jerk_time_;
    return a * jerk_time_ * jerk_time_ / 6.0 + (0.5 * a * jerk_time_ + 0.5 * a * x) * x;
  }
  const double left = ramp() - t;
  return speed_ * (0.5 * ramp() - left) + jerk_ * left * left * left / 6.0;
}

double RestToRest::position(double t) const {
  if (t <= ramp()) return accelerated(t);
  if (t >= duration() - ramp()) return length_ - accelerated(std::max(0.0, duration() - t));
  return 0.5 * speed_ * ramp() + speed_ * (t - ramp());
}

}  // namespace swarf::motion
