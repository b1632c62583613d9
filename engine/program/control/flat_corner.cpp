#include "program/control/flat_corner.h"
#include "base/angles.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace swarf::program::nc {
namespace {

constexpr double kNoCornerWay = 1e-9;

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}
Vec2 left(const Vec2& v) {
  return {-v.y(), v.x()};
}

/// Unit direction of travel at a point of the piece.
Vec2 tangent(const FlatPiece& piece, const Vec2& at) {
  if (!piece.is_arc) return (piece.to - piece.from).normalized();
  const Vec2 along = left(at - piece.centre).normalized();
  return piece.counter_clockwise ? along : Vec2(-along);
}

/// The curve on which the centres of touching circles lie: a line, or a circle of radius >= 0.
struct Locus {
  bool circle = false;
  Vec2 point, direction;  ///< of the line; `point` is the centre of the circle
  double radius = 0.0;
};

Locus locus(const FlatPiece& piece, double radius, double side) {
  Locus locus;
  locus.circle = piece.is_arc;
  if (!piece.is_arc) {
    locus.direction = tangent(piece, piece.from);
    locus.point = piece.from + side * radius * left(locus.direction);
    return locus;
  }
  const bool inside = piece.counter_clockwise == (side > 0.0);
  const double own = (piece.from - piece.centre).norm();
  locus.point = piece.centre;
  locus.radius = inside ? own - radius : own + radius;
  return locus;
}

struct Points {
  std::array<Vec2, 2> at{Vec2::Zero(), Vec2::Zero()};
  int count = 0;
};

Points meet(const Locus& a, const Locus& b) {
  Points points;
  if (a.circle && !b.circle) return meet(b, a);
  if (!a.circle && !b.circle) {
    const double turn = cross(a.direction, b.direction);
    if (std::abs(turn) < kNoCornerWay) return points;
    points.at[0] = a.point + cross(b.point - a.point, b.direction) / turn * a.direction;
    points.count = 1;
    return points;
  }
  if (b.radius < 0.0 || (a.circle && a.radius < 0.0)) return points;
  // Two circles meet on a line across the one through their centres.
  Vec2 foot, along;
  if (!a.circle) {
    along = a.direction;
    foot = a.point + (b.point - a.point).dot(along) * along;
  } else {
    const Vec2 between = b.point - a.point;
    const double distance = between.norm();
    if (distance < kNoCornerWay) return points;
    const double x = 0.5 * (distance + (a.radius * a.radius - b.radius * b.radius) / distance);
    foot = a.point + x / distance * between;
    along = left(between) / distance;
  }
  const double square = b.radius * b.radius - (foot - b.point).squaredNorm();
  if (square < 0.0) return points;
  const double half = std::sqrt(square);
  points.at = {Vec2(foot - half * along), Vec2(foot + half * along)};
  points.count = 2;
  return points;
}

Vec2 touch_of_piece(const FlatPiece& piece, const Vec2& centre) {
  if (piece.is_arc) {
    const Vec2 out = centre - piece.centre;
    return piece.centre + (piece.from - piece.centre).norm() * out.normalized();
  }
  const Vec2 along = tangent(piece, piece.from);
  return piece.from + (centre - piece.from).dot(along) * along;
}

/// The point lies on the piece, ends included.
bool on(const FlatPiece& piece, const Vec2& point) {
  if (!piece.is_arc) {
    const double along = (point - piece.from).dot(tangent(piece, piece.from));
    return along >= -kNoCornerWay && along <= (piece.to - piece.from).norm() + kNoCornerWay;
  }
  const auto angle = [&](const Vec2& p) {
    const Vec2 a = piece.from - piece.centre, b = p - piece.centre;
    const double turned = (piece.counter_clockwise ? 1.0 : -1.0) * std::atan2(cross(a, b), a.dot(b));
    return turned < -kNoCornerWay ? turned + kTurn : turned;
  };
  const double whole = (piece.to - piece.from).norm() < kNoCornerWay ? kTurn : angle(piece.to);
  return angle(point) <= whole + kNoCornerWay;
}

}  // namespace

double turn_at_corner(const FlatPiece& before, const FlatPiece& after) {
  const Vec2 in = tangent(before, before.to), out = tangent(after, after.from);
  return std::atan2(cross(in, out), in.dot(out));
}

std::optional<FlatCorner> round_corner(const FlatPiece& before, const FlatPiece& after, double radius,
                                       std::string& why) {
  const double turn = cross(tangent(before, before.to), tangent(after, after.from));
  if (std::abs(turn) < kNoCornerWay) {
    why = "the contour does not turn here";
    return std::nullopt;
  }
  const double side = turn > 0.0 ? 1.0 : -1.0;
  const Points found = meet(locus(before, radius, side), locus(after, radius, side));
  std::optional<FlatCorner> best;
  for (int i = 0; i < found.count; ++i) {
    const Vec2& centre = found.at[static_cast<size_t>(i)];
    const FlatCorner corner{touch_of_piece(before, centre), touch_of_piece(after, centre), centre,
                            side > 0.0};
    if (!on(before, corner.leave) || !on(after, corner.join)) continue;
    const Vec2 at = before.to;
    if (!best || (corner.leave - at).norm() < (best->leave - at).norm()) best = corner;
  }
  if (!best) why = "the pieces before and after it are too short, or no circle touches both";
  return best;
}

std::optional<FlatCorner> cut_corner(const FlatPiece& before, const FlatPiece& after, double length,
                                     std::string& why) {
  if (before.is_arc || after.is_arc) {
    why = "a chamfer needs straight pieces before and after it: where it ends on an arc is not published";
    return std::nullopt;
  }
  if (std::abs(cross(tangent(before, before.to), tangent(after, after.from))) < kNoCornerWay) {
    why = "the contour does not turn here, or goes back the way it came";
    return std::nullopt;
  }
  if (length > (before.to - before.from).norm() + kNoCornerWay ||
      length > (after.to - after.from).norm() + kNoCornerWay) {
    why = "the pieces before and after it are too short";
    return std::nullopt;
  }
  FlatCorner corner;
  corner.leave = before.to - length * tangent(before, before.to);
  corner.join = after.from + length * tangent(after, after.from);
  return corner;
}

}  // namespace swarf::program::nc
