// What came of many runs: a record for each, and one table, page and JUnit file of all.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace swarf::reports {

/// One job of a batch that has ended, or that has not been run (`exit_code` empty).
struct BatchRow {
  std::string name, file;
  std::vector<std::string> words;  ///< of swarf run
  std::string version;             ///< commit of the program that ran it
  std::optional<int> exit_code{};
  double seconds = 0.0;         ///< of the clock on the wall
  std::string verdict{};        ///< the run's own sentence, or why there is none
  double machine_time_s = 0.0;  ///< cycle time of the program; 0: not known
  size_t findings = 0;          ///< in findings.json
};

/// Worst first for the exit code of all: internal error, stopped or not run, wrong input, findings, pass.
int batch_exit_code(const std::vector<BatchRow>& rows);

/// "PASS", "FINDINGS", "WRONG INPUT", "STOPPED", "FAILED" or "NOT RUN".
const char* batch_word(const BatchRow& row);

/// The record of a job beside its folder of results; what it says is checked when it is read: none for a file
/// that is not there or is broken.
std::string batch_record_path(const std::string& folder, const std::string& name);
void write_batch_record(const std::string& folder, const BatchRow& row);
std::optional<BatchRow> read_batch_record(const std::string& folder, const std::string& name);

/// Verdict, machine time and findings from the results of a run that has ended; of one that has none the
/// first error in its log.
void read_outcome(const std::string& folder, BatchRow& row);

/// batch.json.
std::string batch_json(const std::string& title, const std::vector<BatchRow>& rows);
/// batch.html: a table with a link to each job's page (or its log), worst first. Opens from disk.
std::string batch_page(const std::string& title, const std::vector<BatchRow>& rows,
                       const std::string& folder);
/// The suites of all jobs; a job without one (not run, killed) is an error in a suite of its own.
std::string batch_junit(const std::vector<BatchRow>& rows, const std::string& folder);

/// The file in the results' folder that says what they are.
inline constexpr const char* kBatchMark = "batch.json";
/// Of one job: "<folder>/<name>.log", ".junit.xml".
std::string batch_file(const std::string& folder, const std::string& name, const char* ending);

}  // namespace swarf::reports
