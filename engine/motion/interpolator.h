// From the tool path to one tool pose and one set of axis positions per control cycle.
//
//   ToolPath --> surface pass --> SurfaceInterpolator (taylor1, surface) --+
//            --> surface pass --> straight segments (offline) -------------+--> ToolSample --> inverse --> q
//            --> free move    --> straight tip, slerp axis ----------------+
//            --> blocks       --> their own law (block_motion.h), by runs --+
//
// Every pass and move, and every run of blocks (block_run.h), starts and ends at rest; between them nothing
// moves. The rotary branch is chosen once, nearest to home, and then follows by continuity; blocks that give
// axis values keep theirs. The first block of another tool begins with a sample of its own; how the axes come
// there is not part of the program.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/progress.h"
#include "base/units.h"
#include "cutter/cutter.h"
#include "kinematics/machine_model.h"
#include "motion/tool_sample.h"
#include "toolpath/tool_path.h"

namespace swarf::motion {

enum class Mode {
  kTaylor1,  ///< "taylor1": Lin & Koren Eq. (5), u += V T / |C'|
  kSurface,  ///< "surface": Taylor 2 and two Newton steps on the chord, the production rule
  kOffline,  ///< "offline": straight segments by chord tolerance, what a CAM system would have written
};

/// The tool axis along an off-line segment whose ends carry exact normals.
enum class OfflineOrientation {
  kConstant,          ///< that of the segment's start; the tool turns at rest at its end, so it always stops
  kLinearInU,         ///< Lin & Koren Eq. (7)
  kLinearAlongChord,  ///< what controls do, and what reproduces the paper's Fig. 6 (erratum E5)
};

struct MotionOptions {
  Mode mode = Mode::kSurface;
  /// Control cycle, s. Shorter: smaller chords and more samples.
  double period_s = 1e-3;
  /// Of the contact point along the path, mm/s^2. Axis limits may lower it.
  double path_acceleration_max = 2000.0;
  /// Of the contact point along the path, mm/s^3. Lower: gentler starts and stops, longer times.
  double path_jerk_max = 50000.0;
  /// Off-line mode only.
  OfflineOrientation orientation = OfflineOrientation::kLinearAlongChord;
  /// Off-line mode only: pass through corners at the speed that the chord tolerance allows instead of
  /// stopping at the end of each block (erratum E19). Without effect on constant orientation.
  bool look_ahead = true;
  /// Blocks: how far the tip may leave a corner between blocks that give no tolerance of their own (G64 P,
  /// CYCLE832), mm. Larger: corners are passed faster.
  double corner_tolerance_mm = 0.01;
  /// Feed blocks that turn their rotary axes by more per mm of the tip are reported, rad/mm.
  double fast_rotary_rad_mm = 10.0 * kPi / 180.0;
  /// Blocks that turn one rotary axis by more are reported, rad.
  double swing_rad = kPi;
};

/// Every contradiction in the options, in words with numbers; empty when they can be used.
std::vector<std::string> validate(const MotionOptions& options);

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
  std::vector<double> by_tool_s;  ///< by BlockMove::tool, all of the above
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
};

struct MotionResult {
  Trajectory trajectory;
  MotionStatistics statistics;
  std::vector<MotionFinding> findings;  ///< by element, then axis
};

/// Interpolates the whole path. Deterministic but for tick_ns_*. When the user stops it, the elements
/// finished so far are returned. Throws InputError ("bad-options", "too-many-cycles") for input that cannot
/// be used.
/// `by_tool`: the machine with each tool in its spindle (BlockMove::tool), or one for whatever tool.
/// `cutter`: of surface passes.
MotionResult interpolate(const toolpath::ToolPath& path, std::span<const kinematics::MachineModel> by_tool,
                         const cutter::Cutter& cutter, const MotionOptions& options, Progress& progress);
inline MotionResult interpolate(const toolpath::ToolPath& path, const kinematics::MachineModel& machine,
                                const cutter::Cutter& cutter, const MotionOptions& options,
                                Progress& progress) {
  return interpolate(path, std::span(&machine, 1), cutter, options, progress);
}

}  // namespace swarf::motion
