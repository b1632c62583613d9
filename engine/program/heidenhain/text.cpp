#include "program/heidenhain/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "program/heidenhain/parameters.h"
#include "program/letters/arithmetic.h"
#include "program/source_text.h"

namespace swarf::program::nc::heidenhain {
namespace {

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\f' || c == '\x1A';
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool is_letter(char c) {
  return c >= 'A' && c <= 'Z';
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

/// Offset of the ';' that starts the comment, npos without one.
size_t comment_start(std::string_view line) {
  const size_t first = line.find(';');
  if (first == std::string_view::npos || line.substr(0, first).find('"') == std::string_view::npos)
    return first;
  bool quoted = false;
  for (size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') quoted = !quoted;
    if (line[i] == ';' && !quoted) return i;
  }
  return std::string_view::npos;
}

/// Makes the letters outside of quotes capitals.
void capitalise(std::string& text, size_t from) {
  bool quoted = false;
  for (size_t i = from; i < text.size(); ++i) {
    char& c = text[i];
    if (c == '"') quoted = !quoted;
    if (!quoted && c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
}

/// Appends the words of a line; true when the block goes on in the next one.
bool append_line(std::string_view line, int number, BlockText& block) {
  const size_t written = block.written.size();
  block.written += line;
  std::string_view rest = trimmed(line);
  const bool goes_on = rest.ends_with('~');
  if (goes_on) rest.remove_suffix(1);
  size_t begin = 0;
  if (block.pieces.empty()) {
    while (begin < rest.size() && is_space(rest[begin])) ++begin;
    while (begin < rest.size() && is_digit(rest[begin])) ++begin;
    while (begin < rest.size() && is_space(rest[begin])) ++begin;
  }
  const size_t comment = comment_start(rest);
  if (comment != std::string_view::npos) {
    if (block.comment.empty()) block.comment = trimmed(rest.substr(comment + 1));
    rest = rest.substr(0, std::max(begin, comment));
  }
  const size_t from = block.text.size();
  block.pieces.push_back({from, number, begin, written});
  block.text += trimmed(rest.substr(begin));
  capitalise(block.text, from);
  block.text += '\n';
  return goes_on;
}

}  // namespace

void BlockText::clear() {
  text.clear();
  comment.clear();
  pieces.clear();
  written.clear();
}

bool read_block(nc::LineSource& source, nc::Control& control, BlockText& block,
                std::vector<std::pair<int, std::string>>& comments) {
  std::string_view line;
  for (long skipped = 0;; skipped += static_cast<long>(block.pieces.size())) {
    block.clear();
    block.skipped = skipped;
    block.file = source.file();
    block.mark = source.mark();
    if (!source.next(line)) return false;
    bool goes_on = append_line(line, static_cast<int>(source.line_number()), block);
    while (goes_on) {
      if (!source.next(line)) {
        control.report.at(source.file(), block.pieces.back().line, 1);
        control.report.fail("open-continuation", 0, "the file ends behind '~', which continues the block",
                            "the file is cut off here: transfer it again, or take the '~' out");
      }
      goes_on = append_line(line, static_cast<int>(source.line_number()), block);
    }
    const bool heading = block.text.starts_with('*');
    if (heading) block.comment = trimmed(block.text);
    const bool blank = trimmed(block.text).empty();
    if (!heading && !blank) return true;
    if (!block.comment.empty()) comments.emplace_back(block.line(), block.comment);
  }
}

nc::Place BlockReader::place_of(size_t offset) const {
  size_t n = 0;
  while (n + 1 < block_.pieces.size() && block_.pieces[n + 1].offset <= offset) ++n;
  const BlockText::Piece& piece = block_.pieces[n];
  return {block_.file, piece.line, nc::column_at(block_.line_text(n), piece.skipped + offset - piece.offset)};
}

void BlockReader::fail(const char* code, size_t offset, std::string text, std::string fix) const {
  const nc::Place place = place_of(offset);
  control_.report.at(place.file, place.line, place.column);
  control_.report.fail(code, place.column, std::move(text), std::move(fix));
}

bool BlockReader::done() {
  while (at_ < block_.text.size() && is_space(block_.text[at_])) ++at_;
  return at_ >= block_.text.size();
}

/// Q1, QL1, QR1: the parameter of FQ50, not a part of the word.
bool BlockReader::parameter_at(size_t offset) const {
  if (block_.text[offset] != 'Q' || offset + 1 >= block_.text.size()) return false;
  const char next = block_.text[offset + 1];
  if (next != 'L' && next != 'R') return is_digit(next);
  return offset + 2 < block_.text.size() && is_digit(block_.text[offset + 2]);
}

std::string_view BlockReader::letters() {
  done();
  size_t end = at_;
  while (end < block_.text.size() && is_letter(block_.text[end])) {
    if (end > at_ && parameter_at(end)) break;
    ++end;
  }
  return std::string_view(block_.text).substr(at_, end - at_);
}

std::string_view BlockReader::take_letters() {
  const std::string_view word = letters();
  at_ += word.size();
  return word;
}

bool BlockReader::take(std::string_view word) {
  if (letters() != word) return false;
  at_ += word.size();
  return true;
}

bool BlockReader::take_char(char c) {
  done();
  if (peek() != c) return false;
  ++at_;
  return true;
}

bool BlockReader::value_follows() {
  done();
  const char c = peek();
  if (c == 'Q') return is_digit(peek_after(1)) || peek_after(1) == 'L' || peek_after(1) == 'R';
  return is_digit(c) || c == '+' || c == '-' || c == '.';
}

double BlockReader::value() {
  done();
  const size_t start = at_;
  double sign = 1.0;
  if (peek() == '+' || peek() == '-') {
    if (peek() == '-') sign = -1.0;
    ++at_;
    done();
  }
  if (peek() == 'Q') return sign * parameters_.read(*this);
  if (peek() == '+' || peek() == '-') {
    fail("bad-number", at_, "a second sign stands here", "write one sign");
  }
  double number = 0.0;
  const std::string_view here = std::string_view(block_.text).substr(at_);
  size_t length = nc::read_number(here, number);
  // Older controls write the decimal point as a comma.
  if (length > 0 && length < here.size() && here[length] == ',' && is_digit(here[length - 1])) {
    std::string with_point(here.substr(0, std::min<size_t>(here.size(), 400)));
    with_point[length] = '.';
    length = nc::read_number(with_point, number);
  }
  if (length == std::string::npos) fail("bad-number", at_, "this number is too large", "write a number");
  if (length == 0) {
    fail("missing-number", start, "a number or a Q parameter is missing here", "write X+10 or X+Q1");
  }
  at_ += length;
  const char next = peek();
  if (next == '.' || next == ',' || is_digit(next)) {
    fail("bad-number", start, "this is not a number", "write digits with one decimal point: 12.5");
  }
  return sign * number;
}

bool BlockReader::parameter_follows() const {
  const bool word_before = at_ > 0 && (is_letter(block_.text[at_ - 1]) || is_digit(block_.text[at_ - 1]));
  return !word_before && peek() == 'Q' && is_digit(peek_after(1));
}

long BlockReader::whole_number(long max) {
  const size_t start = (done(), at_);
  const long number = whole_number_before_point(max);
  if (peek() == '.' || peek() == ',') {
    fail("not-whole-number", start, "a whole number belongs here", "take the fraction out");
  }
  return number;
}

long BlockReader::whole_number_before_point(long max) {
  done();
  const size_t start = at_;
  long number = 0;
  while (is_digit(peek())) {
    number = number * 10 + (peek() - '0');
    ++at_;
    if (number > max) {
      fail("out-of-range", start, fmt::format("this number is above {}", max), "correct the number");
    }
  }
  if (at_ == start) fail("missing-number", start, "a whole number is missing here", "write M3, LBL 5");
  return number;
}

long BlockReader::whole_value(long min, long max) {
  done();
  const size_t start = at_;
  const double number = value();
  if (number != std::floor(number)) {
    fail("not-whole-number", start, fmt::format("{:g} is no whole number", number), "write a whole number");
  }
  if (!(number >= static_cast<double>(min) && number <= static_cast<double>(max))) {
    fail("out-of-range", start, fmt::format("{:g} is not between {} and {}", number, min, max),
         "correct the number");
  }
  return static_cast<long>(number);
}

std::string BlockReader::quoted() {
  done();
  const size_t start = at_;
  if (peek() != '"') fail("missing-text", start, "a text in quotes belongs here", "write \"NAME\"");
  const size_t end = block_.text.find('"', at_ + 1);
  const size_t line_end = block_.text.find('\n', at_);
  if (end == std::string::npos || end > line_end) {
    fail("unclosed-string", start, "this quote is never closed", "close it in its line");
  }
  std::string text = block_.text.substr(at_ + 1, end - at_ - 1);
  at_ = end + 1;
  return text;
}

std::string BlockReader::text_value() {
  done();
  return peek() == 'Q' ? parameters_.read_text(*this) : quoted();
}

std::string_view BlockReader::rest() {
  done();
  const std::string_view left = trimmed(std::string_view(block_.text).substr(at_));
  at_ = block_.text.size();
  return left;
}

void BlockReader::expect_end() {
  if (done()) return;
  const size_t start = at_;
  std::string word(take_letters());
  if (word.empty()) word = std::string(1, block_.text[start]);
  fail("unexpected-word", start, fmt::format("{} does not belong to this block", word), "take it out");
}

}  // namespace swarf::program::nc::heidenhain
