// Cutters for the stock tests: convex pieces made by walking along their profile, and random ones.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/rng.h"
#include "base/units.h"
#include "stock/sweep/sweep.h"

namespace swarf::stock {

/// Walks along a profile with the material to the left, from the axis or the bottom upwards. The angle is
/// that of the outward normal: -90 deg at a flat bottom, 0 at a flank.
class ProfileWalk {
 public:
  ProfileWalk(Vec2 at, double angle_deg) : at_(std::move(at)), angle_(rad_from_deg(angle_deg)) {
    piece_.low = at_.y();
    piece_.radius = at_.x();
  }
  ProfileWalk& line(double length) {
    const Vec2 n = normal(angle_);
    piece_.faces.push_back({n, n.dot(at_)});
    return move(at_ + length * Vec2(-n.y(), n.x()));
  }
  ProfileWalk& turn_to(double angle_deg, double radius = 0.0) {
    const double next = rad_from_deg(angle_deg);
    if (radius > 0.0) {
      const Vec2 centre = at_ - radius * normal(angle_);
      piece_.rounds.push_back({centre, radius, normal(angle_), normal(next)});
      if (angle_ < 0.0 && next > 0.0) move(centre + Vec2(radius, 0.0));
      move(centre + radius * normal(next));
    }
    angle_ = next;
    return *this;
  }
  /// A flat top where the walk stands.
  cutter::ConvexPiece close() {
    piece_.faces.push_back({{0.0, 1.0}, at_.y()});
    piece_.high = at_.y();
    return piece_;
  }
  const Vec2& at() const { return at_; }

 private:
  static Vec2 normal(double angle) {
    if (angle == rad_from_deg(-90.0)) return {0.0, -1.0};
    return {std::cos(angle), std::sin(angle)};
  }
  ProfileWalk& move(const Vec2& to) {
    at_ = to;
    piece_.radius = std::max(piece_.radius, at_.x());
    return *this;
  }
  Vec2 at_;
  double angle_;
  cutter::ConvexPiece piece_;
};

inline CutterSolid solid_of(std::vector<cutter::ConvexPiece> pieces) {
  CutterSolid solid;
  solid.radius = solid.height = 0.0;
  for (const auto& piece : pieces) {
    solid.radius = std::max(solid.radius, piece.radius);
    solid.height = std::max(solid.height, piece.high);
  }
  solid.pieces = std::move(pieces);
  return solid;
}

inline CutterSolid ball_nose(double radius, double height) {
  return solid_of({ProfileWalk({0, 0}, -90).turn_to(0, radius).line(height - radius).close()});
}
inline CutterSolid bull_nose(double radius, double corner, double height) {
  return solid_of(
      {ProfileWalk({0, 0}, -90).line(radius - corner).turn_to(0, corner).line(height - corner).close()});
}
/// Flat end of radius `tip`, flank leaning outward by `half_angle_deg`.
inline CutterSolid taper(double tip, double half_angle_deg, double height) {
  const double slant = height / std::cos(rad_from_deg(half_angle_deg));
  return solid_of({ProfileWalk({0, 0}, -90).line(tip).turn_to(-half_angle_deg).line(slant).close()});
}
/// Sharp point on the axis with the full `point_angle_deg`, then a cylindrical flank.
inline CutterSolid drill(double radius, double point_angle_deg, double height) {
  const double half = rad_from_deg(0.5 * point_angle_deg);
  return solid_of({ProfileWalk({0, 0}, -0.5 * point_angle_deg)
                       .line(radius / std::sin(half))
                       .turn_to(0)
                       .line(height - radius / std::tan(half))
                       .close()});
}
/// A T-slot cutter: a disc and a thinner neck, which overlap (pieces that only touch would leave a skin).
inline CutterSolid t_slot(double radius, double thickness, double neck, double height) {
  const double foot = 0.5 * thickness;
  return solid_of({cutter::ConvexPiece::cylinder(radius, thickness),
                   ProfileWalk({0, foot}, -90).line(neck).turn_to(0).line(height - foot).close()});
}
/// Barrel: ball tip, flank of a large radius whose centre lies beyond the axis.
inline CutterSolid barrel() {
  return solid_of({ProfileWalk({0, 0}, -90).turn_to(-20, 1.5).turn_to(10, 40.0).close()});
}

/// A convex piece of one to four lines, its corners sharp or rounded, its foot on the axis.
inline cutter::ConvexPiece random_piece(Rng& rng) {
  const bool flat = rng.uniform() < 0.4;
  const double first = flat ? -90.0 : rng.uniform(-85.0, -30.0);
  ProfileWalk walk({0.0, 0.0}, rng.uniform() < 0.3 ? -90.0 : first);
  walk.turn_to(first, flat ? 0.0 : rng.uniform(0.3, 2.0));
  walk.line(rng.uniform(0.5, 4.0));
  double angle = first;
  for (int n = static_cast<int>(rng.uniform(1.0, 4.0)); n > 0; --n) {
    angle += rng.uniform(0.3, 0.9) * (20.0 - angle);
    walk.turn_to(angle, rng.uniform() < 0.5 ? 0.0 : rng.uniform(0.2, 3.0));
    walk.line(std::min(rng.uniform(0.5, 6.0), walk.at().x()));
  }
  return walk.close();
}

inline std::string text(const cutter::ConvexPiece& piece) {
  std::string out = "ConvexPiece{{";
  for (const auto& f : piece.faces)
    out += fmt::format("{{{{{:.17g}, {:.17g}}}, {:.17g}}},", f.normal.x(), f.normal.y(), f.offset);
  out += "}, {";
  for (const auto& r : piece.rounds) {
    out += fmt::format("{{{{{:.17g}, {:.17g}}}, {:.17g}, {{{:.17g}, {:.17g}}}, {{{:.17g}, {:.17g}}}}},",
                       r.centre.x(), r.centre.y(), r.radius, r.from.x(), r.from.y(), r.to.x(), r.to.y());
  }
  return out + fmt::format("}}, {:.17g}, {:.17g}, {:.17g}}}", piece.radius, piece.low, piece.high);
}

}  // namespace swarf::stock
