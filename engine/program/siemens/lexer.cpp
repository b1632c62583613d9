#include "program/siemens/lexer.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "program/control/report.h"
#include "program/letters/arithmetic.h"
#include "program/source_text.h"

namespace swarf::program::nc::siemens {
namespace {

char upper(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

bool is_symbol(char c) {
  switch (c) {
    case '=':
    case '<':
    case '>':
    case '+':
    case '-':
    case '*':
    case '/':
    case '(':
    case ')':
    case '[':
    case ']':
    case ',':
    case ':':
      return true;
    default:
      return false;
  }
}

class LineLexer {
 public:
  LineLexer(const LineRef& line, std::vector<Token>& tokens)
      : line_(line), text_(line.text), tokens_(tokens) {}

  void run() {
    for (skip_space(); at_ < text_.size() && text_[at_] != ';'; skip_space()) token();
  }

 private:
  char peek(size_t ahead = 0) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }
  void skip_space() {
    while (peek() == ' ' || peek() == '\t') ++at_;
  }

  void token() {
    const char c = peek();
    tokens_.emplace_back();
    Token& token = tokens_.back();
    token.offset = at_;
    if (is_letter(c) || c == '_' || c == '$') {
      word(token);
    } else if (is_digit(c) || (c == '.' && is_digit(peek(1)))) {
      token.kind = TokenKind::kNumber;
      number(token, at_);
    } else if (c == '"') {
      string(token);
    } else if (c == '\'') {
      coded_number(token);
    } else {
      symbol(token);
    }
    token.text =
        token.kind == TokenKind::kString ? token.text : text_.substr(token.offset, at_ - token.offset);
  }

  void word(Token& token) {
    const size_t start = at_;
    ++at_;
    const char next = peek();
    const bool single = is_letter(text_[start]) && !is_letter(next) && next != '_';
    if (single && (is_digit(next) || next == '.' || next == '-' || next == '+')) {
      if (!extended_address(token, start)) address(token, start);
      return;
    }
    while (in_name(peek())) ++at_;
    name(token, start);
  }

  /// In capitals, up to where the lexer stands.
  void name(Token& token, size_t start) {
    token.kind = TokenKind::kName;
    for (size_t at = start; at < at_; ++at) token.name.push_back(upper(text_[at]));
  }

  /// S1= A3= R5=: letter, digits, and one '=' (not two).
  bool extended_address(Token& token, size_t start) {
    size_t end = at_;
    while (end < text_.size() && is_digit(text_[end])) ++end;
    size_t equals = end;
    while (equals < text_.size() && (text_[equals] == ' ' || text_[equals] == '\t')) ++equals;
    if (end == at_ || equals >= text_.size() || text_[equals] != '=') return false;
    if (equals + 1 < text_.size() && text_[equals + 1] == '=') return false;
    at_ = end;
    name(token, start);
    return true;
  }

  void address(Token& token, size_t start) {
    token.kind = TokenKind::kAddress;
    token.letter = upper(text_[start]);
    const bool negative = peek() == '-';
    if (negative || peek() == '+') ++at_;
    if (!is_digit(peek()) && peek() != '.') {
      refuse(line_, start, "bad-number", fmt::format("{} has no number after its sign", token.letter),
             fmt::format("write digits after it: {}-12.5", token.letter));
    }
    number(token, start);
    if (negative) token.number = -token.number;
  }

  /// Digits, one point, EX and a whole number.
  void number(Token& token, size_t start) {
    constexpr size_t kDigitsMax = 60;
    const size_t digits = nc::read_number(text_.substr(at_), token.number, &token.whole);
    if (digits == 0 || digits > kDigitsMax || (at_ + digits < text_.size() && text_[at_ + digits] == '.')) {
      while (is_digit(peek()) || peek() == '.') ++at_;
      refuse(line_, start, "bad-number",
             fmt::format("'{}' is not a number", text_.substr(start, std::min<size_t>(at_ - start, 40))),
             "a number has digits and at most one point: -12.5");
    }
    at_ += digits;
    if (upper(peek()) == 'E') exponent(token, start);
  }

  void exponent(Token& token, size_t start) {
    const bool siemens = upper(peek(1)) == 'X' &&
                         (is_digit(peek(2)) || ((peek(2) == '-' || peek(2) == '+') && is_digit(peek(3))));
    const bool other = is_digit(peek(1)) || ((peek(1) == '-' || peek(1) == '+') && is_digit(peek(2)));
    if (other) {
      refuse(line_, start, "bad-number", "a number has no exponent E on this control",
             "write EX: 1.5EX-3 is 0.0015");
    }
    if (!siemens) return;
    at_ += 2;
    const bool negative = peek() == '-';
    if (negative || peek() == '+') ++at_;
    int power = 0;
    while (is_digit(peek()) && power < 1000) power = 10 * power + (text_[at_++] - '0');
    token.number *= std::pow(10.0, negative ? -power : power);
    token.whole = false;
    if (!std::isfinite(token.number) || power >= 1000) {
      refuse(line_, start, "bad-number", "the number does not fit the range of floating point",
             "write an exponent between EX-300 and EX300");
    }
  }

  void string(Token& token) {
    const size_t end = text_.find('"', at_ + 1);
    if (end == std::string_view::npos) {
      refuse(line_, at_, "unclosed-string", "this text is not closed on its line", "close it with \"");
    }
    token.kind = TokenKind::kString;
    token.text = text_.substr(at_ + 1, end - at_ - 1);
    at_ = end + 1;
  }

  /// 'HFF', 'B101'.
  void coded_number(Token& token) {
    const size_t end = text_.find('\'', at_ + 1);
    const std::string_view code =
        end == std::string_view::npos ? std::string_view{} : text_.substr(at_ + 1, end - at_ - 1);
    const int base = code.empty() ? 0 : upper(code[0]) == 'H' ? 16 : upper(code[0]) == 'B' ? 2 : 0;
    unsigned value = 0;
    const char* first = code.data() + (code.empty() ? 0 : 1);
    const char* last = code.data() + code.size();
    const auto [stop, problem] = base == 0 ? std::from_chars_result{first, std::errc::invalid_argument}
                                           : std::from_chars(first, last, value, base);
    if (problem != std::errc{} || stop != last) {
      refuse(line_, at_, "bad-number", "a number in quotes is 'H' and hexadecimal or 'B' and binary digits",
             "write 'HFF' or 'B101', at most 32 bits");
    }
    token.kind = TokenKind::kNumber;
    token.whole = true;
    token.number = value;
    at_ = end + 1;
  }

  void symbol(Token& token) {
    const char c = peek(), next = peek(1);
    if (is_symbol(c)) {
      const bool two =
          next == '=' ? c == '=' || c == '<' || c == '>' : c == '<' && (next == '>' || next == '<');
      token.name.push_back(c);
      if (two) token.name.push_back(next);
      at_ += two ? 2 : 1;
      return;
    }
    const int length = utf8_length(text_, at_);
    const std::string_view shown = text_.substr(at_, length > 0 ? static_cast<size_t>(length) : 1);
    const auto byte = static_cast<unsigned char>(shown[0]);
    const bool printable = length > 0 && byte >= 0x20 && byte != 0x7F;
    refuse(line_, at_, "unexpected-character",
           printable ? fmt::format("'{}' does not belong here", shown)
                     : fmt::format("byte 0x{:02X} does not belong here", byte),
           "a block has words, formulas and names; comments stand after ';', texts in \"\"");
  }

  const LineRef& line_;
  std::string_view text_;
  std::vector<Token>& tokens_;
  size_t at_ = 0;
};

}  // namespace

int column_of(const LineRef& line, size_t offset) {
  int column = 1;
  for (size_t at = 0; at < offset && at < line.text.size(); ++column) {
    const int length = utf8_length(line.text, at);
    at += length > 0 ? static_cast<size_t>(length) : 1;
  }
  return column;
}

void refuse(const LineRef& line, size_t offset, std::string code, std::string text, std::string fix) {
  nc::Report::fail_at({*line.file, line.line, column_of(line, offset)}, std::move(code), std::move(text),
                      std::move(fix));
}

std::string capitals(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = upper(c);
  return result;
}

void lex(const LineRef& line, std::vector<Token>& tokens) {
  tokens.clear();
  LineLexer(line, tokens).run();
}

}  // namespace swarf::program::nc::siemens
