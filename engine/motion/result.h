// What is known of a motion when all its cycles have been seen.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/diagnostics.h"

namespace swarf::motion {

/// What one axis did over the whole program. mm or rad, mm/s or rad/s, ...
struct AxisStatistics {
  std::string name;
  double min = 0.0, max = 0.0;
  double travel = 0.0;  ///< sum of all movements
  double speed_max = 0.0, acceleration_max = 0.0, jerk_max = 0.0;
  double time_at_speed_limit_s = 0.0;  ///< with at least kAtLimit of its speed limit
};
inline constexpr double kAtLimit = 0.99;

/// Time of a program by what it is spent on, s.
struct CycleTime {
  double feed_s = 0.0, rapid_s = 0.0, dwell_s = 0.0;
  std::vector<double> by_tool_s;     ///< by BlockMove::tool, all of the above
  std::vector<double> in_spindle_s;  ///< by ToolSample::tool, with the cycle in which it is changed
};

/// How far the tip would be off, were the blocks driven in the other mode: under tcp and ends the axes
/// linear, under joint the tip straight.
struct OtherMode {
  double tip_error_max_mm = 0.0;  ///< distance from the straight line between a block's ends, or its arc
  int element = -1;               ///< where that is; -1: no block turns
  double share = 0.0;
};

/// Measured on the finished trajectory, not taken from the planner.
struct MotionStatistics {
  uint64_t ticks = 0;
  double time_s = 0.0;
  double path_length_mm = 0.0;             ///< sum of the chords in contact
  double feed_error_max_rel = 0.0;         ///< in contact: |chord - commanded feed T| / (programmed feed T)
  double chord_error_max_mm = 0.0;         ///< distance of the middle of each chord from the true curve
  double orientation_error_max_rad = 0.0;  ///< commanded axis against the exact one, at the ticks
  double fk_ik_error_max_mm = 0.0;         ///< tip of forward(inverse) against the commanded tip
  double tip_error_max_mm = 0.0;  ///< axes moved linearly between ticks, against the true path at mid tick
  uint64_t singular_ticks = 0;    ///< tool axis at the pole within rounding
  double tick_ns_median = 0.0;    ///< step() and inverse, real-time modes only; 0 in off-line mode
  double tick_ns_p999 = 0.0;
  double pole_distance_min_rad = 0.0;  ///< in contact; pi when the machine has no pole
  int pole_element = -1;               ///< where that was
  double feed_min_mm_s = 0.0;        ///< in contact, between the first and last time a pass has its top feed
  std::vector<AxisStatistics> axes;  ///< order of MachineModel::axes
  CycleTime cycle;
  OtherMode other_mode;
  /// Greatest distance of the tip from the programmed place in a rounded corner of feeds, and its element.
  double corner_deviation_max_mm = 0.0;
  int corner_element = -1;
};

/// The program asks of the machine what it cannot do.
struct MotionFinding {
  std::string code;  ///< "travel" | "axis-speed" | "unreachable"; warnings: "fast-rotary" | "swing"
  std::string text;
  int element = 0;
  double t_s = 0.0;  ///< of the worst sample; of the block's first one for a warning
  SourceLocation where;
  Severity severity = Severity::kError;
  std::string axis{};  ///< the axis at fault; "" where it is none alone
};

struct MotionResult {
  MotionStatistics statistics;
  std::vector<MotionFinding> findings;  ///< by element, then axis
};

}  // namespace swarf::motion
