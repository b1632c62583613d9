// The tool path in the work frame: passes on a surface and free moves between them, or the blocks of a CL
// program.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/cubic_spline.h"
#include "base/diagnostics.h"
#include "base/frames.h"
#include "cutter/cutter.h"
#include "kinematics/machine_model.h"
#include "program/block_law.h"
#include "program/cl/program.h"
#include "program/surface_blocks/program.h"
#include "surface/surface.h"

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
  double dwell_s = 0.0;               ///< the tool stands this long before it moves
  bool exact_stop = false;            ///< comes to rest at its end
  double corner_tolerance_mm = 0.0;   ///< the corner at its end may be rounded by this much; 0: the default
  std::optional<AxisSpan> axes;       ///< as the program commands them; none: they follow from the poses
  std::optional<double> spindle_rpm;  ///< above 0 clockwise, below 0 counter-clockwise; none: nobody says
  int tool = 0;                       ///< index into the job's tools
  int pass = -1;                      ///< 0-based count of the passes; -1 on rapids
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
  std::variant<SurfacePass, FreeMove, BlockMove> what;
  int operation = 0;     ///< index into Program::operations; 0 for CL programs
  SourceLocation where;  ///< the block that caused it
};

struct ToolPath {
  std::string planner;  ///< "constant_scallop" | "lin_koren" | "isoparametric"; "cl" for CL programs
  std::vector<Element> elements;
  int passes = 0;
  double pass_length_mm = 0.0;  ///< contact length, without links
  double link_length_mm = 0.0;
};

/// True for the path of a CL program: its elements are blocks and nothing else.
bool holds_blocks(const ToolPath& path);

/// Tool pose in contact at a curve point: flat end, axis = normal turned by lead (about the cross direction,
/// towards the feed) and tilt (towards the left of the feed). With zero lean the tip centre is the contact
/// point; leaned, the contact lies on the rim and the tip centre is one radius behind it in the bottom plane.
/// `unit_feed` is the direction of travel.
ToolPose pose_in_contact(const Vec3& contact, const Vec3& normal, const Vec3& unit_feed, double lead_rad,
                         double tilt_rad, double radius_mm);

enum class Planner { kConstantScallop, kLinKoren, kIsoparametric };
/// "constant_scallop" and so on; nullptr-safe names for reports and TOML.
const char* planner_name(Planner planner);

struct PlanOptions {
  Planner planner = Planner::kConstantScallop;
  double safe_distance_mm = 5.0;  ///< retract along the tool axis between passes
  double overrun_mm = 1.5;        ///< each pass runs on past the edge of the part by this much
  double rapid_clearance_mm =
      20.0;                   ///< first approach and last retract, above the highest point of the stock
  double stock_top_mm = 0.0;  ///< W, highest point of the stock
  double approach_feed_fraction = 0.5;
};

/// Plans every operation of the program. Alarms of theory 1.6 that need the cutter (saddle or concave without
/// lean, P beyond D R/(R+h)) and operations that cannot be planned go to `diagnostics`.
ToolPath plan(const program::Program& program, const cutter::Cutter& cutter, const PlanOptions& options,
              Diagnostics& diagnostics);

}  // namespace swarf::toolpath
