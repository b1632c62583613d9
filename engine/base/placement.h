// Where a part stands: turned, and one of its points put on a place of the work.
#pragma once

#include "base/frames.h"

namespace swarf {

/// The point of a turned part that its position is told of.
enum class PartOrigin {
  kFile,    ///< the origin of the file's own coordinates
  kCorner,  ///< least X, least Y, greatest Z of the box around it
  kCentre   ///< middle of X and of Y, greatest Z
};

/// A rigid motion from the frame of a file to the work.
struct Placement {
  Mat3 turn = Mat3::Identity();
  Vec3 position = Vec3::Zero();  ///< of the origin in the work, mm
  PartOrigin origin = PartOrigin::kFile;

  /// Whether the part stays where its file has it.
  bool stays() const { return turn.isIdentity(0.0) && position.isZero(0.0) && origin == PartOrigin::kFile; }

  /// `turned`: the least box around the turned part, mm; the file's origin does not look at it.
  Pose pose(const Box& turned) const {
    Vec3 origin_at = Vec3::Zero();
    if (origin == PartOrigin::kCorner) origin_at = {turned.lower.x(), turned.lower.y(), turned.upper.z()};
    if (origin == PartOrigin::kCentre)
      origin_at = {turned.centre().x(), turned.centre().y(), turned.upper.z()};
    Pose pose = Pose::Identity();
    pose.linear() = turn;
    pose.translation() = position - origin_at;
    return pose;
  }
};

}  // namespace swarf
