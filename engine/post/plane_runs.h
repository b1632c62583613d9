// Which moves of a stretch could be written in a tilted plane, and the plane itself.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "post/holes.h"

namespace swarf::post {

/// Moves of one direction of the tool: it begins behind a rapid and ends before one, so that no cut is
/// interrupted, and it holds whole cycles.
struct PlaneRun {
  size_t first = 0, last = 0;  ///< [first, last)
  bool asked = false;
  std::shared_ptr<const TiltedPlane> tilt;  ///< once asked; null: it does without
};

/// `free_start`: the first move begins where the tool is out of the work, or in a plane already.
std::vector<PlaneRun> plane_runs(const Follower& follower, std::span<const program::Move> moves,
                                 std::span<const HoleSpan> holes, bool free_start);

/// The plane square to the tool where the axes stand at `q`. Null where they would turn by more than 0.1 deg
/// for its rounded turns (beside a pole), or could not.
std::shared_ptr<const TiltedPlane> plane_at(const Follower& follower, const PlaneRules& rules,
                                            const ToolPose& pose, const kinematics::AxisValues& q);

/// Null is no plane.
bool same_plane(const TiltedPlane* a, const TiltedPlane* b);

}  // namespace swarf::post
