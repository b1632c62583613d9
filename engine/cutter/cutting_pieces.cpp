#include "cutter/cutting_pieces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "base/check.h"
#include "base/plane_vectors.h"
#include "base/units.h"
#include "cutter/profile.h"

namespace swarf::cutter {
namespace {

using Outline = std::vector<OutlineElement>;

constexpr double kReflexRad = 1e-9;       // a smaller turn into the material is rounding
constexpr double kTouch = 1e-9;           // mm; lengths below are rounding
constexpr double kRoundRad = 0.75 * kPi;  // a Round turns through less than half a turn
constexpr double kInfinity = std::numeric_limits<double>::infinity();

int chord_count(const OutlineElement& arc) {
  const double step = 2.0 * std::acos(std::max(0.0, 1.0 - kChordTolerance / std::abs(arc.radius)));
  return std::max(1, static_cast<int>(std::ceil(arc_angle(arc) / step)));
}

/// The outline with its hollow arcs as chords.
Outline without_hollows(const Outline& outline) {
  Outline straight;
  for (const OutlineElement& element : outline) {
    if (element.radius >= 0.0) {
      straight.push_back(element);
      continue;
    }
    const int count = chord_count(element);
    const Vec2 arm = element.from - element.centre;
    Vec2 last = element.from;
    for (int i = 1; i <= count; ++i) {
      const Vec2 next =
          i == count ? element.to
                     : Vec2(element.centre + Eigen::Rotation2Dd(-arc_angle(element) * i / count) * arm);
      straight.push_back({last, next, 0.0, Vec2::Zero()});
      last = next;
    }
  }
  return straight;
}

/// Distance along the ray to the element; infinity when it misses. A corner that it passes within kTouch
/// counts as hit: the ray then ends early, which is always allowed.
double hit(const Vec2& origin, const Vec2& direction, const OutlineElement& element) {
  if (element.is_line()) {
    const Vec2 along = element.to - element.from, to_line = element.from - origin;
    const double turn = cross(direction, along);
    if (turn == 0.0) return kInfinity;
    const double t = cross(to_line, along) / turn, s = cross(to_line, direction) / turn;
    const double slack = kTouch / along.norm();
    return t > kTouch && s >= -slack && s <= 1.0 + slack ? t : kInfinity;
  }
  const Vec2 offset = origin - element.centre;
  const double r = element.radius;
  const double b = offset.dot(direction), discriminant = b * b - offset.squaredNorm() + r * r;
  if (discriminant < 0.0) return kInfinity;
  const Vec2 from = element.from - element.centre, to = element.to - element.centre;
  for (const double t : {-b - std::sqrt(discriminant), -b + std::sqrt(discriminant)}) {
    const Vec2 arm = offset + t * direction;
    if (t > kTouch && cross(from, arm) >= -kTouch * r && cross(arm, to) >= -kTouch * r) return t;
  }
  return kInfinity;
}

/// Where a ray that goes from a corner straight into the material leaves it: at the axis, at the top or at
/// one of the elements ahead.
Vec2 exit_of(std::span<const OutlineElement> ahead, double top, const Vec2& origin, const Vec2& direction) {
  double t = kInfinity;
  if (direction.x() < 0.0) t = origin.x() / -direction.x();
  if (direction.y() > 0.0) t = std::min(t, (top - origin.y()) / direction.y());
  for (const OutlineElement& element : ahead) t = std::min(t, hit(origin, direction, element));
  SWARF_CHECK(std::isfinite(t), "a ray into the cutter leaves it again");
  return origin + t * direction;
}

/// A direction of travel that rounding or a dip below the profile's tolerance turned downwards, made level.
Vec2 rising(const Vec2& tangent) {
  return tangent.y() >= 0.0 ? tangent : Vec2(tangent.x() < 0.0 ? -1.0 : 1.0, 0.0);
}

class PieceBuilder {
 public:
  explicit PieceBuilder(const Vec2& start) : low_(start.y()), high_(start.y()) { reach(start); }

  void add(const OutlineElement& element) {
    reach(element.to);
    if (element.is_line()) {
      const Vec2 normal = outward(rising(end_tangent(element)));
      face(normal, std::max(normal.dot(element.from), normal.dot(element.to)));
    } else {
      arc(element);
    }
  }
  /// A point that the piece reaches straight beyond its part of the outline.
  void reach(const Vec2& point) {
    radius_ = std::max(radius_, point.x());
    low_ = std::min(low_, point.y());
    high_ = std::max(high_, point.y());
  }
  /// A level end, unless the outline itself has one there.
  void cap(double side, double z) {
    const auto level = [&](const Face& f) { return f.normal == Vec2(0.0, side) && f.offset == side * z; };
    if (std::none_of(piece_.faces.begin(), piece_.faces.end(), level)) face({0.0, side}, side * z);
  }
  ConvexPiece take() {
    piece_.radius = radius_;
    piece_.low = low_;
    piece_.high = high_;
    return std::move(piece_);
  }

 private:
  void face(const Vec2& normal, double offset) { piece_.faces.push_back({normal, offset}); }

  void arc(const OutlineElement& element) {
    const double r = element.radius;
    const Vec2 from = outward(rising(start_tangent(element)));
    const Vec2 to = outward(rising(end_tangent(element)));
    if (from.y() <= 0.0 && to.y() >= 0.0) radius_ = std::max(radius_, element.centre.x() + r);
    if (arc_angle(element) <= kRoundRad) {
      piece_.rounds.push_back({element.centre, r, from, to});
      return;
    }
    const Vec2 middle = (from + to).norm() > 1e-3 ? Vec2((from + to).normalized()) : left(from);
    piece_.rounds.push_back({element.centre, r, from, middle});
    piece_.rounds.push_back({element.centre, r, middle, to});
  }

  ConvexPiece piece_;
  double radius_ = 0.0, low_, high_;
};

/// The piece of the elements [begin, end), a convex stretch of the outline, carried on beyond both its ends.
ConvexPiece piece_of(std::span<const OutlineElement> outline, size_t begin, size_t end) {
  const auto stretch = outline.subspan(begin, end - begin);
  const double top = outline.back().to.y();
  PieceBuilder build(stretch.front().from);
  for (const OutlineElement& element : stretch) build.add(element);
  const auto carry_on = [&](std::span<const OutlineElement> ahead, const Vec2& from, const Vec2& direction) {
    const Vec2 exit = exit_of(ahead, top, from, direction);
    build.reach(exit);
    if (exit.x() > kTouch) build.cap(direction.y() > 0.0 ? 1.0 : -1.0, exit.y());
  };
  const Vec2 down = -rising(start_tangent(stretch.front())), up = rising(end_tangent(stretch.back()));
  // A level stretch of the outline is itself the end of the piece.
  if (begin > 0 && down.y() < 0.0) carry_on(outline.first(begin), stretch.front().from, down);
  if (end < outline.size()) {
    if (up.y() > 0.0) carry_on(outline.subspan(end), stretch.back().to, up);
  } else if (stretch.back().to.x() > kTouch) {
    build.cap(1.0, top);
  }
  return build.take();
}

}  // namespace

std::vector<ConvexPiece> cutting_pieces(const Cutter& cutter) {
  SWARF_CHECK(validate(cutter).empty(), "the pieces of a cutter that has problems");
  const Outline elements = without_hollows(outline(cutter));
  std::vector<ConvexPiece> pieces;
  size_t begin = 0;
  for (size_t i = 1; i <= elements.size(); ++i) {
    const bool ends = i == elements.size() || cross(rising(end_tangent(elements[i - 1])),
                                                    rising(start_tangent(elements[i]))) < -kReflexRad;
    if (!ends) continue;
    pieces.push_back(piece_of(elements, begin, i));
    begin = i;
  }
  return pieces;
}

double chord_error_mm(const Cutter& cutter) {
  double worst = 0.0;
  for (const OutlineElement& element : outline(cutter)) {
    if (element.radius >= 0.0) continue;
    const double half = 0.5 * arc_angle(element) / chord_count(element);
    worst = std::max(worst, -element.radius * (1.0 - std::cos(half)));
  }
  return worst;
}

}  // namespace swarf::cutter
