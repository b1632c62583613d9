// What a run has found: everything that outputs read.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "measure/flank_error.h"
#include "measure/measure.h"
#include "measure/metrics.h"
#include "motion/cycles/axis_keys.h"
#include "motion/cycles/cycles.h"
#include "motion/cycles/time_envelope.h"
#include "motion/judged/driven_check.h"
#include "motion/judged/singularity_scan.h"
#include "motion/result.h"
#include "sim/check.h"
#include "sim/run/carried_cuts.h"
#include "sim/run/contact_event.h"
#include "sim/run/cut_stage.h"
#include "sim/run/flank_figures.h"
#include "sim/run/job_sweeps.h"
#include "sim/run/machine_contacts.h"
#include "sim/run/memory.h"
#include "sim/run/tool_use.h"
#include "stock/rays/surface_dexels.h"
#include "stock/stock.h"
#include "toolpath/nc_path.h"
#include "toolpath/tool_path.h"

namespace swarf::sim {

/// One path, interpolated and measured on the surface dexels.
struct MeasuredPath {
  toolpath::ToolPath path;
  std::unique_ptr<motion::Cycles> cycles;  ///< of the path's elements
  /// Of earlier set-ups; never null.
  CarriedCutsPtr carried = std::make_shared<const CarriedCuts>();
  motion::MotionResult motion;
  motion::TimeEnvelope envelope{0, 1.0};  ///< of the cycles, for plots
  /// Of all cycles, for animations; none where nobody asks for them.
  std::optional<motion::AxisKeys> keys;
  std::vector<Operation> operations;        ///< of the run's own motion
  std::optional<MachineContacts> contacts;  ///< of the run's own motion; none: not looked at
  /// What cut the measuring rays; Sweep::block is its index. Those of earlier set-ups stand behind the
  /// program's own and have no source.
  JobSweeps rays;
  stock::RayFieldPtr mesh_rays;              ///< of a design of facets, once its memory was predicted
  std::vector<stock::SurfaceDexels> dexels;  ///< one per surface of Job::design, in its order
  std::optional<toolpath::NcReading> nc;     ///< of NC jobs
  std::vector<Diagnostic> warnings;          ///< of the program
  std::vector<measure::Ridge> ridges;
  measure::SurfaceMetrics surface;
  double plan_seconds = 0.0, motion_seconds = 0.0, dexel_seconds = 0.0;
};

/// One line of the comparison tables.
struct ComparisonRow {
  std::string name;
  int passes = 0;
  double pass_length_mm = 0.0, link_length_mm = 0.0, time_s = 0.0;
  double orientation_error_max_rad = 0.0, feed_error_max_rel = 0.0, chord_error_max_mm = 0.0;
  measure::SurfaceMetrics surface;
  bool used = false;  ///< the one this run cut the stock with
};

/// One line of Kato et al.'s comparison: the same passes driven by the surface, or as blocks of a CAM system.
struct DrivenRow {
  std::string name;
  double cam_tolerance_mm = 0.0;  ///< 0: driven by the surface
  size_t blocks = 0;              ///< that the control is given; of the surface: one for the part
  size_t program_bytes = 0;       ///< of those blocks as G1 with four decimals; 0: none are needed
  double time_s = 0.0;
  double feed_mean_mm_s = 0.0, feed_lowest_mm_s = 0.0;  ///< in contact; lowest but for the ends of passes
  double position_error_max_mm = 0.0;  ///< of cycles and the middles of their chords, from the exact path
  double position_error_rms_mm = 0.0;
  measure::SurfaceMetrics surface;
  bool used = false;  ///< the one this run cut the stock with
};

struct Result {
  MeasuredPath main;
  std::vector<ComparisonRow> planners;  ///< the scene's interpolator, every planner
  std::vector<ComparisonRow> modes;     ///< the scene's planner, the interpolators of the paper's comparison
  std::vector<DrivenRow> driven_rows;   ///< of driven jobs
  std::optional<motion::DrivenStatistics> driven;  ///< of the passes that the surface drove
  std::unique_ptr<stock::Stock> stock;
  double sweep_bound_mm = 0.0;  ///< of the sweeps that cut the level set
  uint64_t merged_sweeps = 0;   ///< how many they are
  /// By this set-up, and at its end.
  double volume_removed_mm3 = 0.0, volume_left_mm3 = 0.0;
  double full_mm3 = 0.0;    ///< of the raw stock as the level set holds it, before any cut
  uint64_t start_hash = 0;  ///< of the stock before the program's first sweep
  /// Proven of the level set; none: not yet.
  std::optional<stock::VolumeRange> volume_range;
  double volume_error_bound_mm3 = 0.0;  ///< proven: neither is farther from the truth (stock_volume.cpp)
  std::optional<measure::CrossCheck> cross_check;  ///< none: no ray of a parametric design could be compared
  ToolClearance clearance;
  std::optional<FlankFigures> flank_milling;  ///< of flank jobs
  std::optional<measure::FlankError> flank;   ///< of a ruled design and a cutter with a cylindrical flank
  std::optional<motion::SingularityScan> singularity;  ///< of blocks on a machine with a pole
  CutOutcome cut;
  MemoryPrediction memory;
  std::vector<Check> checks;  ///< what the verdict rests on; empty when the run was stopped
  std::vector<Finding> findings;
  bool stopped = false;  ///< the user stopped it; what follows the cut is missing
};

}  // namespace swarf::sim
