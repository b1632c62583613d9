// The folder that a run leaves: written beside its final place and moved there when it is complete.
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "base/time_budget.h"
#include "reports/metrics_json.h"
#include "reports/pending_folder.h"
#include "sim/job/kept_job.h"
#include "sim/run/worn_fixtures.h"
#include "sim/simulation.h"

namespace swarf::avoidance {
struct Outcome;
}

namespace swarf::reports {

struct OutputOptions {
  bool render = true;                             ///< false: no movie, no stills
  bool report = true;                             ///< false: no page, no glTF
  std::vector<std::string> overrides;             ///< the --set of this run, kept with it
  std::string command;                            ///< as it was given, ready for a shell
  const avoidance::Outcome* avoidance = nullptr;  ///< of a scene with [post]; else null
  TimeBudget budget;                              ///< after it no further picture is begun
};

using sim::kRunMark;

/// Before the work: copies the inputs into `folder` (kept_inputs.h) and marks it as a run. Throws InputError.
void begin_run(const PendingFolder& folder, const sim::Job& job, const OutputOptions& options);

/// Writes everything into `folder` beside what the run has saved there already, and moves it into place: an
/// earlier result is replaced whole; it stays until then. Stock, rays and numbers come first:
/// when one of them cannot be written, InputError says why, and what could be is kept beside the target. What
/// goes wrong with pictures and page is returned; the rest is there. Result::left_out names what the budget
/// did not allow.
std::vector<Diagnostic> write_run(PendingFolder& folder, const sim::Job& job, sim::Result& result,
                                  const OutputOptions& options, Progress& progress);

/// The job of a run, from the copies in its folder; `overrides` come on top of those that it was run with.
/// Throws InputError "not-a-run" and as load_job does.
sim::Job read_job(const std::string& folder, const std::vector<std::string>& overrides);

/// A run read back from its folder: nothing is cut or measured again.
struct StoredRun {
  sim::Job job;
  stock::Stock stock;
  std::vector<stock::SurfaceDexels> dexels;
  std::vector<sim::WornFixture> worn;  ///< without what was removed
};
StoredRun read_run(const std::string& folder);

/// Warnings where another version of swarf has made the run ("other-version") and where it was stopped before
/// it was judged ("run-stopped").
std::vector<Diagnostic> remarks_on_run(const std::string& folder);

/// The run's motion, made again from its kept inputs; without any cycle when it is not `needed`. Throws
/// InputError "run-differs" when these were changed, or give another motion than the run's to the last bit.
sim::MeasuredPath motion_of(const StoredRun& run, const std::string& folder, bool needed, Progress& progress);

/// The same for readers of a few cycles: they are made when they are read (CycleReader), without those before
/// them.
sim::MeasuredPath window_motion(const sim::Job& job, const std::string& folder, Progress& progress);

}  // namespace swarf::reports
