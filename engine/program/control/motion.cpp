// From a target to segments: what the words of a motion block mean where the machine stands now.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "kinematics/reach.h"
#include "program/control/contour.h"
#include "program/control/control.h"

namespace swarf::program::nc {
namespace {

constexpr double kTurn = 2.0 * kPi;
constexpr uint8_t kLinearBits = 0x07;
/// Rotary ways below this are rounding.
constexpr double kNoTurn = 1e-12;

bool lost(const std::array<double, kAxisWords>& value) {
  return std::any_of(value.begin(), value.end(), [](double x) { return !std::isfinite(x); });
}

}  // namespace

void Control::check_axes(const Target& target) const {
  for (int word = 3; word < kAxisWords; ++word) {
    if (target.has(word)) require_axis(static_cast<AxisWord>(word), target.column);
  }
  if (lost(target.value)) {
    fail("out-of-range", target.column, "a coordinate is not a finite number",
         "write a number that a machine can reach");
  }
}

double Control::rotary_goal(const Target& target, int slot) const {
  const size_t word = static_cast<size_t>(slot) + 3;
  const double now = position_[word];
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

Control::Goal Control::resolve(const Target& target) {
  refresh_position();
  Goal goal;
  for (int i = 0; i < 3; ++i) {
    const double now = position_[static_cast<size_t>(i)], value = target.value[static_cast<size_t>(i)];
    goal.p[i] = !target.has(i) ? now : target.is_incremental(i) ? now + value : value;
    const auto slot = static_cast<size_t>(i);
    goal.programmed[slot] = rotary_goal(target, i);
    const double turn = goal.programmed[slot] - position_[slot + 3];
    goal.rotary[slot] = goal.programmed[slot] + space_.rotary_zero(i);
    if (axis_of(static_cast<AxisWord>(i + 3)) < 0) goal.rotary[slot] = 0.0;
    if (std::abs(turn) > kNoTurn) goal.turns = true;
    if (std::abs(turn) > kPi + kNoTurn) count_unwinding(i, turn);
  }
  if (target.axis_P) solve_vector(target, goal);
  return goal;
}

void Control::solve_vector(const Target& target, Goal& goal) {
  const double length = target.axis_P->norm();
  if (tcp_ == Tcp::kOff) {
    fail("vector-without-tcp", target.column, "a tool vector is programmed while TCP is off",
         "switch TCP on before it");
  }
  if (!(length > 1e-9) || !std::isfinite(length)) {
    fail("bad-vector", target.column, "the tool vector has no length", "give a vector that is not zero");
  }
  const Pose X_WP = space_.X_WP();
  const Vec3 axis_W = X_WP.linear() * (*target.axis_P / length);
  const double gauge = setup_.machine.gauge_M ? space_.length() : 0.0;
  const kinematics::Branch branch =
      space_.inverse().solve_nearest({X_WP * goal.p + gauge * axis_W, axis_W}, q_);
  if (branch.outcome == kinematics::InverseOutcome::kUnreachable) {
    const auto [text, fix] = kinematics::unreachable_text(setup_.machine, {X_WP * goal.p, axis_W});
    fail("unreachable-orientation", target.column, text, fix);
  }
  const std::array<double, 3> before = goal.rotary;
  goal.rotary = space_.rotary_of(branch.q);
  for (size_t i = 0; i < 3; ++i) {
    goal.programmed[i] = goal.rotary[i] - space_.rotary_zero(static_cast<int>(i));
    if (std::abs(goal.rotary[i] - before[i]) > kNoTurn) goal.turns = true;
  }
}

void Control::count_unwinding(int slot, double turn) {
  const char axis = kAxisLetters[slot + 3];
  const std::string code = fmt::format("rotary-unwinds-{}", static_cast<char>(axis - 'A' + 'a'));
  ++unwound_[slot];
  warn_once(code.c_str(), 0,
            fmt::format("{} turns by {:.3f} degrees in one block, as written", axis, deg_from_rad(turn)),
            "program the shorter way if that is meant");
}

// --- The start
// -----------------------------------------------------------------------------------------------

std::string Control::missing_axes() const {
  std::string names;
  for (int word = 0; word < kAxisWords; ++word) {
    const bool there = axis_of(static_cast<AxisWord>(word)) >= 0;
    if (there && (known_ >> word & 1u) == 0)
      names += fmt::format("{}{}", names.empty() ? "" : " ", kAxisLetters[word]);
  }
  return names;
}

void Control::start_here(const std::string& how) {
  started_ = true;
  position_valid_ = false;
  std::string values;
  for (int word = 0; word < kAxisWords; ++word) {
    const int axis = axis_of(static_cast<AxisWord>(word));
    if (axis < 0) continue;
    values += word < 3 ? fmt::format(" {}{:.4f}", kAxisLetters[word], q_[axis])
                       : fmt::format(" {}{:.4f}deg", kAxisLetters[word], deg_from_rad(q_[axis]));
  }
  summary_.start = fmt::format("machine position{}: {}", values, how);
  set_true_tool();
}

bool Control::learn_linear(const Target& target, bool machine) {
  const uint8_t linear = target.given & kLinearBits;
  if (linear == 0) return true;
  if ((target.incremental & linear & ~known_) != 0) return false;
  refresh_position();
  Vec3 p = position_xyz();
  for (int i = 0; i < 3; ++i) {
    const double value = target.value[static_cast<size_t>(i)];
    if (target.has(i)) p[i] = target.is_incremental(i) ? p[i] + value : value;
  }
  const bool each_alone =
      machine || (space_.coordinates() == Coordinates::kAxes && space_.frame().linear().isIdentity(0.0));
  const uint8_t rotary_missing = [&] {
    uint8_t bits = 0;
    for (int word = 3; word < kAxisWords; ++word) {
      if (axis_of(static_cast<AxisWord>(word)) >= 0) bits = static_cast<uint8_t>(bits | (1u << word));
    }
    return static_cast<uint8_t>(bits & ~known_);
  }();
  if (!each_alone) {
    const uint8_t have = static_cast<uint8_t>(linear | (known_ & kLinearBits));
    if (have != kLinearBits || (space_.coordinates() == Coordinates::kWork && rotary_missing != 0))
      return false;
  }
  const Vec3 finite_p = p.unaryExpr([](double x) { return std::isfinite(x) ? x : 0.0; });
  const Vec3 value = machine ? finite_p : space_.linear_from_program(finite_p, space_.rotary_of(q_));
  for (int i = 0; i < 3; ++i) {
    if (each_alone ? target.has(i) : true) q_[axis_of(static_cast<AxisWord>(i))] = value[i];
  }
  known_ = static_cast<uint8_t>(known_ | (each_alone ? linear : kLinearBits));
  return true;
}

bool Control::ready(Motion motion, const Target& target, bool machine) {
  if (started_) return true;
  if (first_motion_.line == 0) first_motion_ = place_;
  for (int slot = 0; slot < 3; ++slot) {
    const int word = slot + 3, axis = axis_of(static_cast<AxisWord>(word));
    if (!target.has(word)) continue;
    if (target.is_incremental(word) && (known_ >> word & 1u) == 0) {
      fail(
          "start-unknown", target.column,
          fmt::format("{} is programmed incrementally, and where it stands is not known", kAxisLetters[word]),
          "give the start position in the scene");
    }
    const double value = target.value[static_cast<size_t>(word)];
    q_[axis] = target.is_incremental(word) ? q_[axis] + value
               : machine                   ? value
                                           : value + space_.rotary_zero(slot);
    known_ = static_cast<uint8_t>(known_ | (1u << word));
  }
  if (target.axis_P || motion == Motion::kClockwise || motion == Motion::kCounterClockwise ||
      !learn_linear(target, machine)) {
    fail("start-unknown", target.column,
         fmt::format("this block needs the position before it, and {} is not known yet", missing_axes()),
         fmt::format(
             "give the start position in the scene, or position all axes with absolute {} blocks before it",
             words_.rapid));
  }
  const std::string missing = missing_axes();
  if (missing.empty()) {
    start_here(fmt::format("the first complete position, in line {} of the program", place_.line));
    return false;
  }
  if (motion == Motion::kFeed) {
    fail("start-unknown", target.column,
         fmt::format("this is a feed move, and {} has no position yet", missing),
         fmt::format("give the start position in the scene, or position all axes with {} before it",
                     words_.rapid));
  }
  return false;
}

// --- Motion
// --------------------------------------------------------------------------------------------------

void Control::prepare(Motion motion, const Target& target, Segment& segment) {
  segment.motion = motion;
  segment.place = place_;
  if (target.column > 0) segment.place.column = target.column;
  segment.feed = feed_;
  segment.feed_unit_mm = feed_unit_mm_;
  segment.feed_mode = feed_mode_;
  segment.corner_tolerance_mm = corner_tolerance_mm_;
  segment.exact_stop = exact_stop_ || exact_stop_once_;
  segment.spindle_rpm = spindle_ * speed_rpm_;
  segment.dwell_s = pending_dwell_s_;
  pending_dwell_s_ = 0.0;
  exact_stop_once_ = false;
  if (motion == Motion::kRapid) return;
  const bool inverse = feed_mode_ == FeedMode::kInverseTime;
  if (feed_ <= 0.0 || (inverse && !feed_fresh_)) {
    fail("missing-feed", segment.place.column,
         inverse ? "G93 wants F in each feed block, and this one has none"
                 : "this feed move has no F here or before",
         inverse ? "add F, 1/min: one over the minutes that the block takes" : "add the feed: F1000");
  }
  if (feed_mode_ == FeedMode::kPerRevolution && segment.spindle_rpm == 0.0) {
    fail("feed-without-spindle", segment.place.column,
         fmt::format("the feed is per revolution ({}), and the spindle stands", words_.per_revolution),
         fmt::format("start the spindle before it: {}", words_.spindle_on));
  }
}

void Control::arrive(const Goal& goal) {
  for (size_t i = 0; i < 3; ++i) {
    position_[i] = goal.p[static_cast<long>(i)];
    position_[i + 3] = goal.programmed[i];
  }
  feed_fresh_ = false;
}

void Control::take(Segment& segment) {
  if (contour_->side() == Compensation::kOff && !contour_->leading_out()) {
    emit(segment);
  } else {
    contour_->add(segment);
  }
}

void Control::line(Motion motion, const Target& target) {
  check_axes(target);
  if (!ready(motion, target, false)) return;
  Segment segment;
  prepare(motion, target, segment);
  const Goal goal = resolve(target);
  segment.from = position_xyz();
  segment.to = goal.p;
  segment.rotary_from = space_.rotary_of(q_);
  segment.rotary_to = goal.rotary;
  segment.turns_rotaries = goal.turns;
  take(segment);
  arrive(goal);
}

void Control::machine_line(Motion motion, const Target& target) {
  check_axes(target);
  if (compensation() != Compensation::kOff) {
    fail("compensation-active", target.column,
         "a move in machine coordinates while cutter compensation is on",
         fmt::format("switch it off first: {}", words_.compensation_off));
  }
  flush();
  if (!ready(motion, target, true)) return;
  Segment segment;
  prepare(motion, target, segment);
  segment.machine = true;
  segment.from = segment.to = space_.linear_of(q_);
  segment.rotary_from = segment.rotary_to = space_.rotary_of(q_);
  for (int i = 0; i < 3; ++i) {
    const auto slot = static_cast<size_t>(i);
    const double linear = target.value[slot], rotary = target.value[slot + 3];
    if (target.has(i)) segment.to[i] = target.is_incremental(i) ? segment.to[i] + linear : linear;
    if (target.has(i + 3))
      segment.rotary_to[slot] = target.is_incremental(i + 3) ? segment.rotary_to[slot] + rotary : rotary;
    if (std::abs(segment.rotary_to[slot] - segment.rotary_from[slot]) > kNoTurn)
      segment.turns_rotaries = true;
  }
  emit(segment);
  position_valid_ = false;
  feed_fresh_ = false;
}

void Control::arc(Motion motion, const Target& target, const ArcWords& words) {
  check_axes(target);
  if (!ready(motion, target, false)) return;
  const Goal goal = resolve(target);
  if (goal.turns && tcp_ == Tcp::kOff) return turning_arc(motion, words, goal);
  Segment segment;
  prepare(motion, target, segment);
  segment.from = position_xyz();
  segment.to = goal.p;
  segment.rotary_from = space_.rotary_of(q_);
  segment.rotary_to = goal.rotary;
  segment.turns_rotaries = goal.turns;
  segment.further_turns = words.further_turns;
  place_circle(motion, words, segment);
  take(segment);
  arrive(goal);
}

void Control::turning_arc(Motion motion, const ArcWords& words, const Goal& goal) {
  Segment circle;
  circle.place = place_;
  circle.from = position_xyz();
  circle.to = goal.p;
  circle.further_turns = words.further_turns;
  place_circle(motion, words, circle);
  const std::array<double, kAxisWords>& here = position();
  TurningArc::Rotaries from, to;
  for (size_t slot = 0; slot < 3; ++slot) {
    if (axis_of(static_cast<AxisWord>(slot + 3)) < 0) continue;
    from[slot] = here[slot + 3];
    to[slot] = goal.programmed[slot];
  }
  curve(TurningArc(circle, swept(circle) + kTurn * circle.further_turns, from, to), kCurveToleranceMm);
}

void Control::place_circle(Motion motion, const ArcWords& words, Segment& segment) const {
  const Vec3 normal = words.normal ? words.normal->normalized() : Vec3::Unit(axes_of(plane_).normal);
  segment.normal = motion == Motion::kClockwise ? Vec3(-normal) : normal;
  segment.motion = motion;
  const auto flat = [&](const Vec3& v) { return Vec3(v - v.dot(normal) * normal); };
  const Vec3 chord = flat(segment.to - segment.from);
  if (!words.centre) {
    const double half = 0.5 * chord.norm(), radius = std::abs(words.radius);
    if (!(radius > 0.0) || !(half > 0.0)) {
      fail("bad-arc", words.column,
           half > 0.0 ? "the arc has no radius"
                      : "an arc by radius ends where it starts: its centre is anywhere",
           fmt::format("give the centre of a whole circle with {}", words_.centre));
    }
    if (half > radius + words.radius_tolerance_mm) {
      fail("bad-arc", words.column,
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
    fail("bad-arc", words.column,
         fmt::format("the start is {:.4f} mm from the centre, the end {:.4f} mm", r_from, r_to),
         "correct the centre or the end of the arc");
  }
  if (!(r_from > 1e-9) || !(r_to > 1e-9)) {
    fail("bad-arc", words.column, "the arc has a radius of zero",
         fmt::format("give the centre with {}, or a radius", words_.centre));
  }
}

void Control::finish() {
  flush();
  if (!started_ && first_motion_.line > 0) {
    place_ = first_motion_;
    fail("no-start", 0,
         fmt::format("the program never gives {} a position, and the scene gives no start", missing_axes()),
         "give the start position in the scene");
  }
  if (pending_dwell_s_ > 0.0 && started_) {
    Segment stand;
    prepare(Motion::kRapid, Target(), stand);
    stand.machine = true;
    stand.from = stand.to = space_.linear_of(q_);
    stand.rotary_from = stand.rotary_to = space_.rotary_of(q_);
    emit(stand);
  }
  for (int slot = 0; slot < 3; ++slot) {
    if (unwound_[slot] > 0) {
      diagnostics_.note("rotary-unwinds", {summary_.files.empty() ? "" : summary_.files[0]},
                        fmt::format("{} turned by more than half a turn in {} block(s), as written",
                                    kAxisLetters[slot + 3], unwound_[slot]));
    }
  }
}

}  // namespace swarf::program::nc
