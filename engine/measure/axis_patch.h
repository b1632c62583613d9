// The surface that a tool axis runs over in one block whose two guide points move linearly (theory 5).
#pragma once

#include "base/frames.h"

namespace swarf::measure {

/// Distance between the segments a0 a1 and b0 b1, mm. Segments of no length count as points.
double segment_distance(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1);
/// Distance of a point to the segment b0 b1, mm.
double segment_distance(const Vec3& x, const Vec3& b0, const Vec3& b1);

/// L(t,l) = (1-l)(P0 + t(P1-P0)) + l(Q0 + t(Q1-Q0)), 0 <= t, l <= 1: P is the guide point near the tip.
class AxisPatch {
 public:
  AxisPatch(const Vec3& P0, const Vec3& P1, const Vec3& Q0, const Vec3& Q1);

  /// Distance of x to the patch, mm: the least of all its stationary values, so no start can mislead it.
  /// At a fixed t the squared distance to the axis line is N(t)/D(t), N = |(x-P) x (Q-P)|^2 of degree 4 and
  /// D = |Q-P|^2 of degree 2; inside the patch it is stationary where N'D - ND' = 0, of degree 5. The four
  /// edges are segments.
  double distance(const Vec3& x) const;
  /// Never above distance(x): to the sphere around the four corners.
  double distance_bound(const Vec3& x) const { return (x - centre_).norm() - radius_; }

 private:
  Vec3 P0_, P1_, Q0_, Q1_;
  Vec3 dP_, Q_, dQ_;  ///< P1-P0; axis vector Q-P at t=0 and its change
  Vec3 centre_;
  double radius_;
};

}  // namespace swarf::measure
