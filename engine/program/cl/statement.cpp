#include "program/cl/statement.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace swarf::program {
namespace {

constexpr std::string_view kBlanks = " \t\r";
constexpr std::string_view kMark = "\xEF\xBB\xBF";
constexpr size_t kNone = std::string_view::npos;

bool is_letter(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}

bool is_word_character(char c) {
  return is_letter(c) || (c >= '0' && c <= '9') || c == '-' || c == '_';
}

char capital(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

/// Words whose text is kept as it stands; it may go on behind a $ in those that CATIA breaks into lines.
enum class Text { kNo, kOneLine, kGoesOn };
Text text_of(const std::string& word) {
  static constexpr std::array kWords{"PARTNO", "PPRINT", "INSERT", "REMARK", "PAINT", "TOOL PATH", "MACHIN"};
  if (std::find(kWords.begin(), kWords.end(), word) != kWords.end()) return Text::kOneLine;
  return word == "TOOLNO" || word == "TPRINT" ? Text::kGoesOn : Text::kNo;
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

std::string_view trimmed(std::string_view text) {
  const size_t first = text.find_first_not_of(kBlanks);
  if (first == kNone) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) + 1 - first);
}

}  // namespace

std::string shown(const ClArgument& argument) {
  return argument.number ? fmt::format("{:g}", argument.value) : argument.text;
}

ClText::ClText(std::string_view text) : rest_(text) {
  if (rest_.starts_with(kMark)) rest_.remove_prefix(kMark.size());
}

bool ClText::next(std::string_view& line) {
  if (rest_.empty()) return false;
  const size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
  line = rest_.substr(0, end);
  const size_t skip = rest_.substr(end).starts_with("\r\n") ? 2 : 1;
  rest_.remove_prefix(std::min(end + skip, rest_.size()));
  return true;
}

bool ClScanner::next_line(bool& goes_on) {
  goes_on = false;
  if (!lines_.next(whole_)) return false;
  ++number_;
  line_ = whole_;
  const size_t dollar = line_.find('$');
  if (dollar == kNone) return true;
  goes_on = !line_.substr(dollar).starts_with("$$");
  line_ = line_.substr(0, dollar);
  return true;
}

size_t ClScanner::read_comment(size_t begin, ClStatement& statement, bool& goes_on) {
  statement.word = "$$";
  statement.text = trimmed(whole_.substr(begin + 2));
  if (!whole_.substr(begin).starts_with("$$->")) return kNone;
  // $$-> NAME / arguments: a statement of Creo's own.
  size_t at = std::min(whole_.find_first_not_of(kBlanks, begin + 4), whole_.size());
  const size_t name = at;
  while (at < whole_.size() && is_word_character(whole_[at])) ++at;
  statement.word += "->";
  for (const char c : whole_.substr(name, at - name)) statement.word += capital(c);
  const size_t dollar = std::min(whole_.find('$', at), whole_.size());
  goes_on = dollar < whole_.size() && !whole_.substr(dollar).starts_with("$$");
  line_ = whole_.substr(0, dollar);
  statement.text = trimmed(line_.substr(at));
  if (statement.text.starts_with('/')) statement.text = trimmed(std::string_view(statement.text).substr(1));
  return statement.word == "$$->CSYS" || statement.word == "$$->CUTTER" ? at : kNone;
}

void ClScanner::read_text(size_t at, bool may_go_on, ClStatement& statement) {
  const size_t text = whole_.find_first_not_of(" \t/", at);
  if (text != kNone) statement.text = whole_.substr(text);
  while (may_go_on) {
    const size_t last = statement.text.find_last_not_of(kBlanks);
    may_go_on = last != std::string::npos && statement.text[last] == '$' && lines_.next(whole_);
    if (!may_go_on) return;
    ++number_;
    statement.text.resize(last);
    statement.text += trimmed(whole_);
  }
}

bool ClScanner::next(ClStatement& statement, Reporter& reporter) {
  bool goes_on = false;
  while (!reporter.full() && next_line(goes_on)) {
    const size_t begin = whole_.find_first_not_of(kBlanks);
    if (begin == kNone) continue;
    any_text_ = true;
    statement.line = number_;
    statement.column = column_of(begin);
    statement.word.clear();
    statement.text.clear();
    statement.arguments.clear();
    if (whole_.substr(begin).starts_with("$$")) {
      const size_t data = read_comment(begin, statement, goes_on);
      if (data == kNone || read_arguments(data, goes_on, statement, reporter)) return true;
      continue;
    }
    size_t at = begin;
    for (; at < line_.size() && is_word_character(line_[at]); ++at) statement.word += capital(line_[at]);
    // The one word of two words.
    if (statement.word == "TOOL" && trimmed(line_.substr(at)).starts_with("PATH")) {
      statement.word = "TOOL PATH";
      at = line_.find("PATH", at) + 4;
    }
    const Text text = text_of(statement.word);
    if (text != Text::kNo) {
      read_text(at, text == Text::kGoesOn, statement);
      return true;
    }
    if (at == begin || !is_letter(line_[begin])) {
      reporter.error("bad-statement", statement.line, column_of(begin),
                     fmt::format("'{}' starts no statement", whole_.substr(begin, 20)),
                     "a statement is WORD or WORD/argument,argument, for example GOTO/10,20,30");
      while (goes_on && next_line(goes_on)) {
      }
      continue;
    }
    const size_t after = line_.find_first_not_of(kBlanks, at);
    const bool nested =
        statement.word == "PSIS" || statement.word == "CLEARP" || (after != kNone && line_[after] == ',');
    if (nested ? read_nested(at, goes_on, statement, reporter)
               : read_arguments(at, goes_on, statement, reporter))
      return true;
  }
  return false;
}

bool ClScanner::ends_inside(const ClStatement& statement, Reporter& reporter) const {
  reporter.error("bad-statement", statement.line, statement.column,
                 fmt::format("the file ends inside {}, after a $", statement.word),
                 "complete the statement, or take the $ away");
  return false;
}

bool ClScanner::read_arguments(size_t at, bool goes_on, ClStatement& statement, Reporter& reporter) {
  bool good = true;
  at = line_.find_first_not_of(kBlanks, at);
  if (at != kNone && line_[at] != '/') {
    reporter.error("bad-statement", statement.line, column_of(at),
                   fmt::format("'{}' follows {} without a slash", line_.substr(at, 20), statement.word),
                   fmt::format("write {}/ and then its arguments with commas between", statement.word));
    good = false;
  }
  // SolidWorks CAM writes RAPID/ where others write RAPID.
  const bool bare = good && !goes_on && statement.word == "RAPID";
  if (bare && at != kNone && line_.find_first_not_of(kBlanks, at + 1) == kNone) return true;
  size_t begin = at == kNone ? line_.size() : at + 1;
  bool open = at != kNone;  // an argument is still to come
  for (;;) {
    const size_t comma = std::min(line_.find(',', begin), line_.size());
    const bool blank = line_.find_first_not_of(kBlanks, begin) >= comma;
    if (good && !(blank && comma == line_.size() && (goes_on || !open))) {
      good = read_argument(begin, comma, statement, reporter);
    }
    open = comma < line_.size() || (open && blank);
    begin = comma + 1;
    if (comma < line_.size()) continue;
    if (!goes_on) return good;
    if (!next_line(goes_on)) return ends_inside(statement, reporter);
    begin = 0;
    // The slash may stand on the line that follows.
    const size_t first = line_.find_first_not_of(kBlanks);
    if (statement.arguments.empty() && first != kNone && line_[first] == '/') {
      begin = first + 1;
      open = true;
    }
  }
}

bool ClScanner::read_nested(size_t at, bool goes_on, ClStatement& statement, Reporter& reporter) {
  bool good = true, comma = false;
  int depth = 0;
  const auto refuse = [&](size_t where, const char* what) {
    if (good) {
      reporter.error("bad-statement", number_, column_of(where), fmt::format("{} {}", statement.word, what),
                     "brackets hold a statement: (CIRCLE/0,0,0,5), and commas stand between arguments");
    }
    good = false;
  };
  for (;;) {
    const size_t mark = std::min(line_.find_first_of(",/()", at), line_.size());
    const bool blank = line_.find_first_not_of(kBlanks, at) >= mark;
    if (good && !blank) good = read_argument(at, mark, statement, reporter);
    if (!blank) comma = false;
    at = mark + 1;
    if (mark < line_.size()) {
      const char c = line_[mark];
      if (c == ',' && comma) refuse(mark, "has an empty argument");
      comma = c == ',';
      depth += c == '(' ? 1 : c == ')' ? -1 : 0;
      if (depth < 0) refuse(mark, "has a bracket that was not opened");
      continue;
    }
    if (!goes_on) break;
    if (!next_line(goes_on)) return ends_inside(statement, reporter);
    at = 0;
  }
  if (depth > 0) refuse(line_.size(), "has a bracket that is not closed");
  return good;
}

bool ClScanner::read_argument(size_t begin, size_t end, ClStatement& statement, Reporter& reporter) const {
  const size_t first = std::min(line_.find_first_not_of(kBlanks, begin), end);
  const std::string_view text = trimmed(line_.substr(first, end - first));
  ClArgument argument;
  argument.line = number_;
  argument.column = column_of(first);
  if (text.empty()) {
    reporter.error("bad-statement", argument.line, argument.column,
                   fmt::format("{} has an empty argument", statement.word),
                   "write a number or a word between the commas");
    return false;
  }
  if (text == "3AXIS" || text == "5AXIS") {
    argument.text = text;  // the words of CL data that begin with a figure: MOVNRB's
  } else if (is_letter(text[0]) && text != "nan" && text != "inf" && text != "NaN" && text != "NAN" &&
             text != "INF" && text != "infinity") {
    argument.text = text;
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
