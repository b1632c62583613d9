// Tools and blanks of Heidenhain programs.
#include <fmt/format.h>

#include <cmath>

#include "program/heidenhain/steps.h"

namespace swarf::program::nc::heidenhain {
/// TOOL CALL 5 Z S3000 F500 DL+0.1 DR+0.05 DR2+0.02; without a number: a new speed or feed alone.
void tool_call(Executor& executor, BlockReader& reader) {
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
  if (!named && (length || radius || corner) && nc::active_tool(executor.control) == nullptr)
    reader.fail("missing-word", at, "TOOL CALL changes a tool, and none is in the spindle", "TOOL CALL 5 Z");
  if (named) {
    const int column = reader.column(at);
    const int index = text          ? nc::find_tool(executor.control, name, column)
                      : number == 0 ? -1
                                    : nc::find_tool(executor.control, static_cast<int>(number), column);
    nc::select_tool(executor.control.tools, index, static_cast<int>(number));
    nc::change_tool(executor.control);
    executor.path.tangent.reset();
  }
  if (plane) nc::set_plane(executor.control, *plane);
  if (named || length || radius || corner) {
    const NcTool* tool = nc::active_tool(executor.control);
    const double own = tool == nullptr ? 0.0 : tool->length_mm;
    nc::set_length_compensation(executor.control, own + executor.control.modal.mm(length.value),
                                tool != nullptr);
    executor.modes.delta_radius = executor.control.modal.mm(radius.value);
    executor.modes.delta_corner = executor.control.modal.mm(corner.value);
    executor.parameters.set_q(108, tool == nullptr ? 0.0
                                                   : (0.5 * tool->diameter_mm + executor.modes.delta_radius) /
                                                         executor.control.modal.mm(1.0));
    executor.parameters.set_q(114, own / executor.control.modal.mm(1.0));
    if (named) executor.modes.tool_feed = 0.0;
  }
  if (speed) executor.control.modal.speed_rpm = speed.value;
  if (feed) executor.modes.tool_feed = executor.modes.feed = feed.value;
}

/// TOOL DEF 5 makes a tool ready. TOOL DEF 5 L+50 R+5 describes it: the table has to say the same, or there
/// is no table.
void tool_ready(nc::Control& control, Modes& modes, BlockReader& reader) {
  reader.done();
  const size_t at = reader.offset();
  const bool text = reader.peek() == '"' || reader.letters() == "QS";
  const std::string name = text ? reader.text_value() : std::string();
  const long number = text ? 0 : reader.whole_value(0, 65535);
  Amount length, radius;
  while (!reader.done()) {
    const size_t start = reader.offset();
    const std::string word(reader.take_letters());
    Amount* into = word == "L" ? &length : word == "R" ? &radius : nullptr;
    if (into == nullptr) refuse_word(reader, start, word.empty() ? std::string(1, reader.peek()) : word);
    if (into->given)
      reader.fail("word-twice", start, fmt::format("{} stands twice", word), "keep one of them");
    *into = {reader.value(), start, true, false};
  }
  int index = -1;
  if (text) {
    index = nc::find_tool(control, name, reader.column(at));
  } else if (number != 0) {
    index = nc::find_tool(control, static_cast<int>(number), reader.column(at));
  }
  if (!length && !radius) {
    control.report.without_effect("TOOL DEF");
    return;
  }
  if (index < 0) {
    modes.defined_radius[static_cast<int>(number)] = control.modal.mm(radius.value);
    return;
  }
  const NcTool& tool = control.setup.tools[static_cast<size_t>(index)];
  const bool other_length = length && std::abs(control.modal.mm(length.value) - tool.length_mm) > 1e-6;
  const bool other_radius =
      radius && std::abs(control.modal.mm(radius.value) - 0.5 * tool.diameter_mm) > 1e-6;
  if (other_length || other_radius)
    control.report.warn_once(
        "tool-def-contradicts-table", reader.column(at),
        fmt::format(
            "the program says L {:g} and R {:g} mm of this tool, the tool table L {:g} and R {:g} mm: "
            "the table holds, as on a control with a central tool file",
            control.modal.mm(length.value), control.modal.mm(radius.value), tool.length_mm,
            0.5 * tool.diameter_mm),
        "correct one of them, or write TOOL DEF with the number alone");
}

/// The blank is the scene's; what the program says of it is kept as a note.
void blank_form(nc::Control& control, BlockReader& reader) {
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
  control.report.note("BLK FORM", text);
}

}  // namespace swarf::program::nc::heidenhain
