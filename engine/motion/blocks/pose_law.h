// What all places of a block have in common, found once: for those who look at many.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/tool_axis.h"
#include "motion/blocks/block_motion.h"

namespace swarf::motion {

/// An arc as polar coordinates about its axis; radius and height may differ a little between the ends.
struct ArcShape {
  Vec3 centre, along, across, normal;
  double angle, r_from, r_to, h_from, h_to;

  explicit ArcShape(const toolpath::BlockMove& block)
      : centre(block.arc->centre_W), normal(block.arc->normal_W), angle(toolpath::arc_angle(block)) {
    const Vec3 from = block.from.tip_W - centre, to = block.to.tip_W - centre;
    h_from = from.dot(normal);
    h_to = to.dot(normal);
    along = (from - h_from * normal).normalized();
    across = normal.cross(along);
    r_from = (from - h_from * normal).norm();
    r_to = (to - h_to * normal).norm();
  }
  Vec3 point(double s) const {
    const double r = r_from + s * (r_to - r_from);
    return centre + (h_from + s * (h_to - h_from)) * normal +
           r * (std::cos(s * angle) * along + std::sin(s * angle) * across);
  }
  double speed() const {
    return std::max(r_from, r_to) * angle + std::abs(r_to - r_from) + std::abs(h_to - h_from);
  }
  double acceleration() const {
    return std::max(r_from, r_to) * angle * angle + 2.0 * std::abs(r_to - r_from) * angle;
  }
};

/// pose_at() of one block, bit for bit.
class PoseLaw {
 public:
  explicit PoseLaw(const BlockMotion& motion);
  /// Of the same motion.
  ToolPose at(const BlockMotion& motion, double s) const {
    ToolPose pose;
    set(motion, s, pose);
    return pose;
  }
  /// The same, written where it stays.
  void set(const BlockMotion& motion, double s, ToolPose& pose) const;

 private:
  std::optional<GreatCircle> circle_;  ///< of the axis, where it is on one
  std::optional<ArcShape> arc_;
};

}  // namespace swarf::motion
