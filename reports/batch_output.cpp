#include "reports/batch_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "reports/pending_folder.h"
#include "reports/pipeline_output.h"

namespace swarf::reports {
namespace {

namespace fs = std::filesystem;
using Record = nlohmann::ordered_json;

constexpr int kPass = 0, kFindings = 1, kBadInput = 2, kStopped = 130;
constexpr FileFault kRecordUnreadable{"file-unreadable", "this cannot be read"};

/// Worst first.
int rank(const BatchRow& row) {
  if (!row.exit_code || *row.exit_code == kStopped) return 1;
  switch (*row.exit_code) {
    case kPass:
      return 4;
    case kFindings:
      return 3;
    case kBadInput:
      return 2;
    default:
      return 0;
  }
}

std::optional<Record> parsed(const std::string& path) {
  if (!fs::is_regular_file(path)) return {};
  Record record = Record::parse(read_all(path, kRecordUnreadable), nullptr, false);
  if (record.is_discarded()) return {};
  return record;
}

/// The first line of the log that says what was wrong, else its last one.
std::string error_in(const std::string& log) {
  std::ifstream file(log);
  std::string line, last;
  while (std::getline(file, line)) {
    if (line.find("error: ") != line.npos) return line;
    if (!line.empty()) last = line;
  }
  return last;
}

Record record_of(const BatchRow& row) {
  Record record{{"name", row.name},       {"file", row.file},     {"words", row.words},
                {"commit", row.version},  {"exit_code", nullptr}, {"outcome", batch_word(row)},
                {"verdict", row.verdict}, {"findings", nullptr},  {"machine_time_s", nullptr},
                {"seconds", nullptr}};
  if (!row.exit_code) return record;
  record["exit_code"] = *row.exit_code;
  record["seconds"] = row.seconds;
  if (*row.exit_code > kFindings) return record;
  record["findings"] = row.findings;
  if (row.machine_time_s > 0.0) record["machine_time_s"] = row.machine_time_s;
  return record;
}

std::string text(const Record& record) {
  return record.dump(2, ' ', false, Record::error_handler_t::replace) + "\n";
}

/// What stands between the first suite and the end of a JUnit file; "" when it holds none.
std::string suites_in(const std::string& path) {
  if (!fs::is_regular_file(path)) return "";
  const std::string all = read_all(path, kRecordUnreadable);
  const size_t from = all.find("  <testsuite "), to = all.rfind("</testsuites>");
  return from == all.npos || to == all.npos || to < from ? "" : all.substr(from, to - from);
}

}  // namespace

int batch_exit_code(const std::vector<BatchRow>& rows) {
  int worst = 4;
  for (const BatchRow& row : rows) worst = std::min(worst, rank(row));
  constexpr int kCodes[] = {3, kStopped, kBadInput, kFindings, kPass};
  return kCodes[worst];
}

const char* batch_word(const BatchRow& row) {
  if (!row.exit_code) return "NOT RUN";
  constexpr const char* kWords[] = {"FAILED", "STOPPED", "WRONG INPUT", "FINDINGS", "PASS"};
  return kWords[rank(row)];
}

std::string batch_file(const std::string& folder, const std::string& name, const char* ending) {
  return (fs::path(folder) / (name + ending)).string();
}

std::string batch_record_path(const std::string& folder, const std::string& name) {
  return batch_file(folder, name, ".job.json");
}

void write_batch_record(const std::string& folder, const BatchRow& row) {
  write_text(batch_record_path(folder, row.name), text(record_of(row)));
}

std::optional<BatchRow> read_batch_record(const std::string& folder, const std::string& name) {
  const std::optional<Record> record = parsed(batch_record_path(folder, name));
  if (!record) return {};
  try {
    BatchRow row{.name = name,
                 .file = record->at("file"),
                 .words = record->at("words"),
                 .version = record->at("commit"),
                 .exit_code = record->at("exit_code").get<int>(),
                 .seconds = record->at("seconds"),
                 .verdict = record->at("verdict")};
    if (!record->at("findings").is_null()) row.findings = record->at("findings");
    if (!record->at("machine_time_s").is_null()) row.machine_time_s = record->at("machine_time_s");
    return row;
  } catch (const Record::exception&) {
    return {};
  }
}

void read_outcome(const std::string& folder, BatchRow& row) {
  const fs::path results = fs::path(folder) / row.name;
  if (row.exit_code.value_or(kStopped) > kFindings) {
    row.verdict = error_in(batch_file(folder, row.name, ".log"));
    return;
  }
  if (const auto metrics = parsed((results / "metrics.json").string())) {
    row.verdict = metrics->value("verdict_text", "");
    if (metrics->contains("motion")) row.machine_time_s = metrics->at("motion").value("time_s", 0.0);
  } else if (const auto setups = parsed((results / "setups.json").string())) {
    for (const Record& one : setups->value("setups", Record::array())) {
      row.verdict += (row.verdict.empty() ? "" : "; ") + one.value("verdict", "");
      row.machine_time_s += one.value("time_s", 0.0);
    }
  }
  if (const auto findings = parsed((results / "findings.json").string())) row.findings = findings->size();
}

std::string batch_json(const std::string& title, const std::vector<BatchRow>& rows) {
  Record jobs = Record::array();
  for (const BatchRow& row : rows) jobs.push_back(record_of(row));
  return text({{"schema", 1}, {"title", title}, {"exit_code", batch_exit_code(rows)}, {"jobs", jobs}});
}

std::string batch_junit(const std::vector<BatchRow>& rows, const std::string& folder) {
  std::string all = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"swarf\">\n";
  for (const BatchRow& row : rows) {
    const std::string suites =
        row.exit_code ? suites_in(batch_file(folder, row.name, ".junit.xml")) : std::string();
    if (!suites.empty()) {
      all += suites;
      continue;
    }
    all += fmt::format(
        "  <testsuite name=\"{0}\" tests=\"1\" failures=\"0\" errors=\"1\" skipped=\"0\">\n"
        "    <testcase classname=\"{0}\" name=\"run\"><error message=\"{1}\"/></testcase>\n  </testsuite>\n",
        xml_text(row.file), row.exit_code ? "the run has left no verdict" : "not run");
  }
  return all + "</testsuites>\n";
}

}  // namespace swarf::reports
