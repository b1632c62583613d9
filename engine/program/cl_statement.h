// The statements of APT CL data: WORD/argument,argument with $ for a line that goes on and $$ for a comment.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "program/reporter.h"

namespace swarf::program {

/// A number or a word between commas.
struct ClArgument {
  std::string text;  ///< as written, without blanks around it
  double value = 0.0;
  bool number = false;
  int line = 0, column = 0;
};

struct ClStatement {
  std::string word;  ///< in capitals: "GOTO"
  std::string text;  ///< what follows, of the words that carry free text (PARTNO, PPRINT, INSERT)
  std::vector<ClArgument> arguments;
  int line = 0, column = 0;
};

/// Splits a text into statements. Blanks count for nothing outside free text, letters may be small.
class ClScanner {
 public:
  /// `text` must outlive the scanner.
  explicit ClScanner(std::string_view text);
  /// The next statement; false at the end. A statement with a fault ("bad-number", "bad-statement") is
  /// reported and left out. Reuses the memory of `statement`.
  bool next(ClStatement& statement, Reporter& reporter);

 private:
  /// The next line without its comment; `goes_on`: it ends with $.
  bool next_line(std::string_view& line, bool free_text, bool& goes_on);
  bool read_arguments(std::string_view line, size_t at, bool goes_on, ClStatement& statement,
                      Reporter& reporter);
  bool read_argument(std::string_view line, size_t begin, size_t end, ClStatement& statement,
                     Reporter& reporter) const;

  std::vector<std::string_view> lines_;
  size_t line_ = 0;  ///< lines taken so far, so the 1-based number of the current one
};

}  // namespace swarf::program
