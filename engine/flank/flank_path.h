// A tool path of blocks along the rulings.
//
//      rapid to above the start | down the axis | rulings u_low .. 0 | 0 .. 1 | 1 .. u_high | up the axis
#pragma once

#include <span>
#include <vector>

#include "flank/placement.h"
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
  double period_s = 1e-3;    ///< of the control
  double chord_mm = 1e-4;    ///< blocks stay this close to the axis surface
  double overrun_mm = 10.0;  ///< the surface is continued at both ends
  double retract_mm = 50.0;  ///< along its axis, before and after
  double spindle_rpm = 0.0;  ///< 0: nobody says
  toolpath::BlockLaw law = toolpath::BlockLaw::kTcp;
};

/// One block end of a pass and the greatest speed about it by each rule.
struct Station {
  double u = 0.0;
  ToolPose pose;
  double bisected_mm_s = 0.0, curvature_mm_s = 0.0;  ///< 0 without a limit
};

/// Block ends so close that no pose half way between two lies more than chord_mm beside the axis surface, in
/// terms of e; at least 16 blocks. Throws InputError "too-many-blocks" at `where` above 20 000.
std::vector<Station> stations_of(const FlankTask& task, const FlankMotion& motion,
                                 const SourceLocation& where);

/// Passes in order, each one pass of the path.
toolpath::ToolPath flank_path(std::span<const std::vector<Station>> stations, const FlankMotion& motion,
                              FeedRule rule, const SourceLocation& where);

}  // namespace swarf::flank
