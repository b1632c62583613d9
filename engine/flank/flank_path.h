// A tool path of blocks along the rulings.
//
//      rapid to above the start | down the axis | rulings u_low .. 0 | 0 .. 1 | 1 .. u_high | up the axis
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "flank/feed.h"
#include "flank/placement.h"
#include "toolpath/pose_curve.h"
#include "toolpath/tool_path.h"

namespace swarf::flank {

/// What speed the blocks get.
enum class FeedRule {
  kProgrammed,  ///< the same everywhere
  kBisected,    ///< the greatest within the limit at every ruling (bisected_feed)
  kConstant,    ///< the least of those everywhere: the best constant feed of the same error
  kCurvature    ///< by the curvature of the guide curves alone
};

struct FlankMotion {
  double feed_mm_s = 0.0;    ///< programmed; no rule goes above it
  double limit_mm = 0.0;     ///< of |e|; 0: none, then kProgrammed is the only rule
  ChordMiddle middle;        ///< of the control's chords
  double period_s = 1e-3;    ///< of the control
  double chord_mm = 1e-4;    ///< blocks stay this close to the axis surface; the feed keeps it off the limit
  double overrun_mm = 10.0;  ///< the surface is continued at both ends
  double retract_mm = 50.0;  ///< along its axis, before and after
  double spindle_rpm = 0.0;  ///< 0: nobody says
  bool on_curve = false;     ///< the control follows one smooth curve instead of straight blocks
  toolpath::BlockLaw law = toolpath::BlockLaw::kTcp;  ///< of straight blocks
};

/// One block end of a pass and the greatest speed about it by each rule.
struct Station {
  double u = 0.0;
  ToolPose pose;
  double way_mm = 0.0;                               ///< of the tip, on a curve
  double bisected_mm_s = 0.0, curvature_mm_s = 0.0;  ///< 0 without a limit
};

/// One pass over a surface.
struct FlankPass {
  FlankTask task;
  FlankMotion motion;
  SourceLocation where;
  size_t surface = 0;  ///< of the design
  std::vector<Station> stations;
  std::shared_ptr<const toolpath::PoseCurve> curve;  ///< null: straight blocks
};

/// Fills stations and curve. Straight blocks: so close that no pose half way between two lies more than
/// chord_mm beside the axis surface, in terms of e; at least 16. A curve: within chord_mm of it
/// (axis_curve.h), stations half a mm apart, for the feed alone. Throws InputError "too-many-blocks" at the
/// pass' place above 20 000.
void plan_pass(FlankPass& pass);

/// Passes in order, each one pass of the path.
toolpath::ToolPath flank_path(std::span<const FlankPass> passes, FeedRule rule);

}  // namespace swarf::flank
