// How programs of Siemens 840D are recognised and run.
#include <fmt/format.h>

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
         {"TRAORI", "TRAFOOF", "SUPA", "TRANS", "ATRANS", "ROT", "AROT", "GOTOF", "GOTOB", "DEF", "PROC",
          "MCALL", "CIP", "STOPRE", "ORIWKS", "ORIAXES", "ORIVECT", "FNORM", "COMPCAD"}) {
      if (token.name == word) return true;
    }
  }
  return false;
}

}  // namespace

Evidence evidence(std::string_view head, std::string_view extension) {
  Evidence found;
  if (extension == ".mpf" || extension == ".spf") {
    found = {3, fmt::format("the ending {}", extension)};
  }
  std::vector<Token> tokens;
  const std::string none;
  int number = 0;
  while (!head.empty()) {
    const size_t end = std::min(head.find_first_of("\r\n"), head.size());
    const std::string_view text = head.substr(0, end);
    head.remove_prefix(std::min(head.size(), end + (head.substr(end).starts_with("\r\n") ? 2 : 1)));
    ++number;
    if (text.empty()) continue;
    bool tells = text.starts_with("%_N_");
    if (!tells) {
      try {
        lex({&none, number, text}, tokens);
      } catch (const InputError&) {
        continue;  // another dialect's line, or a faulty one: it says nothing
      }
      tells = telling(tokens);
    }
    if (!tells) continue;
    ++found.score;
    if (found.reason.empty()) found.reason = fmt::format("'{}' in line {}", text.substr(0, 40), number);
  }
  return found;
}

void run(const std::string& path, Control& control) {
  Executor executor(control);
  control.report.enter_file(path);
  Flow flow(executor, control.setup.subprogram_folders);
  run(flow, path);
  if (!flow.counts.ended)
    control.report.warn_once("missing-end", 0,
                             "the program ends with its file, without M30, M17 or RET: it may be cut off",
                             "transfer it again, or write its end");
  nc::finish(control);
  control.report.summary.lines = flow.counts.lines;
  control.report.summary.blocks = flow.counts.blocks;
}

}  // namespace swarf::program::nc::siemens
