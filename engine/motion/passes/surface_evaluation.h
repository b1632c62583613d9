// Surface evaluation ahead of interpolation (Kato et al., section 2.2): what a pass meets on its way, and how
// fast each place of it may be passed.
//
//   1. The tool is set down on lines kStep_mm apart; where the path turns by more than kTurn_rad between two,
//      they are divided, until it does not or the lines are one.
//   2. Lines that are one with different tips: a step, passed straight along the tool's axis. With one tip
//   and
//      two directions: a crease.
//   3. Clamp speeds: chords of curves, what the axes can do, creases and steps (theory 3).
//
// Between two lines nothing is looked at. What a cutter rests on is widened by the cutter itself: a bump of
// height d lifts a ball of radius r over 2 sqrt(2 r d), a flat end over its whole diameter. So bumps above
// (kStep_mm / 2)^2 / (2 r) are seen, .25 um for a ball D10; a dip may be narrower, and is then passed at the
// speed of what lies around it. Positions do not depend on it: each cycle sets the tool down itself.
#pragma once

#include <vector>

#include "kinematics/machine_model.h"
#include "motion/options.h"
#include "motion/speed/speed_control.h"
#include "toolpath/driven/driven_pass.h"

namespace swarf::motion {

inline constexpr double kEvaluationStep_mm = 0.1;

/// Why a place must be passed slower than the set speed.
enum class ClampReason { kNone, kCurvature, kAxes, kCrease, kStep };
const char* clamp_reason_name(ClampReason reason);

/// One line of the evaluation.
struct EvaluatedNode {
  double x = 0.0;  ///< parameter of the guide
  ToolPose pose;
  bool corner = false;  ///< a crease, or an end of a step
};

/// A pass as it lies ahead.
struct EvaluatedPass {
  std::vector<EvaluatedNode> nodes;
  std::vector<bool> steps;  ///< one per cell: straight along the axis, at one x
  ClampSpeeds clamps;       ///< by the way of the tip; nodes as above
  std::vector<ClampReason> cell_reasons, node_reasons;
  /// Along the path, for the whole pass: what changes of speed may take. mm/s^2, mm/s^3.
  RampLimits limits;
  size_t positions = 0;  ///< that have been calculated for it
};

/// `hint`: axis values before the pass. Throws InputError "guide-misses-part" where the tool would rest on
/// nothing.
EvaluatedPass evaluate_ahead(const toolpath::DrivenPass& pass, const kinematics::MachineModel& machine,
                             const kinematics::InverseKinematics& inverse, const MotionOptions& options,
                             const kinematics::AxisValues& hint);

}  // namespace swarf::motion
