// What motion blocks of Heidenhain programs have in common, and L.
#include <fmt/format.h>

#include <cmath>

#include "base/units.h"
#include "program/heidenhain/executor.h"

namespace swarf::program::nc::heidenhain {

using nc::Motion;
using nc::Target;

namespace {

constexpr unsigned kAlways = kFeedAllowed | kFunctionsAllowed | kCompensationAllowed;
constexpr double kTurn = 2.0 * kPi;

}  // namespace

Vec3 Executor::present() {
  if (approach_) return approach_->contour;
  return held_ ? held_->to : nc::position_xyz(control_);
}

Vec3 Executor::end_of(const Target& target) {
  Vec3 end = present();
  for (int i = 0; i < 3; ++i) {
    const double value = target.value[static_cast<size_t>(i)];
    if (target.has(i)) end[i] = target.is_incremental(i) ? end[i] + value : value;
  }
  return end;
}

Target Executor::target_of(BlockReader& reader, const MotionWords& words, int words_taken) {
  Target target;
  target.column = control_.report.place.column;
  const bool shortest = words.has_function(126) || (shortest_ && !words.has_function(127));
  for (int i = 0; i < words_taken; ++i) {
    const Amount& word = words.axes[static_cast<size_t>(i)];
    if (!word) continue;
    const auto axis = static_cast<nc::AxisWord>(i);
    if (i >= 3 && control_.space.axis_of(axis) < 0)
      nc::require_axis(control_, axis, reader.column(word.offset));
    target.set(
        i,
        i < 3 ? stretch_.along(i, control_.modal.mm(word.value), word.incremental) : rad_from_deg(word.value),
        word.incremental);
    if (i >= 3 && shortest) target.way[static_cast<size_t>(i) - 3] = nc::RotaryWay::kShortest;
  }
  return target;
}

/// The feed of this block as the control takes it; F is modal, FMAX holds in its block.
double Executor::feed_of(BlockReader& reader, const MotionWords& words, Motion& motion) {
  motion = words.feed == FeedWord::kMax ? Motion::kRapid : Motion::kFeed;
  last_rapid_ = motion == Motion::kRapid;
  if (words.feed == FeedWord::kAuto) {
    if (!(tool_feed_ > 0.0))
      reader.fail("missing-feed", words.feed_value.offset, "FAUTO, and TOOL CALL gave no F",
                  "TOOL CALL 5 Z S3000 F500");
    feed_ = tool_feed_;
  }
  if (words.feed == FeedWord::kValue || words.feed == FeedWord::kPerRevolution) {
    if (!(words.feed_value.value > 0.0))
      reader.fail("bad-feed", words.feed_value.offset,
                  fmt::format("F {:g} is not a feed", words.feed_value.value), "F500");
    feed_ = words.feed_value.value;
    const bool turns = words.feed == FeedWord::kPerRevolution || words.has_function(136) ||
                       (per_revolution_ && !words.has_function(137));
    nc::set_feed_mode(control_.modal, turns ? nc::FeedMode::kPerRevolution : nc::FeedMode::kPerMinute);
  } else if (words.has_function(136) || words.has_function(137)) {
    feed_ = 0.0;  // the old number means nothing in the other unit
  }
  return feed_;
}

/// What stands in every motion block around its motion.
void Executor::move(BlockReader& reader, const MotionWords& words, Element& element) {
  if (spatial_ && (element.target.given & 0x38u) != 0)
    reader.fail("unsupported-word", element.offset, "spatial angles (AXIS SPAT) are supported in L alone",
                "write them in a block L");
  Motion straight = Motion::kFeed;
  element.feed = feed_of(reader, words, straight);
  if (element.motion == Motion::kFeed) {
    element.motion = straight;
  } else if (straight == Motion::kRapid) {
    reader.fail("unexpected-word", words.feed_value.offset, "an arc is not moved at FMAX",
                "write F with a value");
  }
  element.place = control_.report.place;
  element.target.column = element.place.column;
  element.from = present();
  element.to = end_of(element.target);
  if (held_) {
    for (int i = 0; i < 3; ++i) element.target.set(i, element.to[i], false);
    close_corner(element);
  }
  if (approach_) close_approach(element);
  functions_before(reader, words);
  if (words.compensation) {
    const nc::Compensation side = side_of(*words.compensation);
    nc::set_compensation(control_, side, side != nc::Compensation::kOff ? cutter_radius(reader) : 0.0,
                         element.place.column);
  }
  const BlockText* next = flow_.following();
  if (next != nullptr && (next->text.starts_with("RND") || next->text.starts_with("CHF"))) {
    if (!element.from.allFinite() || !element.to.allFinite())
      reader.fail("start-unknown", 0, "a corner follows, and the position is not known yet",
                  "position all axes before it");
    held_ = element;
  } else {
    emit(element);
  }
  finish_motion(reader, words);
}

/// RL and RR of the program; a mirror image has the cutter on the other side.
nc::Compensation Executor::side_of(nc::Compensation written) const {
  const nc::PlaneAxes axes = nc::axes_of(control_.modal.plane);
  if (written == nc::Compensation::kOff || !stretch_.turns_over(axes.first, axes.second)) return written;
  return written == nc::Compensation::kLeft ? nc::Compensation::kRight : nc::Compensation::kLeft;
}

double Executor::cutter_radius(BlockReader& reader) {
  const NcTool* tool = nc::active_tool(control_);
  const auto defined = defined_radius_.find(control_.tools.active_number);
  if (tool == nullptr && defined != defined_radius_.end()) return defined->second + delta_radius_;
  if (tool == nullptr)
    reader.fail("compensation-no-tool", 0, "RL or RR without a tool of the table in the spindle",
                "TOOL CALL 5 Z");
  return 0.5 * tool->diameter_mm + delta_radius_;
}

void Executor::finish_motion(BlockReader& reader, const MotionWords& words) {
  if (held_) {
    for (const MWord& word : words.functions) {
      if (word.number == 99 || word.number == 89 || word.number == 2 || word.number == 30 ||
          word.number == 129)
        reader.fail("bad-corner", word.offset, fmt::format("M{} stands before a corner", word.number),
                    "write it in a block behind the corner");
    }
    if (modal_call_)
      reader.fail("bad-corner", 0, "a corner follows while M89 calls a cycle after each block",
                  "end the modal cycle with M99 before it");
  }
  functions_after(reader, words.functions);
  if (modal_call_ && words.positions()) run_cycle(reader, 0);
}

void Executor::emit(const Element& element) {
  control_.report.at(element.place.file, element.place.line, element.place.column);
  if (element.motion != Motion::kRapid && element.feed > 0.0)
    set_feed(rotary_feed(element), (element.target.given & 7u) == 0 && !element.target.axis_P);
  const nc::PlaneAxes axes = nc::axes_of(control_.modal.plane);
  const bool arc = element.motion == Motion::kClockwise || element.motion == Motion::kCounterClockwise;
  if (arc) {
    nc::arc(control_, element.motion, element.target, element.arc);
    Vec3 out = element.to - *element.arc.centre;
    out[axes.normal] = 0.0;
    const double sign = element.motion == Motion::kCounterClockwise ? 1.0 : -1.0;
    tangent_ = sign * Vec3::Unit(axes.normal).cross(out).normalized();
    return;
  }
  nc::line(control_, element.motion, element.target);
  Vec3 way = element.to - element.from;
  way[axes.normal] = 0.0;
  tangent_.reset();
  if (way.allFinite() && way.norm() > 1e-9) tangent_ = way.normalized();
}

/// F counts units or degrees a minute, in inch programs tenths of an inch.
void Executor::set_feed(double feed, bool degrees) {
  const bool tenths =
      control_.modal.inches() && !degrees && control_.modal.feed_mode == nc::FeedMode::kPerMinute;
  nc::set_feed(control_.report, control_.modal, tenths ? 0.1 * feed : feed, 0);
}

void Executor::line(BlockReader& reader, size_t start) {
  const MotionWords words = read_motion_words(reader, kAxesAllowed | kAlways | kMachineAllowed | kTcpAllowed);
  if (words.has_function(91)) return machine_line(reader, words, start);
  // M128 of this block already holds for its rotary words.
  if (words.has_function(128)) {
    no_open_corner(reader, start);
    set_tcpm(true, false, false, false);
  }
  Element element;
  element.offset = start;
  const bool spatial = words.any_rotary() && tcpm_ && spatial_;
  element.target = target_of(reader, words, spatial ? nc::kA : nc::kAxisWords);
  if (spatial) {
    for (size_t i = 3; i < 6; ++i) {
      if (!words.axes[i] || words.axes[i].incremental)
        reader.fail("missing-word", start, "spatial angles are written as A, B and C, all absolute",
                    "L A+0 B+30 C+0");
    }
    element.target.axis_P =
        spatial_rotation(words.axes[3].value, words.axes[4].value, words.axes[5].value).col(2);
  } else if (words.any_rotary() && tcpm_) {
    turn_by(nc::Tcp::kAxes);
  } else if (words.any_rotary() && tilted_) {
    no_open_corner(reader, start);
    if (!words.any_linear()) {
      Motion motion = Motion::kFeed;
      const double feed = feed_of(reader, words, motion);
      functions_before(reader, words);
      if (words.compensation && *words.compensation != nc::Compensation::kOff)
        reader.fail("words-conflict", start, "RL or RR with rotary axes in a tilted plane", "write R0");
      if (words.compensation) nc::set_compensation(control_, nc::Compensation::kOff, 0.0, 0);
      if (motion == Motion::kFeed && feed > 0.0) set_feed(feed, true);
      rotary_move(motion, element.target);
      return finish_motion(reader, words);
    }
    if (!words.axes[0] || !words.axes[1] || !words.axes[2])
      reader.fail("words-conflict", start,
                  "in a tilted plane without M128, rotary axes move with all of X Y Z or with none",
                  "write the rotary axes in a block of their own");
  }
  if (!element.target.any()) return move_without_axes(reader, words, element, start);
  move(reader, words, element);
}

/// L R0 F100 M3: words without a motion.
void Executor::move_without_axes(BlockReader& reader, const MotionWords& words, Element& element,
                                 size_t start) {
  if (approach_) no_open_corner(reader, start);
  if (held_) {
    element.from = element.to = present();
    close_corner(element);
  }
  Motion motion = Motion::kFeed;
  feed_of(reader, words, motion);
  functions_before(reader, words);
  if (words.compensation && *words.compensation != nc::Compensation::kOff)
    reader.fail("missing-word", start, "RL and RR need a motion in their block", "L X+10 Y+0 RL");
  if (words.compensation) nc::set_compensation(control_, nc::Compensation::kOff, 0.0, 0);
  finish_motion(reader, words);
}

/// L Z-10 R0 FMAX M91: machine coordinates.
void Executor::machine_line(BlockReader& reader, const MotionWords& words, size_t start) {
  no_open_corner(reader, start);
  functions_before(reader, words);
  Motion motion = Motion::kFeed;
  const double feed = feed_of(reader, words, motion);
  if (words.compensation) {
    if (*words.compensation != nc::Compensation::kOff)
      reader.fail("words-conflict", start, "RL or RR with M91", "write R0");
    nc::set_compensation(control_, nc::Compensation::kOff, 0.0, 0);
  }
  const Target target = target_of(reader, words);
  if (!target.any()) reader.fail("missing-word", start, "M91 stands without an axis", "L Z-10 FMAX M91");
  if (motion == Motion::kFeed && feed > 0.0) set_feed(feed, !words.any_linear());
  nc::machine_line(control_, motion, target);
  tangent_.reset();
  finish_motion(reader, words);
}

/// Rotary axes alone in a tilted plane: the linear axes stand.
void Executor::rotary_move(Motion motion, const Target& target) {
  kinematics::AxisValues q = control_.path.q;
  for (int slot = 0; slot < 3; ++slot) {
    if (!target.has(slot + 3)) continue;
    const int axis = control_.space.axis_of(static_cast<nc::AxisWord>(slot + 3));
    const double value = target.value[static_cast<size_t>(slot) + 3];
    if (target.is_incremental(slot + 3)) {
      q[axis] += value;
      continue;
    }
    const double goal = value + control_.space.rotary_zero(slot);
    q[axis] = shortest_ ? q[axis] + std::remainder(goal - q[axis], kTurn) : goal;
  }
  nc::turn_rotaries(control_, motion, q, false);
  tangent_.reset();
}

}  // namespace swarf::program::nc::heidenhain
