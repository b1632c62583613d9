// One element of a tool path: a pass on a surface, a free move, or a block of a CL or NC program.
#pragma once

#include <optional>
#include <variant>

#include "base/cubic_spline.h"
#include "base/diagnostics.h"
#include "base/frames.h"
#include "kinematics/machine_model.h"
#include "program/block_law.h"
#include "program/moves.h"
#include "surface/surface.h"
#include "toolpath/driven/driven_pass.h"
#include "toolpath/pose_curve.h"

namespace swarf::toolpath {

/// A curve on a surface as a graph over one parameter: (u,v) = (t, w(t)) when along_u, else (w(t), t).
struct SurfaceCurve {
  bool along_u = true;
  CubicSpline w;
};

/// The curve's point and its derivatives by t, and the surface's derivatives there.
struct CurvePoint {
  double u = 0.0, v = 0.0;
  surface::Derivatives surface;
  Vec3 C, dC, ddC;  ///< mm per unit t
};
CurvePoint curve_at(const surface::Surface& surface, const SurfaceCurve& curve, double t);
/// Position alone (cheaper).
Vec3 curve_point(const surface::Surface& surface, const SurfaceCurve& curve, double t);

/// One pass in contact with the part, travelled from t_start to t_end (either may be the larger).
struct SurfacePass {
  surface::SurfacePtr surface;
  SurfaceCurve curve;
  double t_start = 0.0, t_end = 1.0;
  double feed_mm_s = 0.0;
  double chord_tolerance_mm = 1e-3;
  double lead_rad = 0.0, tilt_rad = 0.0;
  double interval_mm = 0.0;        ///< chord to the previous pass: its minimum; 0 for the first pass
  double scallop_theory_mm = 0.0;  ///< greatest cusp that theory 1.1 gives between this and the previous pass
  int pass = 0;                    ///< 0-based count of passes
};

enum class MoveKind { kRapid, kApproach, kRetract };

/// A straight move of the tip with the axis turning along the great circle (slerp).
struct FreeMove {
  MoveKind kind = MoveKind::kRapid;
  ToolPose from, to;
  double feed_mm_s = 0.0;  ///< 0: rapid, limited by the machine alone
};

using program::BlockLaw;
using program::law_name;

/// Axis values at both ends of a block, mm and rad.
struct AxisSpan {
  kinematics::AxisValues from = kinematics::AxisValues::Zero(), to = kinematics::AxisValues::Zero();
};

/// One move of a CL or NC program.
struct BlockMove {
  ToolPose from, to;
  std::optional<program::Arc> arc;  ///< the tip's; kTcp and kTcpAxes only
  BlockLaw law = BlockLaw::kTcp;
  double feed_mm_s = 0.0;  ///< of the tip; 0 with duration_s 0: rapid, limited by the machine alone
  /// Above 0: how long the block takes at its programmed feed, where that is not simply that of the tip.
  double duration_s = 0.0;
  double dwell_s = 0.0;                 ///< the tool stands this long before it moves
  bool exact_stop = false;              ///< comes to rest at its end
  double corner_tolerance_mm = 0.0;     ///< the corner at its end may be rounded by this much; 0: the default
  std::optional<AxisSpan> axes;         ///< as the program commands them; none: they follow from the poses
  std::optional<double> spindle_rpm;    ///< above 0 clockwise, below 0 counter-clockwise; none: nobody says
  int tool = 0;                         ///< index into the job's tools
  int pass = -1;                        ///< 0-based count of the passes; -1 on rapids
  std::optional<CurveSpan> curve = {};  ///< that tip and axis follow; kCurve, and no other
};
/// Limited by the machine alone.
inline bool is_rapid(const BlockMove& block) {
  return block.feed_mm_s == 0.0 && block.duration_s == 0.0;
}
/// Angle in (0, 2 pi] that the tip of an arc block goes round.
double arc_angle(const BlockMove& block);
/// Way of the tip under kTcp, mm.
double tip_way(const BlockMove& block);

struct Element {
  std::variant<SurfacePass, FreeMove, BlockMove, DrivenPass> what;
  int operation = 0;     ///< index into Program::operations; 0 for CL programs
  SourceLocation where;  ///< the block that caused it
};

}  // namespace swarf::toolpath
