// How Heidenhain conversational programs are recognised.
#include "program/heidenhain/dialect.h"

#include <algorithm>

namespace swarf::program::nc::heidenhain {

/// BEGIN PGM stands in the first line that is not empty; no other dialect has it, whatever its words score.
Evidence evidence(const ProgramHead& head) {
  Evidence found;
  for (const HeadLine& line : head.lines) {
    const size_t first = std::min(line.code.find_first_not_of(" \t0123456789"), line.code.size());
    const std::string_view words = std::string_view(line.code).substr(first);
    if (words.starts_with("BEGIN PGM")) found.add(1'000'000, "'BEGIN PGM'", line.number);
    if (!words.empty() && !words.starts_with("*")) break;
  }
  if (found.score == 0 && head.extension == ".h") found = {1, "the ending .h"};
  return found;
}

}  // namespace swarf::program::nc::heidenhain
