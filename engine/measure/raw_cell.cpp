#include "measure/raw_cell.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace swarf::measure {
namespace {

/// Of the radius of a ball: beyond the rounding of what lies in it.
constexpr double kWider = 1e-9, kRawRounding = 1e-7;  // share; mm
constexpr double kAlmost = 0.999;                     // of a radius: a place in the ball
/// A cell that reaches so far beyond a face, of the ball's radius, is not held against it.
constexpr double kBeyond = 0.1;

/// The columns of a cell around the one in its middle: at height s none is farther from it than width + |s|
/// spread.
struct ColumnTube {
  Vec3 centre, normal;
  double width, spread;

  explicit ColumnTube(const DesignCell& cell)
      : centre(cell.centroid()),
        normal(cell.mean_normal()),
        width(cell.radius() + cell.flatness_mm),
        spread(cell.turn) {
    double lean = 0.0;
    for (const CellCorner& corner : cell.corners) lean = std::max(lean, (corner.normal - normal).norm());
    spread += lean;
  }
  Vec3 at(double s) const { return centre + s * normal; }
  double aside(double s) const { return width + std::abs(s) * spread; }
};

struct RawBall {
  Vec3 centre;
  double radius;
};

}  // namespace

double raw_air_above(const DesignCell& cell, const stock::RawShape& raw, double top_mm) {
  constexpr int kMostSteps = 32;
  const ColumnTube tube(cell);
  double s = top_mm;
  for (int step = 0; step < kMostSteps && s > 0.0; ++step) {
    const double free = raw.distance_mm(tube.at(s)) - tube.aside(s);
    if (!(free > 0.0)) break;
    s -= free;
    if (free < 0.1 * tube.width) break;
  }
  return std::max(s, 0.0);
}

namespace {

/// Above one plane over all of the surface in the ball.
std::optional<CornerHeights> beyond_one(const DesignCell& cell, const stock::RawShape& raw,
                                        const RawBall& ball, const Vec3& out) {
  const stock::RawExtent surface = raw.extent(ball.centre, ball.radius, out);
  if (surface.empty()) {
    if (raw.distance_mm(ball.centre) > 0.0) return CornerHeights{0.0, 0.0, 0.0};
    return std::nullopt;
  }
  const Vec3 probe = ball.centre + kAlmost * ball.radius * out;
  if (!(out.dot(probe) > surface.greatest + kRawRounding) || !(raw.distance_mm(probe) > 0.0))
    return std::nullopt;
  return outside_from(cell, out, surface.greatest);
}

/// Heights from which on the columns lie above a face, up to `high`.
std::optional<CornerHeights> above_face(const DesignCell& cell, const stock::RawFace& face, double high) {
  const double margin = face.greatest + cell.flatness_mm + cell.turn * high - kTouch;
  bool above = true;
  for (const CellCorner& corner : cell.corners) {
    const double from = face.normal.dot(corner.point), to = from + high * face.normal.dot(corner.normal);
    above = above && std::min(from, to) >= margin;
  }
  if (above) return CornerHeights{0.0, 0.0, 0.0};
  const CornerHeights heights = outside_from(cell, face.normal, face.greatest);
  return heights[0] < kNever ? std::optional(heights) : std::nullopt;
}

/// A place above all faces of a ball, as far from them as it is easily found; `side` -1: below.
std::optional<Vec3> place_between(const RawBall& ball, const std::vector<stock::RawFace>& faces,
                                  const Vec3& guess, double side, double& margin) {
  Vec3 mean = Vec3::Zero();
  for (const stock::RawFace& face : faces) mean += face.normal;
  for (const Vec3& way : {mean, guess}) {
    if (!(way.norm() > 0.0)) continue;
    const Vec3 place = ball.centre + side * 0.5 * ball.radius * way.normalized();
    margin = kNever;
    for (const stock::RawFace& face : faces) {
      const double at = face.normal.dot(place);
      margin = std::min(margin, side > 0.0 ? at - face.greatest : face.least - at);
    }
    if (margin > kRawRounding) return place;
  }
  return std::nullopt;
}

/// How far planes are moved where a face that ends at one of them is left out, so that the rounding of its
/// corners does not count; mm.
constexpr double kMovedPlane = 1e-5;

/// Whether a face lies wholly on the other side of one of `kept`: above it (`side` 1), or below.
bool is_cut_off(const stock::RawFace& face, const std::vector<stock::RawFace>& kept, double side) {
  return !face.hull.empty() && std::any_of(kept.begin(), kept.end(), [&](const stock::RawFace& plane) {
    const double limit = side > 0.0 ? plane.least : -plane.greatest;
    return std::all_of(face.hull.begin(), face.hull.end(),
                       [&](const Vec3& p) { return side * plane.normal.dot(p) >= limit - kMovedPlane; });
  });
}

/// The faces for which `meets` holds, moved a little where others had to be left out; nothing where one of
/// those may reach into what the kept ones bound. `side`: of the planes on which the others lie.
template <typename Meets>
std::vector<stock::RawFace> bounding_faces(const stock::RawShape& raw, const RawBall& ball, double side,
                                           const Meets& meets) {
  std::vector<stock::RawFace> kept, others;
  for (stock::RawFace& face : raw.faces(ball.centre, ball.radius))
    (meets(face) ? kept : others).push_back(std::move(face));
  for (const stock::RawFace& face : others)
    if (!is_cut_off(face, kept, side)) return {};
  for (stock::RawFace& face : kept) {
    face.least -= others.empty() ? 0.0 : kMovedPlane;
    face.greatest += others.empty() ? 0.0 : kMovedPlane;
  }
  return kept;
}

/// Above all faces in the ball at once.
std::optional<CornerHeights> beyond_all(const DesignCell& cell, const stock::RawShape& raw,
                                        const RawBall& ball, const Vec3& out, double air_mm) {
  const std::vector<stock::RawFace> faces = bounding_faces(raw, ball, -1.0, [&](const stock::RawFace& face) {
    return above_face(cell, face, air_mm).has_value();
  });
  double margin = 0.0;
  const auto probe = place_between(ball, faces, out, 1.0, margin);
  if (faces.empty() || !probe || !(raw.distance_mm(*probe) > 0.0)) return std::nullopt;
  CornerHeights all{0.0, 0.0, 0.0};
  for (const stock::RawFace& face : faces) {
    const auto heights = above_face(cell, face, air_mm);
    if (!heights) return std::nullopt;
    for (size_t k = 0; k < 3; ++k) all[k] = std::max(all[k], (*heights)[k]);
  }
  return all;
}

/// Places whose hull holds the cell but for its stray.
std::vector<Vec3> hull_of(const DesignCell& cell) {
  std::vector<Vec3> places;
  for (const CellCorner& corner : cell.corners) places.push_back(corner.point);
  for (size_t k = 0; k < 3 && cell.is_curved(); ++k) places.push_back(cell.side(k).point);
  return places;
}

/// Below one plane under all of the surface in the ball: how far down the columns reach it.
double down_to_one(const DesignCell& cell, const stock::RawShape& raw, const RawBall& ball, const Vec3& out,
                   const ColumnTube& tube) {
  const stock::RawExtent surface = raw.extent(ball.centre, ball.radius, out);
  const Vec3 probe = ball.centre - kAlmost * ball.radius * out;
  if (surface.empty() || !(out.dot(probe) < surface.least - kRawRounding) || !(raw.distance_mm(probe) < 0.0))
    return kNever;
  double beyond = 0.0, rise = kNever;
  for (const Vec3& p : hull_of(cell)) beyond = std::max(beyond, out.dot(p) + cell.stray_mm - surface.least);
  for (const CellCorner& corner : cell.corners) rise = std::min(rise, out.dot(corner.normal) - cell.turn);
  if (beyond <= 0.0) return 0.0;
  const double down = beyond / rise;
  return rise > 0.0 && down + tube.aside(down) <= ball.radius ? down : kNever;
}

/// Below all faces in the ball at once: how far the cell's places are from there. A place that lies `beyond`
/// reaches it on the way to one that lies `margin` within, after that share of the way.
double down_to_all(const DesignCell& cell, const stock::RawShape& raw, const RawBall& ball, const Vec3& out) {
  const std::vector<Vec3> hull = hull_of(cell);
  const std::vector<stock::RawFace> faces = bounding_faces(raw, ball, 1.0, [&](const stock::RawFace& face) {
    return std::all_of(hull.begin(), hull.end(), [&](const Vec3& p) {
      return face.normal.dot(p) + cell.stray_mm <= face.least + kBeyond * ball.radius;
    });
  });
  double margin = 0.0;
  const auto probe = place_between(ball, faces, out, -1.0, margin);
  if (faces.empty() || !probe || !(raw.distance_mm(*probe) < 0.0)) return kNever;
  double beyond = 0.0, way = 0.0;
  for (const Vec3& p : hull) {
    for (const stock::RawFace& face : faces)
      beyond = std::max(beyond, face.normal.dot(p) + cell.stray_mm - face.least);
    way = std::max(way, (p - *probe).norm() + cell.stray_mm);
  }
  return beyond / (beyond + margin) * way;
}

}  // namespace

std::optional<CornerHeights> raw_outside(const DesignCell& cell, const stock::RawShape& raw, double air_mm) {
  const ColumnTube tube(cell);
  const RawBall ball{tube.at(0.5 * air_mm),
                     (0.5 * air_mm + tube.aside(air_mm)) * (1.0 + kWider) + kRawRounding};
  const Vec3 out = raw.at(tube.at(air_mm)).normal;
  const auto one = beyond_one(cell, raw, ball, out);
  if (one && (*one)[0] < kNever) return one;
  return beyond_all(cell, raw, ball, out, air_mm);
}

double raw_stood(const DesignCell& cell, const stock::RawShape& raw) {
  const ColumnTube tube(cell);
  const stock::RawPoint here = raw.at(tube.centre);
  if (-here.distance_mm > tube.width) return (-here.distance_mm - tube.width) / (1.0 + tube.spread);
  const RawBall ball{tube.centre, 2.0 * tube.width + 1e2 * kRawRounding};
  double lacking = std::max(0.0, here.distance_mm) + tube.width;
  lacking = std::min(lacking, down_to_one(cell, raw, ball, here.normal, tube));
  if (lacking > 0.0) lacking = std::min(lacking, down_to_all(cell, raw, ball, here.normal));
  return -lacking;
}

}  // namespace swarf::measure
