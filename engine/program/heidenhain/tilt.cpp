// How PLANE turns the rotary axes into the tilted plane: MOVE, TURN, STAY.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/units.h"
#include "kinematics/model_check.h"
#include "program/heidenhain/steps.h"

namespace swarf::program::nc::heidenhain {

using nc::Motion;

namespace {

/// The rotary axis next to the work is parallel to the tool: COORD ROT leaves it where it is, TABLE ROT does
/// not. Elsewhere both words mean the same.
bool rotary_is_free(nc::Control& control, const kinematics::AxisValues& q) {
  const kinematics::MachineModel& machine = control.setup.machine;
  kinematics::AxisValues turned_on = q;
  turned_on[kinematics::rotary_order(machine).front()] += 1.0;
  const Vec3 before = kinematics::forward(machine, q).axis_W;
  return (kinematics::forward(machine, turned_on).axis_W - before).norm() < 1e-9;
}

/// TABLE ROT: the table that turns about the tool does it until the machine's X, in the work, is that of the
/// plane. The nearest such value.
void turn_free_table(const nc::Control& control, BlockReader& reader, kinematics::AxisValues& q,
                     size_t start) {
  const kinematics::MachineModel& machine = control.setup.machine;
  const int index = kinematics::rotary_order(machine).front();
  const kinematics::Axis& axis = machine.axes[static_cast<size_t>(index)];
  if (axis.side != kinematics::Side::kTable)
    reader.fail(
        "unsupported-word", start,
        fmt::format("TABLE ROT turns a table, and {}, which turns about the tool, is none", axis.name),
        "COORD ROT, or turn the axis before it");
  const Vec3 plane_x = control.space.frame().linear().col(0);
  const auto missing = [&](double value) {
    kinematics::AxisValues there = q;
    there[index] = value;
    const Vec3 tool = kinematics::forward(machine, there).axis_W;
    const Vec3 x = linear_columns_W(machine, there).col(0);
    return std::atan2(tool.dot(x.cross(plane_x)), (x - x.dot(tool) * tool).dot(plane_x));
  };
  const double off = missing(q[index]);
  double value = q[index] + off;
  if (std::abs(missing(value)) > std::abs(missing(q[index] - off))) value = q[index] - off;
  const double here = control.path.q[index];
  value += kTurn * std::round((here - value) / kTurn);
  if (value > axis.max) value -= kTurn;
  if (value < axis.min) value += kTurn;
  if (value < axis.min - kinematics::kAxisTolerance || value > axis.max + kinematics::kAxisTolerance)
    reader.fail("unreachable-orientation", start,
                fmt::format("TABLE ROT turns {} to {:.4f} degrees, beyond its travel", axis.name,
                            deg_from_rad(value)),
                "COORD ROT leaves the table where it is");
  q[index] = value;
}

/// MOVE DIST50: the point that lies this far ahead of the tip stands, on the part, while the tool turns about
/// it. Pieces of joint-linear moves, so short that the point strays from its place by less than 1 um.
void turn_about(nc::Control& control, PathState& path, const kinematics::AxisValues& goal,
                const Positioning& how) {
  const kinematics::MachineModel machine =
      kinematics::with_tool(control.setup.machine, control.space.length() + how.distance);
  nc::flush(control);
  const kinematics::AxisValues from = control.path.q;
  const Vec3 centre_W = kinematics::forward(machine, from).tip_W;
  double most = 0.0;
  for (int slot = nc::kA; slot < nc::kAxisWords; ++slot) {
    const int axis = control.space.axis_of(static_cast<nc::AxisWord>(slot));
    if (axis >= 0) most = std::max(most, std::abs(goal[axis] - from[axis]));
  }
  // Sag of a chord of the circle with radius r: r a^2 / 8; the linear axes are no further than this from any
  // axis.
  constexpr double kSagMm = 1e-3, kRadiusMm = 2000.0;
  const int pieces = std::max(1, static_cast<int>(std::ceil(most / std::sqrt(8.0 * kSagMm / kRadiusMm))));
  if (how.motion == Motion::kFeed) set_feed(control, how.feed, false);
  for (int n = 1; n <= pieces; ++n) {
    kinematics::AxisValues q = from + static_cast<double>(n) / pieces * (goal - from);
    const Vec3 off = centre_W - kinematics::forward(machine, q).tip_W;
    const Vec3 linear = linear_columns_W(machine, q).inverse() * off;
    nc::Target target;
    target.column = control.report.place.column;
    for (int word = 0; word < nc::kAxisWords; ++word) {
      const int axis = control.space.axis_of(static_cast<nc::AxisWord>(word));
      if (axis >= 0) target.set(word, q[axis] + (word < 3 ? linear[word] : 0.0), false);
    }
    nc::machine_line(control, how.motion, target);
  }
  path.tangent.reset();
}

}  // namespace

/// MOVE, TURN or STAY with DIST, F, SEQ.
Positioning positioning(nc::Control& control, Modes& modes, BlockReader& reader, size_t start) {
  Positioning how;
  how.feed = modes.feed;
  while (!reader.done()) {
    const size_t at = reader.offset();
    const std::string word(reader.take_letters());
    if (word == "MOVE" || word == "TURN" || word == "STAY") {
      if (!how.kind.empty())
        reader.fail("words-conflict", at, fmt::format("{} and {} in one block", how.kind, word),
                    "keep one of them");
      how.kind = word;
    } else if (word == "SEQ") {
      if (!reader.take_char('+') && reader.peek() != '-')
        reader.fail("missing-word", at, fmt::format("{} has no sign", word),
                    fmt::format("{0}+ or {0}-", word));
      how.preference.choice = reader.take_char('-') ? nc::TiltPreference::Choice::kNegative
                                                    : nc::TiltPreference::Choice::kPositive;
    } else if (word == "DIST" || word == "ABST") {
      how.distance = control.modal.mm(reader.value());
      how.distance_offset = at;
    } else if (word == "FMAX") {
      how.motion = Motion::kRapid;
    } else if (word == "F" || word == "FAUTO") {
      if (word == "FAUTO" || reader.take("AUTO")) {
        how.feed = modes.tool_feed;
      } else if (reader.take("MAX")) {
        how.motion = Motion::kRapid;
      } else {
        how.feed = reader.value();
      }
      if (how.motion == Motion::kFeed && !(how.feed > 0.0))
        reader.fail("bad-feed", at, fmt::format("F {:g} is not a feed", how.feed), "F1000");
    } else if (word == "MB") {
      how.retracts = true;
      if (!reader.take("MAX")) how.retraction = control.modal.mm(reader.value());
      if (how.retraction && !(*how.retraction >= 0.0))
        reader.fail("out-of-range", at, "MB retracts by a way of zero or more", "MB MAX, MB50");
    } else if ((word == "COORD" || word == "TABLE") && reader.take("ROT")) {
      how.turns_table = word == "TABLE";
    } else if (word == "TABLE" || word == "COORD" || word == "SYM") {
      reader.fail("unsupported-word", at, fmt::format("{} is known, but not supported here", word),
                  "take it out");
    } else {
      refuse_word(reader, at, word.empty() ? std::string(1, reader.peek()) : word);
    }
  }
  if (how.kind.empty())
    reader.fail("missing-word", start, "PLANE says neither MOVE nor TURN nor STAY", "PLANE RESET STAY");
  if (how.distance != 0.0 && how.kind != "MOVE")
    reader.fail("unexpected-word", how.distance_offset, "DIST belongs to MOVE", "take it out");
  if (how.kind != "STAY" && how.motion == Motion::kFeed && !(how.feed > 0.0))
    reader.fail("missing-feed", start, "the rotary axes turn without F", "TURN FMAX");
  if (how.kind == "STAY" && how.retracts)
    reader.fail("unexpected-word", start, "MB belongs to MOVE and TURN", "take it out");
  return how;
}

/// Turns the rotary axes into the plane, to `goal` where the program gives their values.
void position_plane(Executor& executor, BlockReader& reader, const Positioning& how,
                    const kinematics::AxisValues* goal, size_t start) {
  const bool turns = how.kind != "STAY";
  if (executor.control.setup.machine.axes.size() <= 3) {
    if (!executor.orientation.tilt.isIdentity(1e-12))
      reader.fail("unreachable-orientation", start, "the machine has no rotary axes for a tilted plane",
                  "choose a five-axis machine");
    return;
  }
  if (!executor.control.path.started) {
    if (turns)
      reader.fail("start-unknown", start, "the rotary axes turn, and the position is not known yet",
                  "position all axes before it");
    return;
  }
  if (turns && how.retracts) {
    if (how.motion == Motion::kFeed) set_feed(executor.control, how.feed, false);
    retract_by(executor.control, executor.path, how.retraction, how.motion);
  }
  kinematics::AxisValues q = goal != nullptr
                                 ? *goal
                                 : nc::tilt_solution(executor.control, Vec3::UnitZ(), how.preference,
                                                     executor.control.report.place.column);
  for (int i = 0; i < 3; ++i) {
    const int axis = executor.control.space.axis_of(static_cast<nc::AxisWord>(i));
    q[axis] = executor.control.path.q[axis];
  }
  if (!executor.orientation.tilted) {  // PLANE RESET: all rotary axes go to zero
    for (int slot = 0; slot < 3; ++slot) {
      const int axis = executor.control.space.axis_of(static_cast<nc::AxisWord>(slot + 3));
      if (axis >= 0) q[axis] = executor.control.space.rotary_zero(slot);
    }
  }
  if (how.turns_table && executor.orientation.tilted && rotary_is_free(executor.control, q))
    turn_free_table(executor.control, reader, q, start);
  rotary_parameters(executor.control, executor.parameters, q);
  if (!turns) return;
  if (how.kind == "MOVE" && how.distance != 0.0) return turn_about(executor.control, executor.path, q, how);
  if (how.motion == Motion::kFeed) set_feed(executor.control, how.feed, true);
  nc::turn_rotaries(executor.control, how.motion, q, how.kind == "MOVE");
}

/// Q120, Q121, Q122: where A, B and C have to go, degrees.
void rotary_parameters(nc::Control& control, Parameters& parameters, const kinematics::AxisValues& values) {
  for (int slot = 0; slot < 3; ++slot) {
    const int axis = control.space.axis_of(static_cast<nc::AxisWord>(slot + 3));
    if (axis >= 0) parameters.set_q(120 + slot, deg_from_rad(values[axis] - control.space.rotary_zero(slot)));
  }
}

}  // namespace swarf::program::nc::heidenhain
