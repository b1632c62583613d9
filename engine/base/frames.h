// Vectors, poses and the frame letters.
//
//   W work (part)   P pallet/table   M machine   S spindle gauge line   T tool tip   G stock grid
//
// A pose name reads destination-from-source and inner letters cancel: X_MT = X_MW * X_WT.
// A vector names its frame: axis_W, tip_W. Lengths are mm, times s, angles rad.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace swarf {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat2 = Eigen::Matrix2d;
using Mat3 = Eigen::Matrix3d;
using Pose = Eigen::Isometry3d;

/// Where a tool stands: the centre of its tip and its axis, which points from the tip to the spindle.
struct ToolPose {
  Vec3 tip_W = Vec3::Zero();    ///< mm; centre of the bottom of the cutter
  Vec3 axis_W = Vec3::UnitZ();  ///< unit vector, tip to spindle
};

/// Axis-aligned box, mm.
struct Box {
  Vec3 lower = Vec3::Zero();
  Vec3 upper = Vec3::Zero();
  Vec3 size() const { return upper - lower; }
  Vec3 centre() const { return 0.5 * (lower + upper); }
};

}  // namespace swarf
