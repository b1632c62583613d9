// First parsing step: a line of a program becomes words, each a letter and a number with its column.
//
//   N100 G10 L71 P1 i0 J0 X-50. Y+.5 Z 0   (comment)   ; comment to the end of the line
//
// 1. Letters may be small; white space may stand between words and between a letter and its number.
// 2. A number is [+-] digits [.] digits with at least one digit. There is no exponent: E is a word, so
//    digits, E and a whole number without white space ("B0E1") are refused instead of guessed.
// 3. (comments) end on their line and do not nest. '%' stands alone on its line.
#pragma once

#include <string_view>
#include <vector>

#include "program/reporter.h"

namespace swarf::program {

struct Word {
  char letter = ' ';      ///< 'A' to 'Z'
  double value = 0.0;     ///< finite
  bool valid = true;      ///< false: its number was refused, `value` means nothing
  int column = 0;         ///< 1-based, in characters
  std::string_view text;  ///< as written, letter and number
};

struct Block {
  int line = 0;
  bool percent = false;  ///< a '%' line
  bool complete = true;  ///< false: an unclosed comment may have swallowed words
  std::vector<Word> words;
};

/// Reads one line. Reports "bad-number", "unexpected-character", "unclosed-comment". The words point into
/// `line`.
Block lex_line(std::string_view line, int line_number, Reporter& reporter);

/// The first word with this letter, or null.
const Word* find_word(const Block& block, char letter);

}  // namespace swarf::program
