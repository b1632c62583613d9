// The run: program -> tool path -> samples -> axes -> cuts -> measures. The only place that joins all
// modules.
#pragma once

#include "base/progress.h"
#include "sim/job/job_path.h"
#include "sim/job/scene.h"
#include "sim/judge/judge.h"
#include "sim/run/cut_stage.h"
#include "sim/run/result.h"

namespace swarf::sim {

/// Plans and interpolates the job's program, nothing else; of the options, only those of the tables count.
/// Throws InputError when the path cannot be planned or never meets the stock, or a table cannot be written.
MeasuredPath move_tool(const Job& job, Progress& progress, const CutOptions& options = {});

/// Plans the job's program: its cycles can be walked or recalled (cycles.h), none is made. Throws InputError
/// as move_tool does.
MeasuredPath plan_tool(const Job& job, Progress& progress);

/// Runs everything. Throws InputError as move_tool and cut_stock do.
Result simulate(const Job& job, const CutOptions& options, Progress& progress);

/// For every rank but 0 of a run that cuts tile by tile: makes the motion and does what rank 0 asks of it,
/// until that one says that it is done. `options`: of the run. What is wrong here is told by rank 0.
void serve_tiles(const Job& job, const CutOptions& options, Ranks& ranks, Progress& progress);

/// The verdict: of Result::checks.
inline bool passes(const Result& result) {
  return passes(result.checks);
}

}  // namespace swarf::sim
