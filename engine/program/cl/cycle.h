// Drilling cycles of CL data as single steps.
//
//   A = P + arrive a  ---- rapid ---->  C = P + clear a  ---->  feed to P - depth a, dwell, out again
//
// P is the point of GOTO, a its tool axis. DEEP comes out to C between its pecks and goes back in rapid to
// kPeckGap above the ground; BRKCHP only lifts by kPeckGap.
#pragma once

#include <vector>

#include "base/frames.h"

namespace swarf::program {

enum class ClCycleKind { kDrill, kFace, kDeep, kChipBreak, kBore, kTap };

struct ClCycle {
  ClCycleKind kind = ClCycleKind::kDrill;
  double depth_mm = 0.0;          ///< below the point
  double arrive_mm = 0.0;         ///< above it: where the tool comes to, in rapid
  double clear_mm = 0.0;          ///< above it: where the feed begins
  double retract_mm = 0.0;        ///< above it, when the hole is done
  bool retract_to_start = false;  ///< RTRCTO,AUTO: to where the tool stood before the cycle, instead
  double step_mm = 0.0;           ///< of DEEP and BRKCHP
  double first_step_mm = 0.0;     ///< of the first peck where it is another one; 0: step_mm
  double dwell_s = 0.0;           ///< on the ground
  double feed_mm_s = 0.0;
};

/// Distance above the ground of the last peck that is approached in rapid, mm.
inline constexpr double kPeckGap = 0.5;

/// A step along the axis of the hole.
struct ClCycleStep {
  double height_mm = 0.0;  ///< of its end above the point
  bool rapid = false;
  double dwell_s = 0.0;  ///< before it
};

/// The steps of one hole after the tool has come to `arrive_mm`.
std::vector<ClCycleStep> cycle_steps(const ClCycle& cycle);

}  // namespace swarf::program
