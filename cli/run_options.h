// What stands behind `swarf run`.
#pragma once

#include <string>
#include <vector>

#include "base/time_budget.h"
#include "cli/job_flags.h"
#include "cli/pipeline_files.h"
#include "sim/run/cut_stage.h"

namespace swarf {
class Ranks;
}

namespace swarf::cli {

struct RunOptions {
  std::string scene, output;
  JobWords job;
  std::vector<std::string> overrides;
  std::string from, save_after, trajectory;
  int threads = 0;
  size_t record_every = 256;
  size_t setup = 0;  ///< the last one of several; 0: all
  double max_memory_mb = 0.0, keep_every_s = 60.0;
  double budget_s = 0.0;  ///< 0: what the scene says
  TimeBudget::Clock::time_point begun = TimeBudget::Clock::now();
  bool no_render = false, report = false, json = false, record = false, check = false, open = false,
       pdf = false;
  bool tiles = false, spill = false;
  Ranks* ranks = nullptr;  ///< of --tiles
  PipelineFiles pipeline;
};

/// The command that was given, with every option that is not at its default.
std::vector<std::string> command_words(const RunOptions& options);

/// What the options set in the scene.
std::vector<std::string> overrides_of(const RunOptions& options);

/// What they ask of the cut; its files go to `save_folder`. Throws InputError for places that are none.
sim::CutOptions cut_options(const RunOptions& options, const std::string& save_folder);

/// All of them, and examples below the help. `options` must outlive the command.
void add_run_options(CLI::App& command, RunOptions& options);

}  // namespace swarf::cli
