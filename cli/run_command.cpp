#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "base/parallel.h"
#include "cli/commands.h"
#include "cli/terminal.h"
#include "reports/metrics_json.h"
#include "reports/pending_folder.h"
#include "reports/run_output.h"
#include "reports/run_report.h"
#include "sim/simulation.h"

namespace swarf::cli {
namespace {

struct RunOptions {
  std::string scene, output;
  std::vector<std::string> overrides;
  int threads = 0;
  bool no_render = false, json = false;
};

void print_outcome(const sim::Job& job, const sim::Result& result, const std::string& folder) {
  fmt::print("\n{}\n", job.scene.title);
  print_table(reports::summary_lines(job, result));
  for (const sim::Finding& finding : result.findings) {
    fmt::print("  finding: {}\n",
               format({finding.code, finding.severity, finding.where, finding.text, finding.fix}));
  }
  fmt::print("  {}\n  report: {}\n", sim::passes(result) ? "PASS: every limit of [accept] holds" : "FINDINGS",
             (std::filesystem::path(folder) / "report.html").string());
}

int run(const RunOptions& options) {
  set_thread_count(options.threads);
  const sim::Job job = sim::load_job(options.scene, options.overrides);
  print_diagnostics(job.warnings);
  const std::string folder = options.output.empty() ? "out/" + job.scene.name : options.output;
  reports::check_output_folder(folder, reports::kRunMark);
  TerminalProgress progress;
  sim::Result result = sim::simulate(job, progress);
  reports::write_run(folder, job, result, {!options.no_render, options.overrides}, progress);
  if (result.stopped) {
    fmt::print(stderr, "stopped: what was finished is in {}\n", folder);
    return kStopped;
  }
  if (options.json) {
    fmt::print("{}", reports::metrics_json(job, result, {}));
  } else {
    print_outcome(job, result, folder);
  }
  return sim::passes(result) ? kPass : kFindings;
}

}  // namespace

void add_run(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command =
      app.add_subcommand("run", "Simulate a scene: plan, interpolate, cut, measure, render, report");
  command->add_option("scene", options->scene, "scene.toml")->required();
  command->add_option("-o,--output", options->output, "folder for the results (default: out/<scene folder>)");
  command->add_option("--set", options->overrides, "replace a key of the scene: --set stock.voxel_mm=0.1")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->take_all();
  command
      ->add_option("--threads", options->threads,
                   "threads to use (default: all cores); results do not depend on it")
      ->check(CLI::Range(1, 4096));
  command->add_flag("--no-render", options->no_render, "no movie and no stills");
  command->add_flag("--json", options->json, "print metrics.json instead of the table");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace swarf::cli
