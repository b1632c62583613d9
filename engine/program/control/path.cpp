// From a target to segments: what the words of a motion block mean where the machine stands now.
#include "program/control/path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/units.h"
#include "kinematics/reach.h"
#include "program/control/corner.h"
#include "program/control/cycles.h"
#include "program/control/emit.h"
#include "program/control/tools.h"

namespace swarf::program::nc {
namespace {

constexpr uint8_t kLinearBits = 0x07;
/// Rotary ways below this are rounding.
constexpr double kNoTurn = 1e-12;

bool lost(const std::array<double, kAxisWords>& value) {
  return std::any_of(value.begin(), value.end(), [](double x) { return !std::isfinite(x); });
}

/// Where a block goes, in full.
struct Goal {
  Vec3 p = Vec3::Zero();
  std::array<double, 3> rotary{};      ///< machine values of A B C
  std::array<double, 3> programmed{};  ///< program values of A B C
  bool turns = false;                  ///< a rotary axis moves
};

void check_axes(const Control& control, const Target& target) {
  for (int word = 3; word < kAxisWords; ++word) {
    if (target.has(word)) require_axis(control, static_cast<AxisWord>(word), target.column);
  }
  if (lost(target.value)) {
    control.report.fail("out-of-range", target.column, "a coordinate is not a finite number",
                        "write a number that a machine can reach");
  }
}

double rotary_goal(const PathState& path, const Target& target, int slot) {
  const size_t word = static_cast<size_t>(slot) + 3;
  const double now = path.position[word];
  if (!target.has(slot + 3)) return now;
  const double value = target.value[word];
  if (target.is_incremental(slot + 3)) return now + value;
  const double ahead = value - now - kTurn * std::floor((value - now) / kTurn);  // [0, 2 pi)
  switch (target.way[static_cast<size_t>(slot)]) {
    case RotaryWay::kAsWritten:
      return value;
    case RotaryWay::kShortest:
      return now + (ahead > kPi ? ahead - kTurn : ahead);
    case RotaryWay::kPositive:
      return now + ahead;
    case RotaryWay::kNegative:
      return now + (ahead > kNoTurn ? ahead - kTurn : 0.0);
  }
  return value;
}

void count_unwinding(Report& report, PathState& path, int slot, double turn) {
  const char axis = kAxisLetters[slot + 3];
  const std::string code = fmt::format("rotary-unwinds-{}", static_cast<char>(axis - 'A' + 'a'));
  ++path.unwound[slot];
  report.warn_once(
      code.c_str(), 0,
      fmt::format("{} turns by {:.3f} degrees in one block, as written", axis, deg_from_rad(turn)),
      "program the shorter way if that is meant");
}

void solve_vector(Control& control, const Target& target, Goal& goal) {
  const double length = target.axis_P->norm();
  if (control.offsets.tcp == Tcp::kOff) {
    control.report.fail("vector-without-tcp", target.column, "a tool vector is programmed while TCP is off",
                        "switch TCP on before it");
  }
  if (!(length > 1e-9) || !std::isfinite(length)) {
    control.report.fail("bad-vector", target.column, "the tool vector has no length",
                        "give a vector that is not zero");
  }
  const Pose X_WP = control.space.X_WP();
  const Vec3 axis_W = X_WP.linear() * (*target.axis_P / length);
  const double gauge = control.setup.machine.gauge_M ? control.space.length() : 0.0;
  const kinematics::Branch branch =
      control.space.inverse().solve_nearest({X_WP * goal.p + gauge * axis_W, axis_W}, control.path.q);
  if (branch.outcome == kinematics::InverseOutcome::kUnreachable) {
    const auto [text, fix] = kinematics::unreachable_text(control.setup.machine, {X_WP * goal.p, axis_W});
    control.report.fail("unreachable-orientation", target.column, text, fix);
  }
  const std::array<double, 3> before = goal.rotary;
  goal.rotary = control.space.rotary_of(branch.q);
  for (size_t i = 0; i < 3; ++i) {
    goal.programmed[i] = goal.rotary[i] - control.space.rotary_zero(static_cast<int>(i));
    if (std::abs(goal.rotary[i] - before[i]) > kNoTurn) goal.turns = true;
  }
}

Goal resolve(Control& control, const Target& target) {
  refresh_position(control.space, control.path);
  Goal goal;
  for (int i = 0; i < 3; ++i) {
    const double now = control.path.position[static_cast<size_t>(i)],
                 value = target.value[static_cast<size_t>(i)];
    goal.p[i] = !target.has(i) ? now : target.is_incremental(i) ? now + value : value;
    const auto slot = static_cast<size_t>(i);
    goal.programmed[slot] = rotary_goal(control.path, target, i);
    const double turn = goal.programmed[slot] - control.path.position[slot + 3];
    goal.rotary[slot] = goal.programmed[slot] + control.space.rotary_zero(i);
    if (control.space.axis_of(static_cast<AxisWord>(i + 3)) < 0) goal.rotary[slot] = 0.0;
    if (std::abs(turn) > kNoTurn) goal.turns = true;
    if (std::abs(turn) > kPi + kNoTurn) count_unwinding(control.report, control.path, i, turn);
  }
  if (target.axis_P) solve_vector(control, target, goal);
  return goal;
}

bool learn_linear(Control& control, const Target& target, bool machine) {
  const uint8_t linear = target.given & kLinearBits;
  if (linear == 0) return true;
  if ((target.incremental & linear & ~control.path.known) != 0) return false;
  refresh_position(control.space, control.path);
  Vec3 p = position_xyz(control);
  for (int i = 0; i < 3; ++i) {
    const double value = target.value[static_cast<size_t>(i)];
    if (target.has(i)) p[i] = target.is_incremental(i) ? p[i] + value : value;
  }
  const bool each_alone = machine || (control.space.coordinates() == Coordinates::kAxes &&
                                      control.space.frame().linear().isIdentity(0.0));
  const uint8_t rotary_missing = [&] {
    uint8_t bits = 0;
    for (int word = 3; word < kAxisWords; ++word) {
      if (control.space.axis_of(static_cast<AxisWord>(word)) >= 0)
        bits = static_cast<uint8_t>(bits | (1u << word));
    }
    return static_cast<uint8_t>(bits & ~control.path.known);
  }();
  if (!each_alone) {
    const uint8_t have = static_cast<uint8_t>(linear | (control.path.known & kLinearBits));
    if (have != kLinearBits || (control.space.coordinates() == Coordinates::kWork && rotary_missing != 0))
      return false;
  }
  const Vec3 finite_p = p.unaryExpr([](double x) { return std::isfinite(x) ? x : 0.0; });
  const Vec3 value =
      machine ? finite_p
              : control.space.linear_from_program(finite_p, control.space.rotary_of(control.path.q));
  for (int i = 0; i < 3; ++i) {
    if (each_alone ? target.has(i) : true)
      control.path.q[control.space.axis_of(static_cast<AxisWord>(i))] = value[i];
  }
  control.path.known = static_cast<uint8_t>(control.path.known | (each_alone ? linear : kLinearBits));
  return true;
}

bool ready(Control& control, Motion motion, const Target& target, bool machine) {
  if (control.path.started) return true;
  if (control.path.first_motion.line == 0) control.path.first_motion = control.report.place;
  for (int slot = 0; slot < 3; ++slot) {
    const int word = slot + 3, axis = control.space.axis_of(static_cast<AxisWord>(word));
    if (!target.has(word)) continue;
    if (target.is_incremental(word) && (control.path.known >> word & 1u) == 0) {
      control.report.fail(
          "start-unknown", target.column,
          fmt::format("{} is programmed incrementally, and where it stands is not known", kAxisLetters[word]),
          "give the start position: start in [setup] of the scene, swarf check --home");
    }
    const double value = target.value[static_cast<size_t>(word)];
    control.path.q[axis] = target.is_incremental(word) ? control.path.q[axis] + value
                           : machine                   ? value
                                                       : value + control.space.rotary_zero(slot);
    control.path.known = static_cast<uint8_t>(control.path.known | (1u << word));
  }
  if (target.axis_P || motion == Motion::kClockwise || motion == Motion::kCounterClockwise ||
      !learn_linear(control, target, machine)) {
    control.report.fail("start-unknown", target.column,
                        fmt::format("this block needs the position before it, and {} is not known yet",
                                    missing_axes(control.space, control.path)),
                        fmt::format("give the start position (start in [setup] of the scene, swarf check "
                                    "--home), or position all axes with absolute {} blocks before it",
                                    control.report.words.rapid));
  }
  const std::string missing = missing_axes(control.space, control.path);
  if (missing.empty()) {
    start_here(control, fmt::format("the first complete position, in line {} of the program",
                                    control.report.place.line));
    return false;
  }
  if (motion == Motion::kFeed) {
    control.report.fail("start-unknown", target.column,
                        fmt::format("this is a feed move, and {} has no position yet", missing),
                        fmt::format("give the start position (start in [setup] of the scene, swarf check "
                                    "--home), or position all axes with {} before it",
                                    control.report.words.rapid));
  }
  return false;
}

void arrive(ModalState& modal, PathState& path, const Goal& goal) {
  for (size_t i = 0; i < 3; ++i) {
    path.position[i] = goal.p[static_cast<long>(i)];
    path.position[i + 3] = goal.programmed[i];
  }
  modal.feed_fresh = false;
}

void place_circle(const Report& report, const ModalState& modal, Motion motion, const ArcWords& words,
                  Segment& segment) {
  const Vec3 normal = words.normal ? words.normal->normalized() : Vec3::Unit(axes_of(modal.plane).normal);
  segment.normal = motion == Motion::kClockwise ? Vec3(-normal) : normal;
  segment.motion = motion;
  const auto flat = [&](const Vec3& v) { return Vec3(v - v.dot(normal) * normal); };
  const Vec3 chord = flat(segment.to - segment.from);
  if (!words.centre) {
    const double half = 0.5 * chord.norm(), radius = std::abs(words.radius);
    if (!(radius > 0.0) || !(half > 0.0)) {
      report.fail("bad-arc", words.column,
                  half > 0.0 ? "the arc has no radius"
                             : "an arc by radius ends where it starts: its centre is anywhere",
                  fmt::format("give the centre of a whole circle with {}", report.words.centre));
    }
    if (half > radius + words.radius_tolerance_mm) {
      report.fail("bad-arc", words.column,
                  fmt::format("the ends are {:.4f} mm apart, more than the diameter {:.4f} mm", 2.0 * half,
                              2.0 * radius),
                  "correct the radius or the end of the arc");
    }
    const double height = std::sqrt(std::max(0.0, radius * radius - half * half));
    const Vec3 left = segment.normal.cross(chord.normalized());
    segment.centre = segment.from + 0.5 * chord + (words.radius > 0.0 ? height : -height) * left;
    return;
  }
  segment.centre = segment.from - flat(segment.from - *words.centre);
  const double r_from = flat(segment.from - segment.centre).norm();
  const double r_to = flat(segment.to - segment.centre).norm();
  if (!(std::abs(r_from - r_to) <= words.radius_tolerance_mm)) {
    report.fail("bad-arc", words.column,
                fmt::format("the start is {:.4f} mm from the centre, the end {:.4f} mm", r_from, r_to),
                "correct the centre or the end of the arc");
  }
  if (!(r_from > 1e-9) || !(r_to > 1e-9)) {
    report.fail("bad-arc", words.column, "the arc has a radius of zero",
                fmt::format("give the centre with {}, or a radius", report.words.centre));
  }
}

void turning_arc(Control& control, Motion motion, const ArcWords& words, const Goal& goal) {
  Segment circle;
  circle.place = control.report.place;
  circle.from = position_xyz(control);
  circle.to = goal.p;
  circle.further_turns = words.further_turns;
  place_circle(control.report, control.modal, motion, words, circle);
  const std::array<double, kAxisWords>& here = position(control);
  TurningArc::Rotaries from, to;
  for (size_t slot = 0; slot < 3; ++slot) {
    if (control.space.axis_of(static_cast<AxisWord>(slot + 3)) < 0) continue;
    from[slot] = here[slot + 3];
    to[slot] = goal.programmed[slot];
  }
  curve(control, TurningArc(circle, swept(circle) + kTurn * circle.further_turns, from, to),
        kCurveToleranceMm);
}

}  // namespace

std::string missing_axes(const WorkSpace& space, const PathState& path) {
  std::string names;
  for (int word = 0; word < kAxisWords; ++word) {
    const bool there = space.axis_of(static_cast<AxisWord>(word)) >= 0;
    if (there && (path.known >> word & 1u) == 0)
      names += fmt::format("{}{}", names.empty() ? "" : " ", kAxisLetters[word]);
  }
  return names;
}

void start_here(Control& control, const std::string& how) {
  control.path.started = true;
  control.path.position_valid = false;
  std::string values;
  for (int word = 0; word < kAxisWords; ++word) {
    const int axis = control.space.axis_of(static_cast<AxisWord>(word));
    if (axis < 0) continue;
    values += word < 3 ? fmt::format(" {}{:.4f}", kAxisLetters[word], control.path.q[axis])
                       : fmt::format(" {}{:.4f}deg", kAxisLetters[word], deg_from_rad(control.path.q[axis]));
  }
  control.report.summary.start = fmt::format("machine position{}: {}", values, how);
  set_true_tool(control);
}

void prepare(Report& report, ModalState& modal, Motion motion, const Target& target, Segment& segment) {
  segment.motion = motion;
  segment.place = report.place;
  if (target.column > 0) segment.place.column = target.column;
  segment.feed = modal.feed;
  segment.feed_unit_mm = modal.feed_unit_mm;
  segment.feed_mode = modal.feed_mode;
  segment.corner_tolerance_mm = modal.corner_tolerance_mm;
  segment.exact_stop = modal.exact_stop || modal.exact_stop_once;
  segment.spindle_rpm = modal.spindle * modal.speed_rpm;
  segment.dwell_s = modal.pending_dwell_s;
  modal.pending_dwell_s = 0.0;
  modal.exact_stop_once = false;
  if (motion == Motion::kRapid) return;
  const bool inverse = modal.feed_mode == FeedMode::kInverseTime;
  if (modal.feed <= 0.0 || (inverse && !modal.feed_fresh)) {
    report.fail("missing-feed", segment.place.column,
                inverse ? "G93 wants F in each feed block, and this one has none"
                        : "this feed move has no F here or before",
                inverse ? "add F, 1/min: one over the minutes that the block takes" : "add the feed: F1000");
  }
  if (modal.feed_mode == FeedMode::kPerRevolution && segment.spindle_rpm == 0.0) {
    report.fail(
        "feed-without-spindle", segment.place.column,
        fmt::format("the feed is per revolution ({}), and the spindle stands", report.words.per_revolution),
        fmt::format("start the spindle before it: {}", report.words.spindle_on));
  }
}

void line(Control& control, Motion motion, const Target& target) {
  check_axes(control, target);
  if (!ready(control, motion, target, false)) return;
  Segment segment;
  prepare(control.report, control.modal, motion, target, segment);
  const Goal goal = resolve(control, target);
  segment.from = position_xyz(control);
  segment.to = goal.p;
  segment.rotary_from = control.space.rotary_of(control.path.q);
  segment.rotary_to = goal.rotary;
  segment.turns_rotaries = goal.turns;
  take_piece(control, segment);
  arrive(control.modal, control.path, goal);
}

void machine_line(Control& control, Motion motion, const Target& target) {
  check_axes(control, target);
  if (control.contour.side() != Compensation::kOff) {
    control.report.fail("compensation-active", target.column,
                        "a move in machine coordinates while cutter compensation is on",
                        fmt::format("switch it off first: {}", control.report.words.compensation_off));
  }
  flush(control);
  if (!ready(control, motion, target, true)) return;
  Segment segment;
  prepare(control.report, control.modal, motion, target, segment);
  segment.machine = true;
  segment.from = segment.to = control.space.linear_of(control.path.q);
  segment.rotary_from = segment.rotary_to = control.space.rotary_of(control.path.q);
  for (int i = 0; i < 3; ++i) {
    const auto slot = static_cast<size_t>(i);
    const double linear = target.value[slot], rotary = target.value[slot + 3];
    if (target.has(i)) segment.to[i] = target.is_incremental(i) ? segment.to[i] + linear : linear;
    if (target.has(i + 3))
      segment.rotary_to[slot] = target.is_incremental(i + 3) ? segment.rotary_to[slot] + rotary : rotary;
    if (std::abs(segment.rotary_to[slot] - segment.rotary_from[slot]) > kNoTurn)
      segment.turns_rotaries = true;
  }
  emit(control, segment);
  control.path.position_valid = false;
  control.modal.feed_fresh = false;
}

void arc(Control& control, Motion motion, const Target& target, const ArcWords& words) {
  check_axes(control, target);
  if (!ready(control, motion, target, false)) return;
  const Goal goal = resolve(control, target);
  if (goal.turns && control.offsets.tcp == Tcp::kOff) return turning_arc(control, motion, words, goal);
  Segment segment;
  prepare(control.report, control.modal, motion, target, segment);
  segment.from = position_xyz(control);
  segment.to = goal.p;
  segment.rotary_from = control.space.rotary_of(control.path.q);
  segment.rotary_to = goal.rotary;
  segment.turns_rotaries = goal.turns;
  segment.further_turns = words.further_turns;
  place_circle(control.report, control.modal, motion, words, segment);
  take_piece(control, segment);
  arrive(control.modal, control.path, goal);
}

}  // namespace swarf::program::nc
