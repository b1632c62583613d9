// Free moves: first approach, links between passes, last retract.
//
//     high ---- rapid at the clearance height ----
//       |                                            _ _ raised _ _ _          straight, the axis by slerp
//       | rapid, then approach along the axis       |              |
//       v                                     retract along     approach along
//     ==== pass ================================ the axis      the next axis ==== pass ====
#pragma once

#include "base/diagnostics.h"
#include "toolpath/tool_path.h"

namespace swarf::toolpath {

/// What the links must keep clear of: points of the design, no farther apart than the spacing.
struct Obstacle {
  std::vector<Vec3> points;
  double diagonal_mm = 0.0;  ///< of their bounding box
};
Obstacle obstacle_of(const surface::Surface& surface, double spacing_mm);

/// True when the cutter (a cylinder of the given radius and length on its tip), moved straight with its axis
/// by slerp, keeps `clearance_mm` from every point of the obstacle. Checked by conservative advancement.
bool move_is_clear(const ToolPose& from, const ToolPose& to, const Obstacle& obstacle,
                   const cutter::Cutter& cutter, double clearance_mm);

/// Appends an operation's passes with all free moves before, between and after them, and adds up the lengths.
/// A link that cannot be raised clear of the part goes to the diagnostics ("link-not-clear").
void append_passes(ToolPath& path, const std::vector<SurfacePass>& passes, int operation,
                   const SourceLocation& where, const cutter::Cutter& cutter, const PlanOptions& options,
                   Diagnostics& diagnostics);

/// Tool poses where a pass begins and where it ends.
struct PassEnds {
  ToolPose start, end;
};
PassEnds ends_of(const SurfacePass& pass, const ContactEnd& end);

}  // namespace swarf::toolpath
