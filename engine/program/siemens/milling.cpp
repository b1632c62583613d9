#include "program/siemens/milling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "program/siemens/functions.h"

namespace swarf::program::nc::siemens {
namespace {

/// A cycle with more infeeds or passes than this is a slip.
constexpr double kStepsMax = 100'000.0;

double exact_function(const char* name, double degrees, const BlockPlace& place) {
  return call_function(name, {Value::real(degrees)}, *place.line, 0).number;
}

}  // namespace

MillCall::MillCall(Executor& executor, const CycleCall& call, size_t arguments_max)
    : executor_(executor), call_(call) {
  const nc::Control& control = executor.control;
  if (call.arguments.size() > arguments_max) {
    fail("wrong-arguments", arguments_max,
         fmt::format("{} takes at most {} arguments", call.name, arguments_max), "count the commas");
  }
  if (!control.path.started) {
    siemens::fail(executor.place, "start-unknown", call.offset,
                  fmt::format("{} starts, and the position is not known yet", call.name),
                  "position all axes before it");
  }
  if (control.contour.side() != nc::Compensation::kOff) {
    siemens::fail(executor.place, "compensation-active", call.offset,
                  fmt::format("{} compensates the cutter itself, and G41 or G42 is on", call.name),
                  "write G40 and a move before it");
  }
  if ((executor.frames.stretch.factor - Vec3::Ones()).norm() != 0.0) {
    siemens::fail(executor.place, "unsupported-word", call.offset,
                  "milling cycles in mirrored or scaled frames are not supported",
                  "write the cycle outside of the frame, or its moves as blocks");
  }
  const NcTool* tool = nc::active_tool(control);
  if (tool == nullptr || !(tool->diameter_mm > 0.0)) {
    siemens::fail(
        executor.place, "no-tool-offset", call.offset,
        fmt::format("{} needs the radius of the tool in the spindle (alarm 61000), and {}", call.name,
                    tool == nullptr ? "none is there" : "the tool table has none"),
        "call a tool with T and M6; its diameter stands in the tool table: swarf check --tools FILE, "
        "swarf run --tools T1=6");
  }
  if (!control.tools.length_on) {
    siemens::fail(executor.place, "no-tool-offset", call.offset,
                  fmt::format("{} runs with a tool offset, and D0 holds (alarm 61000)", call.name),
                  "write D1 before it");
  }
  tool_radius_ = 0.5 * tool->diameter_mm;
}

double MillCall::number(size_t index, std::optional<double> fallback) const {
  return argument(call_, index, *executor_.place.line, fallback);
}

int MillCall::whole(size_t index, std::optional<double> fallback) const {
  return whole_argument(call_, index, *executor_.place.line, fallback);
}

double MillCall::length(size_t index, std::optional<double> fallback) const {
  return executor_.control.modal.mm(number(index, fallback));
}

double MillCall::size(size_t index, std::optional<double> fallback) const {
  return std::abs(length(index, fallback));
}

double MillCall::way(size_t index) const {
  const double value = size(index, std::nullopt);
  if (!(value > 0.0)) fail("bad-cycle", index, fmt::format("a size of {} is zero", name()), "give it in mm");
  return value;
}

double MillCall::feed(size_t index) const {
  const double value = number(index, 0.0);
  if (!(value >= 0.0)) fail("out-of-range", index, "a feed is below zero", "give a feed above zero");
  if (value > 0.0) return value;
  const nc::ModalState& modal = executor_.control.modal;
  if (!(modal.feed > 0.0) || modal.feed_mode == nc::FeedMode::kInverseTime) {
    fail("missing-feed", index, fmt::format("{} has no feed, and none holds (alarm 61003)", name()),
         "give the feeds of the cycle, or F before it");
  }
  return modal.feed;
}

int MillCall::sense(size_t index, bool outside) const {
  const int kind = whole(index, 0.0);
  if (kind < 0 || kind > 3)
    fail("out-of-range", index, fmt::format("{} is no direction (alarm 61109)", kind),
         "0 climb, 1 conventional, 2 G2, 3 G3");
  if (kind >= 2) return kind == 3 ? 1 : -1;
  const int spindle = executor_.control.modal.spindle;
  if (spindle == 0) {
    fail("feed-without-spindle", index,
         fmt::format("the direction of {} counts from the spindle's, which stands (alarm 61102)", name()),
         "write M3 or M4 before it, or 2 or 3 as direction");
  }
  // A cutter that turns clockwise has its work on the right in climb milling.
  const int within = spindle > 0 ? 1 : -1;
  return (outside ? -within : within) * (kind == 0 ? 1 : -1);
}

int MillCall::steps(double way, double most, size_t index) const {
  constexpr double kNoWay = 1e-9, kRounding = 1e-9;
  if (!(way > kNoWay)) return 0;
  if (most == 0.0) return 1;
  if (!(way <= kStepsMax * most))
    fail("bad-cycle", index, fmt::format("a way of {:g} mm is cut in steps of {:g} mm", way, most),
         "give a larger step, or 0 for one");
  return std::max(1, static_cast<int>(std::ceil(way / most - kRounding)));
}

void MillCall::only_zero_from(size_t first) const {
  only_zero(executor_.place, call_, first, call_.arguments.size());
}

void MillCall::only_zero_between(size_t first, size_t behind) const {
  only_zero(executor_.place, call_, first, behind - 1);
}

void MillCall::plain_modes(size_t gmode) const {
  const int geometry = whole(gmode, 0.0), plane = whole(gmode + 1, 0.0), depth = whole(gmode + 2, 0.0);
  for (const int digit : {geometry / 100 % 10, geometry / 1000 % 10, geometry / 10000 % 10}) {
    if (geometry < 0 || digit > 1)
      fail("unsupported-word", gmode, fmt::format("_GMODE {} chooses a variant, which is not read", geometry),
           "machine from the centre and all at once: digits 0 and 1");
  }
  const int active = executor_.control.modal.plane == nc::Plane::kXY   ? 1
                     : executor_.control.modal.plane == nc::Plane::kZX ? 2
                                                                       : 3;
  if (plane % 10 != 0 && plane % 10 != active)
    fail("words-conflict", gmode + 1, fmt::format("_DMODE {} names another plane than the active one", plane),
         "write G17, G18 or G19 before it");
  if (depth < 0 || depth % 10 > 2 || depth / 10 % 10 > 1)
    fail("unsupported-word", gmode + 2, fmt::format("_AMODE {} is not read", depth),
         "units 0 to 2 (depth absolute or from RFP), tens 0 (mm) or 1 (percent of the tool)");
}

void MillCall::fail(const char* code, size_t index, std::string text, std::string fix) const {
  const size_t offset = index < call_.offsets.size() ? call_.offsets[index] : call_.offset;
  siemens::fail(executor_.place, code, offset, std::move(text), std::move(fix));
}

void MillCall::warn(const char* code, std::string text) const {
  executor_.control.report.warn_once(code, column(), std::move(text),
                                     "depths, walls and floor do not depend on it; times and forces do");
}

int MillCall::column() const {
  return siemens::column(executor_.place, call_.offset);
}

MillHeights mill_heights(const MillCall& call, bool has_dpr, size_t amode, size_t first) {
  const double reference = call.length(first + 1, std::nullopt);
  MillHeights heights;
  heights.retract = call.length(first, std::nullopt);
  heights.safe = reference + call.size(first + 2, 0.0);
  const int mode = call.whole(amode, 0.0) % 10;
  const bool absolute = call.given(first + 3), relative = has_dpr && call.number(first + 4, 0.0) != 0.0;
  if (has_dpr && mode == 0 && absolute == relative) {
    call.fail("wrong-arguments", first + 3,
              fmt::format("{} takes the depth once, as DP or as DPR", call.name()),
              "leave the other one out");
  }
  const bool from_reference = mode == 0 ? relative : mode == 1;
  heights.bottom = from_reference ? reference - call.size(first + (has_dpr ? 4 : 3), std::nullopt)
                                  : call.length(first + 3, std::nullopt);
  if (!(heights.bottom < reference)) {
    call.fail("bad-cycle", first + 3,
              fmt::format("the depth {:g} mm does not lie below the reference plane {:g} mm (alarm 61101)",
                          heights.bottom, reference),
              "DP is an absolute height below RFP");
  }
  if (heights.retract < heights.safe - 1e-9) {
    call.fail("bad-cycle", first,
              fmt::format("the retraction plane {:g} mm lies below the start of milling {:g} mm",
                          heights.retract, heights.safe),
              "RTP lies above RFP by SDIS or more");
  }
  return heights;
}

MillShape rectangle_at(const MillCall& call, size_t at, const char* what) {
  MillShape shape;
  shape.half_length = 0.5 * call.way(at);
  shape.half_width = 0.5 * call.way(at + 1);
  shape.corner = call.size(at + 2, 0.0);
  if (shape.corner > std::min(shape.half_length, shape.half_width) + 1e-9)
    call.fail("bad-cycle", at + 2,
              fmt::format("corners of {:g} mm do not fit a {} of {:g} by {:g} mm (alarm 61113)", shape.corner,
                          what, 2.0 * shape.half_length, 2.0 * shape.half_width),
              "give a corner radius of at most half the shorter side");
  shape.centre = Vec2(call.length(at + 3, std::nullopt), call.length(at + 4, std::nullopt));
  shape.angle_deg = call.number(at + 5, 0.0);
  return shape;
}

MillShape circle_at(const MillCall& call, size_t at, bool diameter) {
  MillShape shape;
  shape.half_length = shape.half_width = shape.corner = (diameter ? 0.5 : 1.0) * call.way(at);
  shape.centre = Vec2(call.length(at + 1, std::nullopt), call.length(at + 2, std::nullopt));
  return shape;
}

MillMotion::MillMotion(const MillCall& call, const Vec2& origin, double angle_deg)
    : control_(call.executor().control),
      column_(call.column()),
      origin_(origin),
      along_(exact_function("COS", angle_deg, call.executor().place),
             exact_function("SIN", angle_deg, call.executor().place)),
      axes_(nc::axes_of(control_.modal.plane)),
      feed_(control_.modal.feed),
      unit_(control_.modal.feed_unit_mm),
      mode_(control_.modal.feed_mode),
      feed_unit_mm_(call.executor().modes.units == kG70 ? 1.0 : control_.modal.mm(1.0)) {
  if (control_.modal.feed_mode == nc::FeedMode::kInverseTime)
    control_.modal.feed_mode = nc::FeedMode::kPerMinute;
}

nc::Target MillMotion::at(const Vec2& to) const {
  nc::Target target;
  target.column = column_;
  target.set(axes_.first, origin_.x() + along_.x() * to.x() - along_.y() * to.y(), false);
  target.set(axes_.second, origin_.y() + along_.y() * to.x() + along_.x() * to.y(), false);
  return target;
}

void MillMotion::use(double feed) {
  control_.modal.feed = feed;
  control_.modal.feed_unit_mm = feed_unit_mm_;
}

void MillMotion::rapid(const Vec2& to) {
  nc::line(control_, nc::Motion::kRapid, at(to));
}

void MillMotion::rapid_height(double height) {
  nc::Target target;
  target.column = column_;
  target.set(axes_.normal, height, false);
  nc::line(control_, nc::Motion::kRapid, target);
}

void MillMotion::feed(const Vec2& to, double feed) {
  use(feed);
  nc::line(control_, nc::Motion::kFeed, at(to));
}

void MillMotion::feed_height(double height, double feed) {
  use(feed);
  nc::Target target;
  target.column = column_;
  target.set(axes_.normal, height, false);
  nc::line(control_, nc::Motion::kFeed, target);
}

void MillMotion::ramp(const Vec2& to, double height, double feed) {
  use(feed);
  nc::Target target = at(to);
  target.set(axes_.normal, height, false);
  nc::line(control_, nc::Motion::kFeed, target);
}

void MillMotion::arc(const Vec2& to, const Vec2& centre, int turn, double feed,
                     std::optional<double> height) {
  use(feed);
  nc::Target target = at(to);
  if (height) target.set(axes_.normal, *height, false);
  const nc::Target middle = at(centre);
  nc::ArcWords words;
  words.centre = nc::position_xyz(control_);
  for (const int axis : {axes_.first, axes_.second})
    (*words.centre)[axis] = middle.value[static_cast<size_t>(axis)];
  words.column = column_;
  nc::arc(control_, turn > 0 ? nc::Motion::kCounterClockwise : nc::Motion::kClockwise, target, words);
}

void MillMotion::follow(const Outline& outline, double feed) {
  for (const OutlinePiece& piece : outline.pieces) {
    if (piece.turn == 0)
      this->feed(piece.to, feed);
    else
      arc(piece.to, piece.centre, piece.turn, feed);
  }
}

}  // namespace swarf::program::nc::siemens
