// Distance of two convex primitives, one of which may move: Gilbert, Johnson & Keerthi 1988, with both
// bounds.
//
//   The first stands still. The second is seen at two instants and stands for the hull of both, which holds
//   it at every instant between where its points move on straight lines. Support planes give the lower bound,
//   which is proven whatever the iteration did; the weights of the nearest point of the hull say at which
//   instant it lies and which point of the moving primitive it is.
#pragma once

#include "collision/body.h"
#include "collision/relative_motion.h"

namespace swarf::collision {

/// A primitive at one pose, or at two as their hull. Points are told in the frame that the poses lead to.
struct ConvexView {
  const RevolvedSolid* solid = nullptr;  ///< null: a triangle
  int poses = 1;
  std::array<Vec3, 6> corners;               ///< of a triangle: at the first pose, then at the second
  std::array<Vec3, 3> home;                  ///< of a triangle: its corners in the home drawing
  const Pose* pose[2] = {nullptr, nullptr};  ///< of a solid; null: it stands in the home drawing
};

/// The primitive in its home drawing.
ConvexView view_of(const Body& body, uint32_t primitive);
/// The same carried by a pose, or by two; the poses must outlive it.
ConvexView view_of(const Body& body, uint32_t primitive, const Pose& first, const Pose* second = nullptr);

/// What the motion of the second may take off a lower bound (MotionBounds::slack).
struct MotionSlack {
  const MotionBounds* motion = nullptr;  ///< null: nothing
  double square = 0.0;
  double along(const Vec3& n) const { return motion == nullptr ? 0.0 : motion->slack(n, square); }
};

struct ConvexDistance {
  double lower = 0.0;  ///< mm, less the slack; proven, but for the rounding of a few sums
  /// Unit, across the plane between both that gave the lower bound; zero where there was none.
  Vec3 normal = Vec3::Zero();
  double upper = 0.0;  ///< of the points below, where the second moves: between its hull and the first
  double t = 0.0;      ///< share of the second pose in its nearest point: 0 the first instant, 1 the second
  Vec3 home_a = Vec3::Zero(), home_b = Vec3::Zero();  ///< nearest points, each in its own home drawing
};

/// Bounds apart by at most this and the slack, unless the iteration stalls, mm.
inline constexpr double kConvexGap = 1e-7;

/// Stops once the lower bound is above `enough`.
ConvexDistance convex_distance(const ConvexView& a, const ConvexView& b, double enough,
                               const MotionSlack& slack = {});

}  // namespace swarf::collision
