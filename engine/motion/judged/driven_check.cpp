#include "motion/judged/driven_check.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace swarf::motion {
namespace {

/// Sums of chords round; limits are met, not undercut.
constexpr double kChordSum = 1e-6;

/// Shorter chords, of a start from rest, are held to a share of this, mm.
constexpr double kShortestChord_mm = 1e-5;
/// Of a piece between two lines of the evaluation, from its chord, by its length.
constexpr double kPieceSagitta = 0.02;

/// Measures one pass.
class PassCheck {
 public:
  PassCheck(const DrivenInterpolator& interpolator, const MotionOptions& options, DrivenStatistics& out)
      : ahead_(interpolator.ahead()),
        options_(options),
        period_(options.period_s),
        out_(out),
        before_(interpolator.start().pose.tip_W),
        miss_(ahead_.nodes.size(), std::numeric_limits<double>::infinity()) {}

  void add(const DrivenOutput& cycle) {
    const Vec3 tip = cycle.at.pose.tip_W;
    see_corners(tip);
    const bool on_corner = at_corner_;
    const double asked = cycle.feed_mm_s * period_;
    const double error = std::abs(cycle.chord_mm - asked) / std::max(asked, kShortestChord_mm);
    if (!on_corner) out_.chord_error_max_rel = std::max(out_.chord_error_max_rel, error);
    if (!on_corner && error > kChordKept) ++out_.off_chord;
    const double speed = cycle.chord_mm / period_, acceleration = (speed - speed_) / period_;
    const double jerk = (acceleration - acceleration_) / period_;
    out_.acceleration_max = std::max(out_.acceleration_max, std::abs(acceleration));
    out_.jerk_max = std::max(out_.jerk_max, std::abs(jerk));
    if (std::abs(acceleration) > options_.path_acceleration_max * (1.0 + kChordSum))
      ++out_.above_acceleration;
    if (std::abs(jerk) > options_.path_jerk_max * (1.0 + kChordSum)) ++out_.above_jerk;
    // A chord within one cell has that cell's clamp.
    if (cell_before_ == cell_ && speed > ahead_.clamps.speed[cell_] * (1.0 + kChordSum) + 1e-9)
      ++out_.above_clamp;
    s_ += cycle.chord_mm;
    trace.push_back({s_, tip.z(), speed, cycle.clamp_mm_s});
    speed_ = speed;
    acceleration_ = acceleration;
    before_ = tip;
    ++out_.cycles;
  }

  void finish() {
    for (size_t i = 0; i < miss_.size(); ++i)
      if (ahead_.nodes[i].corner && ahead_.clamps.at[i] == 0.0)
        out_.crease_miss_max_mm = std::max(out_.crease_miss_max_mm, miss_[i]);
  }

  std::vector<DrivenTracePoint> trace;

 private:
  /// Follows the cells; nodes that this cycle stands on or has passed.
  void see_corners(const Vec3& tip) {
    constexpr double kOn_mm = 1e-6;
    cell_before_ = cell_;
    at_corner_ = false;
    const auto near = [&](size_t node) { return (ahead_.nodes[node].pose.tip_W - tip).norm(); };
    for (size_t node = cell_; node < std::min(cell_ + 2, miss_.size()); ++node) {
      miss_[node] = std::min(miss_[node], near(node));
      at_corner_ = at_corner_ || (ahead_.nodes[node].corner && near(node) < kOn_mm);
    }
    const auto ahead_of = [&](size_t node) {
      const Vec3 along = ahead_.nodes[node].pose.tip_W - ahead_.nodes[node - 1].pose.tip_W;
      return (ahead_.nodes[node].pose.tip_W - tip).dot(along) > kOn_mm * along.norm();
    };
    while (cell_ + 2 < ahead_.nodes.size() && !ahead_of(cell_ + 1)) {
      ++cell_;
      miss_[cell_] = std::min(miss_[cell_], near(cell_));
      at_corner_ = at_corner_ || ahead_.nodes[cell_].corner;
    }
  }

  const EvaluatedPass& ahead_;
  const MotionOptions& options_;
  double period_;
  DrivenStatistics& out_;
  Vec3 before_;
  std::vector<double> miss_;  ///< by node
  size_t cell_ = 0, cell_before_ = 0;
  bool at_corner_ = false;
  double speed_ = 0.0, acceleration_ = 0.0, s_ = 0.0;
};

void count_ahead(const EvaluatedPass& ahead, double feed_mm_s, DrivenStatistics& out) {
  out.positions_ahead += ahead.positions;
  for (size_t i = 1; i + 1 < ahead.nodes.size(); ++i) {
    if (ahead.node_reasons[i] == ClampReason::kCrease) ++out.creases;
    if (ahead.clamps.at[i] > 0.0 && ahead.clamps.at[i] < feed_mm_s)
      out.slowest_clamp_mm_s = out.slowest_clamp_mm_s > 0.0
                                   ? std::min(out.slowest_clamp_mm_s, ahead.clamps.at[i])
                                   : ahead.clamps.at[i];
  }
  out.steps += static_cast<size_t>(std::count(ahead.steps.begin(), ahead.steps.end(), true));
  for (const double speed : ahead.clamps.speed) {
    if (speed >= feed_mm_s) continue;
    ++out.clamped_cells;
    out.slowest_clamp_mm_s = out.slowest_clamp_mm_s > 0.0 ? std::min(out.slowest_clamp_mm_s, speed) : speed;
  }
}

size_t corners_of(const EvaluatedPass& ahead) {
  return static_cast<size_t>(std::count_if(ahead.nodes.begin(), ahead.nodes.end(),
                                           [](const EvaluatedNode& node) { return node.corner; }));
}

double straight_distance(const Vec3& a, const Vec3& b, const Vec3& p) {
  const Vec3 along = b - a;
  const double square = along.squaredNorm();
  const double t = square > 0.0 ? std::clamp((p - a).dot(along) / square, 0.0, 1.0) : 0.0;
  return (p - a - t * along).norm();
}

}  // namespace

DrivenStatistics check_driven(const toolpath::Elements& elements, const kinematics::MachineModel& machine,
                              const kinematics::InverseKinematics& inverse, const MotionOptions& options) {
  DrivenStatistics out;
  size_t most = 0;
  kinematics::AxisValues q = kinematics::AxisValues::Zero();
  for (size_t i = 0; i < machine.axes.size(); ++i) q[static_cast<Eigen::Index>(i)] = machine.axes[i].home;
  for (size_t i = 0; i < elements.size(); ++i) {
    const toolpath::DrivenPass* pass = elements.driven(i);
    if (pass == nullptr) continue;
    DrivenInterpolator interpolator(*pass, machine, inverse, options, q);
    count_ahead(interpolator.ahead(), pass->feed_mm_s, out);
    PassCheck check(interpolator, options, out);
    for (bool finished = false; !finished;) {
      const DrivenOutput cycle = interpolator.step({});
      check.add(cycle);
      finished = cycle.finished;
    }
    check.finish();
    if (++out.passes == 1 || corners_of(interpolator.ahead()) > most) {
      most = corners_of(interpolator.ahead());
      out.trace = std::move(check.trace);
    }
  }
  return out;
}

ExactPath::ExactPath(const toolpath::DrivenPass& pass, const kinematics::MachineModel& machine,
                     const kinematics::InverseKinematics& inverse, const MotionOptions& options)
    : pass_(pass), ahead_(evaluate_ahead(pass, machine, inverse, options, kinematics::AxisValues::Zero())) {}

/// By the place that stands across the cell's chord from the tip, by regula falsi (Illinois): on a piece that
/// turns by less than the evaluation's angle the nearest place is nearer by less than a share of 1e-3.
double ExactPath::cell_distance(size_t cell, const Vec3& tip) {
  const EvaluatedNode &a = ahead_.nodes[cell], &b = ahead_.nodes[cell + 1];
  if (ahead_.steps[cell]) return straight_distance(a.pose.tip_W, b.pose.tip_W, tip);
  constexpr int kMostSteps = 16;
  constexpr double kClose = 1e-7;  // mm
  const Vec3 way = (b.pose.tip_W - a.pose.tip_W).normalized();
  double low = a.x, high = b.x;
  double before = (a.pose.tip_W - tip).dot(way), behind = (b.pose.tip_W - tip).dot(way);
  double found = std::min((a.pose.tip_W - tip).norm(), (b.pose.tip_W - tip).norm());
  int last = 0;
  for (int i = 0; i < kMostSteps && before < 0.0 && behind > 0.0; ++i) {
    const double x = low + (high - low) * before / (before - behind);
    const Vec3 off = toolpath::tip_at(pass_, x, near_).pose.tip_W - tip;
    const double along = off.dot(way);
    found = std::min(found, off.norm());
    if (std::abs(along) < kClose) break;
    const int side = along < 0.0 ? -1 : 1;
    (side < 0 ? low : high) = x;
    (side < 0 ? before : behind) = along;
    if (side == last) (side < 0 ? behind : before) *= 0.5;
    last = side;
  }
  return found;
}

double ExactPath::distance(const Vec3& tip) {
  constexpr double kWindow_mm = 3.0;
  const auto straight = [&](size_t cell) {
    return straight_distance(ahead_.nodes[cell].pose.tip_W, ahead_.nodes[cell + 1].pose.tip_W, tip);
  };
  size_t best = cell_;
  double nearest = straight(cell_), way = 0.0;
  for (size_t cell = cell_ + 1; cell < ahead_.steps.size() && way < kWindow_mm; ++cell) {
    way += (ahead_.nodes[cell + 1].pose.tip_W - ahead_.nodes[cell].pose.tip_W).norm();
    if (straight(cell) >= nearest) continue;
    nearest = straight(cell);
    best = cell;
  }
  cell_ = best;
  double found = cell_distance(best, tip);
  // A piece that turns by a few hundredths stays within a hundredth of its length from its chord.
  const auto may_be_nearer = [&](size_t cell) {
    const double length = (ahead_.nodes[cell + 1].pose.tip_W - ahead_.nodes[cell].pose.tip_W).norm();
    return straight(cell) - kPieceSagitta * length < found;
  };
  if (best > 0 && may_be_nearer(best - 1)) found = std::min(found, cell_distance(best - 1, tip));
  if (best + 1 < ahead_.steps.size() && may_be_nearer(best + 1))
    found = std::min(found, cell_distance(best + 1, tip));
  return found;
}

}  // namespace swarf::motion
