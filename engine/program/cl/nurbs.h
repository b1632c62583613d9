// MOVNRB of Creo: a B-spline that the tip follows, and with five axes a second one for a point up the tool.
#pragma once

#include <vector>

#include "base/frames.h"

namespace swarf::program {

/// What has been read of one MOVNRB motion; points in the work, mm.
struct ClNurbs {
  bool five_axis = false;
  double length_mm = 0.0;  ///< five axes: from the lower curve to the upper one, along the tool
  int order = 0;           ///< degree + 1; 0 before MOVNRB/ON
  size_t knots_wanted = 0, points_wanted = 0;
  std::vector<double> knots;
  std::vector<Vec3> low_W, high_W;  ///< control points of the tip, and of the upper curve
  bool listing = false;             ///< after NEXT: the GOTO that follow list the same motion point by point
  ToolPose end;                     ///< where the curve ends
  bool ends_there = true;           ///< the last GOTO of the list stood there, or there was none
  int line = 0, column = 0;         ///< of the statement that began it
};

/// Chords of a MOVNRB motion leave its curves by no more than this, mm.
inline constexpr double kNurbsChordMm = 1e-3;

/// Poses along the curves after their start, the first being the start itself. Throws std::invalid_argument
/// with a text for the user when orders, knots and points do not fit together, or the upper curve meets the
/// lower one.
std::vector<ToolPose> nurbs_poses(const ClNurbs& nurbs, const Vec3& axis_W);

}  // namespace swarf::program
