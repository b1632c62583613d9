// What no law along a planned run's path can beat, and the best law over all: two solutions beside the direct
// transcription (time_optimum.h), neither of which searches from a first law.
//
// 1. Without jerk the problem is convex, and its optimum is found in one pass back and one forth over a grid
//    (time-optimal path parameterization by reachability: Pham and Pham, 2018): with b = v^2 all limits are
//    linear in b and b'. Every law that keeps jerk as well is one of those compared: a lower bound of time,
//    up to the grid.
// 2. With jerk: dynamic programming over (v, a) at the places of a grid, from the end back (Bellman). The
//    states of each place are those that its limits allow, w in [0,1] of the greatest speed and alpha in
//    [-1,1] of what acceleration is left; between them the time to go is interpolated. All laws are compared,
//    up to the grid: it costs some 10 ms, 1 to 6 % of what is compared here.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "unit/motion/path_place.h"

namespace swarf::motion {

/// Limits at one place of the path: |p b + q b'| <= bound for each row, b <= most; and for jerk
/// |third v^3 + 3 second v a + first j| <= jerk.
struct PlaceLimits {
  struct Row {
    double first, second, third;  ///< derivatives of an axis, or 1, 0, 0 for the tip
    double acceleration, jerk;
  };
  double s = 0.0;
  std::vector<Row> rows;
  double speed = 0.0;
  /// Accelerations along the path that keep all rows at speed v; empty when low > high.
  std::array<double, 2> accelerations(double v) const {
    double low = -kUnbounded, high = kUnbounded;
    for (const Row& row : rows) {
      const double bend = row.second * v * v;
      if (std::abs(row.first) < 1e-12) {
        if (std::abs(bend) > row.acceleration) return {1.0, -1.0};
        continue;
      }
      const double a = (-row.acceleration - bend) / row.first, b = (row.acceleration - bend) / row.first;
      low = std::max(low, std::min(a, b));
      high = std::min(high, std::max(a, b));
    }
    return {low, high};
  }
  std::array<double, 2> jerks(double v, double acceleration) const {
    double low = -kUnbounded, high = kUnbounded;
    for (const Row& row : rows) {
      const double rest = (row.third * v * v + 3.0 * row.second * acceleration) * v;
      if (std::abs(row.first) < 1e-12) continue;
      const double a = (-row.jerk - rest) / row.first, b = (row.jerk - rest) / row.first;
      low = std::max(low, std::min(a, b));
      high = std::min(high, std::max(a, b));
    }
    return {low, high};
  }
  static constexpr double kUnbounded = 1e12;
};

/// When a phase has come so far, s; not a number where it turns back before.
inline double time_over(const Phase& phase, double way) {
  const auto speed = [&](double t) { return phase.speed + (phase.acceleration + 0.5 * phase.jerk * t) * t; };
  double low = 0.0, high = way / std::max(phase.speed, 1e-3);
  for (int i = 0; i < 60 && phase.way(high) < way; ++i) high *= 2.0;
  double t = std::min(high, std::cbrt(6.0 * way / std::max(std::abs(phase.jerk), 1e-6)));
  for (int i = 0; i < 60; ++i) {
    const double excess = phase.way(t) - way;
    (excess < 0.0 ? low : high) = t;
    const double newton = t - excess / speed(t);
    const double taken = newton > low && newton < high ? newton : 0.5 * (low + high);
    if (std::abs(taken - t) < 1e-10 * t) break;
    t = taken;
  }
  // It never goes backwards: the least speed is at the ends or where the acceleration is gone.
  const double turn = phase.jerk > 0.0 ? -phase.acceleration / phase.jerk : -1.0;
  const double least = turn > 0.0 && turn < t ? std::min(speed(turn), speed(t)) : speed(t);
  return least >= -1e-6 ? t : std::numeric_limits<double>::quiet_NaN();
}

class LeastTime {
 public:
  LeastTime(const PlannedRun& run, const kinematics::MachineModel& machine, const MotionOptions& options) {
    const AxisLimits limits = axis_limits(machine, false);
    double length = 0.0, from = 0.0;
    for (const PathCell& cell : run.path.cells) length += cell.length;
    for (size_t c = 0; c < run.path.cells.size(); ++c) {
      const double own = run.path.cells[c].length;
      for (double at = 0.0; at < own;) {
        const double place = std::min(from + at, length - from - at);
        double step = std::min({length / kPlaces, own / (run.path.cells[c].corner ? 16.0 : 1.0),
                                std::max(0.002 * length, 0.25 * place)});
        if (own - at < 1.5 * step) step = own - at;
        places_.push_back(limits_at(run, limits, options, c, at + 0.5 * step));
        places_.back().s = from + at;
        at += step;
      }
      from += own;
    }
    places_.push_back(places_.back());
    places_.back().s = length;
    // From rest, and to rest, no jerk of the tip leads to more: v = (6 s)^(2/3) j^(1/3) / 2.
    double jerk = 0.0;
    for (const PlaceLimits& place : places_) jerk = std::max(jerk, place.rows.front().jerk);
    for (PlaceLimits& place : places_) {
      const double way = std::max(std::min(place.s, length - place.s), 1e-3 * length);
      place.speed = std::min(place.speed, 0.5 * std::pow(6.0 * way, 2.0 / 3.0) * std::cbrt(jerk));
    }
  }

  double without_jerk() const;
  double with_jerk();

 private:
  static constexpr double kPlaces = 70.0;

  static PlaceLimits limits_at(const PlannedRun& run, const AxisLimits& limits, const MotionOptions& options,
                               size_t cell, double offset) {
    const PathRates rates = path_rates(run.path, cell, offset);
    const double tip = options.path_acceleration_max / run.path.cells[cell].tip.acceleration;
    PlaceLimits place;
    place.speed = run.motions.feed_mm_s(run.place.first + point_at(run.path, cell, offset).block) / tip;
    place.rows.push_back({1.0, 0.0, 0.0, options.path_acceleration_max / tip, options.path_jerk_max / tip});
    for (Eigen::Index i = 0; i < kinematics::kMaxAxes; ++i) {
      if (std::abs(rates.first[i]) < 1e-9 && std::abs(rates.second[i]) < 1e-6) continue;
      place.rows.push_back(
          {rates.first[i], rates.second[i], rates.third[i], limits.acceleration[i], limits.jerk[i]});
      place.speed = std::min(place.speed, limits.speed[i] / std::abs(rates.first[i]));
    }
    // The greatest speed that some acceleration goes with.
    double low = 0.0, high = place.speed;
    for (int i = 0; i < 60; ++i) {
      const double v = i == 0 ? high : 0.5 * (low + high);
      const auto [least, most] = place.accelerations(v);
      (least <= most ? low : high) = v;
      if (low == high) break;
    }
    place.speed = low;
    return place;
  }

  std::vector<PlaceLimits> places_;
};

inline double LeastTime::without_jerk() const {
  const size_t n = places_.size() - 1;
  // Greatest b from which the end can be reached, back from there.
  std::vector<double> most(n + 1, 0.0);
  for (size_t k = n; k-- > 0;) {
    const double h = places_[k + 1].s - places_[k].s;
    double low = 0.0, high = std::pow(places_[k].speed, 2);
    for (int i = 0; i < 60; ++i) {
      const double b = i == 0 ? high : 0.5 * (low + high);
      const auto [least, greatest] = places_[k].accelerations(std::sqrt(b));
      (least <= greatest && b + 2.0 * least * h <= most[k + 1] ? low : high) = b;
      if (low == high) break;
    }
    most[k] = low;
  }
  double b = 0.0, time = 0.0;
  for (size_t k = 0; k < n; ++k) {
    const double h = places_[k + 1].s - places_[k].s;
    const double next = std::clamp(b + 2.0 * places_[k].accelerations(std::sqrt(b))[1] * h, 0.0, most[k + 1]);
    time += 2.0 * h / (std::sqrt(b) + std::sqrt(next));
    b = next;
  }
  return time;
}

inline double LeastTime::with_jerk() {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  constexpr size_t speeds = 50, half = 16, width = 2 * half + 1;
  const auto share = [&](size_t i) { return static_cast<double>(i) / static_cast<double>(speeds); };
  std::vector<double> next((speeds + 1) * width, kNever), now(next.size());
  // At rest without acceleration; what is left of both costs more than it takes to lose it, so that no law
  // gains by it and none is lost for the width of a cell.
  const double jerk = places_.back().jerks(0.0, 0.0)[1];
  for (size_t i = 0; i <= speeds; ++i) {
    const double v = share(i) * places_.back().speed;
    const auto [low, high] = places_.back().accelerations(v);
    for (size_t m = 0; m < width; ++m) {
      const double a = low + (high - low) * static_cast<double>(m) / static_cast<double>(2 * half);
      next[i * width + m] = std::abs(a) / jerk + 2.0 * std::sqrt(v / jerk);
    }
  }
  // Time to go from (v, a) at a place, interpolated; states that lead nowhere have no weight.
  const auto to_go = [&](const PlaceLimits& place, double v, double a) {
    const double w = v / place.speed * static_cast<double>(speeds);
    if (!(w >= 0.0) || w > static_cast<double>(speeds) * (1.0 + 1e-3)) return kNever;
    const auto [low, high] = place.accelerations(std::min(v, place.speed));
    const double alpha = ((a - low) / (high - low)) * static_cast<double>(2 * half);
    if (alpha < -0.5 || alpha > static_cast<double>(2 * half) + 0.5) return kNever;
    const double cw = std::clamp(w, 0.0, static_cast<double>(speeds) - 1e-9);
    const double ca = std::clamp(alpha, 0.0, static_cast<double>(2 * half) - 1e-9);
    const auto i = static_cast<size_t>(cw), j = static_cast<size_t>(ca);
    const double x = cw - static_cast<double>(i), y = ca - static_cast<double>(j);
    double sum = 0.0, weight = 0.0;
    for (size_t corner = 0; corner < 4; ++corner) {
      const double value = next[(i + corner / 2) * width + j + corner % 2];
      const double own = (corner / 2 == 1 ? x : 1.0 - x) * (corner % 2 == 1 ? y : 1.0 - y);
      if (value == kNever) continue;
      sum += own * value;
      weight += own;
    }
    return weight > 0.25 ? sum / weight : kNever;
  };
  for (size_t k = places_.size() - 1; k-- > 0;) {
    const double h = places_[k + 1].s - places_[k].s;
    std::fill(now.begin(), now.end(), kNever);
    for (size_t i = 0; i <= (k == 0 ? 0 : speeds); ++i) {
      const double v = share(i) * places_[k].speed;
      const auto [low, high] = places_[k].accelerations(v);
      for (size_t m = 0; m < width; ++m) {
        const double a = low + (high - low) * static_cast<double>(m) / static_cast<double>(2 * half);
        const auto [least, most] = places_[k].jerks(v, a);
        if (least > most) continue;
        double best = kNever;
        constexpr int kJerks = 8;
        constexpr double kStanding = 10.0;  // s: it stands
        for (int c = 0; c <= kJerks; ++c) {
          const Phase phase{0.0, v, a, least + (most - least) * c / kJerks};
          const double t = time_over(phase, h);
          if (!(t > 0.0 && t < kStanding)) continue;
          const double after = phase.speed + (phase.acceleration + 0.5 * phase.jerk * t) * t;
          best = std::min(best, t + to_go(places_[k + 1], after, phase.acceleration + phase.jerk * t));
        }
        now[i * width + m] = best;
      }
    }
    now.swap(next);
  }
  return next[half];
}

}  // namespace swarf::motion
