#include "motion/passes/surface_evaluation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angles.h"
#include "base/diagnostics.h"
#include "motion/speed/look_ahead.h"
#include "motion/speed/speed_clamps.h"

namespace swarf::motion {
namespace {

using toolpath::DrivenPass;

/// Two lines are divided while the path turns by more than this between them.
constexpr double kTurn_rad = 0.02;
/// The tip goes no farther than this between two lines.
constexpr double kFarthest_mm = 1.5 * kEvaluationStep_mm;
/// A cell in which the path turns by so much more than beside it has a crease.
constexpr double kKinkShare = 1.5;
/// Lines closer than this are one, mm: a hundredth of a nanometre's share of any speed.
constexpr double kOne_mm = 1e-7;
/// A jump of the tip by more than this within one line is a step, mm.
constexpr double kStepHeight_mm = 1e-4;
/// Nodes other than corners keep this distance, mm: closer ones tell rounding, not curvature.
constexpr double kApart_mm = 1e-4;
/// Share of the acceleration and of the jerk that a crease may take; the rest is for changes of speed.
constexpr double kCreaseShare = 0.5;
/// A crease that would be passed slower than a standing machine is after ten cycles is a stop.
constexpr double kStopCycles = 10.0;

/// Share of the jerk that is planned with: clamps are looked at along chords, and what arcs are longer shows
/// in the third difference of the last cycles before a stop.
constexpr double kPlannedJerk = 0.95;

constexpr double kNoClamp = std::numeric_limits<double>::infinity();

struct Line {
  double x = 0.0;
  ToolPose pose;
};

/// The lines of a pass, made denser where the path turns.
class Lines {
 public:
  explicit Lines(const DrivenPass& pass) : pass_(pass) {}

  Line at(double x) {
    const toolpath::TipPoint tip = toolpath::tip_at(pass_, x, near_);
    ++positions;
    if (!std::isfinite(tip.rest.height)) {
      const Vec3 p = pass_.guide->line(x).point_W;
      throw InputError("guide-misses-part", {},
                       fmt::format("pass {}: the tool rests on nothing at ({:.3f}, {:.3f}, {:.3f}) mm",
                                   pass_.pass + 1, p.x(), p.y(), p.z()),
                       "keep the guide on the part (area_mm), or say how low the tool may go: floor_mm");
    }
    return {x, tip.pose};
  }

  /// Evenly between the joints of the guide.
  std::vector<Line> even() {
    std::vector<double> stops = pass_.guide->joints();
    stops.push_back(pass_.guide->end());
    std::vector<Line> lines{at(0.0)};
    for (const double stop : stops) {
      const double from = lines.back().x;
      const int parts = std::max(2, static_cast<int>(std::ceil((stop - from) / kEvaluationStep_mm)));
      for (int i = 1; i < parts; ++i) lines.push_back(at(from + (stop - from) * i / parts));
      lines.push_back(at(stop));
    }
    return lines;
  }

  size_t positions = 0;

 private:
  const DrivenPass& pass_;
  position::Near near_;
};

Vec3 way(const Line& a, const Line& b) {
  return b.pose.tip_W - a.pose.tip_W;
}

/// What the path and the axis turn through at each line; 0 at both ends.
struct Turns {
  std::vector<double> path, most;  ///< rad; the greater one of path and axis
};

Turns turns_of(const std::vector<Line>& lines) {
  Turns turns{std::vector<double>(lines.size(), 0.0), std::vector<double>(lines.size(), 0.0)};
  for (size_t i = 1; i + 1 < lines.size(); ++i) {
    const Vec3 in = way(lines[i - 1], lines[i]), out = way(lines[i], lines[i + 1]);
    turns.path[i] = in.norm() > 0.0 && out.norm() > 0.0 ? angle_between(in, out) : 0.0;
    turns.most[i] = std::max(turns.path[i], angle_between(lines[i].pose.axis_W, lines[i + 1].pose.axis_W));
  }
  return turns;
}

/// A small crease, as the edges of a mesh are: in the cell behind line i the path turns by more than `least`,
/// and much more than beside it. A curve turns evenly.
bool kinks_in(const std::vector<double>& turns, size_t i, double least) {
  const double here = turns[i] + turns[i + 1];
  const double beside = (i > 0 ? turns[i - 1] : 0.0) + (i + 2 < turns.size() ? turns[i + 2] : 0.0);
  return here > least && here > kKinkShare * beside;
}

bool is_one(const Line& a, const Line& b) {
  return b.x - a.x <= kOne_mm;
}

/// A cell in which the tip goes far although its line moves little: a step whose direction the path already
/// has, as beside a wall that a ball rolls down.
bool leaps(const Line& a, const Line& b) {
  return way(a, b).norm() > kFarthest_mm;
}

/// A crease takes some 60 lines; a part with more than this between two of the first lines has no direction
/// there, as where heights are known less closely than their lines lie apart.
constexpr int kMostBetween = 6000;

void require_direction(const DrivenPass& pass, const std::vector<Line>& first,
                       const std::vector<Line>& lines) {
  size_t next = 1;
  int between = 0;
  for (const Line& line : lines) {
    if (++between > kMostBetween) {
      const Vec3& p = line.pose.tip_W;
      throw InputError(
          "part-too-rough", {},
          fmt::format(
              "pass {}: about ({:.4f}, {:.4f}, {:.4f}) mm the path turns by more than {:.2g} rad between "
              "all of {} positions within {:g} mm: it has no direction there",
              pass.pass + 1, p.x(), p.y(), p.z(), kTurn_rad, kMostBetween, kEvaluationStep_mm),
          "smooth the part or export it again more closely; a noise of a micrometre's hundredth is enough");
    }
    while (next < first.size() && line.x >= first[next].x) {
      ++next;
      between = 0;
    }
  }
}

/// Divides the cells beside every turn, those with a crease of more than `least_crease`, and those that leap,
/// until none can be divided.
void refine(const DrivenPass& pass, Lines& source, double least_crease, std::vector<Line>& lines) {
  const std::vector<Line> first = lines;
  bool divided = true;
  while (divided) {
    divided = false;
    std::vector<Line> finer{lines.front()};
    const Turns turns = turns_of(lines);
    for (size_t i = 0; i + 1 < lines.size(); ++i) {
      const bool divides = turns.most[i] > kTurn_rad || turns.most[i + 1] > kTurn_rad ||
                           kinks_in(turns.path, i, least_crease) || leaps(lines[i], lines[i + 1]);
      if (divides && !is_one(lines[i], lines[i + 1])) {
        finer.push_back(source.at(0.5 * (lines[i].x + lines[i + 1].x)));
        divided = true;
      }
      finer.push_back(lines[i + 1]);
    }
    lines = std::move(finer);
    require_direction(pass, first, lines);
  }
}

/// A chord of one cycle at the set feed, with a crease of this turn in its middle, leaves the path by half of
/// the tolerance: what turns less needs no clamp of its own. rad
double least_crease(const DrivenPass& pass, const MotionOptions& options) {
  return std::min(kTurn_rad, 2.0 * pass.chord_tolerance_mm / (pass.feed_mm_s * options.period_s));
}

/// Lines that are one, or a single line.
struct Spot {
  Line first, last;
  bool corner = false, step = false;
};

/// The places of a pass. Its ends are corners: it comes from rest and goes to rest.
std::vector<Spot> places_of(const std::vector<Line>& lines) {
  std::vector<Spot> places;
  for (size_t i = 0; i < lines.size();) {
    size_t end = i + 1;
    while (end < lines.size() && is_one(lines[end - 1], lines[end])) ++end;
    const Line &first = lines[i], &last = lines[end - 1];
    const bool step = way(first, last).norm() > kStepHeight_mm;
    places.push_back({first, last, end - i > 1, step});
    i = end;
  }
  places.front().corner = places.back().corner = true;
  return places;
}

/// Without those that lie too near to a corner or to each other to tell curvature by.
std::vector<Spot> apart(const std::vector<Spot>& places) {
  std::vector<Spot> kept;
  for (const Spot& place : places) {
    const bool near = !kept.empty() && way(kept.back().last, place.first).norm() < kApart_mm;
    if (near && !place.corner) continue;
    if (near && !kept.back().corner) kept.pop_back();
    kept.push_back(place);
  }
  return kept;
}

void add_nodes(const std::vector<Spot>& places, EvaluatedPass& out) {
  for (const Spot& place : places) {
    if (!out.nodes.empty()) out.steps.push_back(false);
    out.nodes.push_back({place.first.x, place.first.pose, place.corner});
    if (!place.step) continue;
    out.steps.push_back(true);
    out.nodes.push_back({place.last.x, place.last.pose, true});
  }
}

Vec3 way(const EvaluatedPass& pass, size_t cell) {
  return pass.nodes[cell + 1].pose.tip_W - pass.nodes[cell].pose.tip_W;
}

/// What the path turns through at a node, rad.
double turn_at(const EvaluatedPass& pass, size_t node) {
  return angle_between(way(pass, node - 1), way(pass, node));
}

/// Lowers a limit and remembers why.
void lower(double& limit, ClampReason& kept, double value, ClampReason reason) {
  if (!(value < limit)) return;
  limit = value;
  kept = reason;
}

/// Theory 3: the greatest speed at which one cycle turns through a crease: 2 F sin(turn/2) within what
/// acceleration and jerk leave for it, and the chord across it within the tolerance.
double crease_speed(double turn, const RampLimits& limits, double chord_tolerance_mm, double period_s) {
  const double half = std::sin(0.5 * turn), T = period_s;
  const double change = kCreaseShare * std::min(limits.acceleration * T, limits.jerk * T * T);
  const double speed = std::min(change, 4.0 * chord_tolerance_mm / T) / (2.0 * half);
  return speed < kStopCycles * limits.jerk * T * T ? 0.0 : speed;
}

void clamp_nodes(const DrivenPass& pass, const MotionOptions& options, EvaluatedPass& out) {
  const size_t last = out.nodes.size() - 1;
  out.clamps.at.assign(out.nodes.size(), kNoClamp);
  out.node_reasons.assign(out.nodes.size(), ClampReason::kNone);
  for (size_t i = 1; i < last; ++i) {
    if (!out.nodes[i].corner) continue;
    const bool step = out.steps[i - 1] || out.steps[i];
    lower(out.clamps.at[i], out.node_reasons[i],
          step ? 0.0 : crease_speed(turn_at(out, i), out.limits, pass.chord_tolerance_mm, options.period_s),
          step ? ClampReason::kStep : ClampReason::kCrease);
  }
  out.clamps.at.front() = out.clamps.at.back() = 0.0;
}

/// 1/mm, of the path of the tip at a node; 0 at corners.
double curvature_at(const EvaluatedPass& pass, size_t node) {
  if (pass.nodes[node].corner) return 0.0;
  return 2.0 * turn_at(pass, node) / (way(pass, node - 1).norm() + way(pass, node).norm());
}

/// How unevenly the axis turns at a node, rad/mm2: between two cycles it turns evenly along a great circle,
/// so of its second derivative the part square to it is left out; 0 at corners.
double uneven_turn_at(const EvaluatedPass& pass, size_t node) {
  if (pass.nodes[node].corner) return 0.0;
  const auto axis = [&](size_t i) -> const Vec3& { return pass.nodes[i].pose.axis_W; };
  const double in = way(pass, node - 1).norm(), out = way(pass, node).norm();
  // Closer nodes, as beside creases, tell by what their places are known within (2e-5 mm), not by the axis.
  constexpr double kFar_mm = 0.2 * kEvaluationStep_mm;
  if (!(std::min(in, out) > kFar_mm)) return 0.0;
  const Vec3 bend =
      2.0 / (in + out) * ((axis(node + 1) - axis(node)) / out - (axis(node) - axis(node - 1)) / in);
  return (bend - bend.dot(axis(node)) * axis(node)).norm();
}

/// Theory 3: chord at the sampling time, and jerk cbrt(J rho^2) by a share as creases have it. The underside
/// of a tool that turns about its contact leaves its exact place by the chord of the tip and by that of the
/// axis, times how far it reaches from the tip.
void clamp_curves(const DrivenPass& pass, const MotionOptions& options, EvaluatedPass& out) {
  const double wide = pass.on->profile.radius(), reach = std::hypot(wide, pass.on->profile.height(wide));
  for (size_t cell = 0; cell < out.clamps.speed.size(); ++cell) {
    const double curvature = std::max(curvature_at(out, cell), curvature_at(out, cell + 1));
    const double turn = std::max(uneven_turn_at(out, cell), uneven_turn_at(out, cell + 1));
    const double bend = curvature + reach * turn;
    if (!(bend > 0.0)) continue;
    const double chord = chord_speed_limit(1.0 / bend, pass.chord_tolerance_mm, options.period_s);
    const double jerk = curvature > 0.0
                            ? std::cbrt(kCreaseShare * options.path_jerk_max / (curvature * curvature))
                            : kNoClamp;
    lower(out.clamps.speed[cell], out.cell_reasons[cell], std::min(chord, jerk), ClampReason::kCurvature);
  }
}

/// Axis values at the nodes; out of reach: those of the node before.
std::vector<PathNode> path_nodes(const EvaluatedPass& pass, const kinematics::InverseKinematics& inverse,
                                 const kinematics::AxisValues& hint) {
  std::vector<PathNode> nodes;
  double s = 0.0;
  for (size_t i = 0; i < pass.nodes.size(); ++i) {
    if (i > 0) s += way(pass, i - 1).norm();
    const kinematics::Branch branch =
        inverse.solve_nearest(pass.nodes[i].pose, i == 0 ? hint : nodes.back().q);
    const bool reached = branch.outcome != kinematics::InverseOutcome::kUnreachable;
    nodes.push_back({pass.nodes[i].x, s, reached ? branch.q : (i == 0 ? hint : nodes.back().q),
                     pass.nodes[i].corner, reached});
  }
  return nodes;
}

/// q' over each cell; q'' at each node and q''' over each cell of one axis, none across corners.
struct AxisRates {
  std::vector<double> first, second, third;
};

AxisRates axis_rates(const std::vector<PathNode>& nodes, Eigen::Index axis) {
  AxisRates rates{std::vector<double>(nodes.size() - 1, 0.0), std::vector<double>(nodes.size(), 0.0),
                  std::vector<double>(nodes.size() - 1, 0.0)};
  const auto size = [&](size_t cell) { return nodes[cell + 1].s - nodes[cell].s; };
  for (size_t i = 0; i + 1 < nodes.size(); ++i)
    if (size(i) > 0.0) rates.first[i] = (nodes[i + 1].q[axis] - nodes[i].q[axis]) / size(i);
  for (size_t i = 1; i + 1 < nodes.size(); ++i)
    if (!nodes[i].corner && size(i - 1) + size(i) > 0.0)
      rates.second[i] = 2.0 * (rates.first[i] - rates.first[i - 1]) / (size(i - 1) + size(i));
  for (size_t i = 0; i + 1 < nodes.size(); ++i)
    if (!nodes[i].corner && !nodes[i + 1].corner && size(i) > 0.0)
      rates.third[i] = (rates.second[i + 1] - rates.second[i]) / size(i);
  return rates;
}

/// A rotary axis q(s) takes the jerk q''' v^3 + 3 q'' v a + q' j: a third of its limit for each of them. The
/// jerk of linear axes is that of the path.
void clamp_by_rotary_jerk(const std::vector<PathNode>& nodes, const kinematics::MachineModel& machine,
                          EvaluatedPass& out) {
  constexpr double kThird = 1.0 / 3.0;
  for (size_t n = 0; n < machine.axes.size(); ++n) {
    if (machine.axes[n].kind != kinematics::AxisKind::kRotary) continue;
    const double share = kThird * kPlannedJerk * machine.axes[n].jerk_max;
    const AxisRates rates = axis_rates(nodes, static_cast<Eigen::Index>(n));
    // Division by zero gives infinity: an axis at rest limits nothing.
    for (const double first : rates.first)
      out.limits.jerk = std::min(out.limits.jerk, share / std::abs(first));
    for (size_t i = 0; i < out.clamps.speed.size(); ++i) {
      const double second = std::max(std::abs(rates.second[i]), std::abs(rates.second[i + 1]));
      lower(out.clamps.speed[i], out.cell_reasons[i],
            std::min(std::cbrt(share / std::abs(rates.third[i])),
                     share / (3.0 * second * out.limits.acceleration)),
            ClampReason::kAxes);
    }
  }
}

void clamp_cells(const DrivenPass& pass, const kinematics::MachineModel& machine,
                 const kinematics::InverseKinematics& inverse, const MotionOptions& options,
                 const kinematics::AxisValues& hint, EvaluatedPass& out) {
  const std::vector<PathNode> nodes = path_nodes(out, inverse, hint);
  SpeedLimits limits = uniform_limits(nodes, pass.feed_mm_s, kPlanned * options.path_acceleration_max);
  clamp_by_axes(nodes, machine, limits);
  out.limits = {*std::min_element(limits.acceleration.begin(), limits.acceleration.end()),
                kPlannedJerk * options.path_jerk_max};
  out.clamps.s = limits.s;
  out.clamps.speed = limits.speed;
  out.cell_reasons.assign(limits.speed.size(), ClampReason::kNone);
  for (size_t i = 0; i < limits.speed.size(); ++i)
    if (limits.speed[i] < pass.feed_mm_s) out.cell_reasons[i] = ClampReason::kAxes;
  clamp_by_rotary_jerk(nodes, machine, out);
  clamp_curves(pass, options, out);
}

}  // namespace

const char* clamp_reason_name(ClampReason reason) {
  switch (reason) {
    case ClampReason::kNone:
      return "none";
    case ClampReason::kCurvature:
      return "curvature";
    case ClampReason::kAxes:
      return "axes";
    case ClampReason::kCrease:
      return "crease";
    case ClampReason::kStep:
      return "step";
  }
  return "none";
}

EvaluatedPass evaluate_ahead(const DrivenPass& pass, const kinematics::MachineModel& machine,
                             const kinematics::InverseKinematics& inverse, const MotionOptions& options,
                             const kinematics::AxisValues& hint) {
  Lines source(pass);
  std::vector<Line> lines = source.even();
  refine(pass, source, least_crease(pass, options), lines);
  EvaluatedPass out;
  add_nodes(apart(places_of(lines)), out);
  out.positions = source.positions;
  clamp_cells(pass, machine, inverse, options, hint, out);
  clamp_nodes(pass, options, out);
  return out;
}

}  // namespace swarf::motion
