// RND RNDM CHF CHR with FRC FRCM, and the straight line by ANG.
#include <cmath>

#include "base/units.h"
#include "program/control/corner.h"
#include "program/control/path.h"
#include "program/siemens/steps.h"

namespace swarf::program::nc::siemens {
namespace {

using Kind = nc::CornerWords::Kind;

struct CornerWord {
  const Amount* amount;
  Kind kind;
};

/// RND, CHF or CHR of the block; no amount: it has none of them.
CornerWord corner_word(const BlockPlace& place, const BlockWords& words) {
  CornerWord found{nullptr, Kind::kRound};
  for (const CornerWord& one :
       {CornerWord{&words.round, Kind::kRound}, CornerWord{&words.chamfer, Kind::kChord},
        CornerWord{&words.chamfer_leg, Kind::kLegs}}) {
    if (!*one.amount) continue;
    if (found.amount != nullptr)
      fail(place, "words-conflict", one.amount->offset, "a block has one corner", "write RND, CHF or CHR");
    found = one;
  }
  return found;
}

void check_size(const BlockPlace& place, const Amount& amount, bool zero_too) {
  if (amount && !(amount.value > 0.0 || (zero_too && amount.value == 0.0)))
    fail(place, "out-of-range", amount.offset, "the size or feed of a corner is not above zero",
         "RND=2, CHF=1.5, CHR=1, FRC=200; RNDM=0 and FRCM=0 end theirs");
}

}  // namespace

void corner_modes(nc::Control& control, BlockPlace& place, Modes& modes, const BlockWords& words) {
  check_size(place, words.round_all, true);
  check_size(place, words.corner_feed_all, true);
  check_size(place, words.corner_feed, false);
  if (words.round_all) modes.round_all_mm = control.modal.mm(words.round_all.value);
  if (words.corner_feed_all) modes.corner_feed = words.corner_feed_all.value;
  const CornerWord word = corner_word(place, words);
  if (word.amount == nullptr) return;
  check_size(place, *word.amount, false);
  if ((!words.moves() && !words.angle) || words.code(Group::kNoMotion) || words.code(Group::kSuppress) ||
      modes.motion == kG0 || modes.motion == kPoly)
    fail(place, "bad-corner", word.amount->offset, "a corner stands in a block without a feed move",
         "write it in the G1, G2 or G3 block that leads to the corner");
}

/// The technology of a corner is that of the block behind it, as the control is delivered (MD20201).
void ask_for_corner(nc::Control& control, const BlockPlace& place, const Modes& modes, const Frames& frames,
                    const BlockWords& words) {
  const CornerWord word = corner_word(place, words);
  const bool modal = word.amount == nullptr;
  if (modal && (!(modes.round_all_mm > 0.0) || modes.motion == kPoly)) return;
  const size_t offset = modal ? 0 : word.amount->offset;
  nc::CornerWords asked;
  asked.kind = word.kind;
  asked.size_mm = (modal ? modes.round_all_mm : control.modal.mm(word.amount->value)) *
                  arc_scale(control, place, frames, offset);
  asked.feed = words.corner_feed ? words.corner_feed.value : modes.corner_feed;
  asked.feed_of_next = true;
  asked.modal = modal;
  asked.place = control.report.place;
  asked.place.column = column(place, offset);
  nc::ask_corner(control, asked);
}

namespace {

/// Along ANG=, counted from the plane's first axis towards its second one, as the frame stretches it.
Vec2 along_angle(const Executor& executor, double degrees) {
  const nc::PlaneAxes plane = nc::axes_of(executor.control.modal.plane);
  const Vec3& factor = executor.frames.stretch.factor;
  const double angle = rad_from_deg(degrees);
  return {std::cos(angle) * factor[plane.first], std::sin(angle) * factor[plane.second]};
}

}  // namespace

/// One coordinate of the plane is given.
void angle_end(Executor& executor, const BlockWords& words, Target& target) {
  if (!words.angle) return;
  const nc::PlaneAxes plane = nc::axes_of(executor.control.modal.plane);
  const bool straight = executor.modes.motion == kG0 || executor.modes.motion == kG1;
  if (!straight || target.has(plane.first) == target.has(plane.second))
    fail(executor.place, straight ? "unsupported-word" : "words-conflict", words.angle.offset,
         "ANG= is read in straight moves with one coordinate of the plane, which is then their end",
         "write G1 X40 ANG=30; two lines by their angles: G1 ANG=30, then X80 Y20 ANG=120");
  const Vec2 along = along_angle(executor, words.angle.value);
  const double first = along.x(), second = along.y();
  const bool by_first = target.has(plane.first);
  const int given = by_first ? plane.first : plane.second, other = by_first ? plane.second : plane.first;
  const Vec3 from = nc::position_xyz(executor.control), end = end_of(target, from);
  const double way = (end[given] - from[given]) / (by_first ? first : second);
  if (!(std::abs(by_first ? first : second) > 1e-9) || !(way > 0.0))
    fail(executor.place, "out-of-range", words.angle.offset,
         "the line at this angle never comes to the coordinate that is given",
         "correct the angle or the end");
  target.set(other, from[other] + way * (by_first ? second : first), false);
}

void open_line(Executor& executor, const BlockWords& words) {
  if (executor.modes.motion != kG1 || words.code(Group::kSuppress))
    fail(executor.place, "words-conflict", words.angle.offset,
         "ANG= without an end is a straight line in feed, up to the line of the next block",
         "write G1 ANG=30, then X80 Y20 ANG=120");
  ask_for_corner(executor.control, executor.place, executor.modes, executor.frames, words);
  OpenLine open{words.angle.value, executor.control.report.place};
  open.place.column = column(executor.place, words.angle.offset);
  executor.path.open = open;
}

void refuse_open_line(const Executor& executor) {
  if (!executor.path.open) return;
  const nc::Place& place = executor.path.open->place;
  nc::Report::fail_at({executor.control.report.file_name(place), place.line, place.column},
                      "line-without-end",
                      "ANG= stands without an end, and no line by its end and angle follows at once",
                      "write the next block as X80 Y20 ANG=120, absolute, or give this line one coordinate");
}

void close_line(Executor& executor, BlockWords& words) {
  const nc::PlaneAxes plane = nc::axes_of(executor.control.modal.plane);
  const bool incremental =
      words.code(Group::kMeasure).value_or(executor.modes.incremental ? kG91 : kG90) == kG91;
  const auto absolute = [&](int axis) {
    const Coordinate& word = words.axes[static_cast<size_t>(axis)];
    return word && (word.way == Way::kAbsolute || (word.way == Way::kModal && !incremental));
  };
  const bool plain = words.calls.empty() && !words.frame && !words.transform && !words.tool.given &&
                     !words.cutting_edge && !words.code(Group::kNoMotion) && !words.code(Group::kSuppress) &&
                     !words.code(Group::kPlane) && !words.code(Group::kUnits) && !words.code(Group::kOffset);
  const int motion = words.motion.value_or(executor.modes.motion);
  if (!plain || motion != kG1 || !words.angle || !absolute(plane.first) || !absolute(plane.second))
    refuse_open_line(executor);
  const auto value = [&](int axis) {
    return executor.control.modal.mm(words.axes[static_cast<size_t>(axis)].value) *
           executor.frames.stretch.factor[axis];
  };
  const Vec3 here = nc::position_xyz(executor.control);
  const Vec2 from(here[plane.first], here[plane.second]), to(value(plane.first), value(plane.second));
  const Vec2 a = along_angle(executor, executor.path.open->angle_deg),
             b = along_angle(executor, words.angle.value);
  const double turn = a.x() * b.y() - a.y() * b.x();
  const Vec2 way = to - from;
  const double first = (way.x() * b.y() - way.y() * b.x()) / turn,
               second = (a.x() * way.y() - a.y() * way.x()) / turn;
  if (!(std::abs(turn) > 1e-9) || !(first > 0.0) || !(second > 0.0))
    fail(executor.place, "out-of-range", words.angle.offset,
         "the lines at these two angles do not cross between the start and this end",
         "correct the angles or the end");
  const nc::Place present = executor.control.report.place;
  executor.control.report.place = executor.path.open->place;
  executor.path.open.reset();
  nc::Target target;
  target.column = executor.control.report.place.column;
  target.set(plane.first, from.x() + first * a.x(), false);
  target.set(plane.second, from.y() + first * a.y(), false);
  nc::line(executor.control, nc::Motion::kFeed, target);
  executor.path.last.valid = false;
  executor.control.report.place = present;
  words.angle = {};
}

}  // namespace swarf::program::nc::siemens
