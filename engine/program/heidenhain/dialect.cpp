// How Heidenhain conversational programs are recognised.
#include <fmt/format.h>

#include "program/heidenhain/dialect.h"

namespace swarf::program::nc::heidenhain {
namespace {

std::string_view without_number(std::string_view line) {
  const size_t start = line.find_first_not_of(" \t0123456789");
  return start == std::string_view::npos ? std::string_view() : line.substr(start);
}

}  // namespace

/// BEGIN PGM stands in the first line that is not empty; no other dialect has it, whatever its words score.
Evidence evidence(std::string_view head, std::string_view extension) {
  if (head.starts_with("\xEF\xBB\xBF")) head.remove_prefix(3);
  int number = 0;
  while (!head.empty()) {
    const size_t end = std::min(head.find_first_of("\r\n"), head.size());
    const std::string_view line = without_number(head.substr(0, end));
    ++number;
    if (line.starts_with("BEGIN PGM")) return {1'000'000, fmt::format("'BEGIN PGM' in line {}", number)};
    const bool comment = line.starts_with(";") || line.starts_with("*");
    if (!line.empty() && !comment) break;
    head.remove_prefix(std::min(head.size(), end + 1));
  }
  if (extension == ".h") return {1, "the ending .h"};
  return {};
}

}  // namespace swarf::program::nc::heidenhain
