// The end of a cutter as far as it touches a surface from above: a flat disc, a ball, or a disc with a round
// corner.
//
//        |     |
//        |     |         corner_mm: radius of the corner, 0 for a flat end
//         \___/          flat_mm:   radius of the flat bottom, 0 for a ball
#pragma once

#include "cutter/cutter.h"

namespace swarf::toolpath {

struct ContactEnd {
  double flat_mm = 5.0;
  double corner_mm = 0.0;
  double radius() const { return flat_mm + corner_mm; }
  bool ball() const { return flat_mm == 0.0; }
};

/// True for the shapes that passes over a surface are planned for: flat, ball and bull nose.
inline bool has_contact_end(const cutter::Cutter& cutter) {
  using cutter::Shape;
  return cutter.shape == Shape::kFlat || cutter.shape == Shape::kBall || cutter.shape == Shape::kBullNose;
}

/// The end of a cutter of one of these shapes.
inline ContactEnd contact_end(const cutter::Cutter& cutter) {
  using cutter::Shape;
  if (cutter.shape == Shape::kFlat) return {cutter.radius(), 0.0};
  if (cutter.shape == Shape::kBall) return {0.0, cutter.radius()};
  return {cutter.radius() - cutter.corner_radius_mm, cutter.corner_radius_mm};
}

}  // namespace swarf::toolpath
