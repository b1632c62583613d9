#include "cli/python/scene_run.h"

#include <filesystem>

#include "base/parallel.h"
#include "reports/part_view.h"
#include "reports/pictures.h"
#include "reports/run_output.h"

namespace swarf::cli {
namespace {

namespace fs = std::filesystem;

sim::Job load(const RunRequest& request) {
  if (request.file.empty()) return sim::load_job(sim::SceneText{request.toml, "scene"}, request.overrides);
  if (fs::path(request.file).extension() != ".toml")
    throw InputError("needs-scene", {request.file}, "this is no scene.toml",
                     "a program is run as swarf.run({\"nc\": \"part.nc\", \"tools\": \"6\"}), CL data with "
                     "\"cl\" instead of \"nc\"");
  return sim::load_job(request.file, request.overrides);
}

sim::CutOptions cut_of(const RunRequest& request, const sim::Job& job, const std::string& folder) {
  const bool draws = request.render && !folder.empty();
  sim::CutOptions cut;
  cut.save_folder = folder;
  cut.outputs = {draws, draws};
  cut.overrides = request.overrides;
  cut.budget = TimeBudget(job.scene.output.budget_s);
  return cut;
}

/// A folder that is not moved into place vanishes: a stopped run leaves the one that stood there.
std::vector<Diagnostic> run_into_folder(const RunRequest& request, SceneRun& run, Progress& progress) {
  reports::check_output_folder(request.output, reports::kRunMark);
  reports::PendingFolder pending(request.output);
  const sim::CutOptions cut = cut_of(request, run.job, pending.path());
  const reports::OutputOptions options{request.render,  request.render, request.overrides,
                                       request.command, nullptr,        cut.budget};
  reports::begin_run(pending, run.job, options);
  run.result = sim::simulate(run.job, cut, progress);
  if (run.result.stopped) return {};
  return reports::write_run(pending, run.job, run.result, options, progress);
}

void append(std::vector<Diagnostic>& all, const std::vector<Diagnostic>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

}  // namespace

std::unique_ptr<SceneRun> run_scene(const RunRequest& request, Progress& progress) {
  set_thread_count(request.threads);
  auto run = std::make_unique<SceneRun>(SceneRun{load(request), {}, {}});
  append(run->told, run->job.warnings);
  std::vector<Diagnostic> failures;
  if (request.output.empty())
    run->result = sim::simulate(run->job, cut_of(request, run->job, ""), progress);
  else
    failures = run_into_folder(request, *run, progress);
  append(run->told, run->result.main.warnings);
  append(run->told, failures);
  return run;
}

void save_picture(const SceneRun& run, const PictureRequest& request, const std::string& path) {
  sim::Job job = run.job;
  if (request.width > 0) job.scene.stills.size = {request.width, request.height};
  if (request.samples > 0) job.scene.stills.samples = request.samples;
  const reports::StillKind kind = reports::still_kind(request.kind);
  const sim::Result& result = run.result;
  reports::FinishedRun finished{job, *result.main.cycles, *result.stock, result.main.dexels,
                                *result.main.carried};
  finished.rays = &result.main.rays;
  reports::make_still(finished, reports::still_part(finished, result.stock->mesh(), {}), kind, request.camera,
                      path);
}

}  // namespace swarf::cli
