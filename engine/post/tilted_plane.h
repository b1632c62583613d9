// The tilted working plane: coordinates that stand square to the tool, so that a control drills and mills in
// them as it does without a tilt (G68.2, CYCLE800, PLANE SPATIAL).
//
//   p_W = R p_P     R: the turns as they are written, so that rounded angles put no tip aside; the plane's
//                   zero is the work's
#pragma once

#include <array>

#include "base/frames.h"

namespace swarf::post {

/// Where a post writes planes.
enum class PlaneUse {
  kNever,
  kCycles,    ///< where a drilling cycle could not be kept without one
  kConstant,  ///< wherever the tool keeps its direction from one rapid to another and a rotary axis is turned
};

/// About which axes, each one those that the turns before it have brought along.
enum class PlaneTurns {
  kZXZ,  ///< Euler angles: G68.2 I J K
  kZYX,  ///< the same as X, Y, Z about the axes that stand: spatial angles, roll-pitch-yaw
};

/// What a control has of it.
struct PlaneRules {
  PlaneUse use = PlaneUse::kNever;
  PlaneTurns turns = PlaneTurns::kZXZ;
  int decimals = 4;  ///< of the turns in degrees
};

struct TiltedPlane {
  Mat3 R = Mat3::Identity();          ///< axes of the plane in W, of the turns below
  std::array<double, 3> turns_deg{};  ///< of PlaneTurns, rounded
  bool positive = true;               ///< the rotary axis farthest from the work stands at zero or above
};

/// The one whose Z is nearest to `axis_W` and whose X and Y are turned no more than that needs. Its Z is off
/// by less than sqrt(3) half digits of the turns.
TiltedPlane tilted_plane(const Vec3& axis_W, const PlaneRules& rules);

}  // namespace swarf::post
