#include "kinematics/singularity.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angles.h"
#include "base/diagnostics.h"
#include "base/units.h"
#include "kinematics/joint_path.h"
#include "kinematics/model_check.h"

namespace swarf::kinematics {
namespace {

/// To which maxima are proven, mm and rad; their places come from roots and are exact to rounding.
constexpr double kPeakTolerance = 1e-9;
/// Sine of the angle between two axes below which their great circle is not determined by them.
constexpr double kSameAxis = 1e-12;

MeasureAt length_of(const Vec3& gap, const Vec3& rate) {
  const double value = gap.norm();
  return {value, value > 0.0 ? gap.dot(rate) / value : 0.0};
}

/// The programmed line in M, as JointPath gives its points.
struct Line {
  Vec3 from, direction;
  double length;

  Line(const MachineModel& machine, const BlockEnds& ends) : from(machine.X_MW * ends.from.tip_W) {
    const Vec3 way = machine.X_MW * ends.to.tip_W - from;
    length = way.norm();
    direction = length > 0.0 ? Vec3(way / length) : Vec3::Zero();
  }
  /// Distance to the infinite line, P - P0 in Eq. (6) (E12).
  MeasureAt distance(const Jet& tip) const {
    const Vec3 gap = tip.value - from;
    return length_of(gap - gap.dot(direction) * direction, tip.first);
  }
  MeasureAt distance_to_segment(const Jet& tip) const {
    const Vec3 gap = tip.value - from;
    const double along = std::clamp(gap.dot(direction), 0.0, length);
    return length_of(gap - along * direction, tip.first);
  }
  MeasureAt beyond(const Jet& tip) const {
    const double along = (tip.value - from).dot(direction), rate = tip.first.dot(direction);
    return along - length >= -along ? MeasureAt{along - length, rate} : MeasureAt{-along, -rate};
  }
};

/// Adaptive Simpson, to 1e-10 of the whole per piece. Own, because its measure is the speed of the axes:
/// where the tip hardly moves, a tolerance relative to its own way is below the rounding of its derivative,
/// and a library's rule (Gauss and Kronrod) halves to the last piece.
class ArcLength {
 public:
  explicit ArcLength(const JointPath& path) : path_(path) {}

  double run() const {
    const int cells = node_cells(path_);
    double sum = 0.0;
    for (int i = 0; i < cells; ++i) {
      const double a = static_cast<double>(i) / cells, b = static_cast<double>(i + 1) / cells;
      sum += piece(a, b, speed(a), speed(0.5 * (a + b)), speed(b), 0);
    }
    return sum;
  }

 private:
  static constexpr int kDepthMax = 24;
  static constexpr double kRelative = 1e-10;

  double speed(double u) const {
    Jet tip, axis;
    path_.derivatives(u, tip, axis);
    return tip.first.norm();
  }
  double piece(double a, double b, double at_a, double at_m, double at_b, int depth) const {
    const double m = 0.5 * (a + b), h = b - a;
    const double at_l = speed(0.5 * (a + m)), at_r = speed(0.5 * (m + b));
    const double whole = h / 6.0 * (at_a + 4.0 * at_m + at_b);
    const double halves = h / 12.0 * (at_a + 4.0 * at_l + 2.0 * at_m + 4.0 * at_r + at_b);
    if (depth >= kDepthMax || std::abs(halves - whole) <= 15.0 * kRelative * h * path_.speed()) {
      return halves + (halves - whole) / 15.0;
    }
    return piece(a, m, at_a, at_l, at_m, depth + 1) + piece(m, b, at_m, at_r, at_b, depth + 1);
  }

  const JointPath& path_;
};

double orientation_error(const JointPath& path, const Vec3& from_M, const Vec3& to_M) {
  const Vec3 normal = from_M.cross(to_M);
  const bool same = normal.norm() < kSameAxis;
  if (same && from_M.dot(to_M) < 0.0) return std::numeric_limits<double>::quiet_NaN();
  const Vec3 unit_normal = same ? Vec3(Vec3::Zero()) : Vec3(normal.normalized());
  const auto measure = [&](double u) {
    Jet tip, axis;
    path.derivatives(u, tip, axis);
    if (same) return length_of(axis.value - from_M, axis.first);
    const double height = axis.value.dot(unit_normal), rate = axis.first.dot(unit_normal);
    return height < 0.0 ? MeasureAt{-height, -rate} : MeasureAt{height, rate};
  };
  const double turn = path.turn();
  const double most = greatest(measure, turn * turn, kPeakTolerance).value;
  return same ? 2.0 * std::asin(std::min(1.0, 0.5 * most)) : std::asin(std::min(1.0, most));
}

double value_sense(const Axis& axis) {
  return axis.reversed ? -1.0 : 1.0;
}

}  // namespace

void require_finite(const BlockEnds& ends) {
  const bool finite = ends.from.tip_W.allFinite() && ends.from.axis_W.allFinite() &&
                      ends.to.tip_W.allFinite() && ends.to.axis_W.allFinite() && ends.q_from.allFinite() &&
                      ends.q_to.allFinite();
  if (finite) return;
  throw InputError("not-finite", {}, "a block has a position or axis value that is not a finite number",
                   "give finite numbers, mm and unit axes");
}

Poles find_poles(const MachineModel& machine) {
  Poles poles;
  const std::vector<int> rotary = rotary_order(machine);
  if (!rotary.empty()) poles.outer = rotary[0];
  if (rotary.size() < 2) return poles;
  poles.inner = rotary[1];
  const Mat3 R_WM = machine.X_MW.linear().transpose();
  const auto direction_W = [&](const Vec3& direction_M) -> Vec3 { return (R_WM * direction_M).normalized(); };
  const Axis& inner = machine.axes[static_cast<size_t>(poles.inner)];
  const Vec3 outer_W = direction_W(machine.axes[static_cast<size_t>(poles.outer)].direction_M);
  const RotaryPair pair(outer_W, direction_W(inner.direction_M), direction_W(machine.tool_axis_M));
  for (const double side : {1.0, -1.0}) {
    const Vec3 direction = side * outer_W;
    TurnPair turns[2];
    if (!(pair.pole_distance(direction) <= kPoleTolerance) || pair.solve(direction, turns) == 0) continue;
    poles.at.push_back({direction, value_sense(inner) * turns[0].inner});
  }
  return poles;
}

double pole_distance_on_arc(const Poles& poles, const Vec3& from_W, const Vec3& to_W) {
  double least = std::numeric_limits<double>::infinity();
  const Vec3 across = from_W.cross(to_W);
  const bool turns = across.norm() > kSameAxis;
  for (const Pole& pole : poles.at) {
    least = std::min({least, angle_between(pole.direction_W, from_W), angle_between(pole.direction_W, to_W)});
    if (!turns) continue;
    const Vec3 normal = across.normalized();
    const double height = pole.direction_W.dot(normal);
    const Vec3 foot = pole.direction_W - height * normal;
    const bool within = normal.dot(from_W.cross(foot)) > 0.0 && normal.dot(foot.cross(to_W)) > 0.0;
    if (within) least = std::min(least, std::atan2(std::abs(height), foot.norm()));
  }
  return least;
}

double pole_distance_of_axes(const MachineModel& machine, const Poles& poles, const BlockEnds& ends) {
  double least = std::numeric_limits<double>::infinity();
  for (const Pole& pole : poles.at) {
    const double from = (ends.q_from[poles.inner] - pole.inner_value) / (2.0 * kPi);
    const double to = (ends.q_to[poles.inner] - pole.inner_value) / (2.0 * kPi);
    if (std::floor(from) != std::floor(to) || from == std::floor(from)) return 0.0;
    for (const AxisValues& q : {ends.q_from, ends.q_to}) {
      least = std::min(least, angle_between(pole.direction_W, forward(machine, q).axis_W));
    }
  }
  return least;
}

double singular_cone(double turn_rad, double duration_s, double outer_speed_max) {
  const double ratio = turn_rad / (duration_s * outer_speed_max);
  return ratio < 1.0 ? std::asin(ratio) : 0.5 * kPi;
}

namespace {

Peak peak_of(const JointPath& path, const Line& line, double bend,
             MeasureAt (Line::*measure)(const Jet&) const) {
  return greatest(
      [&](double u) {
        Jet tip, axis;
        path.derivatives(u, tip, axis);
        return (line.*measure)(tip);
      },
      bend, kPeakTolerance);
}

}  // namespace

TrajectoryError trajectory_error(const MachineModel& machine, const BlockEnds& ends) {
  require_finite(ends);
  const JointPath path(machine, ends.q_from, ends.q_to);
  const Line line(machine, ends);
  const double bend = tip_acceleration_bound(path);
  const auto peak = [&](MeasureAt (Line::*measure)(const Jet&) const) {
    return peak_of(path, line, bend, measure);
  };
  TrajectoryError error;
  error.line = peak(&Line::distance);
  error.segment = peak(&Line::distance_to_segment);
  if (line.length > 0.0) error.beyond = peak(&Line::beyond);
  error.length_mm = ArcLength(path).run();
  error.chord_mm = line.length;
  error.orientation_rad = orientation_error(path, machine.X_MW.linear() * ends.from.axis_W,
                                            machine.X_MW.linear() * ends.to.axis_W);
  error.bound_mm = 0.125 * bend;
  return error;
}

Peak segment_deviation(const MachineModel& machine, const BlockEnds& ends) {
  require_finite(ends);
  const JointPath path(machine, ends.q_from, ends.q_to);
  return peak_of(path, Line(machine, ends), tip_acceleration_bound(path), &Line::distance_to_segment);
}

double trajectory_error_bound(const MachineModel& machine, const BlockEnds& ends) {
  require_finite(ends);
  return 0.125 * tip_acceleration_bound(JointPath(machine, ends.q_from, ends.q_to));
}

namespace {

/// Both rotary solutions of a pose near the hint, that of the hint first.
std::vector<AxisValues> solutions_near(const InverseKinematics& inverse, const ToolPose& pose,
                                       const AxisValues& hint, const Poles& poles) {
  const InverseSolutions found = inverse.solve(pose, hint);
  std::vector<AxisValues> all;
  for (int i = 0; i < found.count; ++i) all.push_back(found.branch[i].q);
  const auto away = [&](const AxisValues& q) {
    return std::abs(q[poles.outer] - hint[poles.outer]) + std::abs(q[poles.inner] - hint[poles.inner]);
  };
  std::sort(all.begin(), all.end(),
            [&](const AxisValues& a, const AxisValues& b) { return away(a) < away(b); });
  return all;
}

int first_out_of_travel(const MachineModel& machine, const BranchChoice& choice) {
  for (size_t i = 0; i < machine.axes.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    for (const double value : {choice.q_from[row], choice.q_to[row]}) {
      if (!(value >= machine.axes[i].min - kTipTolerance && value <= machine.axes[i].max + kTipTolerance))
        return static_cast<int>(i);
    }
  }
  return -1;
}

}  // namespace

std::vector<BranchChoice> branch_choices(const MachineModel& machine, const InverseKinematics& inverse,
                                         const BlockEnds& ends) {
  require_finite(ends);
  const Poles poles = find_poles(machine);
  std::vector<BranchChoice> choices;
  if (poles.inner < 0) return choices;
  const auto add = [&](BranchChoice choice) {
    choice.outer_swing_rad = choice.q_to[poles.outer] - choice.q_from[poles.outer];
    choice.inner_swing_rad = choice.q_to[poles.inner] - choice.q_from[poles.inner];
    const TrajectoryError error = trajectory_error(machine, {ends.from, ends.to, choice.q_from, choice.q_to});
    choice.line_mm = error.line.value;
    choice.segment_mm = error.segment.value;
    choice.out_of_travel_axis = first_out_of_travel(machine, choice);
    choices.push_back(choice);
  };
  const std::vector<AxisValues> froms = solutions_near(inverse, ends.from, ends.q_from, poles);
  // Which solution at the end continues which at the start is told by the inner axis: it cannot jump.
  const std::vector<AxisValues> tos = solutions_near(inverse, ends.to, ends.q_to, poles);
  for (size_t f = 0; f < froms.size(); ++f) {
    for (size_t t = 0; t < tos.size(); ++t) {
      BranchChoice choice{f > 0, t > 0, false, froms[f], tos[t]};
      double& outer = choice.q_to[poles.outer];
      const bool as_run = f == 0 && t == 0;
      if (!as_run) outer += 2.0 * kPi * std::nearbyint((choice.q_from[poles.outer] - outer) / (2.0 * kPi));
      add(choice);
      choice.long_way = true;
      outer += outer > choice.q_from[poles.outer] ? -2.0 * kPi : 2.0 * kPi;
      add(choice);
    }
  }
  return choices;
}

}  // namespace swarf::kinematics
