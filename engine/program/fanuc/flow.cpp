// Custom macro B: IF, WHILE, GOTO.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "program/fanuc/reader.h"

namespace swarf::program::nc::fanuc {
double Fanuc::condition() {
  reader_.skip_space();
  return reader_.bracketed();
}

long Fanuc::label_value() {
  const size_t place = reader_.at();
  const double label = reader_.value();
  if (std::isnan(label))
    control_.report.fail("undefined-parameter", reader_.column_of(place), "GOTO goes to a vacant variable",
                         "assign it before it is read");
  return std::lround(std::clamp(label, -1e9, 1e9));
}

int Fanuc::loop_number() {
  const size_t place = reader_.at();
  const double number = reader_.value();
  if (number != 1.0 && number != 2.0 && number != 3.0)
    control_.report.fail("out-of-range", reader_.column_of(place),
                         fmt::format("loops have the numbers 1 to 3, not {:g}", number), "write DO1 to DO3");
  return static_cast<int>(number);
}

bool Fanuc::macro_word() {
  const size_t place = reader_.at();
  auto& loops = calls_.back().loops;
  if (reader_.take("GOTO")) {
    go_to(label_value(), reader_.column_of(place));
    return true;
  }
  if (reader_.take("IF")) {
    const bool holds = condition() != 0.0;
    reader_.skip_space();
    if (reader_.take("GOTO")) {
      const long label = label_value();
      if (holds) go_to(label, reader_.column_of(place));
    } else if (reader_.take("THEN")) {
      reader_.skip_space();
      if (reader_.peek() != '#')
        control_.report.fail("bad-statement", reader_.column(), "THEN wants an assignment",
                             "write IF [#1 GT 2] THEN #3=4");
      if (holds)
        assignment();
      else
        reader_.move_to(reader_.line().size());
    } else {
      control_.report.fail("bad-statement", reader_.column(), "GOTO or THEN is missing after the condition",
                           "write IF [#1 GT 2] GOTO 10");
    }
    return true;
  }
  const bool is_while = reader_.take("WHILE");
  if (is_while || reader_.take("DO")) {
    bool holds = true;
    if (is_while) {
      holds = condition() != 0.0;
      reader_.skip_space();
      if (!reader_.take("DO"))
        control_.report.fail("bad-statement", reader_.column(), "DO is missing after the condition",
                             "write WHILE [#1 GT 2] DO1");
    }
    const int number = loop_number();
    std::erase_if(loops, [&](const auto& one) { return one.first == number; });
    if (holds)
      loops.emplace_back(number, source().line_mark());
    else
      skip_to_end(number);
    if (!holds) reader_.move_to(reader_.line().size());
    return true;
  }
  if (!reader_.take("END")) return false;
  const int number = loop_number();
  if (loops.empty() || loops.back().first != number)
    control_.report.fail("bad-statement", reader_.column_of(place),
                         fmt::format("END{} ends no loop that is open here", number),
                         "close the innermost DO first");
  nc::jump(control_);
  source().seek(loops.back().second);
  reader_.begin({});
  return true;
}

void Fanuc::skip_to_end(int loop) {
  const Place from = control_.report.place;
  std::string_view line;
  while (source().next(line)) {
    ++control_.report.summary.lines;
    control_.report.at(source().file(), static_cast<int>(source().line_number()), 1);
    if (ends_loop(line, loop)) return;
  }
  control_.report.at(from.file, from.line, from.column);
  control_.report.fail("unclosed-loop", 0, fmt::format("DO{} has no END{}", loop, loop),
                       "add the END of the loop");
}

/// "END1", with a block number before it or not.
bool Fanuc::ends_loop(std::string_view line, int loop) {
  reader_.begin(line);
  skip_block_number();
  if (!reader_.take("END")) return false;
  reader_.skip_space();
  return reader_.value() == loop;
}

/// Loops that a jump to the line behind `target` leaves: those that begin behind it or end before it.
void Fanuc::leave_loops(const LineSource::Mark& target) {
  auto& loops = calls_.back().loops;
  std::erase_if(loops, [&](const auto& loop) {
    if (target.line <= loop.second.line) return true;
    source().seek(loop.second);
    std::string_view line;
    while (source().mark().line < target.line && source().next(line)) {
      if (ends_loop(line, loop.first)) return true;
    }
    return false;
  });
}

bool Fanuc::labelled(std::string_view line, long label) {
  size_t at = line.find_first_not_of(" \t");
  if (at == std::string_view::npos || (line[at] != 'N' && line[at] != 'n')) return false;
  double number = 0.0;
  at = line.find_first_not_of(" \t", at + 1);
  if (at == std::string_view::npos) return false;
  const size_t length = read_number(line.substr(at), number);
  return length > 0 && length != std::string_view::npos && number == static_cast<double>(label);
}

void Fanuc::go_to(long label, int column) {
  nc::jump(control_);
  const LineSource::Mark here = source().mark();
  LineSource::Mark begin = calls_.size() > 1 ? calls_.back().top : LineSource::Mark{};
  std::string_view line;
  for (const bool ahead : {true, false}) {
    if (!ahead) source().seek(begin);
    while (source().next(line)) {
      if (!ahead && source().line_number() > here.line) break;
      if (!labelled(line, label)) continue;
      const LineSource::Mark target = source().line_mark();
      leave_loops(target);
      source().seek(target);
      reader_.begin({});
      return;
    }
  }
  control_.report.fail("unknown-label", column, fmt::format("GOTO {}: there is no block N{}", label, label),
                       "add the block number");
}

}  // namespace swarf::program::nc::fanuc
