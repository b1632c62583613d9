#include "program/reporter.h"

#include <fmt/format.h>

#include <utility>

namespace swarf::program {

Reporter::Reporter(Diagnostics& sink, std::string file) : sink_(sink), file_(std::move(file)) {}

void Reporter::error(std::string code, int line, int column, std::string text, std::string fix) {
  if (full()) return;
  sink_.error(std::move(code), at(line, column), std::move(text), std::move(fix));
  ++errors_;
  count(line);
}

void Reporter::warning(std::string code, int line, int column, std::string text, std::string fix) {
  if (full()) return;
  sink_.warning(std::move(code), at(line, column), std::move(text), std::move(fix));
  count(line);
}

void Reporter::count(int line) {
  ++problems_;
  if (!full()) return;
  sink_.note("too-many-problems", at(line, 0),
             fmt::format("{} problems are listed; the rest of the file was not read", kMaxProblems));
}

}  // namespace swarf::program
