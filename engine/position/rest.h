// Where a tool comes to rest when it is set down along a line.
//
//        | a          The tip slides along the line p + t a, against a, until the underside of the cutter
//       _|_           touches the part: t is the greatest at which it does. Kato et al.'s position
//      (   )          calculator; for a = z known as drop cutter.
//    ----x----
#pragma once

#include <limits>

#include "base/frames.h"

namespace swarf::position {

/// The line that the tip moves on. `x_W`, `y_W`, `axis_W` are orthonormal and right-handed.
struct GuideLine {
  Vec3 point_W = Vec3::Zero();
  Vec3 x_W = Vec3::UnitX(), y_W = Vec3::UnitY(), axis_W = Vec3::UnitZ();

  /// Coordinates about the line: (x, y) square to it, z along it from point_W; mm.
  Vec3 local(const Vec3& p_W) const {
    const Vec3 d = p_W - point_W;
    return {d.dot(x_W), d.dot(y_W), d.dot(axis_W)};
  }
  Vec3 world(const Vec3& p) const { return point_W + x_W * p.x() + y_W * p.y() + axis_W * p.z(); }
};
/// Upright over (x, y): heights are those of W.
GuideLine upright(double x, double y);
/// W's own directions turned by the shortest way until Z is the unit axis: x_W and y_W follow the axis
/// smoothly, and are those of W for an upright one. For an axis straight down they are X and -Y.
GuideLine turned_line(const Vec3& point_W, const Vec3& unit_axis_W);
/// Any two directions square to the axis.
GuideLine guide_line(const Vec3& point_W, const Vec3& axis_W);

/// What of the part the tool touches.
enum class Touched { kNothing, kFace, kEdge, kVertex };

/// The tool at rest. Compared by height: the highest of several parts of a work piece is where it rests.
struct Rest {
  double height = -std::numeric_limits<double>::infinity();  ///< of the tip along the line, mm
  Touched what = Touched::kNothing;
  int number = -1;  ///< of the triangle, face, edge or vertex, as the part counts them
  Vec3 contact_W = Vec3::Zero();
  /// How the height changes as the line is moved along its x_W and y_W, mm per mm: the slope of the surface
  /// of resting tips. At a crease of it, that of one of its sides.
  Vec2 gradient = Vec2::Zero();
  double u = 0.0, v = 0.0;  ///< kFace: of the contact on a patch

  bool touches() const { return what != Touched::kNothing; }
};

}  // namespace swarf::position
