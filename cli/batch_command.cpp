#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <thread>

#include "cli/batch_jobs.h"
#include "cli/child_run.h"
#include "cli/commands.h"
#include "cli/shell_text.h"
#include "cli/terminal.h"
#include "cli/version.h"
#include "reports/batch_output.h"
#include "reports/kept_sources.h"
#include "reports/pending_folder.h"

namespace swarf::cli {
namespace {

namespace fs = std::filesystem;
using reports::BatchRow;
using Clock = std::chrono::steady_clock;

struct BatchOptions {
  std::string file, output, junit;
  std::string only;
  int at_once = 1;
  bool again = false, summary = false, json = false;
};

std::string commit_line() {
  const std::string all = version_text();
  const size_t from = all.find("commit ") + 7;
  return all.substr(from, all.find('\n', from) - from);
}

/// The words of swarf run for a job.
std::vector<std::string> run_words(const BatchOptions& options, const BatchJob& job) {
  std::vector<std::string> words{"-q", "--no-progress", "run", job.file};
  words.insert(words.end(), job.arguments.begin(), job.arguments.end());
  const auto is_threads = [](const std::string& word) { return word.starts_with("--threads"); };
  if (options.at_once > 1 && std::none_of(words.begin(), words.end(), is_threads)) {
    const int cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    words.insert(words.end(), {"--threads", fmt::format("{}", std::max(1, cores / options.at_once))});
  }
  words.insert(words.end(), {"-o", (fs::path(options.output) / job.name).string(), "--junit",
                             reports::batch_file(options.output, job.name, ".junit.xml")});
  return words;
}

/// Threads do not change results.
std::vector<std::string> without_threads(std::vector<std::string> words) {
  const auto at = std::find(words.begin(), words.end(), "--threads");
  if (at != words.end()) words.erase(at, std::min(at + 2, words.end()));
  return words;
}

/// Why a job has to be run; "" when its results are those that it would have again.
std::string why_run(const BatchOptions& options, const BatchRow& now) {
  const std::optional<BatchRow> before = reports::read_batch_record(options.output, now.name);
  if (!before) return "new";
  if (options.again) return "--again";
  if (before->exit_code.value_or(kStopped) > kFindings) return "it did not finish";
  if (before->version != now.version) return "another version of swarf";
  if (without_threads(before->words) != without_threads(now.words)) return "other arguments";
  return reports::changed_source(fs::path(options.output) / now.name);
}

/// The record of a run of today's program and arguments that was refused, failed or was stopped: it is run
/// again when it is this call's to run, and is no job that nobody has run.
std::optional<BatchRow> ended_without_result(const BatchOptions& options, const BatchRow& now) {
  std::optional<BatchRow> before = reports::read_batch_record(options.output, now.name);
  if (!before || before->exit_code.value_or(kPass) <= kFindings || before->version != now.version ||
      without_threads(before->words) != without_threads(now.words))
    return std::nullopt;
  return before;
}

/// A job's number in the file, from 1, or its name.
size_t find_job(const BatchOptions& options, const Batch& batch) {
  std::vector<std::string> names;
  for (size_t i = 0; i < batch.jobs.size(); ++i) {
    names.push_back(batch.jobs[i].name);
    if (options.only == names.back() || options.only == fmt::format("{}", i + 1)) return i;
  }
  const std::string near = nearest_name(options.only, names);
  throw InputError("no-job", {"--only"},
                   fmt::format("{} has no job '{}': {} jobs, numbered from 1", options.file, options.only,
                               batch.jobs.size()),
                   near.empty() ? "name a job or its number" : fmt::format("did you mean '{}'?", near));
}

/// Jobs under way, and what has come of those that have ended.
class Runner {
 public:
  Runner(const BatchOptions& options, std::vector<BatchRow>& rows) : options_(options), rows_(rows) {}

  /// Runs these rows, so many at once, until all have ended or Ctrl-C is pressed; both leave a record of each
  /// that has been started.
  void run(const std::vector<size_t>& which) {
    size_t next = 0;
    while (next < which.size() || !running_.empty()) {
      if (interrupted()) {
        next = which.size();
        for (auto& [child, one] : running_) stop(child, one);
      }
      while (next < which.size() && running_.size() < static_cast<size_t>(options_.at_once))
        start(which[next++]);
      if (!collect()) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }

 private:
  struct Running {
    size_t row = 0;
    Clock::time_point since;
    bool told_to_stop = false;
  };

  void start(size_t row) {
    const BatchRow& job = rows_[row];
    const pid_t child = start_child(job.words, reports::batch_file(options_.output, job.name, ".log"));
    running_[child] = {row, Clock::now()};
  }

  static void stop(pid_t child, Running& one) {
    if (!one.told_to_stop) stop_child(child);
    one.told_to_stop = true;
  }

  /// Whether one has ended.
  bool collect() {
    int status = 0;
    const pid_t child = waitpid(-1, &status, WNOHANG);
    const auto found = running_.find(child);
    if (child <= 0 || found == running_.end()) return false;
    BatchRow& row = rows_[found->second.row];
    row.exit_code = exit_code_of(status);
    row.seconds = std::chrono::duration<double>(Clock::now() - found->second.since).count();
    reports::read_outcome(options_.output, row);
    reports::write_batch_record(options_.output, row);
    running_.erase(found);
    tell(row);
    return true;
  }

  void tell(const BatchRow& row) const {
    if (options_.json || (manner().quiet && row.exit_code == kPass)) return;
    fmt::print("  {:<11} {}  {:.1f} s{}\n", reports::batch_word(row), row.name, row.seconds,
               row.exit_code == kPass ? "" : "\n              " + row.verdict);
    std::fflush(stdout);
  }

  const BatchOptions& options_;
  std::vector<BatchRow>& rows_;
  std::map<pid_t, Running> running_;
};

/// batch.json, batch.html and the JUnit file, each whole.
void write_summary(const BatchOptions& options, const Batch& batch, const std::vector<BatchRow>& rows) {
  const fs::path folder = options.output;
  reports::write_text((folder / "batch.html").string(),
                      reports::batch_page(batch.title, rows, options.output));
  reports::write_text((folder / reports::kBatchMark).string(), reports::batch_json(batch.title, rows));
  if (!options.junit.empty()) reports::write_text(options.junit, reports::batch_junit(rows, options.output));
}

/// The folder, new or of an earlier call; other calls may be working in it.
void prepare_folder(const BatchOptions& options) {
  const fs::path folder = options.output;
  const bool mine = fs::exists(folder / reports::kBatchMark);
  if (!mine) reports::check_output_folder(options.output, reports::kBatchMark);
  fs::create_directories(folder);
  if (!mine) reports::write_text((folder / reports::kBatchMark).string(), reports::batch_json("", {}));
  reports::check_output_file((folder / "batch.html").string());
  reports::check_output_file(options.junit);
}

void print_batch(const BatchOptions& options, const std::vector<BatchRow>& rows) {
  const auto passed =
      std::count_if(rows.begin(), rows.end(), [](const auto& row) { return row.exit_code == kPass; });
  const auto missing =
      std::count_if(rows.begin(), rows.end(), [](const auto& row) { return !row.exit_code; });
  fmt::print("  {}: {} of {} jobs pass{}\n  page: {}\n",
             static_cast<size_t>(passed) == rows.size() ? "PASS" : "NOT ALL PASS", passed, rows.size(),
             missing > 0 ? fmt::format("; {} not run", missing) : "",
             (fs::path(options.output) / "batch.html").string());
  if (missing > 0)
    fmt::print("  go on with: {}\n", shell_text({"swarf", "batch", options.file, "-o", options.output}));
}

/// The rows as they stand: of those that need no run what came of them; `which`: of those that do.
std::vector<BatchRow> plan_rows(const BatchOptions& options, const Batch& batch, std::vector<size_t>& which) {
  std::vector<BatchRow> rows;
  const std::string version = commit_line();
  const size_t only = options.only.empty() ? batch.jobs.size() : find_job(options, batch);
  for (size_t i = 0; i < batch.jobs.size(); ++i) {
    BatchRow row{batch.jobs[i].name, batch.jobs[i].file, run_words(options, batch.jobs[i]), version};
    const std::string why = why_run(options, row);
    const bool wanted = !options.summary && (options.only.empty() || only == i);
    if (why.empty()) {
      row = *reports::read_batch_record(options.output, row.name);
    } else if (wanted) {
      which.push_back(i);
      if (manner().verbose) fmt::print(stderr, "note: {} is run: {}\n", row.name, why);
    } else if (std::optional<BatchRow> ended = ended_without_result(options, row)) {
      row = std::move(*ended);
    } else {
      row.verdict = why == "new" ? "" : "its results are not those of today: " + why;
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

int batch(BatchOptions options) {
  const Batch batch = load_batch(options.file);
  if (options.output.empty()) options.output = "out/" + fs::path(options.file).stem().string();
  if (options.summary && !options.only.empty())
    throw InputError("unused-option", {"--only"}, "--summary runs no job", "leave one of the two out");
  prepare_folder(options);
  std::vector<size_t> which;
  std::vector<BatchRow> rows = plan_rows(options, batch, which);
  if (!manner().quiet && !options.json)
    fmt::print("{}: {} jobs, {} to run\n", batch.title, rows.size(), which.size());
  std::fflush(stdout);
  Runner(options, rows).run(which);
  if (!options.only.empty()) {
    // Other calls write their own records; the table is made by --summary.
    const size_t one = find_job(options, batch);
    return reports::batch_exit_code({rows[one]});
  }
  write_summary(options, batch, rows);
  if (options.json) {
    fmt::print("{}", reports::batch_json(batch.title, rows));
  } else {
    print_batch(options, rows);
  }
  return interrupted() ? kStopped : reports::batch_exit_code(rows);
}

constexpr const char* kBatchFooter = R"(jobs.toml:
  title = "night shift"              # optional
  arguments = ["--no-render"]        # of swarf run, for all jobs
  [[job]]
  file = "op10/scene.toml"           # scene, NC program or CL data, as seen from this file
  [[job]]
  file = "posts/*.nc"                # a job for each
  arguments = ["--tool", "6"]

Results: a folder of swarf run for each job, its log and its record beside it; batch.html, batch.json. A job whose inputs,
arguments and program are those of a finished run is not run again, so that a batch that was stopped goes on when the same
command is given.

A cluster runs each job as a task of an array, then one call makes the table; with Slurm assets/cluster/batch_array.sh
submits both:
  swarf batch jobs.toml -o night --only $SLURM_ARRAY_TASK_ID
  swarf batch jobs.toml -o night --summary --junit night.xml

Exit codes: 0 every job passes; 1 findings; 2 an input is wrong; 3 a run failed; 130 a job was stopped or is not run.)";

}  // namespace

void add_batch(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<BatchOptions>();
  CLI::App* command =
      app.add_subcommand("batch", "Run many jobs, one process each, into one table; go on where it stopped");
  command->add_option("jobs", options->file, "jobs.toml")->required();
  command->add_option("-o,--output", options->output,
                      "folder for the results (default: out/<name of the file>)");
  command->add_option("--at-once", options->at_once, "jobs at the same time; they share the cores")
      ->capture_default_str()
      ->check(CLI::Range(1, 1024));
  command->add_option("--only", options->only, "run this job alone, by name or number from 1; no table")
      ->type_name("JOB");
  command->add_flag("--summary", options->summary, "run nothing: the table of what is there");
  command->add_flag("--again", options->again, "run finished jobs as well");
  command->add_option("--junit", options->junit,
                      "write the checks of all jobs as JUnit XML; a job not run is an error");
  command->add_flag("--json", options->json, "print batch.json instead of the table");
  command->footer(kBatchFooter);
  command->callback([options, &exit_code] { exit_code = batch(*options); });
}

}  // namespace swarf::cli
