// Words of Siemens 840D: a block becomes tokens, each with its place.
//
//   N100 /label: X31. Y=_Z_HOME+R1 A3=.5 T="D8" IF R1==2 GOTOF END   ; comment
//
// 1. A letter and a number are one address (X31. G0 M3), with or without white space before the next one.
// 2. A letter and digits before a single '=' are the extended address of an assignment (S1=, A3=, R5=).
// 3. Two letters, or a letter and '_', begin a name: letters, digits, '_'. Case does not matter.
// 4. Numbers have no E; the exponent is EX (1.5EX-3). 'HFF' and 'B101' are whole numbers.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"

namespace swarf::program::nc::siemens {

// Of ASCII; in_name: what a name may hold behind its first letter.
inline bool is_letter(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}
inline bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
inline bool in_name(char c) {
  return is_letter(c) || is_digit(c) || c == '_';
}

/// a == b, neither of them empty. Most words differ in their first letters, or are that letter.
inline bool same(std::string_view a, std::string_view b) {
  return a.size() == b.size() && a[0] == b[0] && (a.size() == 1 || a == b);
}

/// A line of the program, for messages.
struct LineRef {
  const std::string* file = nullptr;
  int line = 0;  ///< 1-based
  std::string_view text;
};

/// Throws InputError at the byte `offset` of the line; the column is counted in characters.
[[noreturn]] void refuse(const LineRef& line, size_t offset, std::string code, std::string text,
                         std::string fix);
/// The column of a byte offset.
int column_of(const LineRef& line, size_t offset);

enum class TokenKind {
  kAddress,  ///< letter and number: X-12.5; `number` and `whole`
  kName,     ///< `name` in capitals: a variable, a word of the language, an address before '=' or '['
  kNumber,   ///< a number without a letter
  kString,   ///< "..." with `text` without the quotes
  kSymbol,   ///< `name`: = == <> < > <= >= << + - * / ( ) [ ] , :
};

struct Token {
  TokenKind kind = TokenKind::kSymbol;
  char letter = ' ';      ///< of an address, in capitals
  bool whole = false;     ///< the number was written without a point
  double number = 0.0;    ///< finite
  std::string name;       ///< in capitals
  std::string_view text;  ///< as written
  size_t offset = 0;      ///< byte in the line

  bool symbol(std::string_view what) const { return kind == TokenKind::kSymbol && same(name, what); }
  bool named(std::string_view what) const { return kind == TokenKind::kName && same(name, what); }
};

/// Reads one line into `tokens` (cleared first). Throws InputError: "bad-number", "unexpected-character",
/// "unclosed-string". Tokens point into the line.
void lex(const LineRef& line, std::vector<Token>& tokens);

/// Letters of ASCII in capitals.
std::string capitals(std::string_view text);

}  // namespace swarf::program::nc::siemens
