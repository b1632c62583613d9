// Tools, blanks and M functions of Heidenhain programs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/units.h"
#include "program/nc/heidenhain_executor.h"

namespace swarf::program::heidenhain {

using nc::Motion;
using nc::Target;

namespace {

constexpr double kTurn = 2.0 * kPi;

/// M functions of the control whose effect on the path or its time is not executed here.
constexpr int kUnsupported[] = {92,  97,  98,  103, 105, 106, 109, 110, 112, 114,
                                116, 118, 120, 124, 130, 138, 143, 144, 150, 197};

bool unsupported(int number) {
  return std::find(std::begin(kUnsupported), std::end(kUnsupported), number) != std::end(kUnsupported);
}

/// Executed elsewhere in the block.
bool executed(int number) {
  constexpr int kExecuted[] = {2, 3, 4, 5, 30, 89, 91, 94, 99, 126, 127, 128, 129, 136, 137, 140};
  return std::find(std::begin(kExecuted), std::end(kExecuted), number) != std::end(kExecuted);
}

}  // namespace

/// TOOL CALL 5 Z S3000 F500 DL+0.1 DR+0.05 DR2+0.02; without a number: a new speed or feed alone.
void Executor::tool_call(BlockReader& reader) {
  reader.done();
  const size_t at = reader.offset();
  const bool text = reader.peek() == '"' || reader.letters() == "QS";
  const bool named = text || reader.value_follows();
  std::string name;
  long number = 0;
  if (text) {
    name = reader.text_value();
  } else if (named) {
    number = reader.whole_value(0, 65535);
  }
  std::optional<nc::Plane> plane;
  Amount speed, feed, length, radius, corner;
  while (!reader.done()) {
    const size_t start = reader.offset();
    const std::string word(reader.take_letters());
    if (word == "X" || word == "Y" || word == "Z") {
      if (plane) reader.fail("word-twice", start, "the tool axis stands twice", "keep one of them");
      plane = word == "Z" ? nc::Plane::kXY : word == "Y" ? nc::Plane::kZX : nc::Plane::kYZ;
      continue;
    }
    const bool second =
        word == "DR" && reader.peek() == '2' && (reader.peek_after(1) == '+' || reader.peek_after(1) == '-');
    if (second) reader.skip();
    Amount* into = word == "S" ? &speed : word == "F" ? &feed : word == "DL" ? &length : nullptr;
    if (word == "DR") into = second ? &corner : &radius;
    if (into == nullptr) {
      refuse_word(reader, start, word.empty() ? std::string(1, reader.peek()) : word);
    }
    if (into->given)
      reader.fail("word-twice", start, fmt::format("{} stands twice", word), "keep one of them");
    *into = {reader.value(), start, true, false};
  }
  if (speed && !(speed.value >= 0.0))
    reader.fail("out-of-range", speed.offset, "S is below zero", "the direction is M3 or M4");
  if (feed && !(feed.value > 0.0))
    reader.fail("bad-feed", feed.offset, fmt::format("F {:g} is not a feed", feed.value), "F500");
  if (!named && (length || radius || corner) && control_.active_tool() == nullptr)
    reader.fail("missing-word", at, "TOOL CALL changes a tool, and none is in the spindle", "TOOL CALL 5 Z");
  if (named) {
    const int column = reader.column(at);
    const int index = text          ? control_.find_tool(name, column)
                      : number == 0 ? -1
                                    : control_.find_tool(static_cast<int>(number), column);
    control_.select_tool(index, static_cast<int>(number));
    control_.change_tool();
    tangent_.reset();
  }
  if (plane) control_.set_plane(*plane);
  if (named || length || radius || corner) {
    const NcTool* tool = control_.active_tool();
    const double own = tool == nullptr ? 0.0 : tool->length_mm;
    control_.set_length_compensation(own + control_.mm(length.value), tool != nullptr);
    delta_radius_ = control_.mm(radius.value);
    delta_corner_ = control_.mm(corner.value);
    parameters_.set_q(108,
                      tool == nullptr ? 0.0 : (0.5 * tool->diameter_mm + delta_radius_) / control_.mm(1.0));
    parameters_.set_q(114, own / control_.mm(1.0));
    if (named) tool_feed_ = 0.0;
  }
  if (speed) control_.set_speed(speed.value);
  if (feed) tool_feed_ = feed_ = feed.value;
}

/// TOOL DEF 5 makes a tool ready; lengths and radii come from the tool table.
void Executor::tool_ready(BlockReader& reader) {
  reader.done();
  const size_t at = reader.offset();
  const bool text = reader.peek() == '"' || reader.letters() == "QS";
  const std::string name = text ? reader.text_value() : std::string();
  const long number = text ? 0 : reader.whole_value(0, 65535);
  if (!reader.done()) {
    reader.fail("unsupported-word", reader.offset(), "tools with L and R in the program are not supported",
                "put them into the tool table, and write TOOL DEF with the number alone");
  }
  if (text) {
    control_.find_tool(name, reader.column(at));
  } else if (number != 0) {
    control_.find_tool(static_cast<int>(number), reader.column(at));
  }
  control_.without_effect("TOOL DEF");
}

/// The blank is the scene's; what the program says of it is kept as a note.
void Executor::blank_form(BlockReader& reader) {
  reader.done();
  const size_t start = reader.offset();
  if (!reader.take("FORM"))
    reader.fail("missing-word", start, "BLK without FORM", "BLK FORM 0.1 Z X+0 Y+0 Z-20");
  const size_t at = (reader.done(), reader.offset());
  const std::string text(reader.rest());
  reader.move_to(at);
  if (reader.value_follows()) {
    const double number = reader.value();
    if (number != 0.1 && number != 0.2)
      reader.fail("out-of-range", at, "BLK FORM is 0.1 or 0.2", "BLK FORM 0.1 Z X+0 Y+0 Z-20");
    const bool lower = number == 0.1;
    bool axis = false;
    for (const char* letter : {"X", "Y", "Z"}) {
      const size_t here = reader.offset();
      if (axis || !lower || !reader.take(letter)) continue;
      axis = !reader.value_follows();
      if (!axis) reader.move_to(here);
    }
    const MotionWords words = read_motion_words(reader, kAxesAllowed);
    if (words.any_rotary() || !words.axes[0] || !words.axes[1] || !words.axes[2])
      reader.fail("missing-word", at, "a corner of the blank has X, Y and Z", "BLK FORM 0.2 X+100 Y+100 Z+0");
  } else if (!reader.take("CYLINDER") && !reader.take("ROTATION") && !reader.take("FILE")) {
    reader.fail("unknown-word", at, "this kind of blank is not known",
                "BLK FORM 0.1, BLK FORM 0.2, CYLINDER");
  } else {
    reader.rest();
  }
  control_.note("BLK FORM", text);
}

void Executor::functions_before(BlockReader& reader, const MotionWords& words) {
  for (const MWord& word : words.functions) {
    if (unsupported(word.number) || (word.number >= 200 && word.number <= 204)) {
      reader.fail("unsupported-word", word.offset,
                  fmt::format("M{} is known, but not supported here", word.number),
                  "post the program without it");
    }
  }
  for (const MWord& word : words.functions) {
    switch (word.number) {
      case 3:
      case 13:
        control_.set_spindle(1);
        break;
      case 4:
      case 14:
        control_.set_spindle(-1);
        break;
      case 94:
        reduce_display(word);
        break;
      case 126:
      case 127:
        shortest_ = word.number == 126;
        break;
      case 128:
        set_tcpm(true, false, false, false);
        break;
      case 136:
      case 137:
        per_revolution_ = word.number == 136;
        control_.set_feed_mode(per_revolution_ ? nc::FeedMode::kPerRevolution : nc::FeedMode::kPerMinute);
        break;
      case 140:
        retract(reader, word, words);
        break;
      default:
        break;
    }
    if (word.number == 13 || word.number == 14) control_.without_effect("M8");
    if (!executed(word.number) && word.number != 13 && word.number != 14) {
      control_.without_effect(fmt::format("M{}", word.number));
      control_.note(fmt::format("M{}", word.number), "");
    }
  }
}

void Executor::functions_after(BlockReader& reader, const std::vector<MWord>& words) {
  for (const MWord& word : words) {
    if (word.number == 5 || word.number == 2 || word.number == 30) control_.set_spindle(0);
    if (word.number == 129) set_tcpm(false, false, false, false);
    if (word.number == 89) modal_call_ = true;
    if (word.number == 99) {
      run_cycle(reader, word.offset);
      modal_call_ = false;
    }
    if (word.number == 2 || word.number == 30) flow_.stop(reader, word.offset);
  }
}

/// M94: whole turns of rotary positions are forgotten; the axis itself stands.
void Executor::reduce_display(const MWord& word) {
  kinematics::AxisValues shift = control_.shift();
  const auto position = control_.position();
  for (int slot = nc::kA; slot < nc::kAxisWords; ++slot) {
    const int axis = control_.axis_of(static_cast<nc::AxisWord>(slot));
    const double value = position[static_cast<size_t>(slot)];
    const bool meant = word.axes == 0 || (word.axes >> slot & 1u) != 0;
    if (axis >= 0 && meant && std::isfinite(value)) shift[axis] += kTurn * std::floor(value / kTurn + 1e-12);
  }
  control_.set_shift(shift);
}

/// M140 MB50 at F of its block, or rapid.
void Executor::retract(BlockReader& reader, const MWord& word, const MotionWords& words) {
  no_open_corner(reader, word.offset);
  if (!control_.started()) {
    reader.fail("start-unknown", word.offset, "M140 retracts, and the position is not known yet",
                "position all axes before it");
  }
  const bool at_feed = words.feed == FeedWord::kValue && words.feed_value.value > 0.0;
  const Motion motion = at_feed ? Motion::kFeed : Motion::kRapid;
  if (at_feed) set_feed(words.feed_value.value, false);
  if (word.max) return retract_by(std::nullopt, motion);
  if (!(word.amount.value > 0.0))
    reader.fail("out-of-range", word.amount.offset, "M140 MB retracts by a way above zero", "M140 MB50");
  retract_by(control_.mm(word.amount.value), motion);
}

/// Along the tool, by a way or up to the end of the first axis' travel.
void Executor::retract_by(std::optional<double> way, Motion motion) {
  control_.flush();
  const kinematics::MachineModel& machine = control_.machine();
  const kinematics::AxisValues& q = control_.axis_values();
  const ToolPose here = kinematics::forward(machine, q);
  Mat3 columns;
  for (int i = 0; i < 3; ++i) {
    kinematics::AxisValues moved = q;
    moved[control_.axis_of(static_cast<nc::AxisWord>(i))] += 1.0;
    columns.col(i) = kinematics::forward(machine, moved).tip_W - here.tip_W;
  }
  Vec3 direction = columns.inverse() * here.axis_W;
  direction = direction.unaryExpr([](double x) { return std::abs(x) < 1e-12 ? 0.0 : x; });
  double length = way.value_or(std::numeric_limits<double>::infinity());
  for (int i = 0; i < 3 && !way; ++i) {
    const int index = control_.axis_of(static_cast<nc::AxisWord>(i));
    const kinematics::Axis& axis = machine.axes[static_cast<size_t>(index)];
    if (direction[i] != 0.0) {
      const double end = direction[i] > 0.0 ? axis.max : axis.min;
      length = std::min(length, std::max(0.0, (end - q[index]) / direction[i]));
    }
  }
  Target target;
  target.column = control_.place().column;
  for (int i = 0; i < 3; ++i) target.set(i, length * direction[i], true);
  control_.machine_line(motion, target);
  tangent_.reset();
}

}  // namespace swarf::program::heidenhain
