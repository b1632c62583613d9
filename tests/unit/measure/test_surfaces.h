// Surfaces with closed forms, and passes over them.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "dome_cut.h"
#include "surface/surface.h"

namespace swarf::measure {

/// Part of a cylinder of radius R about the x axis: u along the axis, v the angle about +z. R < 0: the inside
/// of a bore, seen from its axis.
class Cylinder final : public surface::Surface {
 public:
  Cylinder(double radius, double length, double angle) : radius_(radius), length_(length), angle_(angle) {}
  Vec3 point(double u, double v) const override { return derivatives(u, v).S; }
  surface::Derivatives derivatives(double u, double v) const override {
    const double a = angle_ * (v - 0.5), s = std::sin(a), c = std::cos(a);
    surface::Derivatives d;
    d.S = {length_ * u, radius_ * s, radius_ * c};
    d.Su = {length_, 0, 0};
    d.Sv = angle_ * radius_ * Vec3(0, c, -s);
    d.Suu = d.Suv = Vec3::Zero();
    d.Svv = -angle_ * angle_ * radius_ * Vec3(0, s, c);
    return d;
  }
  surface::BendBounds bend_bounds(const Vec2&, const Vec2&) const override {
    return {{}, {}, {Vec3::Zero(), angle_ * angle_ * std::abs(radius_)}};
  }
  int outward_sign() const override { return radius_ > 0.0 ? 1 : -1; }

 private:
  double radius_, length_, angle_;
};

/// z = -(x^2 / Rx + y^2 / Ry) / 2 over |x|, |y| <= half; a plane for infinite radii.
class Paraboloid final : public surface::Surface {
 public:
  Paraboloid(double curvature_x, double curvature_y, double half)
      : kx_(curvature_x), ky_(curvature_y), half_(half) {}
  Vec3 point(double u, double v) const override { return derivatives(u, v).S; }
  surface::Derivatives derivatives(double u, double v) const override {
    const double side = 2.0 * half_, x = side * u - half_, y = side * v - half_;
    surface::Derivatives d;
    d.S = {x, y, -0.5 * (kx_ * x * x + ky_ * y * y)};
    d.Su = {side, 0, -side * kx_ * x};
    d.Sv = {0, side, -side * ky_ * y};
    d.Suu = {0, 0, -side * side * kx_};
    d.Svv = {0, 0, -side * side * ky_};
    d.Suv = Vec3::Zero();
    return d;
  }
  surface::BendBounds bend_bounds(const Vec2&, const Vec2&) const override {
    const double side2 = 4.0 * half_ * half_;
    return {{Vec3(0.0, 0.0, -side2 * kx_), 0.0}, {}, {Vec3(0.0, 0.0, -side2 * ky_), 0.0}};
  }
  int outward_sign() const override { return 1; }

 private:
  double kx_, ky_, half_;
};

/// A ball end mill with its flank.
inline stock::CutterSolid ball(double radius, double height) {
  stock::CutterSolid cutter(radius, height);
  cutter::ConvexPiece piece;
  piece.faces = {{{1.0, 0.0}, radius}, {{0.0, 1.0}, height}};
  piece.rounds = {{{0.0, radius}, radius, {0.0, -1.0}, {1.0, 0.0}}};
  piece.radius = radius;
  piece.high = height;
  cutter.pieces = {piece};
  return cutter;
}

/// Straight or curved passes: pose_at(pass, t), t in [0,1], in `steps` sweeps each; nothing is swept in
/// between.
inline Passes passes_along(const std::function<ToolPose(int, double)>& pose_at, int passes, int steps) {
  Passes made;
  for (int pass = 0; pass < passes; ++pass) {
    for (int i = 0; i < steps; ++i) {
      made.sweeps.push_back({pose_at(pass, static_cast<double>(i) / steps),
                             pose_at(pass, static_cast<double>(i + 1) / steps),
                             static_cast<uint32_t>(made.sweeps.size())});
      made.pass_of_sweep.push_back(pass);
    }
  }
  return made;
}

}  // namespace swarf::measure
