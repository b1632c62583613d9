// How programs of Siemens 840D are recognised and run.
#include <fmt/format.h>

#include <algorithm>

#include "program/control/presets.h"
#include "program/siemens/dialect.h"
#include "program/siemens/steps.h"

namespace swarf::program::nc::siemens {
namespace {

/// Whether a line has a word that only this control has.
bool telling(const std::vector<Token>& tokens) {
  for (size_t n = 0; n < tokens.size(); ++n) {
    const Token& token = tokens[n];
    if (token.kind == TokenKind::kString) return true;
    if (token.kind != TokenKind::kName || token.name.size() < 2) continue;
    const bool call = n + 1 < tokens.size() && tokens[n + 1].symbol("(");
    const bool value = n + 1 < tokens.size() && tokens[n + 1].symbol("=");
    if (token.name.starts_with("CYCLE") && call) return true;
    if (value && (token.name[0] == 'R' || token.name == "CR" || token.name == "TURN" || token.name == "A3"))
      return true;
    for (const char* word :
         {"TRAORI",  "TRAFOOF", "SUPA",   "TRANS",  "ATRANS", "ROT",      "AROT",   "GOTOF",   "GOTOB",
          "DEF",     "PROC",    "MCALL",  "CIP",    "STOPRE", "ORIWKS",   "ORIMKS", "ORIAXES", "ORIVECT",
          "FNORM",   "COMPCAD", "COMPON", "COMPOF", "BRISK",  "SOFT",     "FFWON",  "FFWOF",   "FGROUP",
          "EXTCALL", "EXTERN",  "CFTCP",  "CUT2D",  "CUT2DF", "WORKPIECE"}) {
      if (token.name == word) return true;
    }
  }
  return false;
}

/// R parameters, and variables that stand in the machine's data (GUD).
void set_presets(const Presets& presets, const BlockTarget& target, Variables& variables) {
  for (const auto& [name, preset] : presets) {
    const std::optional<long> number = preset_number(name, "R");
    const bool is_name = name.size() > 1 && !is_digit(name[0]) && !is_digit(name[1]) &&
                         std::all_of(name.begin(), name.end(), in_name);
    if (number && *number < kParametersMax)
      variables.set_parameter(static_cast<double>(*number), Value::real(preset.value), {}, 0);
    else if (is_name && !target.knows(name))
      variables.set_global(name, preset.value);
    else
      refuse_preset(name, preset, "programs read R0 to R999 and global variables (GUD) of type REAL: R1 = 2");
  }
}

}  // namespace

Evidence evidence(const ProgramHead& head) {
  Evidence found;
  if (head.extension == ".mpf" || head.extension == ".spf")
    found = {3, fmt::format("the ending {}", head.extension)};
  std::vector<Token> tokens;
  const std::string none;
  for (const HeadLine& line : head.lines) {
    // What a transfer writes over a file names the control, though it is a comment.
    bool tells = line.text.starts_with("%_N_") || line.text.starts_with(";$PATH=/_N_");
    if (!tells && !line.code.empty()) {
      try {
        lex({&none, static_cast<int>(line.number), line.code}, tokens);
      } catch (const InputError&) {
        continue;  // another dialect's line, or a faulty one: it says nothing
      }
      tells = telling(tokens);
    }
    if (tells) found.add(1, fmt::format("'{}'", line.text.substr(0, 40)), line.number);
  }
  return found;
}

void run(const std::string& path, Control& control) {
  Executor executor(control);
  control.report.enter_file(path);
  Flow flow(executor, control.setup.subprogram_folders);
  set_presets(control.setup.presets, executor, flow.variables);
  run(flow, path);
  refuse_open_line(executor);
  if (!flow.counts.ended)
    control.report.warn_once("missing-end", 0,
                             "the program ends with its file, without M30, M17 or RET: it may be cut off",
                             "transfer it again, or write its end");
  nc::finish(control);
  control.report.summary.lines = flow.counts.lines;
  control.report.summary.blocks = flow.counts.blocks;
}

}  // namespace swarf::program::nc::siemens
