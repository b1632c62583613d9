#include "program/evidence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace swarf::program {
namespace {

bool letter_of_name(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_';
}
bool digit_of_word(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

/// Whether '(' behind `before` belongs to the block: it opens the arguments of a name of two letters or more,
/// or a part of a formula. Behind a word (G0, X1.5), a ']' or nothing it opens a comment.
bool opens_arguments(std::string_view before) {
  const size_t last = before.find_last_not_of(" \t");
  if (last == std::string_view::npos) return false;
  if (std::string_view("=+-*/,(<>").find(before[last]) != std::string_view::npos) return true;
  if (!letter_of_name(before[last]) && !digit_of_word(before[last])) return false;
  size_t first = last;
  while (first > 0 && (letter_of_name(before[first - 1]) || digit_of_word(before[first - 1]))) --first;
  return last > first && letter_of_name(before[first]) && letter_of_name(before[first + 1]);
}

}  // namespace

void Evidence::add(int points, std::string_view what, long line) {
  if (score == 0) reason = fmt::format("{} in line {}", what, line);
  score += points;
}

std::string code_of_line(std::string_view line) {
  std::string code;
  int arguments = 0;  // open parentheses of the block itself
  for (size_t at = 0; at < line.size(); ++at) {
    const char c = line[at];
    if (c == ';') break;
    if (c == '"') {
      const size_t close = std::min(line.find('"', at + 1), line.size() - 1);
      code += line.substr(at, close - at + 1);
      at = close;
    } else if (c == '(' && arguments == 0 && !opens_arguments(code)) {
      at = std::min(line.find(')', at), line.size());
    } else {
      arguments += c == '(' ? 1 : c == ')' ? -1 : 0;
      code += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    }
  }
  const size_t first = std::min(code.find_first_not_of(" \t"), code.size());
  return code.substr(first, code.find_last_not_of(" \t") + 1 - first);
}

void ProgramHead::add(std::string_view line) {
  lines.push_back({static_cast<long>(lines.size()) + 1, std::string(line), code_of_line(line)});
}

bool has_word(std::string_view code, std::string_view word) {
  for (size_t at = code.find(word); at != std::string_view::npos; at = code.find(word, at + 1)) {
    const char next = at + word.size() < code.size() ? code[at + word.size()] : '\0';
    const bool letter_before = at > 0 && letter_of_name(code[at - 1]);
    if (!digit_of_word(next) && next != '.' && !letter_before) return true;
  }
  return false;
}

}  // namespace swarf::program
