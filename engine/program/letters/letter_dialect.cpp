#include "program/letters/letter_dialect.h"

#include <fmt/format.h>

namespace swarf::program::nc {

LineSource& LetterDialect::open(const std::string& file) {
  for (const auto& one : sources) {
    if (one->path() == file) return *one;
  }
  sources.push_back(std::make_unique<LineSource>(file, control));
  return *sources.back();
}

void LetterDialect::at_line(const LineSource& source) {
  ++control.report.summary.lines;
  control.report.at(source.file(), static_cast<int>(source.line_number()), 1);
}

bool LetterDialect::percent(std::string_view line, bool in_pairs) {
  reader.begin(line);
  reader.skip_space();
  if (reader.peek() != '%') return false;
  if (line.find_first_not_of("% \t\r", reader.at()) != std::string_view::npos)
    control.report.fail("unexpected-character", reader.column() + 1, "'%' stands alone on its line",
                        "put the words on a line of their own");
  const bool after_blocks = control.report.summary.blocks > 0;
  if (in_pairs && after_blocks && !percent_seen)
    control.report.warn_once("percent-alone", reader.column(),
                             "'%' ends the program here, which did not begin with one: LinuxCNC itself stops "
                             "at it with an error",
                             "write '%' in the first line too, or take this one out");
  ended = percent_seen || after_blocks;
  percent_seen = true;
  return true;
}

void LetterDialect::warn_of_missing_end(const char* ends) {
  control.report.warn_once("missing-end", 0,
                           fmt::format("the program ends with its file, without {}: it may be cut off", ends),
                           "transfer it again, or write its end");
}

void LetterDialect::check_letter(char letter, bool allowed, const char* used_with) {
  if (!block.has(letter) || allowed) return;
  control.report.fail("unexpected-word", column(letter),
                      fmt::format("{} has no meaning in this block", letter),
                      fmt::format("{} stands with {}", letter, used_with));
}

void LetterDialect::need(char letter, const char* with) {
  if (block.has(letter)) return;
  control.report.fail("missing-word", 0, fmt::format("{} needs the word {}", with, letter),
                      fmt::format("add {}", letter));
}

void LetterDialect::check_feed_and_speed() {
  if (block.has('F') && !(block.get('F') > 0.0))
    control.report.fail("bad-feed", column('F'), fmt::format("F {:g} is not a feed", block.get('F')),
                        "write a feed above zero");
  if (block.has('S') && block.get('S') < 0.0)
    control.report.fail("out-of-range", column('S'), fmt::format("S {:g} is below zero", block.get('S')),
                        "write S0 or more; M4 turns the other way");
}

}  // namespace swarf::program::nc
