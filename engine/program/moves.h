// A move as CL data and NC programs alike say it: of the tool's tip and axis, in the work frame.
#pragma once

#include <optional>

#include "base/frames.h"

namespace swarf::program {

/// The tip goes round `centre_W` counter-clockwise about `normal_W`; it stays an arc until it is cut. Where
/// its ends lie at different heights along the normal it is a helix of at most one turn.
struct Arc {
  Vec3 centre_W = Vec3::Zero();
  Vec3 normal_W = Vec3::UnitZ();  ///< unit
};

/// One motion statement of CL data; of NC programs the part that no machine is needed for (NcMove).
struct Move {
  ToolPose from, to;       ///< of the active tool, W; `from` is not the last `to` where the tool changed
  std::optional<Arc> arc;  ///< the tip's; none: a straight move, or what NcMove::law says
  bool rapid = false;
  double feed_mm_s = 0.0;    ///< as programmed, of the tip; 0 for rapids, and in NC blocks that are timed
                             ///< another way (G93, turns without a tip way)
  double dwell_s = 0.0;      ///< the tool stands this long before the move (DELAY, G4, cycles)
  double spindle_rpm = 0.0;  ///< above 0 clockwise (M3), below 0 counter-clockwise (M4, CCLW), 0 stopped
  int tool = -1;  ///< index into ControlSetup::tools or ClProgram::tools; -1: none is in the spindle
  int line = 0, column = 0;
};

/// Lengths of tool axes may differ from 1 by this much (rounded output of CAM systems); they are normalised.
inline constexpr double kAxisLengthTolerance = 1e-4;
/// The ends of an arc may miss its circle by this much, mm.
inline constexpr double kArcTolerance = 5e-3;

}  // namespace swarf::program
