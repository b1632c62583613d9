// How a position of CL data may be changed without moving what the cutter touches: advice for the CAM system.
#pragma once

#include <vector>

#include "base/frames.h"
#include "cutter/profile.h"

namespace swarf::avoidance {

/// Lead leans the axis into the feed, tilt to the left of it; lift moves the tool out along its axis.
enum class ChangeKind { kLead, kTilt, kLift };
const char* change_name(ChangeKind kind);

/// Of one position. A lead and a tilt together lean by their root of squares, in the direction that they
/// give.
struct PathChange {
  double lead_rad = 0.0, tilt_rad = 0.0, lift_mm = 0.0;

  double& of(ChangeKind kind);
  double of(ChangeKind kind) const;
  bool none() const { return lead_rad == 0.0 && tilt_rad == 0.0 && lift_mm == 0.0; }
};

/// The pose with the change. `feed_W` need not be square to the axis, nor of unit length.
///
///        a  a'      the tool leans about the point that it stands on, on the plane through its lowest points
///        | /        that is square to the given axis a: the ball of a ball end stays where it is, a flat end
///   _____|/___>d    and a bull nose turn about their edge in the direction d that they lean to
///
/// `outline`: of the flutes.
ToolPose changed_pose(const ToolPose& pose, const Vec3& feed_W,
                      const std::vector<cutter::OutlineElement>& outline, const PathChange& change);

}  // namespace swarf::avoidance
