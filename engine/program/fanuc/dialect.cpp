#include "program/fanuc/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "program/fanuc/dialect.h"

namespace swarf::program::nc::fanuc {
namespace {

constexpr const char* kSkipMark = "/ (block delete is off: such blocks are executed)";

}  // namespace

Fanuc::Fanuc(const std::string& path, Control& control)
    : LetterDialect(path, control, kFanucFormula),
      commons_(kLastCommon + 1, 0.0),
      common_set_(kLastCommon + 1, false) {
  Call main;
  main.source = &open(path);
  main.own_locals = true;
  calls_.push_back(std::move(main));
  control_.modal.feed_rule = FeedRule::kAllAxes;
}

void Fanuc::run() {
  std::string_view line;
  while (!ended_) {
    if (!source().next(line)) {
      if (calls_.size() > 1)
        control_.report.fail("unclosed-subprogram", 0, "the subprogram does not end in its file",
                             "end it with M99");
      if (!calls_.back().loops.empty())
        control_.report.fail("unclosed-loop", 0,
                             fmt::format("DO{} has no END{}", calls_.back().loops.back().first,
                                         calls_.back().loops.back().first),
                             "add the END of the loop");
      warn_of_missing_end("M02, M30, M99 or %");
      break;
    }
    at_line(source());
    if (!percent(line, false))
      ended_ = !execute();
    else if (ended_ && calls_.size() > 1)
      control_.report.fail("unclosed-subprogram", 0, "the file ends within a subprogram", "end it with M99");
  }
  if (nurbs_) {
    const Place where = nurbs_->where;
    control_.report.at(where.file, where.line, where.column);
    control_.report.fail("bad-nurbs", 0,
                         "this NURBS does not end: it needs as many knots after the points as its order",
                         "add blocks with K alone");
  }
  block_.clear();
  expect_plane_block();
  nc::finish(control_);
}

/// ":1234" (ISO code) and "<NAME>" at the head of a program.
bool Fanuc::program_head() {
  reader_.skip_space();
  if (reader_.peek() != ':' && reader_.peek() != '<') return false;
  const size_t from = reader_.at();
  const std::string_view line = reader_.line();
  if (line[from] == ':') {
    reader_.skip();
    reader_.value();
  } else {
    const size_t end = line.find('>', from);
    if (end == std::string_view::npos)
      control_.report.fail("unexpected-character", reader_.column_of(from), "this program name does not end",
                           "close it with '>'");
    control_.report.note("program", line.substr(from + 1, end - from - 1));
    reader_.move_to(end + 1);
  }
  std::string_view message;
  skip_comments(kFanucSyntax, reader_, control_, message);
  if (!reader_.done())
    control_.report.fail("unexpected-character", reader_.column(), "words follow the name of the program",
                         "write one block per line");
  return true;
}

/// Says once how numbers without a decimal point are read: parameter 3401 chooses millimetres (calculator
/// type, as here) or increments of the control.
void Fanuc::state_number_rule() {
  for (const char letter : std::string_view("XYZABC")) {
    const double value = block_.has(letter) ? block_.get(letter) : 0.0;
    if (value == 0.0 || value != std::trunc(value) || !without_point(letter)) continue;
    number_rule_stated_ = true;
    control_.report.summary.dialect_reason += fmt::format(
        "; {}{:g} in line {} has no decimal point: such numbers are {} and degrees (calculator "
        "type, parameter 3401)",
        letter, value, source().line_number(), control_.modal.inches() ? "inches" : "millimetres");
    return;
  }
}

/// The letter's number is digits alone.
bool Fanuc::without_point(char letter) const {
  std::string_view text = reader_.line().substr(block_.place(letter) + 1);
  text.remove_prefix(std::min(text.find_first_not_of(" \t+-"), text.size()));
  const size_t end = text.find_first_not_of("0123456789");
  return end != 0 && (end == std::string_view::npos ? !text.empty() : text[end] != '.');
}

bool Fanuc::execute() {
  if (program_head()) return true;
  if (statement()) {
    ++control_.report.summary.blocks;
    return true;
  }
  block_.clear();
  read_words(kFanucSyntax, reader_, control_, block_, 0);
  if (!block_.message.empty()) control_.report.note("MSG", block_.message);
  if (block_.skip_mark) control_.report.without_effect(kSkipMark);
  if (block_.empty()) return true;
  ++control_.report.summary.blocks;
  control_.report.at(source().file(), static_cast<int>(source().line_number()),
                     reader_.column_of(block_.first));
  if (nurbs_ && add_to_nurbs()) return true;
  expect_plane_block();
  if (!number_rule_stated_) state_number_rule();
  check_words();
  moved_ = false;
  apply();
  if (moved_ && calls_.back().modals > 0) {
    call_modal_macro();
    return true;
  }
  return apply_calls();
}

void Fanuc::skip_block_number() {
  reader_.skip_space();
  if (reader_.peek_upper() != 'N') return;
  reader_.skip();
  reader_.skip_space();
  while (reader_.peek() >= '0' && reader_.peek() <= '9') reader_.skip();
  reader_.skip_space();
}

/// A macro statement or an assignment; the reader stands behind it then.
bool Fanuc::statement() {
  const size_t from = reader_.at();
  const bool marked = reader_.peek() == '/';
  if (marked) {
    reader_.skip();
    if (reader_.peek() >= '1' && reader_.peek() <= '9') reader_.skip();
  }
  skip_block_number();
  if (reader_.peek() == '#') {
    assignment();
  } else if (!macro_word()) {
    reader_.move_to(from);
    return false;
  }
  if (marked) control_.report.without_effect(kSkipMark);
  std::string_view message;
  skip_comments(kFanucSyntax, reader_, control_, message);
  if (!reader_.done())
    control_.report.fail("unexpected-character", reader_.column(), "words follow a macro statement",
                         "write one statement per block");
  return true;
}

Evidence evidence(std::string_view head, std::string_view extension) {
  (void)extension;
  Evidence found;
  long number = 0;
  const auto add = [&](int score, std::string_view what) {
    if (found.score == 0) found.reason = fmt::format("{} in line {}", what, number);
    found.score += score;
  };
  while (!head.empty()) {
    ++number;
    const size_t end = std::min(head.find('\n'), head.size());
    std::string line(head.substr(0, end));
    head.remove_prefix(std::min(end + 1, head.size()));
    std::transform(line.begin(), line.end(), line.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    const std::string code = line.substr(0, line.find_first_of("(;"));
    for (const char* word :
         {"G43.4", "G43.5", "G53.1", "G68.2", "G06.2", "G6.2", "G05.1", "G5.1", "G65", "G54.1", "G05 P"}) {
      if (code.find(word) != std::string::npos) add(2, word);
    }
    if (code.find("GOTO") != std::string::npos || code.find("WHILE [") == 0 || code.find("WHILE[") == 0 ||
        code.find("IF[") == 0 || code.find("IF [") == 0)
      add(2, "a macro statement");
    const size_t o = code.find_first_not_of(" \t");
    const bool program_number =
        o != std::string::npos && (code[o] == 'O' || code[o] == ':') && code.size() >= o + 5 &&
        std::all_of(code.begin() + static_cast<long>(o) + 1, code.begin() + static_cast<long>(o) + 5,
                    [](unsigned char c) { return std::isdigit(c) != 0; }) &&
        code.find_first_not_of(" \t\r", o + 5) == std::string::npos;
    if (program_number) add(2, code.substr(o, 5));
  }
  return found;
}

void run(const std::string& path, Control& control) {
  Fanuc(path, control).run();
}

}  // namespace swarf::program::nc::fanuc
