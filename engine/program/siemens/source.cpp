#include "program/siemens/source.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "program/control/report.h"
#include "program/siemens/lexer.h"

namespace swarf::program::nc::siemens {
namespace {

/// What stands before the words of a block: /2 N100 LABEL:
struct Head {
  std::string number, label;  ///< N100; in capitals
  std::string word;           ///< first name after them, in capitals
};

Head head_of(std::string_view line) {
  Head head;
  size_t at = 0;
  const auto skip_space = [&] {
    while (at < line.size() && (line[at] == ' ' || line[at] == '\t')) ++at;
  };
  const auto run = [&] {
    const size_t start = at;
    while (at < line.size() && in_name(line[at])) ++at;
    return capitals(line.substr(start, at - start));
  };
  skip_space();
  if (at < line.size() && line[at] == '/') {
    ++at;
    while (at < line.size() && is_digit(line[at])) ++at;
    skip_space();
  }
  if (at + 1 < line.size() && (line[at] == 'N' || line[at] == 'n') && is_digit(line[at + 1])) {
    const size_t start = at++;
    while (at < line.size() && is_digit(line[at])) ++at;
    head.number = capitals(line.substr(start, at - start));
    skip_space();
  }
  head.word = run();
  skip_space();
  if (!head.word.empty() && at < line.size() && line[at] == ':') {
    head.label = std::move(head.word);
    ++at;
    skip_space();
    head.word = run();
  }
  return head;
}

/// "N0100" and "N100" are one number.
std::string without_zeros(const std::string& number) {
  const size_t first = number.find_first_not_of('0', 1);
  return first == std::string::npos ? "N0" : fmt::format("N{}", number.substr(first));
}

/// Whether a block that begins with IF is one by itself (IF ... GOTOF ...), or REPEAT names labels.
bool single_block(const LineRef& line, std::string_view word) {
  std::vector<Token> tokens;
  lex(line, tokens);
  if (word == "IF") {
    return std::any_of(tokens.begin(), tokens.end(), [](const Token& token) {
      return token.kind == TokenKind::kName && token.name.starts_with("GOTO");
    });
  }
  const auto repeat =
      std::find_if(tokens.begin(), tokens.end(), [](const Token& token) { return token.named("REPEAT"); });
  return repeat != tokens.end() && repeat + 1 != tokens.end();
}

/// So many lines are passed to come to one that is jumped to.
constexpr int kMarked = 64;

struct Pair {
  std::string_view head, end;
};
constexpr std::array<Pair, 5> kPairs = {
    {{"IF", "ENDIF"}, {"WHILE", "ENDWHILE"}, {"FOR", "ENDFOR"}, {"LOOP", "ENDLOOP"}, {"REPEAT", "UNTIL"}}};

}  // namespace

Source::Source(const std::string& path) : reader_(path) {
  bool blank = true;
  std::string_view line;
  for (;;) {
    const nc::LineSource::Mark here = reader_.mark();
    if (!reader_.next(line)) break;
    if (lines_++ % kMarked == 0) marks_.push_back(here);
    blank = blank && line.find_first_not_of(" \t") == std::string_view::npos;
  }
  if (blank) nc::Report::fail_at({path, 0, 0}, "empty-file", "the program is empty", "give an NC program");
}

LineRef Source::line(int index) {
  const bool ahead = reader_.line_number() <= index && index - reader_.line_number() < kMarked;
  if (!ahead) reader_.seek(marks_[static_cast<size_t>(index / kMarked)]);
  std::string_view text;
  while (reader_.line_number() <= index) reader_.next(text);
  return {&reader_.path(), index + 1, text};
}

std::optional<int> Source::find_label(std::string_view label, int from, int step) {
  const auto [place, fresh] = labels_.try_emplace({std::string(label), from, step});
  if (fresh) place->second = search_label(label, from, step);
  return place->second;
}

std::optional<int> Source::search_label(std::string_view label, int from, int step) {
  const bool number = label.size() > 1 && label[0] == 'N' && is_digit(label[1]);
  const std::string wanted = number ? without_zeros(std::string(label)) : std::string(label);
  for (int index = from; index >= 0 && index < lines(); index += step) {
    const Head head = head_of(line(index).text);
    if (number ? !head.number.empty() && without_zeros(head.number) == wanted : head.label == wanted) {
      return index;
    }
  }
  return std::nullopt;
}

int Source::partner(int index) {
  if (!paired_) pair_structures();
  paired_ = true;
  const auto found = partner_.find(index);
  if (found != partner_.end()) return found->second;
  const LineRef here = line(index);
  refuse(here, here.text.find_first_not_of(" \t"), "bad-block",
         "this word of a loop or branch does not begin its block",
         "write it first, after the block number and the label");
}

void Source::pair_structures() {
  struct Open {
    std::string_view word;
    int head, last;  ///< last: ELSE, or the head itself
  };
  std::vector<Open> open;
  for (int index = 0; index < lines(); ++index) {
    const LineRef here = line(index);
    const std::string word = head_of(here.text).word;
    const size_t offset = here.text.find_first_not_of(" \t");
    const auto starts = [&](const Pair& pair) { return pair.head == word; };
    const auto ends = [&](const Pair& pair) { return pair.end == word; };
    if (const auto* pair = std::find_if(kPairs.begin(), kPairs.end(), starts); pair != kPairs.end()) {
      const bool single = (word == "IF" || word == "REPEAT") && single_block(here, word);
      if (!single) open.push_back({pair->head, index, index});
      continue;
    }
    const auto* pair = std::find_if(kPairs.begin(), kPairs.end(), ends);
    const bool is_else = word == "ELSE";
    if (pair == kPairs.end() && !is_else) continue;
    const std::string_view wanted = is_else ? "IF" : pair->head;
    if (open.empty() || open.back().word != wanted || (is_else && open.back().last != open.back().head)) {
      refuse(here, offset, "end-without-start",
             open.empty() ? fmt::format("{} has no {} before it", word, wanted)
                          : fmt::format("{} stands inside the {} of line {}", word, open.back().word,
                                        open.back().head + 1),
             fmt::format("every {} belongs to one {}", word, wanted));
    }
    partner_[open.back().last] = index;
    if (is_else) {
      open.back().last = index;
      continue;
    }
    partner_[index] = open.back().head;
    open.pop_back();
  }
  if (open.empty()) return;
  const LineRef head = line(open.back().head);
  const std::string_view word = open.back().word;
  const auto* pair =
      std::find_if(kPairs.begin(), kPairs.end(), [&](const Pair& p) { return p.head == word; });
  refuse(head, head.text.find_first_not_of(" \t"), "unclosed-structure",
         fmt::format("{} has no {} after it", word, pair->end), fmt::format("close it with {}", pair->end));
}

}  // namespace swarf::program::nc::siemens
