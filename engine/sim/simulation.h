// The run: program -> tool path -> samples -> axes -> cuts -> measures. The only place that joins all
// modules.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "measure/flank_error.h"
#include "measure/measure.h"
#include "measure/metrics.h"
#include "motion/cycles.h"
#include "motion/result.h"
#include "motion/singularity_scan.h"
#include "motion/time_envelope.h"
#include "sim/contact_event.h"
#include "sim/cut_stage.h"
#include "sim/job_sweeps.h"
#include "sim/judge.h"
#include "sim/memory.h"
#include "sim/scene.h"
#include "stock/stock.h"
#include "stock/surface_dexels.h"
#include "toolpath/nc_path.h"
#include "toolpath/tool_path.h"

namespace swarf::sim {

/// What is wrong with the job (not with the input): where on the part, in which block, when. An error where
/// its check fails or is not proven, else a warning.
struct Finding {
  std::string code;  ///< stable: "gouge", "scallop", "travel", ...
  Severity severity = Severity::kError;
  std::string text, fix;
  SourceLocation where;
  double t_s = 0.0;
  std::string block;    ///< the program's text there; "" where no line is meant
  std::string check{};  ///< Check::name of what it breaks; "" where it breaks nothing
};

/// One path, interpolated and measured on the surface dexels.
struct MeasuredPath {
  toolpath::ToolPath path;
  std::unique_ptr<motion::Cycles> cycles;  ///< of the path's elements
  motion::MotionResult motion;
  motion::TimeEnvelope envelope{0, 1.0};     ///< of the cycles, for plots
  JobSweeps rays;                            ///< what cut the measuring rays; Sweep::block is its index
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

struct Result {
  MeasuredPath main;
  std::vector<ComparisonRow> planners;  ///< the scene's interpolator, every planner
  std::vector<ComparisonRow> modes;     ///< the scene's planner, the interpolators of the paper's comparison
  std::unique_ptr<stock::Stock> stock;
  std::vector<SweepSource> cut_sources;  ///< of the sweeps that cut the level set, by Sweep::block
  double sweep_bound_mm = 0.0;           ///< of the same sweeps
  uint64_t merged_sweeps = 0;            ///< how many they are
  double volume_removed_mm3 = 0.0, volume_left_mm3 = 0.0;  ///< together the box
  double volume_error_bound_mm3 = 0.0;  ///< proven: neither is farther from the truth (stock_volume.cpp)
  std::optional<measure::CrossCheck> cross_check;  ///< none: no ray of a parametric design could be compared
  ToolClearance clearance;
  std::optional<measure::FlankError> flank;  ///< of a ruled design and a cutter with a cylindrical flank
  std::optional<motion::SingularityScan> singularity;  ///< of blocks on a machine with a pole
  CutOutcome cut;
  MemoryPrediction memory;
  std::vector<Check> checks;  ///< what the verdict rests on; empty when the run was stopped
  std::vector<Finding> findings;
  bool stopped = false;  ///< the user stopped it; what follows the cut is missing
};

/// The scene's own path: planned on the surfaces, or the blocks of the CL or NC program. Throws InputError
/// when it cannot be planned; what is only worth a warning goes to `diagnostics`. `reading`, if given,
/// receives what an NC program says besides its moves.
toolpath::ToolPath job_path(const Job& job, Diagnostics& diagnostics, toolpath::NcReading* reading = nullptr);

/// Plans and interpolates the job's program, nothing else; of the options, only those of the tables count.
/// Throws InputError when the path cannot be planned or never meets the stock, or a table cannot be written.
MeasuredPath move_tool(const Job& job, Progress& progress, const CutOptions& options = {});

/// Runs everything. Throws InputError as move_tool and cut_stock do.
Result simulate(const Job& job, const CutOptions& options, Progress& progress);

/// The verdict: of Result::checks.
inline bool passes(const Result& result) {
  return passes(result.checks);
}

}  // namespace swarf::sim
