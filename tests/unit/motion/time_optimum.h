// The least time along a planned run's path, by direct transcription: an oracle for look-ahead that shares
// nothing with it but the path's points.
//
// With b = v^2 over s: a = b'/2, j = sqrt(b) b''/2, and of each axis (theory 1.3)
//     speed          q'^2 b <= V^2
//     acceleration   |q'' b + q' b'/2| <= A
//     jerk           |q''' b + 3/2 q'' b' + q' b''/2| <= J / sqrt(b)
// at the nodes of a grid, dense where the path bends and at both ends. All are linear in b but the last right
// side, which is convex: its tangent is below it, so each linear problem lies within the true one. An
// interior-point method lowers the barrier and moves the tangent to where it has come. Only the nodes are
// held, so the result is a little below what any law can do.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "unit/motion/path_place.h"

namespace swarf::motion {

class TimeOptimum {
 public:
  TimeOptimum(const PlannedRun& run, const kinematics::MachineModel& machine, const MotionOptions& options)
      : run_(run), limits_(axis_limits(machine, false)), options_(options) {
    choose_nodes();
    for (size_t k = 1; k + 1 < s_.size(); ++k) {
      add_rows(k, cell_of_[k - 1]);
      if (cell_of_[k] != cell_of_[k - 1]) add_rows(k, cell_of_[k]);
    }
    // From and to rest without acceleration: b <= (J^2/4) (6 s/J)^(4/3).
    const double first = s_[1], last = s_.back() - s_[s_.size() - 2];
    rows_.push_back({1, {0, 1, 0}, from_rest(first, cell_of_.front()), 0.0});
    rows_.push_back({s_.size() - 2, {0, 1, 0}, from_rest(last, cell_of_.back()), 0.0});
  }

  /// Least time, s: the problem is not convex, so that one start may end beside it. From the plan itself,
  /// and from a law so slow that it holds everything.
  double time() {
    start([&](double s) { return std::pow(planned_speed(s), 2); });
    const double near = descend();
    const double length = s_.back(), scale = std::pow(run_.path.cells.front().speed, 2);
    start([&](double s) {
      return scale * std::pow(std::max(0.0, s * (length - s)) / (length * length), 4.0 / 3.0);
    });
    return std::min(near, descend());
  }

 private:
  double descend() {
    double weight = 0.1 * objective();  // per row, of the barrier
    for (weight /= static_cast<double>(rows_.size());
         weight * static_cast<double>(rows_.size()) > 1e-5 * objective(); weight *= 0.6) {
      for (int i = 0; i < 6; ++i) {
        move_tangents();
        if (newton(weight) < 1e-6) break;
      }
    }
    return objective();
  }

  /// g b(k-1..k+1) <= bound, or <= jerk / sqrt(b_k) where jerk is set.
  struct Row {
    size_t k = 0;
    double g[3] = {0, 0, 0};
    double bound = 0.0, jerk = 0.0;
    double slope = 0.0;  ///< of the tangent, moved to the left side
  };

  void choose_nodes() {
    s_ = {0.0};
    double length = 0.0, from = 0.0;
    for (const PathCell& cell : run_.path.cells) length += cell.length;
    for (size_t c = 0; c < run_.path.cells.size(); ++c) {
      const double own = run_.path.cells[c].length;
      const double least = own / (run_.path.cells[c].corner ? 48.0 : 24.0), step = length / 200.0;
      for (double s = 0.0; s < own;) {
        const double place = from + s;
        const double end = std::min(place, length - place);
        double width = std::min({step, least, std::max(2e-5 * length, 0.06 * end)});
        if (own - s < 1.5 * width) width = own - s;
        s += width;
        s_.push_back(s < own ? from + s : from + own);
        cell_of_.push_back(c);
        offset_.push_back(s - width);
      }
      from += own;
    }
  }

  double tip_at(size_t cell) const {  // mm of the tip per mm
    return options_.path_acceleration_max / run_.path.cells[cell].tip.acceleration;
  }

  void add_rows(size_t k, size_t cell) {
    const double offset = cell == cell_of_[k] ? offset_[k] : run_.path.cells[cell].length;
    const PathRates place = path_rates(run_.path, cell, offset);
    const double tip = tip_at(cell);
    const double l = s_[k] - s_[k - 1], r = s_[k + 1] - s_[k];
    const double d1[3] = {-r / (l * (l + r)), (r - l) / (l * r), l / (r * (l + r))};
    const double d2[3] = {2.0 / (l * (l + r)), -2.0 / (l * r), 2.0 / (r * (l + r))};
    const auto add = [&](double c0, double c1, double c2, double bound, double jerk) {
      for (const double sign : {1.0, -1.0}) {
        Row row{k, {}, bound, jerk};
        for (int i = 0; i < 3; ++i) row.g[i] = sign * (c1 * d1[i] + c2 * d2[i] + (i == 1 ? c0 : 0.0));
        rows_.push_back(row);
      }
    };
    const size_t block = run_.place.first + point_at(run_.path, cell, offset).block;
    double most = std::pow(run_.motions.feed_mm_s(block) / tip, 2);
    add(0.0, 0.5, 0.0, options_.path_acceleration_max / tip, 0.0);
    add(0.0, 0.0, 0.5, 0.0, options_.path_jerk_max / tip);
    for (Eigen::Index i = 0; i < kinematics::kMaxAxes; ++i) {
      const double q1 = place.first[i], q2 = place.second[i], q3 = place.third[i];
      if (std::abs(q1) < 1e-9 && std::abs(q2) < 1e-6) continue;
      most = std::min(most, std::pow(limits_.speed[i] / q1, 2));
      add(q2, 0.5 * q1, 0.0, limits_.acceleration[i], 0.0);
      add(q3, 1.5 * q2, 0.5 * q1, 0.0, limits_.jerk[i]);
    }
    rows_.push_back({k, {0, 1, 0}, most, 0.0});
  }

  double from_rest(double way, size_t cell) const {
    const PathRates place = path_rates(run_.path, cell, cell == 0 ? 0.0 : run_.path.cells[cell].length);
    double jerk = options_.path_jerk_max / tip_at(cell);
    for (Eigen::Index i = 0; i < kinematics::kMaxAxes; ++i)
      jerk = std::min(jerk, limits_.jerk[i] / std::abs(place.first[i]));
    return 0.25 * jerk * jerk * std::pow(6.0 * way / jerk, 4.0 / 3.0);
  }

  double left(const Row& row) const {
    return row.g[0] * b_[row.k - 1] + row.g[1] * b_[row.k] + row.g[2] * b_[row.k + 1];
  }
  double slack(const Row& row) const { return row.bound - left(row) - row.slope * b_[row.k]; }

  /// Sets the tangents of J / sqrt(b) at b.
  void move_tangents() {
    for (Row& row : rows_) {
      if (row.jerk == 0.0) continue;
      const double b = b_[row.k];
      row.bound = 1.5 * row.jerk / std::sqrt(b);
      row.slope = 0.5 * row.jerk / (b * std::sqrt(b));
    }
  }

  bool inside() const {
    for (size_t k = 1; k + 1 < b_.size(); ++k)
      if (!(b_[k] > 0.0)) return false;
    return std::all_of(rows_.begin(), rows_.end(), [&](const Row& row) { return slack(row) > 0.0; });
  }

  double planned_speed(double s) const {
    double from = 0.0;
    for (const PlacedPhase& placed : run_.phases) {
      const Phase& phase = placed.phase;
      const double way = phase.way(phase.duration);
      if (s < from + way) {
        double low = 0.0, high = phase.duration;
        for (int i = 0; i < 50; ++i) {
          const double middle = 0.5 * (low + high);
          (phase.way(middle) <= s - from ? low : high) = middle;
        }
        return phase.speed + (phase.acceleration + 0.5 * phase.jerk * low) * low;
      }
      from += way;
    }
    return 0.0;
  }

  /// Starts from b(s), slowed evenly until it holds everything with room to spare.
  template <typename Squared>
  void start(const Squared& squared) {
    for (double scale = 0.9;; scale *= 0.7) {
      b_.clear();
      for (const double s : s_) b_.push_back(scale * squared(s));
      b_.front() = b_.back() = 0.0;
      move_tangents();
      if (inside()) return;
    }
  }

  double objective() const {
    double time = 0.0;
    const size_t n = b_.size() - 1;
    for (size_t k = 0; k < n; ++k) {
      // In the first and the last step b goes with the power 4/3 of s.
      const double factor = k == 0 || k + 1 == n ? 3.0 : 2.0;
      time += factor * (s_[k + 1] - s_[k]) / (std::sqrt(b_[k]) + std::sqrt(b_[k + 1]));
    }
    return time;
  }
  double merit(double weight) const {
    double sum = objective();
    for (const Row& row : rows_) sum -= weight * std::log(slack(row));
    return sum;
  }

  /// One step; returns what it gained by the quadratic model over the objective.
  double newton(double weight) {
    const size_t n = b_.size();
    gradient_.assign(n, 0.0);
    for (auto& band : hessian_) band.assign(n, 0.0);
    add_objective();
    for (const Row& row : rows_) {
      const double inverse = 1.0 / slack(row);
      const double g[3] = {row.g[0], row.g[1] + row.slope, row.g[2]};
      for (size_t i = 0; i < 3; ++i) {
        gradient_[row.k - 1 + i] += weight * g[i] * inverse;
        for (size_t j = 0; j <= i; ++j)
          hessian_[i - j][row.k - 1 + i] += weight * g[i] * g[j] * inverse * inverse;
      }
    }
    const std::vector<double> step = solve();
    double gain = 0.0;
    for (size_t k = 0; k < n; ++k) gain -= step[k] * gradient_[k];
    const double before = merit(weight);
    const std::vector<double> old = b_;
    for (double share = 1.0; share > 1e-12; share *= 0.6) {
      for (size_t k = 1; k + 1 < n; ++k) b_[k] = old[k] + share * step[k];
      if (inside() && merit(weight) < before) return gain / objective();
    }
    b_ = old;
    return 0.0;
  }

  void add_objective() {
    const size_t n = b_.size() - 1;
    for (size_t k = 0; k < n; ++k) {
      const double h = s_[k + 1] - s_[k], factor = k == 0 || k + 1 == n ? 3.0 : 2.0;
      const double w = std::sqrt(b_[k]) + std::sqrt(b_[k + 1]);
      const double slope[2] = {b_[k] > 0.0 ? 0.5 / std::sqrt(b_[k]) : 0.0,
                               b_[k + 1] > 0.0 ? 0.5 / std::sqrt(b_[k + 1]) : 0.0};
      for (size_t i = 0; i < 2; ++i) {
        gradient_[k + i] -= factor * h / (w * w) * slope[i];
        hessian_[0][k + i] += 2.0 * factor * h / (w * w * w) * slope[i] * slope[i] +
                              2.0 * factor * h / (w * w) * slope[i] * slope[i] * slope[i];
      }
      hessian_[1][k + 1] += 2.0 * factor * h / (w * w * w) * slope[0] * slope[1];
    }
  }

  /// The step: Cholesky of the matrix of five bands, both ends held.
  std::vector<double> solve() {
    const size_t n = b_.size();
    for (const size_t k : {size_t{0}, n - 1}) {
      gradient_[k] = 0.0;
      hessian_[0][k] = 1.0;
      hessian_[1][k] = hessian_[2][k] = 0.0;
    }
    hessian_[1][1] = hessian_[2][2] = 0.0;
    std::vector<double> x(n);
    auto& [d, e, f] = hessian_;
    for (size_t k = 0; k < n; ++k) {
      if (k >= 2) f[k] /= d[k - 2];
      if (k >= 1) e[k] = (e[k] - (k >= 2 ? f[k] * e[k - 1] : 0.0)) / d[k - 1];
      d[k] = std::sqrt(d[k] - (k >= 1 ? e[k] * e[k] : 0.0) - (k >= 2 ? f[k] * f[k] : 0.0));
      x[k] = (-gradient_[k] - (k >= 1 ? e[k] * x[k - 1] : 0.0) - (k >= 2 ? f[k] * x[k - 2] : 0.0)) / d[k];
    }
    for (size_t k = n; k-- > 0;)
      x[k] =
          (x[k] - (k + 1 < n ? e[k + 1] * x[k + 1] : 0.0) - (k + 2 < n ? f[k + 2] * x[k + 2] : 0.0)) / d[k];
    return x;
  }

  const PlannedRun& run_;
  AxisLimits limits_;
  const MotionOptions& options_;
  std::vector<double> s_, b_;    ///< nodes and speed squared
  std::vector<size_t> cell_of_;  ///< of the step after each node
  std::vector<double> offset_;   ///< of the node in that cell
  std::vector<Row> rows_;
  std::vector<double> gradient_;
  std::array<std::vector<double>, 3> hessian_;  ///< diagonal and the two below it, by row
};

}  // namespace swarf::motion
