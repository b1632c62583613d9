// Custom macro B: IF, WHILE, GOTO.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "program/fanuc/steps.h"

namespace swarf::program::nc::fanuc {
namespace {

double condition(LetterDialect& letters) {
  letters.reader.skip_space();
  return letters.reader.bracketed();
}

long label_value(LetterDialect& letters) {
  const size_t place = letters.reader.at();
  const double label = letters.reader.value();
  if (std::isnan(label))
    letters.control.report.fail("undefined-parameter", letters.reader.column_of(place),
                                "GOTO goes to a vacant variable", "assign it before it is read");
  return std::lround(std::clamp(label, -1e9, 1e9));
}

int loop_number(LetterDialect& letters) {
  const size_t place = letters.reader.at();
  const double number = letters.reader.value();
  if (number != 1.0 && number != 2.0 && number != 3.0)
    letters.control.report.fail("out-of-range", letters.reader.column_of(place),
                                fmt::format("loops have the numbers 1 to 3, not {:g}", number),
                                "write DO1 to DO3");
  return static_cast<int>(number);
}

/// "END1", with a block number before it or not.
bool ends_loop(LetterDialect& letters, std::string_view line, int loop) {
  letters.reader.begin(line);
  skip_block_number(letters);
  if (!letters.reader.take("END")) return false;
  letters.reader.skip_space();
  return letters.reader.value() == loop;
}

void skip_to_end(Calls& calls, LetterDialect& letters, int loop) {
  const Place from = letters.control.report.place;
  std::string_view line;
  while (source(calls).next(line)) {
    ++letters.control.report.summary.lines;
    letters.control.report.at(source(calls).file(), static_cast<int>(source(calls).line_number()), 1);
    if (ends_loop(letters, line, loop)) return;
  }
  letters.control.report.at(from.file, from.line, from.column);
  letters.control.report.fail("unclosed-loop", 0, fmt::format("DO{} has no END{}", loop, loop),
                              "add the END of the loop");
}

/// Loops that a jump to the line behind `target` leaves: those that begin behind it or end before it.
void leave_loops(Calls& calls, LetterDialect& letters, const LineSource::Mark& target) {
  auto& loops = calls.stack.top().loops;
  std::erase_if(loops, [&](const auto& loop) {
    if (target.line <= loop.second.line) return true;
    source(calls).seek(loop.second);
    std::string_view line;
    while (source(calls).mark().line < target.line && source(calls).next(line)) {
      if (ends_loop(letters, line, loop.first)) return true;
    }
    return false;
  });
}

bool labelled(std::string_view line, long label) {
  size_t at = line.find_first_not_of(" \t");
  if (at == std::string_view::npos || (line[at] != 'N' && line[at] != 'n')) return false;
  double number = 0.0;
  at = line.find_first_not_of(" \t", at + 1);
  if (at == std::string_view::npos) return false;
  const size_t length = read_number(line.substr(at), number);
  return length > 0 && length != std::string_view::npos && number == static_cast<double>(label);
}

}  // namespace

bool macro_word(Calls& calls, Variables& variables, LetterDialect& letters) {
  const size_t place = letters.reader.at();
  auto& loops = calls.stack.top().loops;
  if (letters.reader.take("GOTO")) {
    go_to(calls, letters, label_value(letters), letters.reader.column_of(place));
    return true;
  }
  if (letters.reader.take("IF")) {
    const bool holds = condition(letters) != 0.0;
    letters.reader.skip_space();
    if (letters.reader.take("GOTO")) {
      const long label = label_value(letters);
      if (holds) go_to(calls, letters, label, letters.reader.column_of(place));
    } else if (letters.reader.take("THEN")) {
      letters.reader.skip_space();
      if (letters.reader.peek() != '#')
        letters.control.report.fail("bad-statement", letters.reader.column(), "THEN wants an assignment",
                                    "write IF [#1 GT 2] THEN #3=4");
      if (holds)
        assignment(calls, variables, letters);
      else
        letters.reader.move_to(letters.reader.line().size());
    } else {
      letters.control.report.fail("bad-statement", letters.reader.column(),
                                  "GOTO or THEN is missing after the condition",
                                  "write IF [#1 GT 2] GOTO 10");
    }
    return true;
  }
  const bool is_while = letters.reader.take("WHILE");
  if (is_while || letters.reader.take("DO")) {
    bool holds = true;
    if (is_while) {
      holds = condition(letters) != 0.0;
      letters.reader.skip_space();
      if (!letters.reader.take("DO"))
        letters.control.report.fail("bad-statement", letters.reader.column(),
                                    "DO is missing after the condition", "write WHILE [#1 GT 2] DO1");
    }
    const int number = loop_number(letters);
    std::erase_if(loops, [&](const auto& one) { return one.first == number; });
    if (holds)
      loops.emplace_back(number, source(calls).line_mark());
    else
      skip_to_end(calls, letters, number);
    if (!holds) letters.reader.move_to(letters.reader.line().size());
    return true;
  }
  if (!letters.reader.take("END")) return false;
  const int number = loop_number(letters);
  if (loops.empty() || loops.back().first != number)
    letters.control.report.fail("bad-statement", letters.reader.column_of(place),
                                fmt::format("END{} ends no loop that is open here", number),
                                "close the innermost DO first");
  nc::jump(letters.control);
  source(calls).seek(loops.back().second);
  letters.reader.begin({});
  return true;
}

std::optional<LineSource::Mark> find_label(LineSource& in, const LineSource::Mark& from, long label) {
  const LineSource::Mark back = in.mark();
  in.seek(from);
  std::optional<LineSource::Mark> found;
  std::string_view line;
  while (!found && in.next(line)) {
    if (labelled(line, label)) found = in.line_mark();
  }
  in.seek(back);
  return found;
}

void go_to(Calls& calls, LetterDialect& letters, long label, int column) {
  nc::jump(letters.control);
  const LineSource::Mark here = source(calls).mark();
  LineSource::Mark begin = calls.stack.called() ? calls.stack.top().top : LineSource::Mark{};
  std::string_view line;
  for (const bool ahead : {true, false}) {
    if (!ahead) source(calls).seek(begin);
    while (source(calls).next(line)) {
      if (!ahead && source(calls).line_number() > here.line) break;
      if (!labelled(line, label)) continue;
      const LineSource::Mark target = source(calls).line_mark();
      leave_loops(calls, letters, target);
      source(calls).seek(target);
      letters.reader.begin({});
      return;
    }
  }
  letters.control.report.fail("unknown-label", column,
                              fmt::format("GOTO {}: there is no block N{}", label, label),
                              "add the block number");
}

}  // namespace swarf::program::nc::fanuc
