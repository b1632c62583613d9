// run_nc: which dialect, then its reader on a control.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <string_view>

#include "program/control/control.h"
#include "program/dialects.h"
#include "program/letters/line_source.h"
#include "program/nc_program.h"

namespace swarf::program {
namespace {

/// The first lines, checked as every reader checks them: what is no text shows no dialect either.
std::string head_of(const std::string& path) {
  constexpr size_t kHead = size_t{1} << 18;
  nc::LineSource source(path);
  std::string head;
  for (std::string_view line; head.size() < kHead && source.next(line);) head.append(line) += '\n';
  return head;
}

std::string fix_of_dialect() {
  return "name it: " + dialect_list(", ");
}

/// The reader whose evidence is the strongest; a tie is ambiguous.
const DialectRow* recognised(const std::string& path, NcSummary& summary) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const std::string head = head_of(path);
  const DialectRow* best = nullptr;
  Evidence strongest;
  const DialectRow* rival = nullptr;
  for (const DialectRow& row : dialects()) {
    Evidence evidence = row.evidence(head, extension);
    if (evidence.score <= 0) continue;
    if (best != nullptr && evidence.score == strongest.score) rival = &row;
    if (best != nullptr && evidence.score <= strongest.score) continue;
    best = &row;
    rival = nullptr;
    strongest = std::move(evidence);
  }
  if (best == nullptr) {
    throw InputError("unknown-dialect", {path, 0, 0},
                     "nothing in this program shows in which dialect it is written", fix_of_dialect());
  }
  if (rival != nullptr) {
    throw InputError("unknown-dialect", {path, 0, 0},
                     fmt::format("this program could be {} or {}", best->name, rival->name),
                     fix_of_dialect());
  }
  summary.dialect_reason = "recognised by " + strongest.reason;
  return best;
}

void run(const std::string& path, std::optional<Dialect> dialect, const ControlSetup& setup, NcSink& sink,
         Diagnostics& diagnostics, NcSummary& summary) {
  summary.dialect_reason = "the scene says so";
  const DialectRow& row = dialect ? dialect_row(*dialect) : *recognised(path, summary);
  summary.dialect = row.dialect;
  nc::Control control(setup, sink, diagnostics, summary);
  row.run(path, control);
}

}  // namespace

std::string builder_word(const std::string& written) {
  std::string word;
  for (const char c : written) {
    if (c == ' ' && (word.empty() || word.back() == ' ')) continue;
    word += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  const auto number_after = [&](std::string_view head) -> std::string {
    int number = 0;
    const char* end = word.data() + word.size();
    const auto [last, problem] = std::from_chars(word.data() + head.size(), end, number);
    const bool whole = problem == std::errc() && last == end && number >= 0 && number < 10000;
    return whole ? fmt::format("{}{}", head, number) : "";
  };
  constexpr std::string_view kCycle = "CYCL DEF ";
  if (word.starts_with(kCycle)) return number_after(kCycle);
  if (word.size() > 1 && word[0] == 'M' && std::isdigit(static_cast<unsigned char>(word[1])) != 0)
    return number_after("M");
  const auto of_names = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
  const bool name = word.size() > 1 && std::isdigit(static_cast<unsigned char>(word[0])) == 0 &&
                    std::all_of(word.begin(), word.end(), of_names);
  return name ? word : "";
}

const char* kinematics_name(Kinematics kinematics) {
  return kinematics == Kinematics::kTcp ? "tcp" : "identity";
}

NcSummary run_nc(const std::string& path, std::optional<Dialect> dialect, const ControlSetup& setup,
                 NcSink& sink, Diagnostics& diagnostics) {
  NcSummary summary;
  try {
    run(path, dialect, setup, sink, diagnostics, summary);
  } catch (const InputError& error) {
    diagnostics.append(error.diagnostics);
  } catch (const nc::ProgramStopped&) {
    diagnostics.note("stopped", {path}, "the program was stopped before its end");
  }
  return summary;
}

}  // namespace swarf::program
