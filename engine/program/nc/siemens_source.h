// One program file of Siemens 840D: its lines, labels, block numbers and the partners of its loops.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "program/nc/siemens_lexer.h"

namespace swarf::program::siemens {

class Source {
 public:
  /// Throws InputError "not-text", "empty-file".
  Source(std::string path, std::string text);
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  const std::string& path() const { return path_; }
  int lines() const { return static_cast<int>(starts_.size()); }
  /// `index` counts from 0, LineRef::line from 1.
  LineRef line(int index) const;

  /// The line with this label or block number (N100), looking from `from` forwards (step 1) or backwards
  /// (step -1), `from` itself included.
  std::optional<int> find_label(std::string_view label, int from, int step) const;

  /// Where IF, ELSE, WHILE, FOR, LOOP, REPEAT and their ends jump to:
  ///   IF -> ELSE or ENDIF, ELSE -> ENDIF; a loop's head <-> its end.
  /// Throws InputError "unclosed-structure", "end-without-start" for the first that does not fit, once asked.
  int partner(int index);

 private:
  void pair_structures();

  std::string path_, text_;
  std::vector<size_t> starts_;
  bool paired_ = false;
  std::map<int, int> partner_;
};

}  // namespace swarf::program::siemens
