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
  Mat2 K;  ///< in the frame of the feed
  Lean lean;
  ContactEnd end;
  double side = 1.0;
};

/// How far the point lies outside the tool that stands in contact over the place p; below 0 inside.
double outside_tool(const Flank& flank, const Vec2& p, const Vec3& point) {
  const Vec2 slope = flank.K * p;
  const Vec3 normal = Vec3(slope.x(), slope.y(), 1.0).normalized();
  const Vec3 feed = (Vec3::UnitX() - normal * normal.x()).normalized();
  const Vec3 towards = std::cos(flank.lean.yaw) * feed + std::sin(flank.lean.yaw) * normal.cross(feed);
  const Vec3 axis = std::cos(flank.lean.angle) * normal + std::sin(flank.lean.angle) * towards;
  const Vec3 down = (normal.dot(axis) * axis - normal).normalized();
  const double corner = flank.end.corner_mm;
  // From the middle of the corner's circle.
  const Vec3 middle = Vec3(p.x(), p.y(), -0.5 * p.dot(slope)) + corner * normal - flank.end.flat_mm * down;
  const Vec3 gap = point - middle;
  const double up = gap.dot(axis);
  const double aside = (gap - up * axis).norm();
  return std::hypot(std::max(0.0, aside - flank.end.flat_mm), std::min(up, 0.0)) - corner;
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
  const auto outside = [&](double x) { return outside_pass(flank, x, h); };
  const double at_reach = outside(reach);
  return at_reach <= 0.0 ? reach : bracketed_root(outside, 0.0, reach, outside(0.0), at_reach);
}

}  // namespace

double nose_chord(const Mat2& K, const Vec2& t, double h, const Lean& lean, const ContactEnd& end,
                  RimSides sides) {
  Mat2 frame;
  frame << t.x(), -t.y(), t.y(), t.x();
  const Mat2 turned = frame.transpose() * K * frame;
  const auto half = [&](double side) { return half_strip({turned, lean, end, side}, h); };
  if (sides == RimSides::kBothLeft) return 2.0 * half(1.0);
  if (sides == RimSides::kBothRight) return 2.0 * half(-1.0);
  return half(1.0) + half(-1.0);
}

double nose_scallop(const Mat2& K, const Vec2& t, double P, const Lean& lean, const ContactEnd& end,
                    RimSides sides) {
  const auto over = [&](double h) { return nose_chord(K, t, h, lean, end, sides) - P; };
  // Chords grow with the root of the scallop.
  double high = std::min(P * P / (8.0 * end.corner_mm), 0.5 * end.radius());
  double at_high = over(high);
  for (; at_high < 0.0 && high < end.radius(); at_high = over(high)) high *= 4.0;
  return at_high <= 0.0 ? high : bracketed_root(over, 0.0, high, -P, at_high);
}

}  // namespace swarf::toolpath
