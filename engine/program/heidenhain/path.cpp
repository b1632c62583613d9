// RND and CHF: a piece of contour waits until the one behind the corner is known.
#include <fmt/format.h>

#include "program/heidenhain/steps.h"

namespace swarf::program::nc::heidenhain {

using nc::Motion;

namespace {

FlatPiece flat_piece(const nc::PlaneAxes& axes, Motion motion, const nc::ArcWords& arc, const Vec3& from,
                     const Vec3& to) {
  const auto in_plane = [&](const Vec3& v) { return Vec2(v[axes.first], v[axes.second]); };
  FlatPiece piece{in_plane(from), in_plane(to), false, Vec2::Zero(), motion == Motion::kCounterClockwise};
  piece.is_arc = arc.centre.has_value();
  if (piece.is_arc) piece.centre = in_plane(*arc.centre);
  return piece;
}

}  // namespace

/// RND R5 F100, CHF 2: between the block before and the one behind it.
void corner(nc::Control& control, PathState& path, Frames& frames, BlockReader& reader, bool round,
            size_t start) {
  if (!path.held || path.corner)
    reader.fail("bad-corner", start, "a corner follows no piece of contour",
                "write it between two motion blocks");
  reader.done();
  const size_t at = reader.offset();
  if (round) reader.take("R");
  Corner corner;
  corner.round = round;
  corner.size_mm = plane_scale(control, frames, reader, at) * control.modal.mm(reader.value());
  corner.place = control.report.place;
  corner.feed = path.held->feed;
  if (!(corner.size_mm > 0.0))
    reader.fail("out-of-range", at, "the size of a corner is above zero", "RND R5, CHF 2");
  const MotionWords words = read_motion_words(reader, kFeedAllowed);
  if (words.feed == FeedWord::kMax || words.feed == FeedWord::kAuto || words.feed == FeedWord::kPerRevolution)
    reader.fail("unsupported-word", words.feed_value.offset, "a corner takes F with a value alone",
                "RND R5 F100");
  if (words.feed_value && !(words.feed_value.value > 0.0))
    reader.fail("bad-feed", words.feed_value.offset, "F is not above zero", "F100");
  if (words.feed_value) corner.feed = words.feed_value.value;
  path.corner = corner;
}

void close_corner(Executor& executor, Element& next) {
  const Element before = *executor.path.held;
  const Corner corner = *executor.path.corner;
  executor.path.held.reset();
  executor.path.corner.reset();
  const nc::Place here = executor.control.report.place;
  const nc::PlaneAxes axes = nc::axes_of(executor.control.modal.plane);
  executor.control.report.at(corner.place.file, corner.place.line, corner.place.column);
  const auto refuse = [&](const std::string& why) {
    executor.control.report.fail("bad-corner", 0, why, "make the corner smaller, or the pieces longer");
  };
  const double rise = std::max(std::abs(before.to[axes.normal] - before.from[axes.normal]),
                               std::abs(next.to[axes.normal] - next.from[axes.normal]));
  if (rise > 1e-9 || before.arc.normal || next.arc.normal || before.target.rotary() || next.target.rotary())
    refuse("the pieces before and after a corner lie in the working plane");
  const FlatPiece first = flat_piece(axes, before.motion, before.arc, before.from, before.to);
  const FlatPiece second = flat_piece(axes, next.motion, next.arc, next.from, next.to);
  if ((!first.is_arc && (first.to - first.from).norm() < 1e-9) ||
      (!second.is_arc && (second.to - second.from).norm() < 1e-9))
    refuse("a piece beside the corner has no length in the working plane");
  std::string why;
  const std::optional<FlatCorner> found = corner.round ? round_corner(first, second, corner.size_mm, why)
                                                       : cut_corner(first, second, corner.size_mm, why);
  if (!found) refuse(why);
  const auto place = [&](Element& element, const Vec2& at) {
    element.to[axes.first] = at.x();
    element.to[axes.second] = at.y();
    element.target.set(axes.first, at.x(), false);
    element.target.set(axes.second, at.y(), false);
  };
  Element shortened = before;
  place(shortened, found->leave);
  emit(executor, shortened);
  Element between;
  between.place = corner.place;
  between.feed = corner.feed;
  between.from = shortened.to;
  between.to = before.to;
  between.motion = before.motion == Motion::kRapid ? Motion::kRapid : Motion::kFeed;
  if (corner.round) {
    between.motion = found->counter_clockwise ? Motion::kCounterClockwise : Motion::kClockwise;
    Vec3 centre = Vec3::Zero();
    centre[axes.first] = found->centre.x();
    centre[axes.second] = found->centre.y();
    between.arc.centre = centre;
  }
  place(between, found->join);
  emit(executor, between);
  next.from = between.to;
  executor.control.report.at(here.file, here.line, here.column);
}

void no_open_corner(PathState& path, BlockReader& reader, size_t offset) {
  if (path.approach)
    reader.fail("bad-approach", offset, "APPR before this block has no piece of contour behind it",
                "write L, LP, C, CR or CP in the working plane right behind APPR");
  if (!path.held) return;
  reader.fail("bad-corner", offset, "the corner before this block has no piece of contour behind it",
              "write L, C, CR or CP right behind RND and CHF");
}

}  // namespace swarf::program::nc::heidenhain
