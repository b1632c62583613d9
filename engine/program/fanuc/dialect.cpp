#include "program/fanuc/steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "program/fanuc/dialect.h"

namespace swarf::program::nc::fanuc {
namespace {

constexpr const char* kSkipMark = "/ (block delete is off: such blocks are executed)";

/// ":1234" (ISO code) and "<NAME>" at the head of a program.
bool program_head(LetterDialect& letters, const LetterSyntax& syntax) {
  letters.reader.skip_space();
  if (letters.reader.peek() != ':' && letters.reader.peek() != '<') return false;
  const size_t from = letters.reader.at();
  const std::string_view line = letters.reader.line();
  if (line[from] == ':') {
    letters.reader.skip();
    letters.reader.value();
  } else {
    const size_t end = line.find('>', from);
    if (end == std::string_view::npos)
      letters.control.report.fail("unexpected-character", letters.reader.column_of(from),
                                  "this program name does not end", "close it with '>'");
    letters.control.report.note("program", line.substr(from + 1, end - from - 1));
    letters.reader.move_to(end + 1);
  }
  std::string_view message;
  skip_comments(syntax, letters.reader, letters.control, message);
  if (!letters.reader.done())
    letters.control.report.fail("unexpected-character", letters.reader.column(),
                                "words follow the name of the program", "write one block per line");
  return true;
}

/// A statement that prints, and moves nothing: it ends with its line.
bool listed_statement(LetterDialect& letters, const Rules& rules) {
  for (const std::string_view word : rules.listed_statements) {
    if (!letters.reader.take(word)) continue;
    letters.control.report.without_effect(word);
    letters.reader.move_to(letters.reader.line().size());
    return true;
  }
  return false;
}

/// A macro statement or an assignment; the reader stands behind it then.
bool statement(Calls& calls, Variables& variables, LetterDialect& letters, const Rules& rules) {
  const size_t from = letters.reader.at();
  const bool marked = letters.reader.peek() == '/';
  if (marked) {
    letters.reader.skip();
    if (letters.reader.peek() >= '1' && letters.reader.peek() <= '9') letters.reader.skip();
  }
  skip_block_number(letters);
  if (letters.reader.peek() == '#') {
    assignment(calls, variables, letters);
  } else if (!macro_word(calls, variables, letters) && !listed_statement(letters, rules)) {
    letters.reader.move_to(from);
    return false;
  }
  if (marked) letters.control.report.without_effect(kSkipMark);
  std::string_view message;
  skip_comments(*rules.syntax, letters.reader, letters.control, message);
  if (!letters.reader.done())
    letters.control.report.fail("unexpected-character", letters.reader.column(),
                                "words follow a macro statement", "write one statement per block");
  return true;
}

/// Says once how numbers without a decimal point are read: the machine's setting chooses millimetres
/// (calculator type, as here) or increments of the control.
void state_number_rule(Calls& calls, Modes& modes, LetterDialect& letters, const Rules& rules) {
  for (const char letter : rules.pointless_letters) {
    const double value = letters.block.has(letter) ? letters.block.get(letter) : 0.0;
    if (value == 0.0 || value != std::trunc(value) || !without_point(letters, letter)) continue;
    modes.number_rule_stated = true;
    const char* unit = letters.control.modal.inches() ? "inches" : "millimetres";
    letters.control.report.summary.dialect_reason +=
        fmt::format("; {}{:g} in line {} has no decimal point: such numbers are {} and degrees ({})", letter,
                    value, source(calls).line_number(), unit, rules.point_rule);
    if (rules.warn_of_pointless)
      letters.control.report.warn_once(
          "number-without-point", letters.column(letter),
          fmt::format("{}{:g} has no decimal point: it is read as {} or degrees ({})", letter, value, unit,
                      rules.point_rule),
          fmt::format("write {}{:g}.", letter, value));
    return;
  }
}

/// O and up to eight digits, alone on its line: the number of a program.
bool is_program_number(std::string_view code) {
  return code.size() >= 2 && code.size() <= 9 && (code[0] == 'O' || code[0] == ':') &&
         code.find_first_not_of("0123456789", 1) == std::string_view::npos;
}

bool is_macro_statement(std::string_view code) {
  const size_t first = code.starts_with('N') ? code.find_first_not_of(" \t0123456789", 1) : 0;
  const std::string_view words = code.substr(std::min(first, code.size()));
  return code.find("GOTO") != std::string_view::npos || words.starts_with("WHILE[") ||
         words.starts_with("WHILE [") || words.starts_with("IF[") || words.starts_with("IF [");
}

bool execute(Fanuc& fanuc) {
  if (program_head(fanuc, *fanuc.rules.syntax)) return true;
  if (statement(fanuc.calls, fanuc.variables, fanuc, fanuc.rules)) {
    ++fanuc.control.report.summary.blocks;
    return true;
  }
  fanuc.block.clear();
  read_words(*fanuc.rules.syntax, fanuc.reader, fanuc.control, fanuc.block, 0);
  if (!fanuc.block.message.empty()) fanuc.control.report.note("MSG", fanuc.block.message);
  if (fanuc.block.skip_mark) fanuc.control.report.without_effect(kSkipMark);
  if (fanuc.block.empty()) return true;
  ++fanuc.control.report.summary.blocks;
  fanuc.control.report.at(source(fanuc.calls).file(), static_cast<int>(source(fanuc.calls).line_number()),
                          fanuc.reader.column_of(fanuc.block.first));
  if (fanuc.nurbs && add_to_nurbs(fanuc.modes, fanuc.nurbs, fanuc)) return true;
  expect_plane_block(fanuc.planes, fanuc);
  if (!fanuc.modes.number_rule_stated) state_number_rule(fanuc.calls, fanuc.modes, fanuc, fanuc.rules);
  check_words(fanuc.modes, fanuc, fanuc.rules);
  fanuc.modes.moved = false;
  apply(fanuc);
  if (fanuc.modes.moved && fanuc.calls.stack.top().modals > 0) {
    call_modal_macro(fanuc);
    return true;
  }
  return apply_calls(fanuc);
}

void run(Fanuc& fanuc) {
  std::string_view line;
  while (!fanuc.ended) {
    if (!source(fanuc.calls).next(line)) {
      if (fanuc.calls.stack.called())
        fanuc.control.report.fail("unclosed-subprogram", 0, "the subprogram does not end in its file",
                                  "end it with M99");
      if (!fanuc.calls.stack.top().loops.empty())
        fanuc.control.report.fail("unclosed-loop", 0,
                                  fmt::format("DO{} has no END{}", fanuc.calls.stack.top().loops.back().first,
                                              fanuc.calls.stack.top().loops.back().first),
                                  "add the END of the loop");
      fanuc.warn_of_missing_end("M02, M30, M99 or %");
      break;
    }
    fanuc.at_line(source(fanuc.calls));
    if (!fanuc.percent(line, false))
      fanuc.ended = !execute(fanuc);
    else if (fanuc.ended && fanuc.calls.stack.called())
      fanuc.control.report.fail("unclosed-subprogram", 0, "the file ends within a subprogram",
                                "end it with M99");
  }
  if (fanuc.nurbs) {
    const Place where = fanuc.nurbs->where;
    fanuc.control.report.at(where.file, where.line, where.column);
    fanuc.control.report.fail("bad-nurbs", 0,
                              "this NURBS does not end: it needs as many knots after the points as its order",
                              "add blocks with K alone");
  }
  fanuc.block.clear();
  expect_plane_block(fanuc.planes, fanuc);
  nc::finish(fanuc.control);
}

}  // namespace

Fanuc::Fanuc(const std::string& file, Control& machine, const Rules& own)
    : LetterDialect(file, machine, *own.formula), rules(own) {
  Call main;
  main.source = &open(file);
  main.own_locals = true;
  calls.stack.enter(std::move(main));
  set_presets(machine.setup.presets, calls, variables);
  control.modal.feed_rule = FeedRule::kAllAxes;
}

/// The letter's number is digits alone.
bool without_point(const LetterDialect& letters, char letter) {
  std::string_view text = letters.reader.line().substr(letters.block.place(letter) + 1);
  text.remove_prefix(std::min(text.find_first_not_of(" \t+-"), text.size()));
  const size_t end = text.find_first_not_of("0123456789");
  return end != 0 && (end == std::string_view::npos ? !text.empty() : text[end] != '.');
}

void skip_block_number(LetterDialect& letters) {
  letters.reader.skip_space();
  if (letters.reader.peek_upper() != 'N') return;
  letters.reader.skip();
  letters.reader.skip_space();
  while (letters.reader.peek() >= '0' && letters.reader.peek() <= '9') letters.reader.skip();
  letters.reader.skip_space();
}

Evidence evidence(const ProgramHead& head) {
  Evidence found;
  for (const HeadLine& line : head.lines) {
    for (const char* word : {"G43.4", "G43.5", "G53.1", "G68.2", "G06.2", "G6.2", "G05.1", "G65", "G54.1"}) {
      if (has_word(line.code, word)) found.add(2, word, line.number);
    }
    if (has_word(line.code, "G5.1") && line.code.find('Q') != std::string::npos)
      found.add(2, "G5.1 Q", line.number);
    if (line.code.find("G05 P") != std::string::npos) found.add(2, "G05 P", line.number);
    if (is_macro_statement(line.code)) found.add(2, "a macro statement", line.number);
    if (is_program_number(line.code)) found.add(2, line.code, line.number);
  }
  return found;
}

Evidence derived_evidence(const ProgramHead& head, std::span<const std::string_view> words,
                          size_t program_digits) {
  Evidence found;
  for (const HeadLine& line : head.lines) {
    for (const std::string_view word : words) {
      if (has_word(line.code, word)) found.add(2, word, line.number);
    }
    if (program_digits > 0 && line.code.size() == program_digits + 1 && line.code[0] == 'O' &&
        is_program_number(line.code))
      found.add(2, line.code, line.number);
  }
  if (found.score > 0) found.score += evidence(head).score;
  return found;
}

void run_as(const Rules& rules, const std::string& path, Control& control) {
  Fanuc fanuc(path, control, rules);
  run(fanuc);
}

void run(const std::string& path, Control& control) {
  run_as(kFanucRules, path, control);
}

}  // namespace swarf::program::nc::fanuc
