// Blocks of Heidenhain conversational programs as text: block numbers, comments and continuations are gone,
// every character still knows its line and column.
//
//   12 CYCL DEF 200 DRILLING ~          one block of three lines
//      Q200=+2    ;SET-UP CLEARANCE ~
//      Q201=-20   ;DEPTH
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "program/control/control.h"
#include "program/letters/line_source.h"

namespace swarf::program::nc::heidenhain {

/// One block. Letters outside of quotes are capitals.
struct BlockText {
  struct Piece {
    size_t offset = 0;   ///< in `text`, where this line's part starts
    int line = 0;        ///< 1-based
    size_t skipped = 0;  ///< bytes of the line before that part
    size_t begin = 0;    ///< in `written`, where the line starts
  };
  std::string text;
  std::string comment;  ///< what stood behind ';', or the '*' line
  std::vector<Piece> pieces;
  std::string written;  ///< the lines as they stand in the file, one behind the other
  long skipped = 0;     ///< lines before it that have no words: comments, empty ones
  int file = 0;
  nc::LineSource::Mark mark;  ///< where it starts, to be read again after a jump
  int line() const { return pieces.empty() ? 0 : pieces.front().line; }
  /// The n-th line of the block as it stands in the file.
  std::string_view line_text(size_t n) const {
    const size_t end = n + 1 < pieces.size() ? pieces[n + 1].begin : written.size();
    return std::string_view(written).substr(pieces[n].begin, end - pieces[n].begin);
  }
  void clear();
};

/// Reads the next block that has words; comments alone go to `comments`. False at the end of the file.
/// "open-continuation": the file ends behind '~'.
bool read_block(nc::LineSource& source, nc::Control& control, BlockText& block,
                std::vector<std::pair<int, std::string>>& comments);

class Parameters;

/// Reads a block from left to right. Faults carry the place of the character.
class BlockReader {
 public:
  BlockReader(const BlockText& block, nc::Control& control, Parameters& parameters)
      : block_(block), control_(control), parameters_(parameters) {}

  /// Nothing but white space is left.
  bool done();
  size_t offset() const { return at_; }
  void move_to(size_t offset) { at_ = offset; }
  char peek() const { return at_ < block_.text.size() ? block_.text[at_] : '\0'; }
  char peek_after(size_t ahead) const {
    return at_ + ahead < block_.text.size() ? block_.text[at_ + ahead] : '\0';
  }
  void skip() { ++at_; }
  /// The run of letters here, up to a parameter (F of FQ50); empty when something else stands here. White
  /// space before it is passed.
  std::string_view letters();
  /// The same, and passes it.
  std::string_view take_letters();
  /// Passes the word when it is the whole run of letters here.
  bool take(std::string_view word);
  bool take_char(char c);
  /// A sign, a digit, a point or a Q parameter stands here.
  bool value_follows();
  /// A signed number or Q parameter ("missing-number").
  double value();
  /// A number without sign or parameter, as in M128 and LBL 5 ("missing-number", "not-whole-number").
  long whole_number(long max);
  /// The same where a point may follow: 7 of "7.1".
  long whole_number_before_point(long max);
  /// A Q parameter, not just the letter, stands here.
  bool parameter_follows() const;
  /// A whole value, which may be a Q parameter.
  long whole_value(long min, long max);
  /// Between quotes ("unclosed-string").
  std::string quoted();
  /// "quoted" or a QS parameter.
  std::string text_value();
  /// What is left, without white space at its end; passes it.
  std::string_view rest();
  /// "unexpected-word" unless the block ends here.
  void expect_end();

  nc::Place place_of(size_t offset) const;
  int column(size_t offset) const { return place_of(offset).column; }
  const BlockText& block() const { return block_; }
  nc::Control& control() { return control_; }
  Parameters& parameters() { return parameters_; }
  [[noreturn]] void fail(const char* code, size_t offset, std::string text, std::string fix) const;

 private:
  bool parameter_at(size_t offset) const;

  const BlockText& block_;
  nc::Control& control_;
  Parameters& parameters_;
  size_t at_ = 0;
};

}  // namespace swarf::program::nc::heidenhain
