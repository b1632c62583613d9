// Surface driven passes judged by what they have become: chords, clamp speeds, limits; and how far any path
// over the same guides is from the one that the surface asks for.
#pragma once

#include <string>
#include <vector>

#include "motion/passes/driven_interpolator.h"
#include "toolpath/elements.h"

namespace swarf::motion {

/// One cycle of a pass, as Kato et al. draw it (Fig. 4 and 5).
struct DrivenTracePoint {
  double s_mm = 0.0;  ///< way of the tip
  double z_mm = 0.0;
  double feed_mm_s = 0.0, clamp_mm_s = 0.0;
};

/// Successive points are F dt apart to this share of it.
inline constexpr double kChordKept = 1e-6;

struct DrivenStatistics {
  size_t passes = 0, cycles = 0, positions_ahead = 0;
  size_t creases = 0, steps = 0;    ///< ahead
  size_t clamped_cells = 0;         ///< slower than the set speed
  double slowest_clamp_mm_s = 0.0;  ///< above 0; 0: none
  /// |chord - F dt| / (F dt), but for cycles that end on a corner.
  double chord_error_max_rel = 0.0;
  size_t off_chord = 0;             ///< cycles with a greater one than kChordKept
  double crease_miss_max_mm = 0.0;  ///< greatest distance of a crease that is a stop from the nearest cycle
  size_t above_clamp = 0, above_acceleration = 0, above_jerk = 0;  ///< cycles, along the path
  double acceleration_max = 0.0, jerk_max = 0.0;                   ///< mm/s^2, mm/s^3, differences of chords
  std::vector<DrivenTracePoint> trace;  ///< of the pass with the most corners, the first of them
};

/// Runs the passes of a path again and measures each cycle. `hint`: axis values before the first.
DrivenStatistics check_driven(const toolpath::Elements& elements, const kinematics::MachineModel& machine,
                              const kinematics::InverseKinematics& inverse, const MotionOptions& options);

/// The exact path of a pass, for distances to it.
class ExactPath {
 public:
  ExactPath(const toolpath::DrivenPass& pass, const kinematics::MachineModel& machine,
            const kinematics::InverseKinematics& inverse, const MotionOptions& options);

  /// Distance of a place from the path, mm. Places are asked for in the order of travel, never farther from
  /// the one before than a few mm: the nearest place of the path is looked for near the last one's.
  double distance(const Vec3& tip);

 private:
  double cell_distance(size_t cell, const Vec3& tip);

  toolpath::DrivenPass pass_;
  EvaluatedPass ahead_;
  position::Near near_;
  size_t cell_ = 0;
};

}  // namespace swarf::motion
