// Cutters of every shape, and what they are measured with: volumes, polygons, distances.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "base/rng.h"
#include "base/units.h"
#include "cutter/cutting_pieces.h"
#include "cutter/profile.h"

namespace swarf::cutter::test {

inline Cutter of_shape(Shape shape, double diameter, double corner, double flutes) {
  Cutter c;
  c.shape = shape;
  c.diameter_mm = diameter;
  c.corner_radius_mm = corner;
  c.flute_length_mm = flutes;
  c.shank_diameter_mm = diameter;
  return c;
}

inline Cutter taper(double diameter, double corner, double taper_deg, double flutes) {
  Cutter c = of_shape(Shape::kTaper, diameter, corner, flutes);
  c.taper_rad = rad_from_deg(taper_deg);
  return c;
}

inline Cutter drill(double diameter, double point_deg, double flutes) {
  Cutter c = of_shape(Shape::kDrill, diameter, 0.0, flutes);
  c.point_angle_rad = rad_from_deg(point_deg);
  return c;
}

inline Cutter chamfer(double diameter, double tip, double point_deg, double flutes) {
  Cutter c = of_shape(Shape::kChamfer, diameter, 0.0, flutes);
  c.tip_diameter_mm = tip;
  c.point_angle_rad = rad_from_deg(point_deg);
  return c;
}

inline Cutter woodruff(double diameter, double corner, double width) {
  Cutter c = of_shape(Shape::kWoodruff, diameter, corner, width);
  c.shank_diameter_mm = 0.4 * diameter;
  return c;
}

inline Cutter apt(double d, double r, double alpha_deg, double beta_deg, double h) {
  Cutter c = of_shape(Shape::kApt, d, r, h);
  c.alpha_rad = rad_from_deg(alpha_deg);
  c.beta_rad = rad_from_deg(beta_deg);
  c.length_mm = std::max(60.0, 2.0 * h);
  return c;
}

inline Cutter profile(std::vector<ProfilePoint> points) {
  Cutter c;
  set_profile(c, std::move(points));
  c.length_mm = 100.0;
  return c;
}

/// Drill of 6 mm, then a shoulder to 10 mm.
inline Cutter stepped() {
  return profile({{{0, 0}}, {{3, 2}}, {{3, 10}}, {{5, 10}}, {{5, 30}}});
}
/// A ball of 4 mm radius on a stem of 2 mm.
inline Cutter lollipop() {
  return profile({{{0, 0}}, {{4, 4}, 4.0}, {{2, 4 + std::sqrt(12.0)}, 4.0}, {{2, 20}}});
}
/// A cylinder of 6 mm that flares through a fillet of 2 mm to 10 mm.
inline Cutter flared() {
  return profile({{{0, 0}}, {{3, 0}}, {{3, 10}}, {{5, 12}, -2.0}, {{5, 20}}});
}
/// Three teeth of a thread mill.
inline Cutter toothed() {
  return profile({{{0, 0}}, {{4, 0}}, {{5, 1}}, {{4, 2}}, {{5, 3}}, {{4, 4}}, {{5, 5}}, {{4, 6}}, {{4, 9}}});
}

struct Named {
  const char* name;
  Cutter cutter;
  bool convex;
};

inline void PrintTo(const Named& one, std::ostream* out) {
  *out << one.name;
}

inline std::vector<Named> every_shape() {
  return {{"flat", of_shape(Shape::kFlat, 10, 0, 25), true},
          {"ball", of_shape(Shape::kBall, 10, 0, 25), true},
          {"bull_nose", of_shape(Shape::kBullNose, 10, 2, 25), true},
          {"taper_flat", taper(6, 0, 10, 20), true},
          {"taper_bull", taper(6, 1, 10, 20), true},
          {"taper_ball", taper(4, 2, 5, 30), true},
          {"drill", drill(8, 118, 40), true},
          {"chamfer", chamfer(10, 2, 90, 12), true},
          {"chamfer_without_cylinder", chamfer(10, 0, 90, 5), true},
          {"woodruff", woodruff(20, 0, 4), true},
          {"woodruff_rounded", woodruff(20, 1.5, 4), true},
          {"apt", apt(10, 2, 10, 20, 25), true},
          {"dovetail", apt(16, 0.5, 0, -30, 10), true},
          {"lens", profile({{{0, 0}}, {{6, 80 - std::sqrt(6400 - 36.0)}, 80.0}, {{6, 20}}}), true},
          {"barrel", profile({{{0, 0}}, {{3, 0}}, {{3, 20}, 60.0}}), true},
          {"stepped", stepped(), false},
          {"lollipop", lollipop(), false},
          {"flared", flared(), false},
          {"toothed", toothed(), false}};
}

/// A cutter as C++ that a failing test prints ready to paste.
inline std::string pasted(const Cutter& c) {
  if (c.shape != Shape::kProfile) {
    return fmt::format("apt({:.17g}, {:.17g}, {:.17g}, {:.17g}, {:.17g})", c.diameter_mm, c.corner_radius_mm,
                       deg_from_rad(c.alpha_rad), deg_from_rad(c.beta_rad), c.flute_length_mm);
  }
  std::string text;
  for (const ProfilePoint& p : c.profile) {
    text += fmt::format("{}{{{{{:.17g}, {:.17g}}}, {:.17g}}}", text.empty() ? "" : ", ", p.to.x(), p.to.y(),
                        p.radius_mm);
  }
  return "profile({" + text + "})";
}

inline double union_distance(const std::vector<ConvexPiece>& pieces, const Vec2& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const ConvexPiece& piece : pieces) nearest = std::min(nearest, signed_distance(piece, p.x(), p.y()));
  return nearest;
}

/// The material as a polygon: the outline, then along the top to the axis.
inline std::vector<Vec2> polygon_of(const Cutter& cutter, double tolerance_mm) {
  std::vector<Vec2> polygon = sample_outline(outline(cutter), tolerance_mm);
  polygon.emplace_back(0.0, polygon.back().y());
  return polygon;
}

inline bool inside(const std::vector<Vec2>& polygon, const Vec2& p) {
  bool odd = false;
  for (size_t i = 0, k = polygon.size() - 1; i < polygon.size(); k = i++) {
    const Vec2 &a = polygon[i], &b = polygon[k];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (p.x() < a.x() + (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y())) odd = !odd;
  }
  return odd;
}

/// To the polygon's edges but the one on the axis.
inline double edge_distance(const std::vector<Vec2>& polygon, const Vec2& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i + 1 < polygon.size(); ++i) {
    const Vec2 along = polygon[i + 1] - polygon[i];
    if (along.squaredNorm() == 0.0) continue;
    const double t = std::clamp(along.dot(p - polygon[i]) / along.squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (polygon[i] + t * along - p).norm());
  }
  return nearest;
}

inline Vec2 point_near(const Cutter& cutter, Rng& rng) {
  return {rng.uniform(0.0, 1.2 * greatest_radius(outline(cutter))),
          rng.uniform(-0.1 * cutter.flute_length_mm, 1.1 * cutter.flute_length_mm)};
}

}  // namespace swarf::cutter::test
