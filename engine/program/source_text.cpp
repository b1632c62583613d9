#include "program/source_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "base/file.h"

namespace swarf::program {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

uint8_t byte_at(std::string_view text, size_t at) {
  return at < text.size() ? static_cast<uint8_t>(text[at]) : uint8_t{0};
}

bool in_range(uint8_t byte, uint8_t low, uint8_t high) {
  return byte >= low && byte <= high;
}

/// Range of the second byte, which alone excludes overlong forms, surrogates and what lies too high.
bool second_byte_fits(uint8_t lead, uint8_t second) {
  switch (lead) {
    case 0xE0:
      return in_range(second, 0xA0, 0xBF);
    case 0xED:
      return in_range(second, 0x80, 0x9F);
    case 0xF0:
      return in_range(second, 0x90, 0xBF);
    case 0xF4:
      return in_range(second, 0x80, 0x8F);
    default:
      return in_range(second, 0x80, 0xBF);
  }
}

void report_not_text(std::string_view text, size_t at, int line, int column, Reporter& reporter) {
  const std::string what =
      text[at] == '\0' ? "a NUL byte" : fmt::format("byte 0x{:02X}, which is not UTF-8,", byte_at(text, at));
  reporter.error("not-text", line, column,
                 fmt::format("{} stands at offset {} of the file: this is not text", what, at),
                 "save the program as plain ASCII or UTF-8 text");
}

std::ifstream open_file(const std::string& path) {
  refuse_special_file(path);
  std::error_code problem;
  const auto status = std::filesystem::status(path, problem);
  if (status.type() == std::filesystem::file_type::not_found) {
    throw InputError("file-not-found", {path, 0, 0}, "there is no such file",
                     "check the path of the program");
  }
  std::ifstream stream(path, std::ios::binary);
  if (status.type() != std::filesystem::file_type::regular || !stream) {
    throw InputError("file-unreadable", {path, 0, 0}, "this is not a file that can be read",
                     "give the path of a program file that you may read");
  }
  return stream;
}

}  // namespace

int utf8_length(std::string_view text, size_t at) {
  const uint8_t lead = byte_at(text, at);
  if (lead < 0x80) return 1;
  const int length = in_range(lead, 0xC2, 0xDF)   ? 2
                     : in_range(lead, 0xE0, 0xEF) ? 3
                     : in_range(lead, 0xF0, 0xF4) ? 4
                                                  : 0;
  if (length == 0 || !second_byte_fits(lead, byte_at(text, at + 1))) return 0;
  for (int i = 2; i < length; ++i) {
    if (!in_range(byte_at(text, at + static_cast<size_t>(i)), 0x80, 0xBF)) return 0;
  }
  return length;
}

bool check_text(std::string_view text, Reporter& reporter, const char* what_to_give) {
  int line = 1;
  int column = 1;
  bool blank = true;
  for (size_t at = text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0; at < text.size();) {
    const int length = utf8_length(text, at);
    const char c = text[at];
    if (length == 0 || c == '\0') {
      report_not_text(text, at, line, column, reporter);
      return false;
    }
    const bool line_end = c == '\n' || (c == '\r' && byte_at(text, at + 1) != '\n');
    blank = blank && (line_end || c == '\r' || c == ' ' || c == '\t');
    line += line_end ? 1 : 0;
    column = line_end ? 1 : column + 1;
    at += static_cast<size_t>(length);
  }
  if (blank) {
    reporter.error("empty-file", 0, 0, "the program is empty", what_to_give);
  }
  return !blank;
}

std::vector<std::string_view> split_lines(std::string_view text) {
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const size_t end = std::min(text.find_first_of("\r\n"), text.size());
    lines.push_back(text.substr(0, end));
    const size_t skip = text.substr(end).starts_with("\r\n") ? 2 : 1;
    text.remove_prefix(std::min(end + skip, text.size()));
  }
  return lines;
}

std::string read_file(const std::string& path) {
  std::ifstream stream = open_file(path);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::map<int, std::string> read_lines(const std::string& path, const std::set<int>& wanted) {
  std::map<int, std::string> lines;
  std::ifstream stream = open_file(path);
  std::string text;
  bool after_return = false;
  int number = 1;
  const auto end_line = [&] {
    if (number == 1 && text.starts_with(kByteOrderMark)) text.erase(0, kByteOrderMark.size());
    if (wanted.contains(number)) lines.emplace(number, text);
    text.clear();
    ++number;
  };
  for (std::istreambuf_iterator<char> at(stream), end; at != end && lines.size() < wanted.size(); ++at) {
    const char c = *at;
    if (c == '\r' || (c == '\n' && !after_return)) {
      end_line();
    } else if (c != '\n' && (number == 1 || wanted.contains(number))) {
      text += c;
    }
    after_return = c == '\r';
  }
  if (!text.empty()) end_line();
  return lines;
}

}  // namespace swarf::program
