// Diagnostics of one program text: adds the file name, counts, and stops after a page of them.
#pragma once

#include <string>

#include "base/diagnostics.h"

namespace swarf::program {

/// After this many problems the rest of a file is not read: one early slip has usually caused them.
inline constexpr int kMaxProblems = 50;

class Reporter {
 public:
  Reporter(Diagnostics& sink, std::string file);

  /// Line and column are 1-based; 0 means the whole file or the whole line. Ignored once full().
  void error(std::string code, int line, int column, std::string text, std::string fix);
  void warning(std::string code, int line, int column, std::string text, std::string fix);

  /// True once kMaxProblems have been reported; a note "too-many-problems" then ends the list.
  bool full() const { return problems_ >= kMaxProblems; }
  int errors() const { return errors_; }
  SourceLocation at(int line, int column) const { return {file_, line, column}; }

 private:
  void count(int line);

  Diagnostics& sink_;
  std::string file_;
  int problems_ = 0;
  int errors_ = 0;
};

}  // namespace swarf::program
