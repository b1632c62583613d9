// A block whose top is a bicubic NURBS face trimmed by NURBS curves, as it comes from a STEP file, and the
// same in closed form.
//
//        y ^  ___        z = top(x, y) over |x| <= 12, -12 <= y <= side(x), less an elliptic hole; walls
//          | /   \__/    straight down to z = -8. side: a cubic B-spline function of three spans, whose
//          |   O     |   curve on the top bounds the top face and the wall; the hole's edge is a rational
//          one.
//          |_________|-> x
#pragma once

#include <array>
#include <string>
#include <vector>

#include "bracketed_height.h"
#include "surface/face.h"

namespace swarf::position {

struct NurbsEdgePart {
  static constexpr double kHalf = 12.0, kTopHalf = 14.0, kFloor = -8.0;
  static constexpr double kHoleX = -2.5, kHoleY = -3.0, kHoleWide = 4.0, kHoleHigh = 2.5;
  /// Heights of the top's poles, over a grid of the square |x|, |y| <= kTopHalf.
  std::array<std::array<double, 4>, 4> top_poles{
      {{1.0, -2.0, 0.5, 2.0}, {-1.5, 3.0, -2.5, 1.0}, {2.0, -1.0, 4.0, -2.0}, {0.0, 1.5, -3.0, 1.0}}};
  /// Ordinates of the side's poles; knots 0 0 0 0 1 2 3 3 3 3 over |x| <= kHalf.
  std::array<double, 6> side_poles{6.0, 9.0, 3.0, 8.0, 10.0, 5.0};

  double top(double x, double y) const;
  double side(double x) const;
  /// Abscissae of the side's poles, for which x is linear in the parameter (Greville).
  static std::array<double, 6> side_abscissae();

  /// Top face, wall under the side and wall of the hole, with bounds of their bends from the poles.
  std::vector<Sheet> sheets() const;
  /// The faces of a STEP file of the part, written and read back. Empty: it could not be written.
  std::vector<surface::Face> faces_from_step() const;

 private:
  surface::Region part_of_top(const Vec2& low, const Vec2& high) const;
  double most_side_slope() const;
};

}  // namespace swarf::position
