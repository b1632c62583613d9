// run_nc: which dialect, then its reader on a control.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <string_view>
#include <vector>

#include "program/control/control.h"
#include "program/dialects.h"
#include "program/letters/line_source.h"
#include "program/nc_program.h"

namespace swarf::program {
namespace {

/// The first lines, checked as every reader checks them: what is no text shows no dialect either.
ProgramHead head_of(const std::string& path) {
  constexpr size_t kHead = size_t{1} << 18;
  ProgramHead head;
  head.extension = std::filesystem::path(path).extension().string();
  std::transform(head.extension.begin(), head.extension.end(), head.extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  nc::LineSource source(path);
  size_t bytes = 0;
  for (std::string_view line; bytes < kHead && source.next(line); bytes += line.size() + 1) head.add(line);
  return head;
}

/// A dialect that the program may be in.
struct Candidate {
  const DialectRow* row;
  Evidence evidence;  ///< score 0: nothing speaks for it
};

/// Those with evidence, the strongest first; then the common core of ISO words, as LinuxCNC has it, and
/// Fanuc.
std::vector<Candidate> candidates_of(const std::string& path) {
  const ProgramHead head = head_of(path);
  std::vector<Candidate> list;
  for (const DialectRow& row : dialects()) {
    Evidence evidence = row.evidence(head);
    if (evidence.score > 0) list.push_back({&row, std::move(evidence)});
  }
  std::stable_sort(list.begin(), list.end(), [](const Candidate& a, const Candidate& b) {
    return a.evidence.score > b.evidence.score;
  });
  for (const Dialect common : {Dialect::kLinuxCnc, Dialect::kFanuc}) {
    const DialectRow* row = &dialect_row(common);
    const bool listed =
        std::any_of(list.begin(), list.end(), [&](const Candidate& c) { return c.row == row; });
    if (!listed) list.push_back({row, {}});
  }
  return list;
}

/// Counts the first moves of a trial and keeps none.
class TrialSink final : public NcSink {
 public:
  bool move(const NcMove& /*move*/) override { return ++moves_ < kTrialMoves; }

 private:
  static constexpr int kTrialMoves = 500;
  int moves_ = 0;
};

/// Faults that say: this text is written in other words. Others (travel, tools, unsupported words) would be
/// faults of the program in its own dialect too.
bool is_of_wording(const std::string& code) {
  return code == "unknown-word" || code == "unexpected-character" || code == "bad-number" ||
         code == "unclosed-comment" || code == "unknown-o-word" || code == "bad-block" ||
         code == "unclosed-string" || code == "missing-begin" || code == "no-motion-mode";
}

/// The fault of wording that stops the program within its first moves; nothing when it goes on.
std::optional<Diagnostic> fault_of_wording(const std::string& path, const DialectRow& row,
                                           const ControlSetup& setup) {
  TrialSink sink;
  Diagnostics told;
  NcSummary summary;
  try {
    nc::Control control(setup, sink, told, summary);
    row.run(path, control);
  } catch (const InputError& error) {
    const auto& list = error.diagnostics.list();
    const auto wording =
        std::find_if(list.begin(), list.end(), [](const Diagnostic& one) { return is_of_wording(one.code); });
    if (wording != list.end()) return *wording;
  } catch (const nc::ProgramStopped&) {
    return std::nullopt;
  }
  return std::nullopt;
}

std::string why(const Candidate& candidate) {
  return candidate.evidence.score > 0 ? "recognised by " + candidate.evidence.reason
                                      : "assumed, nothing in the text names a control";
}

std::string fix_of_dialect() {
  return "where that is wrong name it: --dialect, in a scene `dialect`; there are " + dialect_list(", ");
}

/// The dialect with the strongest evidence in which the first lines can be read; what is a guess is said.
const DialectRow* recognised(const std::string& path, const ControlSetup& setup, Diagnostics& diagnostics,
                             NcSummary& summary) {
  const std::vector<Candidate> candidates = candidates_of(path);
  const Candidate& best = candidates.front();
  const std::optional<Diagnostic> fault = fault_of_wording(path, *best.row, setup);
  summary.dialect_reason = why(best);
  if (fault) {
    const auto other = std::find_if(candidates.begin() + 1, candidates.end(), [&](const Candidate& c) {
      return !fault_of_wording(path, *c.row, setup);
    });
    if (other == candidates.end()) return best.row;
    summary.dialect_reason = fmt::format("{}; as {} ({}) line {} cannot be read", why(*other), best.row->name,
                                         why(best), fault->where.line);
    diagnostics.warning("dialect-changed", fault->where,
                        fmt::format("as {} ({}) this line cannot be read: {}; the program is read as {}",
                                    best.row->name, why(best), fault->text, other->row->name),
                        fix_of_dialect());
    return other->row;
  }
  const Candidate& rival = candidates[1];
  if (best.evidence.score == 0) {
    diagnostics.note("dialect-assumed", {path, 0, 0},
                     fmt::format("nothing in the text names a control: it is read as the common core of ISO "
                                 "words ({}); --dialect, in a scene `dialect`, names another",
                                 best.row->name));
  } else if (rival.evidence.score == best.evidence.score) {
    diagnostics.warning(
        "dialect-assumed", {path, 0, 0},
        fmt::format("this program could be {} ({}) or {} ({}): it is read as {}", best.row->name,
                    best.evidence.reason, rival.row->name, rival.evidence.reason, best.row->name),
        fix_of_dialect());
  }
  return best.row;
}

/// Stops a program at its first feed move.
class FirstFeedSink final : public NcSink {
 public:
  bool move(const NcMove& move) override { return move.rapid; }
};

/// What a program has done before it cuts, having begun with an empty spindle.
struct BeforeFirstCut {
  bool no_tool = false;   ///< it cuts, or asks for the tool's size, before it puts any tool in the spindle
  bool selected = false;  ///< T named one
};

BeforeFirstCut before_first_cut(const std::string& path, const DialectRow& row, ControlSetup setup) {
  setup.start_tool = -1;
  FirstFeedSink sink;
  Diagnostics told;
  NcSummary summary;
  nc::Control control(setup, sink, told, summary);
  bool asks = false;
  try {
    row.run(path, control);
  } catch (const InputError& error) {
    const auto& list = error.diagnostics.list();
    asks = std::any_of(list.begin(), list.end(), [](const Diagnostic& one) {
      return one.code == "compensation-no-tool" || one.code == "missing-word";
    });
  } catch (const nc::ProgramStopped&) {
    asks = true;
  }
  const bool empty = control.tools.active < 0 && control.tools.active_number == 0;
  return {asks && empty, control.tools.selected >= 0};
}

/// Whether the first lines call tools by T and none of them has M6.
bool calls_by_t_alone(const std::string& path) {
  constexpr long kLines = 10'000;
  nc::LineSource source(path);
  bool by_t = false;
  for (std::string_view line; source.line_number() < kLines && source.next(line);) {
    line = line.substr(0, line.find(';'));
    for (size_t at = 0; at + 1 < line.size(); ++at) {
      const bool starts = at == 0 || std::isalnum(static_cast<unsigned char>(line[at - 1])) == 0;
      const int letter = starts ? std::toupper(static_cast<unsigned char>(line[at])) : 0;
      by_t = by_t || (letter == 'T' && (line[at + 1] == '=' || std::isdigit(line[at + 1]) != 0));
      const std::string_view rest = line.substr(at + 1);
      const size_t zeros = std::min(rest.find_first_not_of('0'), rest.size());
      const std::string_view number = rest.substr(zeros, 2);
      if (letter == 'M' && number.starts_with('6') &&
          (number.size() == 1 || std::isdigit(static_cast<unsigned char>(number[1])) == 0))
        return false;
    }
  }
  return by_t;
}

const char* why_in_spindle(const ControlSetup& setup) {
  return setup.start_tool_if_needed ? "the only tool there is; the program cuts before it calls one"
                                    : "given as start_tool";
}

/// The setup with what is in the spindle before the first block: what the scene says; its only tool where the
/// program cuts without calling any; on an 840D without M6 what T calls. Guesses are warnings.
ControlSetup with_start_tool(const std::string& path, const DialectRow& row, ControlSetup setup,
                             Diagnostics& diagnostics, NcSummary& summary) {
  const bool by_t = !setup.tools.empty() && !setup.t_changes_tool && row.dialect == Dialect::kSiemens &&
                    (setup.start_tool < 0 || setup.start_tool_if_needed) && calls_by_t_alone(path);
  if (setup.start_tool_if_needed || by_t) {
    const BeforeFirstCut before = before_first_cut(path, row, setup);
    if (!before.no_tool) setup.start_tool = -1;
    if (before.no_tool && before.selected && by_t) {
      setup.start_tool = -1;
      setup.t_changes_tool = true;
      diagnostics.warning(
          "t-changes-tool", {path, 0, 0},
          "the program calls tools by T and cuts without M6: T is taken to change the tool at "
          "once, as machines without a magazine have it (MD22550 = 0)",
          "say it: t_changes_tool = true in [setup] of the scene, swarf check --t-changes-tool");
    }
  }
  if (setup.start_tool < 0) return setup;
  const NcTool& tool = setup.tools[static_cast<size_t>(setup.start_tool)];
  summary.start_tool = fmt::format("{} is in the spindle from the start ({})",
                                   tool.number > 0     ? fmt::format("T{}", tool.number)
                                   : tool.name.empty() ? std::string("the tool")
                                                       : fmt::format("\"{}\"", tool.name),
                                   why_in_spindle(setup));
  if (setup.start_tool_if_needed)
    diagnostics.warning(
        "start-tool-assumed", {path, 0, 0}, summary.start_tool,
        "call it in the program (T and M6), or say it: start_tool in [setup] of the scene, swarf "
        "check --start-tool");
  return setup;
}

void run(const std::string& path, std::optional<Dialect> dialect, const ControlSetup& setup, NcSink& sink,
         Diagnostics& diagnostics, NcSummary& summary) {
  summary.dialect_reason = "the scene says so";
  const DialectRow& row = dialect ? dialect_row(*dialect) : *recognised(path, setup, diagnostics, summary);
  summary.dialect = row.dialect;
  const ControlSetup with_tool = with_start_tool(path, row, setup, diagnostics, summary);
  nc::Control control(with_tool, sink, diagnostics, summary);
  try {
    row.run(path, control);
  } catch (const InputError& error) {
    diagnostics.append(error.diagnostics);
    if (!dialect)
      diagnostics.note("dialect-taken", {path, 0, 0},
                       fmt::format("read as {} ({}); --dialect, in a scene `dialect`, names another: {}",
                                   row.name, summary.dialect_reason, dialect_list(", ")));
  }
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
