#include <fmt/format.h>

#include <csignal>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>

#include "base/parallel.h"
#include "base/ranks.h"
#include "cli/commands.h"
#include "cli/page_pdf.h"
#include "cli/pipeline_files.h"
#include "cli/posted_scene.h"
#include "cli/run_options.h"
#include "cli/run_tiles.h"
#include "cli/shell_text.h"
#include "cli/terminal.h"
#include "reports/avoidance_output.h"
#include "reports/metrics_json.h"
#include "reports/pending_folder.h"
#include "reports/run_output.h"
#include "reports/run_report.h"
#include "reports/setups_json.h"
#include "sim/job/set_ups.h"
#include "sim/simulation.h"

namespace swarf::cli {
namespace {

namespace fs = std::filesystem;

void print_finding(const sim::Finding& finding) {
  fmt::print("  finding: {}\n",
             painted({finding.code, finding.severity, finding.where, finding.text, finding.fix}, stdout));
  if (!finding.block.empty()) fmt::print("    t = {:.3f} s: {}\n", finding.t_s, finding.block);
}

/// By code, in the order in which the codes first appear: the first of each, and how many more there are.
void print_findings(const std::vector<sim::Finding>& findings) {
  const size_t printed = manner().verbose ? findings.size() : 5;
  std::vector<std::string> codes;
  std::map<std::string, std::vector<const sim::Finding*>> by_code;
  for (const sim::Finding& finding : findings) {
    std::vector<const sim::Finding*>& same = by_code[finding.code];
    if (same.empty()) codes.push_back(finding.code);
    same.push_back(&finding);
  }
  for (const std::string& code : codes) {
    const std::vector<const sim::Finding*>& same = by_code[code];
    for (size_t i = 0; i < std::min(printed, same.size()); ++i) print_finding(*same[i]);
    if (same.size() > printed)
      fmt::print("  and {} more of {} in findings.json\n", same.size() - printed, code);
  }
}

/// Before anything else, so that a long run of the wrong thing can be stopped. `aside`: stdout holds JSON.
void print_assumptions(const sim::Assumptions& assumptions, bool aside) {
  if (assumptions.empty()) return;
  FILE* const out = aside ? stderr : stdout;
  size_t width = 0;
  for (const sim::Assumption& one : assumptions) width = std::max(width, one.what.size());
  fmt::print(out, "assumed, for neither the program nor the scene says it:\n");
  for (const sim::Assumption& one : assumptions) {
    fmt::print(out, "  {:<{}}  {}\n", one.what, width, one.value);
    if (!one.reason.empty()) fmt::print(out, "  {:<{}}    {}\n", "", width, one.reason);
    fmt::print(out, "  {:<{}}    say it: {}\n", "", width, one.change);
  }
  fmt::print(out, "\n");
  std::fflush(out);
}

/// `folder`: where the results lie now; `named`: where they will.
void print_outcome(const sim::Job& job, const sim::Result& result, const std::string& folder,
                   const std::string& named) {
  if (!manner().quiet) {
    fmt::print("\n{}\n", job.scene.title);
    print_table(reports::summary_lines(job, result));
  }
  print_findings(result.findings);
  const bool has_page = fs::exists(fs::path(folder) / "report.html");
  fmt::print("  {}\n  {}: {}\n", sim::verdict_sentence(result.checks), has_page ? "report" : "results",
             has_page ? (fs::path(named) / "report.html").string() : named);
}

/// How to go on after Ctrl-C.
void print_stopped(const RunOptions& options, const sim::Result& result, const std::string& folder) {
  const sim::CutState& state = result.cut.state;
  RunOptions again = options;
  again.from = (std::filesystem::path(folder) / sim::kFinishedStock).string();
  again.output = folder;
  again.record = false;  // a record starts with the program
  const std::string cut =
      result.merged_sweeps == 0
          ? fmt::format("before the cut, {} blocks of an earlier run are cut", state.sweeps)
          : fmt::format("{} of {} blocks are cut", state.sweeps, result.merged_sweeps);
  const std::string start =
      options.ranks != nullptr ? fmt::format("mpirun -n {} ", options.ranks->size()) : "";
  fmt::print(stderr,
             "stopped: {}, up to program line {}, {:.3f} s; what was finished is in {}\n"
             "  go on with: {}{}\n",
             cut, state.place.line, state.place.t_s, folder, start, shell_text(command_words(again)));
}

/// Runs of this folder that were killed leave what they have kept beside it.
void tell_of_killed_runs(const std::string& folder) {
  const fs::path target = fs::absolute(folder).lexically_normal();
  const fs::path home = target.has_filename() ? target : target.parent_path();
  const std::string mark = home.filename().string() + ".part";
  std::error_code problem;
  for (const fs::directory_entry& entry : fs::directory_iterator(home.parent_path(), problem)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(mark)) continue;
    fs::path kept = entry.path() / sim::kFinishedStock;  // written, and not yet where it belongs
    if (!fs::exists(kept)) kept = entry.path() / sim::kKeptStock;
    if (!fs::exists(kept)) continue;
    const int process = std::atoi(name.c_str() + mark.size());
    if (process <= 0 || kill(process, 0) == 0 || errno != ESRCH) continue;
    fmt::print(stderr, "note: a run of this folder was killed; --from {} goes on from what it had cut\n",
               shell_text({kept.string()}));
  }
}

/// The file that marks earlier results: of a run, or of several set-ups.
std::string mark_of(const std::string& folder) {
  return fs::exists(fs::path(folder) / reports::kSetupsMark) ? reports::kSetupsMark : reports::kRunMark;
}

/// Room that the results take at the least, bytes: the stock as a compressed grid.
double least_bytes(const sim::Scene& scene) {
  constexpr double kShareOnDisk = 0.05;  // of the memory of an uncut block; a cut one takes more
  return kShareOnDisk *
         static_cast<double>(stock::Stock::memory_estimate(scene.stock.body_W(), scene.stock.voxel_mm));
}

/// Warnings of the input, then what the run has found. What stands in a scene that was made from flags is
/// said of the program: pipelines look for the file.
reports::FileVerdict verdict_of(const RunOptions& options, const sim::Job& job, const sim::Result& result,
                                const std::vector<Diagnostic>& failures) {
  reports::FileVerdict verdict{options.scene, job.warnings, result.checks};
  const auto add = [&](const std::vector<Diagnostic>& more) {
    verdict.told.insert(verdict.told.end(), more.begin(), more.end());
  };
  add(result.main.warnings);
  for (const sim::Finding& f : result.findings)
    verdict.told.push_back({f.code, f.severity, f.where, f.text, f.fix});
  add(failures);
  for (Diagnostic& told : verdict.told)
    if (!job.scene.text.empty() && told.where.file == job.scene.file) told.where = {options.scene, 0, 0};
  return verdict;
}

/// Before any work. Throws InputError "no-opener" and "no-page".
void require_opener(const RunOptions& options) {
  if (options.no_render && !options.report)
    throw InputError("no-page", {"--open"}, "--no-render makes no page that could be opened", "add --report");
  if (std::system("command -v xdg-open >/dev/null 2>&1") != 0)
    throw InputError("no-opener", {"--open"}, "there is no xdg-open here: nothing knows how to show a page",
                     "install xdg-utils, or leave --open out and open report.html yourself");
}

/// Before any work. Throws InputError "no-page" and "no-chromium".
void require_pdf(const RunOptions& options) {
  if (options.no_render && !options.report)
    throw InputError("no-page", {"--pdf"}, "--no-render makes no page that could be printed", "add --report");
  require_chromium();
}

/// `folder`: of finished results.
void print_page(const RunOptions& options, const fs::path& folder) {
  if (options.pdf && fs::exists(folder / "report.html"))
    write_page_pdf((folder / "report.html").string(), (folder / "report.pdf").string());
}

/// Its own process: what shows the page may go on for hours.
void open_page(const std::string& folder) {
  const std::string page = fs::absolute(fs::path(folder) / "report.html").string();
  if (std::system((shell_text({"xdg-open", page}) + " >/dev/null 2>&1 &").c_str()) != 0)
    fmt::print(stderr, "note: xdg-open could not be started; the page is {}\n", page);
}

/// A scene with [post]: what it says is written first, and is the job from here on.
std::optional<PostedScene> take_post(const RunOptions& options, const std::vector<std::string>& overrides,
                                     const reports::PendingFolder& folder, Progress& progress,
                                     sim::Job& job) {
  if (!wants_post(job)) return {};
  const auto load = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all = overrides;
    all.insert(all.end(), more.begin(), more.end());
    return load_job(options.scene, options.job, all);
  };
  Diagnostics told;
  std::optional<PostedScene> posted =
      post_scene({&job, load}, fs::absolute(folder.file("posted.nc")).string(), progress, told);
  print_diagnostics(told.list());
  if (!posted) return {};
  if (!manner().quiet && !options.json) print_table(reports::avoidance_lines(posted->outcome, job));
  job = load(posted->overrides);
  return posted;
}

reports::OutputOptions output_options(const RunOptions& options, const PostedScene* posted = nullptr) {
  reports::OutputOptions output{!options.no_render, !options.no_render || options.report, options.overrides,
                                shell_text(command_words(options)), posted ? &posted->outcome : nullptr};
  if (posted != nullptr)
    output.overrides.insert(output.overrides.end(), posted->overrides.begin(), posted->overrides.end());
  return output;
}

/// One job from its inputs to its results in the folder. `posted`: what it was written by; or null.
struct JobRun {
  sim::Result result;
  int exit_code = kPass;
};
JobRun run_job(const RunOptions& options, const sim::Job& job, const TimeBudget& budget,
               reports::PendingFolder& pending, const PostedScene* posted,
               std::vector<reports::FileVerdict>& found) {
  reports::OutputOptions output = output_options(options, posted);
  output.budget = budget;
  reports::begin_run(pending, job, output);
  TerminalProgress progress;
  sim::CutOptions cut = cut_options(options, pending.path());
  cut.budget = budget;
  if (job.scene.setup.number > 0) cut.keep_every_s = 0.0;  // there is no going on from it
  JobRun run{sim::simulate(job, cut, progress)};
  print_diagnostics(run.result.main.warnings);
  const std::vector<Diagnostic> failures = reports::write_run(pending, job, run.result, output, progress);
  print_diagnostics(failures);
  found.push_back(verdict_of(options, job, run.result, failures));
  if (run.result.stopped)
    run.exit_code = kStopped;
  else if (!failures.empty())
    run.exit_code = kBadInput;  // not everything that was asked for is there
  else
    run.exit_code = sim::passes(run.result) ? kPass : kFindings;
  return run;
}

int run_scene(const RunOptions& options, std::vector<reports::FileVerdict>& found) {
  const std::vector<std::string> overrides = overrides_of(options);
  sim::Job job = load_job(options.scene, options.job, overrides);
  if (options.tiles) refuse_for_tiles(job);
  if (options.record && !job.scene.text.empty())
    throw InputError("needs-scene", {"--record"}, "a record is replayed from a scene, and there is none",
                     "write one: swarf init " + shell_text({options.scene}) + " .., then run it");
  if (!manner().quiet) print_assumptions(job.scene.assumptions, options.json);
  print_diagnostics(job.warnings);
  const std::string folder = options.output.empty() ? "out/" + job.scene.name : options.output;
  reports::check_output_folder(folder, mark_of(folder), least_bytes(job.scene));
  tell_of_killed_runs(folder);
  reports::PendingFolder pending(folder);
  TerminalProgress progress;
  const std::optional<PostedScene> posted = take_post(options, overrides, pending, progress, job);
  if (wants_post(job)) {
    fmt::print(stderr, "stopped: before a program was found; nothing was written\n");
    return kStopped;
  }
  const JobRun run = run_job(options, job, TimeBudget(job.scene.output.budget_s, options.begun), pending,
                             posted ? &*posted : nullptr, found);
  if (run.result.stopped) {
    print_stopped(options, run.result, folder);
    return run.exit_code;
  }
  print_page(options, folder);
  if (options.json) {
    fmt::print("{}", reports::metrics_json(job, run.result, {}, posted ? &posted->outcome : nullptr));
  } else {
    print_outcome(job, run.result, folder, folder);
  }
  if (options.open) open_page(folder);
  return run.exit_code;
}

/// Places in the program, stocks to go on from and records are of one set-up.
void refuse_for_setups(const RunOptions& options) {
  const auto refuse = [&](bool given, const char* option) {
    if (!given) return;
    throw InputError(
        "several-set-ups", {option}, "this is for a run of one set-up, the scene has several",
        "leave it out; or make the second one a scene of its own whose stock.from_run is the folder "
        "of the first");
  };
  refuse(!options.from.empty(), "--from");
  refuse(!options.save_after.empty(), "--save-stock-after");
  refuse(options.record, "--record");
  refuse(options.open, "--open");
  const std::vector<std::string> flags = given_words(options.job);
  if (!flags.empty())
    load_job(options.scene, options.job, {});  // says that flags and a scene do not go together
}

/// Set-ups that were finished before something went wrong with a later one are not thrown away.
template <typename Run>
void keeping_finished(reports::PendingFolder& pending, const std::vector<reports::SetupOutcome>& done,
                      Run run) {
  try {
    run();
  } catch (const InputError& error) {
    if (done.empty()) throw;
    Diagnostics told = error.diagnostics;
    told.note("results-incomplete", {pending.keep_incomplete()},
              fmt::format("{} finished set-ups are kept here; nothing was replaced", done.size()));
    throw InputError(told);
  }
}

/// How the stock went through them, and what all comes to.
void print_setups(const std::vector<reports::SetupOutcome>& done, size_t count, const std::string& folder) {
  fmt::print("\n");
  for (const reports::SetupOutcome& one : done) fmt::print("  {}\n", reports::setup_line(one));
  const auto passed = static_cast<size_t>(
      std::count_if(done.begin(), done.end(), [](const auto& one) { return one.passes; }));
  const std::string rest =
      done.size() < count ? fmt::format("; {} not run: the whole is not judged", count - done.size()) : "";
  const char* const verdict = passed < done.size() ? "FINDINGS" : done.size() < count ? "NOT JUDGED" : "PASS";
  fmt::print("  {}: {} of {} set-ups pass{}\n  results: {}\n", verdict, passed, count, rest, folder);
}

/// All in order; one that fails its checks does not stop the others: they begin with what it has left.
int run_setups(const RunOptions& options, size_t count, std::vector<reports::FileVerdict>& found) {
  refuse_for_setups(options);
  const auto jobs = load_setups(options.scene, options.setup, overrides_of(options));
  for (const auto& job : jobs)
    if (job->scene.post)
      throw InputError("several-set-ups", {job->scene.file}, "[post] is for a scene of one set-up",
                       "write each program with swarf post, and name it as nc of its set-up");
  const std::string folder = options.output.empty() ? "out/" + jobs.front()->scene.name : options.output;
  double bytes = 0.0;
  for (const auto& job : jobs) bytes += least_bytes(job->scene);
  reports::check_output_folder(folder, mark_of(folder), bytes);
  reports::PendingFolder pending(folder);
  std::vector<reports::SetupOutcome> done;
  int exit_code = kPass;
  for (const auto& job : jobs) {
    if (!manner().quiet) {
      fmt::print(options.json ? stderr : stdout, "{}\n", job->scene.title);
      print_assumptions(job->scene.assumptions, options.json);
    }
    print_diagnostics(job->warnings);
    const std::string place = sim::setup_folder(job->scene);
    JobRun run;
    keeping_finished(pending, done, [&] {
      reports::PendingFolder own(pending.file(place));
      const TimeBudget whole(job->scene.output.budget_s, options.begun);
      run = run_job(options, *job, whole.part_of_rest(jobs.size() - done.size()), own, nullptr, found);
    });
    exit_code = std::max(exit_code, run.exit_code);
    if (run.result.stopped) break;
    print_page(options, pending.file(place));
    done.push_back(reports::setup_outcome(*job, run.result));
    if (!options.json)
      print_outcome(*job, run.result, pending.file(place), (fs::path(folder) / place).string());
  }
  const std::string text =
      reports::setups_json(jobs.front()->scene.name, output_options(options).command, count, done);
  reports::write_text(pending.file(reports::kSetupsMark), text);
  pending.move_into_place();
  if (exit_code == kStopped)
    fmt::print(stderr, "stopped: {} of {} set-ups are finished; what there is is in {}\n", done.size(), count,
               folder);
  if (options.json)
    fmt::print("{}", text);
  else
    print_setups(done, count, folder);
  // Set-ups that did not run leave the whole without a verdict.
  return done.size() < count ? std::max(exit_code, kFindings) : exit_code;
}

int run(const RunOptions& options, std::vector<reports::FileVerdict>& found) {
  if (options.open) require_opener(options);
  if (options.pdf) require_pdf(options);
  if (options.tiles) refuse_for_tiles(options);
  const size_t setups = count_setups(options.scene, overrides_of(options));
  if (setups > 0) return run_setups(options, setups, found);
  if (options.setup > 0) load_setups(options.scene, options.setup, {});  // says that there is no list of them
  return run_scene(options, found);
}

}  // namespace

void add_run(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command =
      app.add_subcommand("run", "Simulate a scene or a program: move, cut, measure, render, report");
  add_run_options(*command, *options);
  command->callback([options, &exit_code] {
    set_thread_count(options->threads);
    const auto whole = [](const RunOptions& given) {
      return with_pipeline_files(given.pipeline, given.scene,
                                 [&](std::vector<reports::FileVerdict>& found) { return run(given, found); });
    };
    exit_code = options->tiles ? run_as_rank(*options, whole) : whole(*options);
  });
}

}  // namespace swarf::cli
