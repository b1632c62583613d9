// The statements of APT CL data: WORD/argument,argument with $ for a line that goes on and $$ for a comment.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "program/reporter.h"

namespace swarf::program {

/// A number or a word between commas.
struct ClArgument {
  std::string text;  ///< a word, in capitals; empty for numbers
  double value = 0.0;
  bool number = false;
  int line = 0, column = 0;
};
/// As it may be shown to the user.
std::string shown(const ClArgument& argument);

struct ClStatement {
  std::string word;  ///< in capitals: "GOTO"; "$$" for a comment, "$$->CSYS" for Creo's data in comments
  std::string text;  ///< what follows, of the words that carry free text (PARTNO, PPRINT, INSERT, $$)
  std::vector<ClArgument> arguments;
  int line = 0, column = 0;
  bool comment() const { return word[0] == '$'; }
};

/// Where the lines come from.
class ClLines {
 public:
  virtual ~ClLines() = default;
  /// The next line without its end, valid until the next call; false at the end.
  virtual bool next(std::string_view& line) = 0;
};

/// The lines of a text that outlives them; CR LF, LF and CR all end one.
class ClText final : public ClLines {
 public:
  explicit ClText(std::string_view text);
  bool next(std::string_view& line) override;

 private:
  std::string_view rest_;
};

/// Splits lines into statements. Blanks count for nothing outside free text, letters may be small.
class ClScanner {
 public:
  /// `lines` must outlive the scanner.
  explicit ClScanner(ClLines& lines) : lines_(lines) {}
  /// The next statement; false at the end. A statement with a fault ("bad-number", "bad-statement") is
  /// reported and left out. Reuses the memory of `statement`.
  ///
  /// Statements within statements, as in TLON,GOFWD/(CIRCLE/0,0,0,5),ON,(LINE/0,0,0,5,0,0), become one list:
  /// GOFWD CIRCLE 0 0 0 5 ON LINE 0 0 0 5 0 0. Brackets must match.
  bool next(ClStatement& statement, Reporter& reporter);
  /// A line with anything but blanks has come.
  bool any_text() const { return any_text_; }

 private:
  /// The next line without its comment; `goes_on`: it ends with $.
  bool next_line(bool& goes_on);
  /// Where the arguments of a comment that carries data begin; npos when it is a comment alone.
  size_t read_comment(size_t begin, ClStatement& statement, bool& goes_on);
  /// Free text, over several lines where $ ends one.
  void read_text(size_t at, bool may_go_on, ClStatement& statement);
  bool read_arguments(size_t at, bool goes_on, ClStatement& statement, Reporter& reporter);
  bool read_nested(size_t at, bool goes_on, ClStatement& statement, Reporter& reporter);
  bool read_argument(size_t begin, size_t end, ClStatement& statement, Reporter& reporter) const;
  bool ends_inside(const ClStatement& statement, Reporter& reporter) const;

  ClLines& lines_;
  std::string_view whole_;  ///< the current line
  std::string_view line_;   ///< without what follows a $
  int number_ = 0;          ///< 1-based, of the current line
  bool any_text_ = false;
};

}  // namespace swarf::program
