#include "program/control/corner.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "program/control/emit.h"
#include "program/control/flat_corner.h"

namespace swarf::program::nc {
namespace {

/// Lengths below this are rounding, mm.
constexpr double kNoPieceMm = 1e-9;

void pass_on(Control& control, const Segment& segment) {
  if (control.corners.kept != nullptr) {
    control.corners.kept->push_back(segment);
  } else if (control.contour.side() == Compensation::kOff && !control.contour.leading_out()) {
    emit(control, segment);
  } else {
    control.contour.add(segment);
  }
}

[[noreturn]] void refuse_corner(const Control& control, const CornerWords& words, const std::string& why,
                                const std::string& fix) {
  Report::fail_at({control.report.file_name(words.place), words.place.line, words.place.column}, "bad-corner",
                  "no corner can be here: " + why, fix);
}

/// Why no corner can touch this piece; "" where one can.
std::string unfit(const Control& control, const Segment& piece) {
  const Vec3 normal = Vec3::Unit(axes_of(control.modal.plane).normal);
  if (piece.motion == Motion::kRapid) return "a rapid move stands beside it";
  if (piece.machine || piece.turns_rotaries) return "a rotary axis turns beside it";
  if (std::abs((piece.to - piece.from).dot(normal)) > kNoPieceMm ||
      (piece.is_arc() && (piece.normal.cross(normal).norm() > kNoPieceMm || piece.further_turns > 0)))
    return "a move beside it leaves the working plane";
  if (!piece.is_arc() && (piece.to - piece.from).norm() < kNoPieceMm) return "a move beside it has no length";
  if (piece.feed_mode == FeedMode::kInverseTime) return "G93 gives the time of whole blocks";
  return "";
}

Vec2 flat(const PlaneAxes& axes, const Vec3& v) {
  return {v[axes.first], v[axes.second]};
}

FlatPiece flat_piece(const PlaneAxes& axes, const Segment& piece) {
  const bool left = piece.normal[axes.normal] > 0.0;
  return {flat(axes, piece.from), flat(axes, piece.to), piece.is_arc(), flat(axes, piece.centre), left};
}

Vec3 at_height(const PlaneAxes& axes, const Vec2& point, const Vec3& height) {
  Vec3 p = height;
  p[axes.first] = point.x();
  p[axes.second] = point.y();
  return p;
}

std::optional<FlatCorner> flat_corner(const CornerWords& words, const FlatPiece& before,
                                      const FlatPiece& after, std::string& why) {
  if (words.kind == CornerWords::Kind::kRound) return round_corner(before, after, words.size_mm, why);
  // A chord across a corner that turns by a: each leg is half of it over cos(a / 2).
  const double turn = turn_at_corner(before, after);
  const bool chord = words.kind == CornerWords::Kind::kChord;
  return cut_corner(before, after, chord ? 0.5 * words.size_mm / std::cos(0.5 * turn) : words.size_mm, why);
}

/// What joins both pieces, with the words of one of them.
Segment corner_piece(const Control& control, const CornerWords& words, const FlatCorner& corner,
                     const Segment& before, const Segment& after) {
  const PlaneAxes axes = axes_of(control.modal.plane);
  Segment piece = words.feed_of_next ? after : before;
  piece.place = words.place;
  piece.dwell_s = 0.0;
  piece.from = at_height(axes, corner.leave, before.to);
  piece.to = at_height(axes, corner.join, before.to);
  if (words.feed > 0.0) piece.feed = words.feed;
  const bool round = words.kind == CornerWords::Kind::kRound;
  piece.motion = round ? Motion::kCounterClockwise : Motion::kFeed;
  piece.centre = at_height(axes, corner.centre, before.to);
  piece.normal = (corner.counter_clockwise ? 1.0 : -1.0) * Vec3(Vec3::Unit(axes.normal));
  return piece;
}

/// Sends the piece that waits with its corner, and shortens the next one. False: all of that one is gone.
bool join(Control& control, Segment& next) {
  const auto [before, words] = *std::exchange(control.corners.held, std::nullopt);
  const std::string why_not = unfit(control, next);
  if (!why_not.empty() && words.modal) return pass_on(control, before), true;
  if (!why_not.empty())
    refuse_corner(control, words, why_not, "write it between two feed moves in the plane of G17, G18 or G19");
  const PlaneAxes axes = axes_of(control.modal.plane);
  const FlatPiece first = flat_piece(axes, before), second = flat_piece(axes, next);
  if (std::abs(turn_at_corner(first, second)) <= words.smooth_rad) return pass_on(control, before), true;
  std::string why;
  const std::optional<FlatCorner> corner = flat_corner(words, first, second, why);
  if (!corner)
    refuse_corner(control, words, why, "make the corner smaller or the moves longer, or write it as blocks");
  Segment shortened = before;
  shortened.to = at_height(axes, corner->leave, before.to);
  if ((shortened.to - shortened.from).norm() > kNoPieceMm) pass_on(control, shortened);
  pass_on(control, corner_piece(control, words, *corner, before, next));
  next.from = at_height(axes, corner->join, next.from);
  return (next.to - next.from).norm() > kNoPieceMm;
}

}  // namespace

void ask_corner(Control& control, const CornerWords& words) {
  control.corners.asked = words;
}

void take_piece(Control& control, const Segment& segment) {
  if (!control.corners.asked && !control.corners.held) return pass_on(control, segment);
  const std::optional<CornerWords> asked = std::exchange(control.corners.asked, std::nullopt);
  Segment piece = segment;
  if (control.corners.held && !join(control, piece)) {
    if (asked && !asked->modal)
      refuse_corner(control, *asked, "the corner before it takes the whole move", "make the corners smaller");
    return;
  }
  if (!asked) return pass_on(control, piece);
  const std::string why_not = unfit(control, piece);
  if (!why_not.empty() && asked->modal) return pass_on(control, piece);
  if (!why_not.empty())
    refuse_corner(control, *asked, why_not,
                  "write it between two feed moves in the plane of G17, G18 or G19");
  control.corners.held = {piece, *asked};
}

void send_kept(Control& control, const Segment& segment) {
  pass_on(control, segment);
  control.path.position_valid = false;
}

void release_corner(Control& control) {
  if (!control.corners.held) return;
  const auto [piece, words] = *std::exchange(control.corners.held, std::nullopt);
  if (words.modal) return pass_on(control, piece);
  refuse_corner(control, words, "no move in the plane follows",
                "write the move behind the corner before offsets, tools and the program's end");
}

}  // namespace swarf::program::nc
