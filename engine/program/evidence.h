// How the dialect of a program is recognised from its first lines.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace swarf::program {

/// What speaks for a dialect in a program's first lines.
struct Evidence {
  int score = 0;       ///< number of words that only this dialect has; 0: nothing speaks for it
  std::string reason;  ///< the first such word, as written with its line: "G43.4 in line 12"

  /// Adds to the score; the reason is that of the first word.
  void add(int points, std::string_view what, long line);
};

/// One line of a program's head. Comments are no evidence: CAM systems write any word into them.
struct HeadLine {
  long number = 0;   ///< 1-based
  std::string text;  ///< as it stands in the file, without its end
  /// The text in capitals, without comments and without white space at its ends. A comment is what stands
  /// behind ';' and what stands in parentheses, unless they open the arguments of a name (CYCLE83(..)) or
  /// stand in a formula; texts in quotes stay.
  std::string code;
};

/// The first lines of a program, split once for all dialects.
struct ProgramHead {
  std::string extension;  ///< with its dot, in small letters
  std::vector<HeadLine> lines;

  /// Adds the next line.
  void add(std::string_view line);
};

/// A line's code as HeadLine has it.
std::string code_of_line(std::string_view line);

/// True where `word` (a letter and its number, in capitals) stands in the code and no further digit belongs
/// to it: "G65" is in "N1 G65 P1", not in "G650" or "G65.1".
bool has_word(std::string_view code, std::string_view word);

}  // namespace swarf::program
