#include "program/control/contour.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/angles.h"
#include "base/check.h"
#include "base/units.h"
#include "program/control/curve.h"

namespace swarf::program::nc {
namespace {

/// Shorter ways in the plane are none.
constexpr double kNoWay = 1e-9;

struct Crossings {
  std::array<Vec3, 2> point;
  int count = 0;
};

/// Line through a along the unit vector d, circle about c, all in one plane.
Crossings line_circle(const Vec3& a, const Vec3& d, const Vec3& c, double radius) {
  const Vec3 from = a - c;
  const double along = -from.dot(d);
  const double off_squared = (from + along * d).squaredNorm(), square = radius * radius - off_squared;
  // A line that touches the circle may miss it by rounding.
  if (square < -1e-9 * radius) return {};
  const double half = std::sqrt(std::max(0.0, square));
  return {{Vec3(a + (along - half) * d), Vec3(a + (along + half) * d)}, 2};
}

Crossings circle_circle(const Vec3& a, double ra, const Vec3& b, double rb, const Vec3& normal) {
  const Vec3 between = b - a;
  const double distance = between.norm();
  if (distance < kNoWay) return {};
  const Vec3 d = between / distance;
  const double along = 0.5 * (distance + (ra * ra - rb * rb) / distance), square = ra * ra - along * along;
  if (square < -1e-9 * ra) return {};
  const Vec3 across = std::sqrt(std::max(0.0, square)) * normal.cross(d);
  return {{Vec3(a + along * d + across), Vec3(a + along * d - across)}, 2};
}

}  // namespace

Vec3 Contour::normal() const {
  return Vec3::Unit(axes_of(control_.plane()).normal);
}

Vec3 Contour::flat(const Vec3& v) const {
  Vec3 in_plane = v;
  in_plane[axes_of(control_.plane()).normal] = 0.0;
  return in_plane;
}

Vec3 Contour::at_height(const Vec3& in_plane, const Vec3& height) const {
  return flat(in_plane) + (height - flat(height));
}

Vec3 Contour::aside(const Vec3& along) const {
  const Vec3 left = normal().cross(along);
  return side_ == Compensation::kLeft ? left : Vec3(-left);
}

Vec3 Contour::tangent(const Segment& segment, const Vec3& at) const {
  if (!segment.is_arc()) return flat(segment.to - segment.from).normalized();
  return segment.normal.cross(flat(at - segment.centre)).normalized();
}

void Contour::set_side(Compensation side, double radius_mm, int column) {
  if (side == side_ && (side == Compensation::kOff || radius_mm == radius_)) return;
  if (side == Compensation::kOff) {
    if (!leading_in_) leading_out_ = true;
    leading_in_ = false;
    side_ = side;
    return;
  }
  if (side_ != Compensation::kOff || leading_out_) {
    control_.fail("compensation-active", column,
                  "cutter compensation changes its side or radius while it is on",
                  fmt::format("write {} and a straight move before it", control_.words().compensation_off));
  }
  side_ = side;
  radius_ = radius_mm;
  leading_in_ = true;
  tool_known_ = false;
}

void Contour::enter(Compensation side, double radius_mm, const Vec3& tool) {
  SWARF_CHECK(side_ == Compensation::kOff && !leading_out_ && !pending_,
              "compensation is entered while it is on");
  side_ = side;
  radius_ = radius_mm;
  leading_in_ = false;
  tool_ = tool;
  tool_known_ = true;
}

void Contour::gouge(const Segment& segment, const char* why) const {
  Place place = segment.place;
  control_.at(place.file, place.line, place.column);
  control_.fail("compensation-gouge", place.column,
                fmt::format("{} for a cutter of radius {:.4f} mm", why, radius_),
                "use a smaller cutter, or a wider corner");
}

Contour::Piece Contour::offset(const Segment& programmed) const {
  Piece piece;
  piece.segment = programmed;
  piece.corner = programmed.to;
  piece.way = (programmed.to - programmed.from).norm();
  piece.tangent_from = tangent(programmed, programmed.from);
  piece.tangent_to = tangent(programmed, programmed.to);
  if (programmed.is_arc()) {
    const Vec3 axis = programmed.normal;
    if (std::abs(axis.dot(normal())) < 1.0 - 1e-9) {
      control_.fail("compensation-plane", programmed.place.column,
                    "cutter compensation of an arc outside its plane",
                    fmt::format("switch it off first: {}", control_.words().compensation_off));
    }
    const Vec3 outwards = flat(programmed.from - programmed.centre);
    const double way = aside(piece.tangent_from).dot(outwards.normalized()) * radius_;
    piece.way = outwards.norm() * swept(programmed);
    if (!(outwards.norm() + way > kNoWay)) gouge(programmed, "the inside of this arc is too narrow");
  }
  piece.segment.from = programmed.from + radius_ * aside(piece.tangent_from);
  piece.segment.to = programmed.to + radius_ * aside(piece.tangent_to);
  return piece;
}

void Contour::add(const Segment& programmed) {
  if (programmed.turns_rotaries) {
    control_.fail("compensation-rotaries", programmed.place.column,
                  "a rotary axis turns while cutter compensation is on",
                  fmt::format("switch it off first: {}", control_.words().compensation_off));
  }
  const bool moves = programmed.is_arc() || flat(programmed.to - programmed.from).norm() > kNoWay;
  if (!moves) {
    waiting_.push_back(programmed);
    if (!pending_) send_waiting(tool_known_ ? flat(tool_ - programmed.from) : Vec3(Vec3::Zero()));
    return;
  }
  if (leading_out_) return lead_out(programmed);
  if (leading_in_) return lead_in(programmed);
  Piece next = offset(programmed);
  if (pending_) join(next);
  next.segment.from = at_height(tool_, programmed.from);
  pending_ = next;
}

void Contour::lead_in_round(const Segment& programmed) {
  Piece piece = offset(programmed);
  const Vec3 end = piece.segment.to, out = flat(end - programmed.centre).normalized();
  // |from - c| = |end - c| with c = end - t out
  const Vec3 chord = flat(end - programmed.from);
  const double along = chord.dot(out), t = along > 0.0 ? 0.5 * chord.squaredNorm() / along : 0.0;
  if (!(t > 1e-6)) {
    control_.fail("compensation-entry", programmed.place.column,
                  fmt::format("no arc leads a cutter of radius {:.4f} mm onto the end of this one", radius_),
                  "lead in on a straight move, or on an arc that is larger than the cutter");
  }
  leading_in_ = false;
  piece.lead_in = true;
  piece.segment.from = programmed.from;
  piece.segment.centre = at_height(end - t * out, programmed.centre);
  tool_ = programmed.from;
  tool_known_ = true;
  pending_ = piece;
}

void Contour::lead_in(const Segment& programmed) {
  if (programmed.is_arc() && entry_ == CompensationEntry::kAlongEntry) return lead_in_round(programmed);
  if (programmed.is_arc()) {
    control_.fail("compensation-entry", programmed.place.column, "cutter compensation starts on an arc",
                  "lead in on a straight move in the plane");
  }
  if (!(flat(programmed.to - programmed.from).norm() > radius_)) {
    control_.fail("compensation-entry", programmed.place.column,
                  fmt::format("the lead-in is {:.4f} mm long, not longer than the cutter radius {:.4f} mm",
                              flat(programmed.to - programmed.from).norm(), radius_),
                  "start the compensation further away from the contour");
  }
  leading_in_ = false;
  Piece piece = offset(programmed);
  piece.lead_in = true;
  piece.segment.from = programmed.from;  // the tool still stands on the programmed point
  tool_ = programmed.from;
  tool_known_ = true;
  pending_ = piece;
}

void Contour::lead_out(const Segment& programmed) {
  if (programmed.is_arc()) {
    control_.fail("compensation-exit", programmed.place.column, "cutter compensation ends on an arc",
                  "lead out on a straight move in the plane");
  }
  send_pending();
  leading_out_ = false;
  Segment out = programmed;
  if (tool_known_) out.from = at_height(tool_, programmed.from);
  tool_known_ = false;
  control_.emit(out);
}

void Contour::send_pending() {
  if (!pending_) return;
  control_.emit(pending_->segment);
  tool_ = pending_->segment.to;
  const Vec3 off = flat(tool_ - pending_->corner);
  pending_.reset();
  send_waiting(off);
}

void Contour::send_waiting(const Vec3& offset) {
  for (Segment& segment : waiting_) {
    segment.from += offset;
    segment.to += offset;
    control_.emit(segment);
    tool_ = segment.to;
  }
  waiting_.clear();
}

void Contour::flush() {
  send_pending();
  if (leading_out_) leading_out_ = tool_known_ = false;
}

void Contour::join(const Piece& next) {
  Piece& before = *pending_;
  if (before.lead_in && entry_ == CompensationEntry::kAcrossNext) {
    before.segment.to = before.corner + radius_ * aside(next.tangent_from);
    send_pending();
    return;
  }
  const double turn = signed_angle(normal(), before.tangent_to, next.tangent_from);
  if (std::abs(turn) <= smooth_rad_) {
    send_pending();
    return;
  }
  const bool turns_left = turn > 0.0, reverses = std::abs(turn) >= kPi - smooth_rad_;
  if (turns_left == (side_ == Compensation::kLeft) && !reverses) {
    inner(next);
  } else {
    outer(next);
  }
}

void Contour::outer(const Piece& next) {
  const Vec3 corner = pending_->corner;
  send_pending();
  Segment round = next.segment;
  round.from = tool_;
  round.to = at_height(corner + radius_ * aside(next.tangent_from), tool_);
  round.centre = at_height(corner, tool_);
  round.normal = side_ == Compensation::kLeft ? Vec3(-normal()) : normal();
  if ((round.to - round.from).norm() <= kNoWay) return;
  if (round.motion == Motion::kRapid) {
    control_.fail(
        "compensation-rapid", round.place.column, "a rapid move goes round a compensated corner",
        fmt::format("switch the compensation off before rapid moves, or use {}", control_.words().feed_move));
  }
  round.motion = Motion::kCounterClockwise;
  round.further_turns = 0;
  round.dwell_s = 0.0;
  round.exact_stop = false;
  if (round.feed_mode == FeedMode::kInverseTime) {
    // G93 times the programmed move; the corner goes at the speed that this gives.
    round.feed_mode = FeedMode::kPerMinute;
    round.feed = next.way * next.segment.feed;
    round.feed_unit_mm = 1.0;
  }
  control_.emit(round);
  tool_ = round.to;
}

Vec3 Contour::meet(const Piece& before, const Piece& after) const {
  const Segment& a = before.segment;
  const Segment& b = after.segment;
  const auto radius = [&](const Segment& arc) { return flat(arc.to - arc.centre).norm(); };
  Crossings found;
  if (!a.is_arc() && !b.is_arc()) {
    const Vec3& da = before.tangent_to;
    const Vec3& db = after.tangent_from;
    const double s = flat(b.from - a.to).cross(db).dot(normal()) / da.cross(db).dot(normal());
    return flat(a.to) + s * da;
  }
  if (a.is_arc() && b.is_arc()) {
    found =
        circle_circle(flat(a.centre), radius(a), flat(b.centre), flat(b.from - b.centre).norm(), normal());
  } else if (b.is_arc()) {
    found = line_circle(flat(a.to), before.tangent_to, flat(b.centre), flat(b.from - b.centre).norm());
  } else {
    found = line_circle(flat(b.from), after.tangent_from, flat(a.centre), radius(a));
  }
  if (found.count == 0) gouge(b, "both sides of this inner corner do not meet");
  const Vec3 corner = flat(before.corner);
  return (found.point[0] - corner).norm() <= (found.point[1] - corner).norm() ? found.point[0]
                                                                              : found.point[1];
}

void Contour::inner(const Piece& next) {
  Piece& before = *pending_;
  const Vec3 point = meet(before, next);
  const auto lies_on = [&](const Segment& segment, const Vec3& from, const Vec3& to) {
    if (!segment.is_arc()) {
      const Vec3 way = flat(to - from);
      const double s = flat(point - from).dot(way);
      return s >= -kNoWay * way.norm() && s <= way.squaredNorm() + kNoWay * way.norm();
    }
    const Vec3 axis = segment.normal, a = flat(from - segment.centre);
    const auto angle = [&](const Vec3& v) {
      const double turned = signed_angle(axis, a, v);
      return turned < -1e-12 ? turned + kTurn : turned;
    };
    const double whole = angle(flat(to - segment.centre));
    return angle(flat(point - segment.centre)) <= (whole <= 1e-12 ? kTurn : whole) + 1e-9;
  };
  if (!before.lead_in && !lies_on(before.segment, before.segment.from, before.segment.to))
    gouge(before.segment, "this move is too short for its inner corner");
  if (!lies_on(next.segment, next.segment.from, next.segment.to))
    gouge(next.segment, "this move is too short for its inner corner");
  before.segment.to = point + (before.segment.to - flat(before.segment.to));
  send_pending();
}

}  // namespace swarf::program::nc
