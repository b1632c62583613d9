#include "program/surface_blocks/lexer.h"

#include <fmt/format.h>

#include <charconv>
#include <string>
#include <utility>

#include "program/source_text.h"

namespace swarf::program {
namespace {

bool is_word_letter(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool is_sign(char c) {
  return c == '+' || c == '-';
}
bool is_space(char c) {
  return c == ' ' || c == '\t';
}
/// A part of the program for a message, at most as long as a reader wants.
std::string shown(std::string_view text) {
  constexpr size_t kLongest = 40;
  return text.size() <= kLongest ? std::string(text) : std::string(text.substr(0, kLongest)) + "...";
}
char upper(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

/// A place in the line; `column` counts characters, not bytes.
class Cursor {
 public:
  explicit Cursor(std::string_view line) : line_(line) {}
  bool done() const { return at_ >= line_.size(); }
  char peek(size_t ahead = 0) const { return at_ + ahead < line_.size() ? line_[at_ + ahead] : '\0'; }
  void skip(size_t characters = 1) {
    for (; characters > 0 && !done(); --characters, ++column_) {
      const int length = utf8_length(line_, at_);
      at_ += length > 0 ? static_cast<size_t>(length) : 1;
    }
  }
  void skip_space() {
    while (is_space(peek())) skip();
  }
  size_t position() const { return at_; }
  int column() const { return column_; }
  std::string_view since(size_t start) const { return line_.substr(start, at_ - start); }

 private:
  std::string_view line_;
  size_t at_ = 0;
  int column_ = 1;
};

class LineLexer {
 public:
  LineLexer(std::string_view line, int line_number, Reporter& reporter) : cursor_(line), reporter_(reporter) {
    block_.line = line_number;
  }

  Block run() {
    cursor_.skip_space();
    if (cursor_.peek() == '%') {
      block_.percent = true;
      cursor_.skip();
    }
    for (cursor_.skip_space(); !cursor_.done() && !reporter_.full(); cursor_.skip_space()) token();
    return std::move(block_);
  }

 private:
  void token() {
    const char c = cursor_.peek();
    if (c == ';') {
      while (!cursor_.done()) cursor_.skip();
    } else if (c == '(') {
      comment();
    } else if (is_word_letter(c) && !block_.percent) {
      word();
    } else if (is_digit(c) || is_sign(c) || c == '.') {
      number_without_letter();
    } else {
      unexpected_character();
    }
  }

  void comment() {
    const int column = cursor_.column();
    cursor_.skip();
    while (!cursor_.done() && cursor_.peek() != ')' && cursor_.peek() != '(') cursor_.skip();
    if (cursor_.peek() == ')') {
      cursor_.skip();
      return;
    }
    const bool nested = cursor_.peek() == '(';
    while (!cursor_.done()) cursor_.skip();
    block_.complete = false;
    report("unclosed-comment", column,
           nested ? "a comment opens inside this comment; controls disagree on where it ends"
                  : "this comment is not closed on its line",
           nested ? "use one pair of parentheses" : "close it with ')', or start it with ';'");
  }

  void word() {
    Word word;
    const size_t start = cursor_.position();
    word.letter = upper(cursor_.peek());
    word.column = cursor_.column();
    cursor_.skip();
    cursor_.skip_space();
    word.valid = number(word);
    word.text = cursor_.since(start);
    block_.words.push_back(word);
  }

  /// Reads the number of a word that starts here; false when it was refused.
  bool number(Word& word) {
    const size_t start = cursor_.position();
    while (is_digit(cursor_.peek()) || is_sign(cursor_.peek()) || cursor_.peek() == '.') cursor_.skip();
    std::string_view text = cursor_.since(start);
    if (text.empty()) return missing_number(word);
    if (skip_exponent(text)) {
      return refuse(
          word, fmt::format("'{}' has an exponent, which NC numbers have not", shown(cursor_.since(start))),
          "write all digits (0.001 for 1e-3); if E is a word of its own, put a space before it");
    }
    const bool plus = text.front() == '+';
    if (plus) text.remove_prefix(1);
    const auto [end, problem] =
        std::from_chars(text.data(), text.data() + text.size(), word.value, std::chars_format::fixed);
    if (problem == std::errc::result_out_of_range) {
      return refuse(word,
                    fmt::format("the number of {} does not fit the range of floating point", word.letter),
                    "write a number of at most 15 digits");
    }
    if (problem != std::errc{} || end != text.data() + text.size() || (plus && text.front() == '-')) {
      return refuse(word, fmt::format("'{}' is not a number", shown(cursor_.since(start))),
                    "a number has one optional sign, digits and at most one point: -12.5");
    }
    return true;
  }

  /// Skips E and a whole number that stand directly after digits.
  bool skip_exponent(std::string_view number_text) {
    if (upper(cursor_.peek()) != 'E' || !(is_digit(number_text.back()) || number_text.back() == '.'))
      return false;
    size_t length = is_sign(cursor_.peek(1)) ? 2 : 1;
    if (!is_digit(cursor_.peek(length))) return false;
    while (is_digit(cursor_.peek(length))) ++length;
    if (cursor_.peek(length) == '.') return false;
    cursor_.skip(length);
    return true;
  }

  bool missing_number(const Word& word) {
    const size_t start = cursor_.position();
    size_t length = 0;
    std::string run;
    while (is_word_letter(cursor_.peek(length))) run += upper(cursor_.peek(length++));
    if (run == "NAN" || run == "INF" || run == "INFINITY") {
      cursor_.skip(length);
      return refuse(word, fmt::format("'{}' is not a number that a machine can use", cursor_.since(start)),
                    fmt::format("write {} with digits", word.letter));
    }
    return refuse(word, fmt::format("{} has no number", word.letter),
                  fmt::format("write {} and its number together: {}1", word.letter, word.letter));
  }

  bool refuse(const Word& word, std::string text, std::string fix) {
    report("bad-number", word.column, std::move(text), std::move(fix));
    return false;
  }

  void number_without_letter() {
    const size_t start = cursor_.position();
    const int column = cursor_.column();
    while (is_digit(cursor_.peek()) || is_sign(cursor_.peek()) || cursor_.peek() == '.') cursor_.skip();
    report("bad-number", column, fmt::format("'{}' has no letter before it", shown(cursor_.since(start))),
           "each number belongs to the letter before it; write no space inside a number");
  }

  void unexpected_character() {
    const size_t start = cursor_.position();
    const int column = cursor_.column();
    cursor_.skip();
    const std::string_view c = cursor_.since(start);
    const bool control = c.size() == 1 && static_cast<unsigned char>(c[0]) < 0x20;
    const std::string shown =
        control ? fmt::format("control character 0x{:02X}", c[0]) : fmt::format("'{}'", c);
    report("unexpected-character", column,
           fmt::format("{} does not belong here{}", shown,
                       block_.percent ? ": '%' stands alone on its line" : ""),
           fix_for(c[0]));
  }

  static std::string fix_for(char c) {
    switch (c) {
      case ',':
        return "write a decimal point, and only white space between words";
      case '/':
        return "block delete is not supported: remove the block, or make it a comment";
      case '#':
      case '[':
      case ']':
      case '=':
      case '*':
        return "variables and formulas are not supported: write the number";
      case ')':
        return "open the comment with '(' before it";
      default:
        return "a block has words (a letter and a number), and comments in ( ) or after ;";
    }
  }

  void report(std::string code, int column, std::string text, std::string fix) {
    reporter_.error(std::move(code), block_.line, column, std::move(text), std::move(fix));
  }

  Cursor cursor_;
  Reporter& reporter_;
  Block block_;
};

}  // namespace

Block lex_line(std::string_view line, int line_number, Reporter& reporter) {
  return LineLexer(line, line_number, reporter).run();
}

const Word* find_word(const Block& block, char letter) {
  for (const Word& word : block.words) {
    if (word.letter == letter) return &word;
  }
  return nullptr;
}

}  // namespace swarf::program
