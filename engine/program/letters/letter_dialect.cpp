#include "program/letters/letter_dialect.h"

#include <fmt/format.h>

namespace swarf::program::nc {

LineSource& LetterDialect::open(const std::string& path) {
  for (const auto& one : sources_) {
    if (one->path() == path) return *one;
  }
  sources_.push_back(std::make_unique<LineSource>(path, control_));
  return *sources_.back();
}

void LetterDialect::at_line(const LineSource& source) {
  ++control_.report.summary.lines;
  control_.report.at(source.file(), static_cast<int>(source.line_number()), 1);
}

bool LetterDialect::percent(std::string_view line, bool in_pairs) {
  reader_.begin(line);
  reader_.skip_space();
  if (reader_.peek() != '%') return false;
  if (line.find_first_not_of("% \t\r", reader_.at()) != std::string_view::npos)
    control_.report.fail("unexpected-character", reader_.column() + 1, "'%' stands alone on its line",
                         "put the words on a line of their own");
  const bool after_blocks = control_.report.summary.blocks > 0;
  if (in_pairs && after_blocks && !percent_seen_)
    control_.report.fail("unexpected-character", reader_.column(),
                         "'%' ends a program that does not begin with '%'",
                         "write '%' in the first line too, or end with M2 or M30");
  ended_ = percent_seen_ || after_blocks;
  percent_seen_ = true;
  return true;
}

void LetterDialect::warn_of_missing_end(const char* ends) {
  control_.report.warn_once(
      "missing-end", 0, fmt::format("the program ends with its file, without {}: it may be cut off", ends),
      "transfer it again, or write its end");
}

void LetterDialect::check_letter(char letter, bool allowed, const char* used_with) {
  if (!block_.has(letter) || allowed) return;
  control_.report.fail("unexpected-word", column(letter),
                       fmt::format("{} has no meaning in this block", letter),
                       fmt::format("{} stands with {}", letter, used_with));
}

void LetterDialect::need(char letter, const char* with) {
  if (block_.has(letter)) return;
  control_.report.fail("missing-word", 0, fmt::format("{} needs the word {}", with, letter),
                       fmt::format("add {}", letter));
}

void LetterDialect::check_feed_and_speed() {
  if (block_.has('F') && !(block_.get('F') > 0.0))
    control_.report.fail("bad-feed", column('F'), fmt::format("F {:g} is not a feed", block_.get('F')),
                         "write a feed above zero");
  if (block_.has('S') && block_.get('S') < 0.0)
    control_.report.fail("out-of-range", column('S'), fmt::format("S {:g} is below zero", block_.get('S')),
                         "write S0 or more; M4 turns the other way");
}

}  // namespace swarf::program::nc
