#include "program/cl_statement.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "program/source_text.h"

namespace swarf::program {
namespace {

constexpr std::string_view kBlanks = " \t\r";

bool is_letter(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}

bool is_word_character(char c) {
  return is_letter(c) || (c >= '0' && c <= '9') || c == '-' || c == '_';
}

char capital(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

bool carries_text(const std::string& word) {
  return word == "PARTNO" || word == "PPRINT" || word == "INSERT" || word == "REMARK" || word == "PAINT" ||
         word == "TOOL PATH" || word == "MACHIN";
}

int column_of(size_t at) {
  return static_cast<int>(at) + 1;
}

/// Length of the number that starts the text; 0 when none does. A leading + is legal in APT.
size_t parse_number(std::string_view text, double& value) {
  const size_t sign = text.starts_with('+') ? 1 : 0;
  const char* begin = text.data() + sign;
  const auto [end, failure] = std::from_chars(begin, text.data() + text.size(), value);
  if (failure == std::errc::invalid_argument) return 0;
  if (failure == std::errc::result_out_of_range) value = std::nan("");
  return static_cast<size_t>(end - text.data());
}

}  // namespace

ClScanner::ClScanner(std::string_view text) : lines_(split_lines(text)) {}

bool ClScanner::next_line(std::string_view& line, bool free_text, bool& goes_on) {
  if (line_ >= lines_.size()) return false;
  line = lines_[line_++];
  goes_on = false;
  if (free_text) return true;
  const size_t dollar = line.find('$');
  if (dollar == std::string_view::npos) return true;
  goes_on = !line.substr(dollar).starts_with("$$");
  line = line.substr(0, dollar);
  return true;
}

bool ClScanner::next(ClStatement& statement, Reporter& reporter) {
  std::string_view line;
  bool goes_on = false;
  while (!reporter.full() && next_line(line, false, goes_on)) {
    const size_t begin = line.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) continue;
    statement.line = static_cast<int>(line_);
    statement.column = column_of(begin);
    statement.word.clear();
    statement.text.clear();
    statement.arguments.clear();
    size_t at = begin;
    for (; at < line.size() && is_word_character(line[at]); ++at) statement.word += capital(line[at]);
    // The one word of two words.
    if (statement.word == "TOOL" && line.substr(at).starts_with(" PATH")) {
      statement.word = "TOOL PATH";
      at += 5;
    }
    if (carries_text(statement.word)) {
      const std::string_view whole = lines_[line_ - 1];
      const size_t text = whole.find_first_not_of(" \t/", at);
      if (text != std::string_view::npos) statement.text = whole.substr(text);
      return true;
    }
    if (at == begin || !is_letter(line[begin])) {
      reporter.error("bad-statement", statement.line, column_of(begin),
                     fmt::format("'{}' starts no statement", line.substr(begin, 20)),
                     "a statement is WORD or WORD/argument,argument, for example GOTO/10,20,30");
      while (goes_on && next_line(line, false, goes_on)) {
      }
      continue;
    }
    if (read_arguments(line, at, goes_on, statement, reporter)) return true;
  }
  return false;
}

bool ClScanner::read_arguments(std::string_view line, size_t at, bool goes_on, ClStatement& statement,
                               Reporter& reporter) {
  bool good = true;
  at = line.find_first_not_of(kBlanks, at);
  if (at != std::string_view::npos && line[at] != '/') {
    reporter.error("bad-statement", statement.line, column_of(at),
                   fmt::format("'{}' follows {} without a slash", line.substr(at, 20), statement.word),
                   fmt::format("write {}/ and then its arguments with commas between", statement.word));
    good = false;
  }
  size_t begin = at == std::string_view::npos ? line.size() : at + 1;
  bool open = at != std::string_view::npos;  // an argument is still to come
  for (;;) {
    const size_t comma = std::min(line.find(',', begin), line.size());
    const bool blank = line.find_first_not_of(kBlanks, begin) >= comma;
    if (good && !(blank && comma == line.size() && (goes_on || !open))) {
      good = read_argument(line, begin, comma, statement, reporter);
    }
    open = comma < line.size() || (open && blank);
    begin = comma + 1;
    if (comma < line.size()) continue;
    if (!goes_on) return good;
    if (!next_line(line, false, goes_on)) {
      reporter.error("bad-statement", statement.line, statement.column,
                     fmt::format("the file ends inside {}, after a $", statement.word),
                     "complete the statement, or take the $ away");
      return false;
    }
    begin = 0;
    // The slash may stand on the line that follows.
    const size_t first = line.find_first_not_of(kBlanks);
    if (statement.arguments.empty() && first != std::string_view::npos && line[first] == '/') {
      begin = first + 1;
      open = true;
    }
  }
}

bool ClScanner::read_argument(std::string_view line, size_t begin, size_t end, ClStatement& statement,
                              Reporter& reporter) const {
  const size_t first = std::min(line.find_first_not_of(kBlanks, begin), end);
  std::string_view text = line.substr(first, end - first);
  text = text.substr(0, text.find_last_not_of(kBlanks) + 1);
  ClArgument argument;
  argument.line = static_cast<int>(line_);
  argument.column = column_of(first);
  if (text.empty()) {
    reporter.error("bad-statement", argument.line, argument.column,
                   fmt::format("{} has an empty argument", statement.word),
                   "write a number or a word between the commas");
    return false;
  }
  argument.text = text;
  if (text == "3AXIS" || text == "5AXIS") {
    // The words of CL data that begin with a figure: MOVNRB's.
  } else if (is_letter(text[0]) && text != "nan" && text != "inf" && text != "NaN" && text != "NAN" &&
             text != "INF" && text != "infinity") {
    for (char& c : argument.text) c = capital(c);
  } else if (parse_number(text, argument.value) == text.size() && std::isfinite(argument.value)) {
    argument.number = true;
  } else {
    reporter.error("bad-number", argument.line, argument.column,
                   fmt::format("'{}' in {} is not a finite number", text, statement.word),
                   "write a number such as -12.5 or 1.25E-3");
    return false;
  }
  statement.arguments.push_back(std::move(argument));
  return true;
}

}  // namespace swarf::program
