// What motion blocks of Heidenhain programs have in common, and L.
#include <fmt/format.h>

#include <cmath>

#include "base/angles.h"
#include "base/units.h"
#include "program/heidenhain/steps.h"

namespace swarf::program::nc::heidenhain {

using nc::Motion;

using nc::Target;

namespace {

/// L R0 F100 M3: words without a motion.
void move_without_axes(Executor& executor, BlockReader& reader, const MotionWords& words, Element& element,
                       size_t start) {
  if (executor.path.approach) no_open_corner(executor.path, reader, start);
  if (executor.path.held) {
    element.from = element.to = present(executor.control, executor.path);
    close_corner(executor, element);
  }
  Motion motion = Motion::kFeed;
  feed_of(executor.control, executor.modes, reader, words, motion);
  functions_before(executor, reader, words);
  if (words.compensation && *words.compensation != nc::Compensation::kOff)
    reader.fail("missing-word", start, "RL and RR need a motion in their block", "L X+10 Y+0 RL");
  if (words.compensation) nc::set_compensation(executor.control, nc::Compensation::kOff, 0.0, 0);
  finish_motion(executor, reader, words);
}

/// L Z-10 R0 FMAX M91: machine coordinates.
void machine_line(Executor& executor, BlockReader& reader, const MotionWords& words, size_t start) {
  no_open_corner(executor.path, reader, start);
  functions_before(executor, reader, words);
  Motion motion = Motion::kFeed;
  const double feed = feed_of(executor.control, executor.modes, reader, words, motion);
  if (words.compensation) {
    if (*words.compensation != nc::Compensation::kOff)
      reader.fail("words-conflict", start, "RL or RR with M91", "write R0");
    nc::set_compensation(executor.control, nc::Compensation::kOff, 0.0, 0);
  }
  const Target target = target_of(executor.control, executor.modes, executor.frames, reader, words);
  if (!target.any()) reader.fail("missing-word", start, "M91 stands without an axis", "L Z-10 FMAX M91");
  if (motion == Motion::kFeed && feed > 0.0) set_feed(executor.control, feed, !words.any_linear());
  nc::machine_line(executor.control, motion, target);
  executor.path.tangent.reset();
  finish_motion(executor, reader, words);
}

/// Rotary axes alone in a tilted plane: the linear axes stand.
void rotary_move(nc::Control& control, Modes& modes, PathState& path, Motion motion, const Target& target) {
  kinematics::AxisValues q = control.path.q;
  for (int slot = 0; slot < 3; ++slot) {
    if (!target.has(slot + 3)) continue;
    const int axis = control.space.axis_of(static_cast<nc::AxisWord>(slot + 3));
    const double value = target.value[static_cast<size_t>(slot) + 3];
    if (target.is_incremental(slot + 3)) {
      q[axis] += value;
      continue;
    }
    const double goal = value + control.space.rotary_zero(slot);
    q[axis] = modes.shortest ? q[axis] + std::remainder(goal - q[axis], kTurn) : goal;
  }
  nc::turn_rotaries(control, motion, q, false);
  path.tangent.reset();
}

}  // namespace

Vec3 present(nc::Control& control, PathState& path) {
  if (path.approach) return path.approach->contour;
  return path.held ? path.held->to : nc::position_xyz(control);
}

Vec3 end_of(nc::Control& control, PathState& path, const Target& target) {
  Vec3 end = present(control, path);
  for (int i = 0; i < 3; ++i) {
    const double value = target.value[static_cast<size_t>(i)];
    if (target.has(i)) end[i] = target.is_incremental(i) ? end[i] + value : value;
  }
  return end;
}

Target target_of(nc::Control& control, Modes& modes, Frames& frames, BlockReader& reader,
                 const MotionWords& words, int words_taken) {
  Target target;
  target.column = control.report.place.column;
  const bool shortest = words.has_function(126) || (modes.shortest && !words.has_function(127));
  for (int i = 0; i < words_taken; ++i) {
    const Amount& word = words.axes[static_cast<size_t>(i)];
    if (!word) continue;
    const auto axis = static_cast<nc::AxisWord>(i);
    if (i >= 3 && control.space.axis_of(axis) < 0)
      nc::require_axis(control, axis, reader.column(word.offset));
    target.set(i,
               i < 3 ? frames.stretch.along(i, control.modal.mm(word.value), word.incremental)
                     : rad_from_deg(word.value),
               word.incremental);
    if (i >= 3 && shortest) target.way[static_cast<size_t>(i) - 3] = nc::RotaryWay::kShortest;
  }
  return target;
}

/// The feed of this block as the control takes it; F is modal, FMAX holds in its block.
double feed_of(nc::Control& control, Modes& modes, BlockReader& reader, const MotionWords& words,
               Motion& motion) {
  motion = words.feed == FeedWord::kMax ? Motion::kRapid : Motion::kFeed;
  modes.last_rapid = motion == Motion::kRapid;
  if (words.feed == FeedWord::kAuto) {
    if (!(modes.tool_feed > 0.0))
      reader.fail("missing-feed", words.feed_value.offset, "FAUTO, and TOOL CALL gave no F",
                  "TOOL CALL 5 Z S3000 F500");
    modes.feed = modes.tool_feed;
  }
  if (words.feed == FeedWord::kValue || words.feed == FeedWord::kPerRevolution) {
    if (!(words.feed_value.value > 0.0))
      reader.fail("bad-feed", words.feed_value.offset,
                  fmt::format("F {:g} is not a feed", words.feed_value.value), "F500");
    modes.feed = words.feed_value.value;
    const bool turns = words.feed == FeedWord::kPerRevolution || words.has_function(136) ||
                       (modes.per_revolution && !words.has_function(137));
    nc::set_feed_mode(control.modal, turns ? nc::FeedMode::kPerRevolution : nc::FeedMode::kPerMinute);
  } else if (words.has_function(136) || words.has_function(137)) {
    modes.feed = 0.0;  // the old number means nothing in the other unit
  }
  return modes.feed;
}

/// What stands in every motion block around its motion.
void move(Executor& executor, BlockReader& reader, const MotionWords& words, Element& element) {
  if (executor.orientation.spatial && (element.target.given & 0x38u) != 0)
    reader.fail("unsupported-word", element.offset, "spatial angles (AXIS SPAT) are supported in L alone",
                "write them in a block L");
  Motion straight = Motion::kFeed;
  element.feed = feed_of(executor.control, executor.modes, reader, words, straight);
  if (element.motion == Motion::kFeed) {
    element.motion = straight;
  } else if (straight == Motion::kRapid) {
    reader.fail("unexpected-word", words.feed_value.offset, "an arc is not moved at FMAX",
                "write F with a value");
  }
  element.place = executor.control.report.place;
  element.target.column = element.place.column;
  element.from = present(executor.control, executor.path);
  element.to = end_of(executor.control, executor.path, element.target);
  if (executor.path.held) {
    for (int i = 0; i < 3; ++i) element.target.set(i, element.to[i], false);
    close_corner(executor, element);
  }
  if (executor.path.approach) close_approach(executor.control, executor.path, element);
  functions_before(executor, reader, words);
  if (words.compensation) {
    const nc::Compensation side = side_of(executor.control, executor.frames, *words.compensation);
    nc::set_compensation(
        executor.control, side,
        side != nc::Compensation::kOff ? cutter_radius(executor.control, executor.modes, reader) : 0.0,
        element.place.column);
  }
  const BlockText* next = executor.flow.following();
  if (next != nullptr && (next->text.starts_with("RND") || next->text.starts_with("CHF"))) {
    if (!element.from.allFinite() || !element.to.allFinite())
      reader.fail("start-unknown", 0, "a corner follows, and the position is not known yet",
                  "position all axes before it");
    executor.path.held = element;
  } else {
    emit(executor, element);
  }
  finish_motion(executor, reader, words);
}

/// RL and RR of the program; a mirror image has the cutter on the other side.
nc::Compensation side_of(nc::Control& control, const Frames& frames, nc::Compensation written) {
  const nc::PlaneAxes axes = nc::axes_of(control.modal.plane);
  if (written == nc::Compensation::kOff || !frames.stretch.turns_over(axes)) return written;
  return written == nc::Compensation::kLeft ? nc::Compensation::kRight : nc::Compensation::kLeft;
}

double cutter_radius(nc::Control& control, Modes& modes, BlockReader& reader) {
  const NcTool* tool = nc::active_tool(control);
  const auto defined = modes.defined_radius.find(control.tools.active_number);
  if (tool == nullptr && defined != modes.defined_radius.end()) return defined->second + modes.delta_radius;
  if (tool == nullptr && nc::no_tool_table(control, 0)) return modes.delta_radius;
  if (tool == nullptr)
    reader.fail("compensation-no-tool", 0, "RL or RR without a tool of the table in the spindle",
                "TOOL CALL 5 Z");
  return 0.5 * tool->diameter_mm + modes.delta_radius;
}

void finish_motion(Executor& executor, BlockReader& reader, const MotionWords& words) {
  if (executor.path.held) {
    for (const MWord& word : words.functions) {
      if (word.number == 99 || word.number == 89 || word.number == 2 || word.number == 30 ||
          word.number == 129)
        reader.fail("bad-corner", word.offset, fmt::format("M{} stands before a corner", word.number),
                    "write it in a block behind the corner");
    }
    if (executor.drilling.modal_call)
      reader.fail("bad-corner", 0, "a corner follows while M89 calls a cycle after each block",
                  "end the modal cycle with M99 before it");
  }
  functions_after(executor, reader, words.functions);
  if (executor.drilling.modal_call && words.positions()) run_cycle(executor, reader, 0);
}

void emit(Executor& executor, const Element& element) {
  executor.control.report.at(element.place.file, element.place.line, element.place.column);
  if (element.motion != Motion::kRapid && element.feed > 0.0)
    set_feed(executor.control, rotary_feed(executor.control, executor.modes, executor.orientation, element),
             (element.target.given & 7u) == 0 && !element.target.axis_P);
  const nc::PlaneAxes axes = nc::axes_of(executor.control.modal.plane);
  const bool arc = element.motion == Motion::kClockwise || element.motion == Motion::kCounterClockwise;
  if (arc) {
    nc::arc(executor.control, element.motion, element.target, element.arc);
    executor.path.tangent.reset();
    if (element.arc.normal) return;
    Vec3 out = element.to - *element.arc.centre;
    out[axes.normal] = 0.0;
    const double sign = element.motion == Motion::kCounterClockwise ? 1.0 : -1.0;
    executor.path.tangent = sign * Vec3::Unit(axes.normal).cross(out).normalized();
    return;
  }
  nc::line(executor.control, element.motion, element.target);
  Vec3 way = element.to - element.from;
  way[axes.normal] = 0.0;
  executor.path.tangent.reset();
  if (way.allFinite() && way.norm() > 1e-9) executor.path.tangent = way.normalized();
}

/// F counts units or degrees a minute, in inch programs tenths of an inch.
void set_feed(nc::Control& control, double feed, bool degrees) {
  const bool tenths =
      control.modal.inches() && !degrees && control.modal.feed_mode == nc::FeedMode::kPerMinute;
  nc::set_feed(control.report, control.modal, tenths ? 0.1 * feed : feed, 0);
}

void line(Executor& executor, BlockReader& reader, size_t start) {
  const MotionWords words = read_motion_words(reader, kAxesAllowed | kAlways | kMachineAllowed | kTcpAllowed);
  if (words.has_function(91)) return machine_line(executor, reader, words, start);
  // M128 of this block already holds for its rotary words.
  if (words.has_function(128)) {
    no_open_corner(executor.path, reader, start);
    set_tcpm(executor.control, executor.orientation, true, false, false, false);
  }
  Element element;
  element.offset = start;
  const bool spatial = words.any_rotary() && executor.orientation.tcpm && executor.orientation.spatial;
  element.target = target_of(executor.control, executor.modes, executor.frames, reader, words,
                             spatial ? nc::kA : nc::kAxisWords);
  if (spatial) {
    for (size_t i = 3; i < 6; ++i) {
      if (!words.axes[i] || words.axes[i].incremental)
        reader.fail("missing-word", start, "spatial angles are written as A, B and C, all absolute",
                    "L A+0 B+30 C+0");
    }
    element.target.axis_P =
        spatial_rotation(words.axes[3].value, words.axes[4].value, words.axes[5].value).col(2);
  } else if (words.any_rotary() && executor.orientation.tcpm) {
    turn_by(executor.control, executor.orientation, nc::Tcp::kAxes);
  } else if (words.any_rotary() && executor.orientation.tilted) {
    no_open_corner(executor.path, reader, start);
    if (!words.any_linear()) {
      Motion motion = Motion::kFeed;
      const double feed = feed_of(executor.control, executor.modes, reader, words, motion);
      functions_before(executor, reader, words);
      if (words.compensation && *words.compensation != nc::Compensation::kOff)
        reader.fail("words-conflict", start, "RL or RR with rotary axes in a tilted plane", "write R0");
      if (words.compensation) nc::set_compensation(executor.control, nc::Compensation::kOff, 0.0, 0);
      if (motion == Motion::kFeed && feed > 0.0) set_feed(executor.control, feed, true);
      rotary_move(executor.control, executor.modes, executor.path, motion, element.target);
      return finish_motion(executor, reader, words);
    }
    if (!words.axes[0] || !words.axes[1] || !words.axes[2])
      reader.fail("words-conflict", start,
                  "in a tilted plane without M128, rotary axes move with all of X Y Z or with none",
                  "write the rotary axes in a block of their own");
  }
  if (!element.target.any()) return move_without_axes(executor, reader, words, element, start);
  move(executor, reader, words, element);
}

}  // namespace swarf::program::nc::heidenhain
