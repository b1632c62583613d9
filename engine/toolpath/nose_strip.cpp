#include "toolpath/nose_strip.h"

#include <algorithm>
#include <cmath>

#include "base/minima.h"
#include "base/roots.h"

namespace swarf::toolpath {
namespace {

/// One flank of a strip: the surface z = -p'Kp/2 over its tangent plane at the cusp's foot, with the pass
/// along x. The strip lies to the left of the pass (side = 1) or to its right (-1).
struct Flank {
  Flank(const Mat2& shape, const Lean& lean, const ContactEnd& contact, double which)
      : K(shape),
        end(contact),
        side(which),
        lean_cos(std::cos(lean.angle)),
        lean_sin(std::sin(lean.angle)),
        yaw_cos(std::cos(lean.yaw)),
        yaw_sin(std::sin(lean.yaw)) {}

  Mat2 K;  ///< in the frame of the feed
  ContactEnd end;
  double side;
  double lean_cos, lean_sin, yaw_cos, yaw_sin;
};

/// How far the point lies outside the tool that stands in contact over the place p; below 0 inside.
double outside_tool(const Flank& flank, const Vec2& p, const Vec3& point) {
  const Vec2 slope = flank.K * p;
  const Vec3 normal = Vec3(slope.x(), slope.y(), 1.0).normalized();
  const Vec3 feed = (Vec3::UnitX() - normal * normal.x()).normalized();
  const Vec3 towards = flank.yaw_cos * feed + flank.yaw_sin * normal.cross(feed);
  const Vec3 axis = flank.lean_cos * normal + flank.lean_sin * towards;
  const Vec3 down = (normal.dot(axis) * axis - normal).normalized();
  const double corner = flank.end.corner_mm;
  // From the middle of the corner's circle.
  const Vec3 middle = Vec3(p.x(), p.y(), -0.5 * p.dot(slope)) + corner * normal - flank.end.flat_mm * down;
  const Vec3 gap = point - middle;
  const double up = gap.dot(axis);
  const double aside = (gap - up * axis).norm();
  return Vec2(std::max(0.0, aside - flank.end.flat_mm), std::min(up, 0.0)).norm() - corner;
}

/// The same for the tool that passes at the distance x from the cusp: the distance from a convex body that
/// moves straight has one minimum.
double outside_pass(const Flank& flank, double x, double h) {
  const double reach = flank.end.radius();
  const auto along = [&](double s) { return outside_tool(flank, {s, -flank.side * x}, {0.0, 0.0, h}); };
  return least_between(along, -reach, reach).value;
}

/// Distance from the pass to the cusp of height h on one side.
double half_strip(const Flank& flank, double h) {
  const double reach = flank.end.radius();
  const double at_reach = outside_pass(flank, reach, h);
  if (at_reach <= 0.0) return reach;
  // Over the square of the distance, of which it is nearly a straight line, the root is met in a few steps.
  const auto outside = [&](double square) { return outside_pass(flank, std::sqrt(square), h); };
  return std::sqrt(bracketed_root(outside, 0.0, reach * reach, outside(0.0), at_reach));
}

}  // namespace

double nose_chord(const Mat2& K, const Vec2& t, double h, const Lean& lean, const ContactEnd& end,
                  RimSides sides) {
  Mat2 frame;
  frame << t.x(), -t.y(), t.y(), t.x();
  const Mat2 turned = frame.transpose() * K * frame;
  const auto half = [&](double side) { return half_strip(Flank(turned, lean, end, side), h); };
  if (sides == RimSides::kBothLeft) return 2.0 * half(1.0);
  if (sides == RimSides::kBothRight) return 2.0 * half(-1.0);
  return half(1.0) + half(-1.0);
}

double nose_scallop(const Mat2& K, const Vec2& t, double P, const Lean& lean, const ContactEnd& end,
                    RimSides sides) {
  // Chords grow with the root of the scallop, nearly as a straight line.
  const auto over = [&](double root) { return nose_chord(K, t, root * root, lean, end, sides) - P; };
  double high = std::sqrt(std::min(P * P / (8.0 * end.corner_mm), 0.5 * end.radius()));
  double at_high = over(high);
  for (; at_high < 0.0 && high * high < end.radius(); at_high = over(high)) high *= 2.0;
  const double root = at_high <= 0.0 ? high : bracketed_root(over, 0.0, high, -P, at_high);
  return root * root;
}

}  // namespace swarf::toolpath
