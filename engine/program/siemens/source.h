// One program file of Siemens 840D: its lines, labels, block numbers and the partners of its loops. The text
// stays in the file; only a window of it is kept.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "program/letters/line_source.h"
#include "program/siemens/lexer.h"

namespace swarf::program::nc::siemens {

class Source {
 public:
  /// Reads the file once. Throws InputError "not-text", "line-too-long", "empty-file" (also when it has
  /// nothing but white space), "file-not-found", "file-unreadable".
  explicit Source(const std::string& path);
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  const std::string& path() const { return reader_.path(); }
  int lines() const { return lines_; }
  /// `index` counts from 0, LineRef::line from 1. Valid until this source is asked for anything else.
  LineRef line(int index);

  /// The line with this label or block number (N100), looking from `from` forwards (step 1) or backwards
  /// (step -1), `from` itself included.
  std::optional<int> find_label(std::string_view label, int from, int step);

  /// Where IF, ELSE, WHILE, FOR, LOOP, REPEAT and their ends jump to:
  ///   IF -> ELSE or ENDIF, ELSE -> ENDIF; a loop's head <-> its end.
  /// Throws InputError "unclosed-structure", "end-without-start" for the first that does not fit, once asked.
  int partner(int index);

 private:
  void pair_structures();
  std::optional<int> search_label(std::string_view label, int from, int step);

  nc::LineSource reader_;
  std::vector<nc::LineSource::Mark> marks_;  ///< of every kMarked-th line
  int lines_ = 0;
  std::map<std::tuple<std::string, int, int>, std::optional<int>> labels_;  ///< jumps that were looked for
  bool paired_ = false;
  std::map<int, int> partner_;
};

}  // namespace swarf::program::nc::siemens
